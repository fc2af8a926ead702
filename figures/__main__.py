"""Draw the figures: `python -m figures [NAME ...] [--out DIR] [--fresh] [--full]`."""

import argparse
import sys
import time
from pathlib import Path

from matplotlib import style

from figures import A1, A2, A3, F1, I1, L1, N1, N2, N3, P1, P2_1, X1
from figures.common import HERE, STYLE, kept, result
from stability.errors import Interrupted
from stability.plotting import save

# The names of the paper's labels -> a function of `result` that returns the picture and its caption.
FIGURES = {
    "I1": I1.draw,
    "L1": L1.draw,
    "P1": P1.draw,
    "P2.1": P2_1.draw,
    "N1": N1.draw,
    "N2": N2.draw,
    "N3": N3.draw,
    "X1": X1.draw,
    "F1": F1.draw,
    "A1": A1.draw,
    "A2": A2.draw,
    "A3": A3.draw,
}


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m figures", description="Draw the paper's figures as PDF and PNG.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(FIGURES)}; all where none is named")
    parser.add_argument("--out", type=Path, default=HERE / "out", metavar="DIR", help="folder of pictures and results")
    parser.add_argument("--fresh", action="store_true", help="compute again what is kept in DIR")
    parser.add_argument("--full", action="store_true", help="make the fine runs too (an hour)")
    given = parser.parse_args()
    if unknown := [name for name in given.names if name not in FIGURES]:
        parser.error(f"there is no figure {', '.join(unknown)}: the figures are {', '.join(FIGURES)}")
    made: set[str] = set()  # scenes computed again in this call: N1 and N2 share one
    for name in given.names or FIGURES:
        print(f"{name}: drawing ...", flush=True)
        start = time.perf_counter()
        try:
            paths = write(name, given.out, given.fresh, given.full, made)
        except Interrupted as stopped:
            sys.exit(f"{name}: {str(stopped).split(': go on')[0]}: the same command goes on from there")
        print(f"{name}: {time.perf_counter() - start:.1f} s, wrote {', '.join(map(str, paths))}", flush=True)


def write(
    name: str, folder: Path, fresh: bool = False, full: bool = False, made: set[str] | None = None, **where: Path
) -> list[Path]:
    """Draw one figure and return the files written; results stay next to them.

    Parameters
    ----------
    fresh : whether to compute again what is kept in the folder, but for the scenes in ``made``, to which it adds
    full : whether to make the runs that stand beside others too; without it they are drawn where they have been kept
    """
    made = set() if made is None else made
    with style.context(["default", STYLE]):  # not the reader's own settings
        used: list[Path] = []

        def found(scene: str, beside: bool = False):
            if beside and not full and kept(scene, folder, **where) is None:
                return None
            used.append(folder / f"{scene}.nc")
            again = fresh and scene not in made and (full or not beside)
            made.add(scene)
            return result(scene, folder, again, **where)

        figure, caption = FIGURES[name](found)
        return [*save(figure, folder, name, caption), *used]


if __name__ == "__main__":
    main()
