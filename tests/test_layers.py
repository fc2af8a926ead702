"""Imports point down only, and what is not needed is not imported."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parent.parent / "stability"

# Every module has its layer; a new module must be given one here.
LAYERS = [
    {"errors", "arithmetic", "spectrum", "realroots", "polynomials", "roots", "verdict", "wedges", "__init__"},
    {"userfile"},
    {"parameters", "registry", "bounded", "fast", "puiseux", "forms", "progress", "bracketing", "cured"},
    {"symbols", "balls", "compiled", "layers", "general"},
    {"closures.checks"},
    {"closures.base", "flows.base", "closures", "flows", "directions"},
    {"closures.plane_flow", "records"},
    {f"closures.{n}" for n in ("drucker_prager", "inertial_number", "dilatant_flow", "cosserat")}
    | {"closures.nonlocal_fluidity", "closures.double_shearing"}
    | {f"flows.{n}" for n in ("uniform_strain", "radial_hopper")},
    {f"closures.{n}" for n in ("mu_i", "mu_i_regularised", "mu_i_phi_i", "compressible_i", "critical_state")}
    | {"closures.deviatoric", "closures.viscous", "flows.uniform_fraction", "flows.uniform_fluidity"},
    {"linearise"},
    {"structure"},
    {"tangent"},
    {"emit"},
    {"pointwise"},
    {"codegen"},
    {"model"},
    {"results", "precise", "enclosures", "hoisted", "finite", "causes", "singular", "symbolmap"},
    {"certified", "sweep", "probe", "judge"},
    {"guaranteed", "proof"},
    {"analyses"},
    {f"analyses.{n}" for n in ("growth_map", "reductions", "adaptive", "neutral_curve", "phase_diagram", "certify")}
    | {"analyses.short_waves"},
    {"api"},
    # The time-stepper: siblings of the analyses, which neither import it nor are imported by it.
    {"timestepper"},
    {f"timestepper.{n}" for n in ("mesh", "ordering", "multigrid", "pattern", "volumes", "checkpoint", "paraview")},
    {f"timestepper.{n}" for n in ("law", "linear", "constraints", "compiled")},
    {"timestepper.walls"},
    {"timestepper.problem"},
    {f"timestepper.{n}" for n in ("hopper", "diagnostics", "newton", "output")},
    {"timestepper.integrate"},
    {"timestepper.march"},
    {"timestepper.forecast"},
    # The flow fields that users bring.
    {"field", "field.answers", "field.grids", "field.vtkxml", "field.vtklibrary", "field.guides", "field.waves"},
    {"field.gradients", "field.search", "field.reading", "field.writing"},
    {"field.states", "field.judging"},
    {"field.labels", "opened", "estimates"},
    {"field.mapping", "cure"},
    {"leastcure"},
    # The one place that knows both theory and time-stepper.
    {"crosscheck.theory", "crosscheck.orders"},
    {"crosscheck.symbol", "crosscheck.cell", "crosscheck.modes"},
    {"crosscheck.waves", "crosscheck.first_waves"},
    {"crosscheck.saturation"},
    {"crosscheck.tables"},
    {"crosscheck.report"},
    {"crosscheck"},
    {"scene.shape"},
    {"scene.requests"},
    {"scene.messages"},
    {"scene.numbers"},
    {"scene.fields", "scene.runs", "scene.cures"},
    {"scene.physics"},
    {"scene", "manual"},
    {"plan"},
    {"summary"},
    {"runner"},
    {"resuming"},
    {"plotting"},
    {"field.pictures"},
    {"cli"},
    {"__main__"},
]
LEVEL = {module: level for level, modules in enumerate(LAYERS) for module in modules}


def module_name(path: Path) -> str:
    parts = path.relative_to(PACKAGE).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" and len(parts) > 1 else parts)


MODULES = {module_name(path): path for path in sorted(PACKAGE.rglob("*.py"))}


def imported(path: Path) -> set[str]:
    """Return the package's own modules that a file imports anywhere, functions included."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] == "stability":
            base = node.module.removeprefix("stability").lstrip(".")
            for alias in node.names:
                deep = f"{base}.{alias.name}".lstrip(".")
                found.add(deep if deep in MODULES else base or "__init__")
        elif isinstance(node, ast.Import):
            found |= {a.name.removeprefix("stability.") for a in node.names if a.name.startswith("stability.")}
    return found


def test_every_module_has_a_layer():
    assert sorted(MODULES) == sorted(LEVEL)


@pytest.mark.parametrize("module", sorted(MODULES))
def test_imports_point_down_only(module):
    if module == "__init__":
        return  # the public names, at the top by nature; what it may load is tested below
    upward = {other for other in imported(MODULES[module]) if LEVEL[other] >= LEVEL[module] and other != "__init__"}
    assert not upward


def test_modules_stay_small():
    lengths = {m: len(p.read_text().splitlines()) for m, p in MODULES.items()}
    assert max(lengths.values()) <= 300, max(lengths, key=lengths.get)
    assert sorted(lengths.values())[len(lengths) // 2] <= 150


def loaded_after(code: str) -> set[str]:
    """Return the top-level packages that a fresh process holds after running ``code``."""
    script = f"import sys\n{code}\nprint(*sorted({{m.split('.')[0] for m in sys.modules}}))"
    return set(
        subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout.split()
    )


def test_importing_the_package_loads_no_heavy_library():
    heavy = {"sympy", "matplotlib", "xarray", "pandas", "scipy", "mpmath", "pydantic", "click", "rich", "numpy"}
    assert not heavy & loaded_after("import stability")


def test_registries_can_be_listed_without_sympy():
    assert "sympy" not in loaded_after("import stability as st; list(st.CLOSURES), list(st.FLOWS)")


def test_eigenvalues_from_a_warm_cache_need_no_sympy(perturbed_hopper):
    ask = (
        "import stability as st\n"
        f"st.eigenvalues('perturbed', 'radial_hopper', {perturbed_hopper!r}, dict(r=1, theta=0), 100.0, 45.0)"
    )
    loaded_after(ask)
    assert not {"sympy", "matplotlib"} & loaded_after(ask)


def test_running_a_figures_scene_from_a_warm_cache_needs_no_sympy_and_no_matplotlib():
    scene = PACKAGE.parent / "figures" / "scenes" / "P2.1.toml"
    run = f"import stability as st\nst.run({str(scene)!r})"
    loaded_after(run)
    assert not {"sympy", "matplotlib"} & loaded_after(run)
