"""The command ``stability``. Only click is imported here: each command imports what it needs when it runs."""

import json
import logging
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from time import perf_counter
from typing import Any

import click

from stability import CLOSURES, FLOWS, __version__, manual
from stability.errors import CheckpointError, SceneError, StabilityError

BAD_INPUT, NUMERICAL_FAILURE, INTERRUPTED = 2, 3, 130
CHECKPOINT = ".checkpoint"  # what follows the name of a result that is being made
NARROW = 100  # columns of formulas where there is no terminal to ask


class Commands(click.Group):
    """Commands whose errors are sentences on standard error and an exit status, not tracebacks."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except StabilityError as error:
            for problem in getattr(error, "problems", ()) or (str(error),):
                complain(problem)
            ctx.exit(BAD_INPUT if isinstance(error, SceneError | CheckpointError) else NUMERICAL_FAILURE)
        except KeyboardInterrupt as stop:
            complain(str(stop) or "interrupted: nothing was written")
            ctx.exit(INTERRUPTED)


def complain(problem: str) -> None:
    """Print a sentence on standard error; click leaves out the colour where that is no terminal."""
    plain = False if os.environ.get("NO_COLOR") else None
    click.echo(click.style("error: ", fg="red", bold=True) + problem, err=True, color=plain)


def warn(sentence: str) -> None:
    """Print a warning on standard error."""
    plain = False if os.environ.get("NO_COLOR") else None
    click.echo(click.style("warning: ", fg="yellow", bold=True) + sentence, err=True, color=plain)


class Told(logging.Handler):
    """Prints what the package reports on its way on standard error: a file that is executed, above all."""

    def emit(self, record: logging.LogRecord) -> None:
        """Print a report."""
        click.echo(f"stability: {record.getMessage()}", err=True)


FIELDS = {"closure": "needs the fields", "flow": "provides the fields"}
SETTINGS = {"help_option_names": ["-h", "--help"], "max_content_width": 100}


@click.group(cls=Commands, help=manual.ABOUT, context_settings=SETTINGS)
@click.version_option(__version__, prog_name="stability", message="%(prog)s %(version)s")
@click.pass_context
def main(context: click.Context) -> None:
    """Linear stability and well-posedness of granular flow."""
    log, told = logging.getLogger("stability"), Told(logging.INFO)
    log.addHandler(told)
    log.setLevel(logging.INFO)
    context.call_on_close(lambda: log.removeHandler(told))


@main.command(help=manual.RUN, short_help="Compute what a scene asks for, into a netCDF file.")
@click.argument("scene", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path), help="File to write.  [default: SCENE.nc, here]")
@click.option("-q", "--quiet", is_flag=True, help="No progress and no summary.")
def run(scene: Path, output: Path | None, quiet: bool) -> None:
    """Compute what SCENE asks for, write it as netCDF, and print a summary."""
    from stability.scene import load_scene

    output = writable(output or Path(f"{scene.stem}.nc"), scene)
    checked = load_scene(scene)  # a bad scene is told before the libraries of results are loaded
    from stability import runner

    if checked.request.kind == "march":
        kept = output.with_name(f"{output.name}{CHECKPOINT}")
        finish(lambda: runner.run(checked, progress=not quiet, checkpoint=kept), output, quiet, kept)
    else:
        finish(lambda: runner.run(checked, progress=not quiet), output, quiet)


@main.command(help=manual.RESUME, short_help="Go on with a march that was stopped.")
@click.argument("checkpoint", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path), help="File to write.  [default: as the run's own]")
@click.option("--scene", type=click.Path(path_type=Path), help="Go on by this scene, whose steps or floor differ.")
@click.option("-q", "--quiet", is_flag=True, help="No progress and no summary.")
def resume(checkpoint: Path, output: Path | None, scene: Path | None, quiet: bool) -> None:
    """Go on from CHECKPOINT, write the result as netCDF, and print a summary."""
    own = checkpoint.with_name(checkpoint.name.removesuffix(CHECKPOINT))
    output = writable(output or (own if own != checkpoint else checkpoint.with_suffix(".nc")), checkpoint)
    from stability.resuming import resume as resumed

    finish(lambda: resumed(checkpoint, not quiet, scene), output, quiet, checkpoint)


@main.command(help=manual.EXPORT, short_help="Write a march's fields, or a field map, for ParaView.")
@click.argument("result", type=click.Path(path_type=Path))
@click.option("--vtk", "folder", type=click.Path(path_type=Path), required=True, help="Folder for the files.")
@click.option("--scene", type=click.Path(path_type=Path), help="Of a field map, if RESULT does not lie beside it.")
def export(result: Path, folder: Path, scene: Path | None) -> None:
    """Write the fields of RESULT into a folder."""
    from stability import results

    try:
        ds = results.open_results(result)
    except OSError as error:
        raise SceneError(f"{result} cannot be read as a result: {error.strerror}") from None
    kind = ds.attrs.get("request")
    if kind not in ("march", "field_map"):
        raise SceneError(f"{result} is not the result of a march or a field_map: only these have fields to export")
    try:
        if kind == "march":
            from stability.timestepper.paraview import write_paraview

            written = write_paraview(ds, folder, result.stem)
            more = f" and {ds.sizes['time']} snapshots beside it"
        else:
            from stability.field.writing import write_vtk

            field, more = field_of(ds, scene or result), ""
            folder.mkdir(parents=True, exist_ok=True)
            written = write_vtk(ds, field, folder / f"{result.stem}{'.vts' if field.structured else '.vtu'}")
    except OSError as error:
        raise SceneError(f"--vtk {folder} cannot be written: {error.strerror}") from None
    click.echo(f"wrote {written}{more}; open it in ParaView")


def field_of(ds: Any, beside: Path) -> Any:
    """Return the field that a field map was made of, from the file that its scene names; runs no other file."""
    import tomllib

    from stability.estimates import field_in
    from stability.scene.requests import FieldMap

    ask = FieldMap.model_validate(tomllib.loads(ds.attrs["scene_text"])["request"])
    if not (beside.parent / ask.file).is_file():
        raise SceneError(
            f"the field of this map is in {ask.file}, and there is no {beside.parent / ask.file}: "
            "name the scene of the map, as in --scene scenes/map.toml"
        )
    return field_in(ask, beside.parent)


def finish(task: Callable[[], Any], output: Path, quiet: bool, kept: Path | None = None) -> None:
    """Run a task, write its result, print what it says, and remove the checkpoint that is no longer needed."""
    from stability import results
    from stability.summary import summary

    if kept and kept.exists() and not quiet:
        from stability.timestepper import checkpoint

        click.echo(f"going on from {kept}: {checkpoint.told(checkpoint.load(kept))}", err=True)
    start = perf_counter()
    result = task()
    taken = perf_counter() - start
    for warning in json.loads(result.attrs["plan_warnings"]):
        warn(warning)
    try:
        results.save(result, output)
    except OSError as error:
        left = f"; the run is kept in {kept}: make room, then stability resume {kept}" if kept else ""
        raise SceneError(f"--output {output} cannot be written: {error.strerror}{left}") from None
    if kept:
        from stability.timestepper import checkpoint

        checkpoint.remove(kept)
    if not quiet:
        predicted = json.loads(result.attrs["plan"])["predicted_seconds"]
        click.echo(summary(result))
        click.echo(f"  {'cost':<15}{taken:.2g} s; {predicted:.2g} s predicted")
        click.echo(f'\nwrote {output}; to open it: import stability; ds = stability.open_results("{output}")')


@main.command(help=manual.EXPLAIN, short_help="Say how a scene would be modelled, and what that costs.")
@click.argument("scene", type=click.Path(path_type=Path))
def explain(scene: Path) -> None:
    """Print the plan of SCENE without running it."""
    from stability.plan import plan
    from stability.scene import load_scene

    checked = load_scene(scene)
    found = plan(checked)
    reasons = "\n".join((" " * 17 + reason)[17 * (i == 0) :] for i, reason in enumerate(found.reasons))
    rows = [*found.rows(checked.tolerance.digits), ("reasons", reasons)]
    click.echo("\n".join([checked.title, *(f"  {name:<15}{text}" for name, text in rows)]))
    for warning in found.warnings:
        warn(warning)


def writable(output: Path, scene: Path) -> Path:
    """Return the path if a result can be written there, so that no run is lost for want of a place."""
    if output.is_dir():
        raise SceneError(f"--output {output} is a folder: name a file in it, such as {output / scene.stem}.nc")
    if not output.parent.is_dir():
        raise SceneError(f"--output {output}: there is no folder {output.parent}: make it, or choose another")
    if not os.access(output.parent, os.W_OK):
        raise SceneError(f"--output {output}: the folder {output.parent} cannot be written to: choose another")
    if output.exists() and scene.exists() and output.samefile(scene):
        raise SceneError(f"--output {output} is the scene itself: choose another name")
    return output


@main.command(name="list", short_help="List closures and flows with their parameters.")
@click.argument("what", type=click.Choice(["closures", "flows"]), required=False)
def list_(what: str | None) -> None:
    """List the closures and the flows, with the parameters that a scene must give them.

    Ranges are open: neither end is allowed. Angles are in degrees. One of your own, in a Python file, is named
    my_file.py:NAME (stability run --help).
    """
    for registry in (CLOSURES, FLOWS):
        if what in (None, f"{registry.kind}s"):
            click.echo("\n".join(listing(registry)))


def listing(registry: Any) -> Iterator[str]:
    """Yield the lines that describe every entry of a registry."""
    from stability import codegen

    tables = {}
    for name in registry:
        module = codegen.load(registry, name, codegen.RECORDS)
        words = {f"point.{r.word}": r for r in module.get("POINT", ())} | {r.word: r for r in module["PARAMETERS"]}
        tables[name] = module, [(word, r.unit, f"({r.low:g}, {r.high:g})", r) for word, r in words.items()]
    widths = [max(len(row[i]) for _, table in tables.values() for row in table) for i in range(3)]
    for name, (module, table) in tables.items():
        yield f'{registry.kind} = "{name}"'
        yield f"  {module['TITLE']} [{module['SOURCE']}]"
        if axis := module.get("AXIS"):
            yield f"  wave_angle is measured from {axis}"
        fields = ", ".join(n for f in module["FIELDS"] for n in (f if isinstance(f, tuple) else (f,)))
        yield f"  {FIELDS[registry.kind]} {fields}"
        for *cells, record in table:
            columns = "  ".join(f"{cell:<{width}}" for cell, width in zip(cells, widths, strict=True))
            yield f"    {columns}  {record.meaning} ({record.source})"
        yield ""


@main.command(help=manual.DERIVE, short_help="Print the tangent matrix of a closure.")
@click.argument("closure")
@click.option("--flow", help="Write the base state of this flow out in place of the letters (long).")
@click.option("--matrix", type=click.Choice(["full", "truncated", "leading"]), default="full", show_default=True)
@click.option("--format", "style", type=click.Choice(["text", "latex", "python"]), default="text", show_default=True)
def derive(closure: str, flow: str | None, matrix: str, style: str) -> None:
    """Derive the tangent matrix of CLOSURE and print it in the paper's letters."""
    for registry, name in ((CLOSURES, closure), (FLOWS, flow)):
        if name is not None and isinstance(registry.resolved(name), str):
            registry.place(name)  # raises for an unknown one before SymPy is imported
    from stability.api import tangent_matrix

    found = tangent_matrix(closure, flow, matrix)
    if style == "text":
        from stability.linearise import letters

        click.echo("\n".join(formulas(found, {} if flow else letters(CLOSURES[closure]))))
    elif style == "latex":
        from sympy import latex

        click.echo(latex(found))
    else:
        click.echo(str(found))


def formulas(matrix: Any, letters: dict) -> Iterator[str]:
    """Yield a matrix entry by entry, folded to the width of the terminal, and the letters in it."""
    from sympy import pretty

    width = shutil.get_terminal_size((NARROW, 24)).columns
    for i, j in ((i, j) for i in range(matrix.rows) for j in range(matrix.cols)):
        # Letters stay in ASCII: Unicode has an x but no y as a subscript, so that A_xx_x and A_xx_y looked unlike.
        yield f"[{i + 1}, {j + 1}] =\n{pretty(matrix[i, j], use_unicode=False, num_columns=width)}\n"
    yield from (f"{letter} = {definition}" for letter, definition in letters.items())
