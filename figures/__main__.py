"""Draw the figures: `python -m figures [NAME ...] [--out DIR] [--fresh]`."""

import argparse
import time
from pathlib import Path

from matplotlib import style

from figures import I1, L1, P1, P2_1
from figures.common import HERE, STYLE, result
from stability.plotting import save

# The names of the paper's labels -> a function of `result` that returns the picture and its caption.
FIGURES = {"I1": I1.draw, "L1": L1.draw, "P1": P1.draw, "P2.1": P2_1.draw}


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m figures", description="Draw the paper's figures as PDF and PNG.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(FIGURES)}; all where none is named")
    parser.add_argument("--out", type=Path, default=HERE / "out", metavar="DIR", help="folder of pictures and results")
    parser.add_argument("--fresh", action="store_true", help="compute again what is kept in DIR")
    given = parser.parse_args()
    if unknown := [name for name in given.names if name not in FIGURES]:
        parser.error(f"there is no figure {', '.join(unknown)}: the figures are {', '.join(FIGURES)}")
    for name in given.names or FIGURES:
        print(f"{name}: drawing ...", flush=True)
        start = time.perf_counter()
        paths = write(name, given.out, given.fresh)
        print(f"{name}: {time.perf_counter() - start:.1f} s, wrote {', '.join(map(str, paths))}", flush=True)


def write(name: str, folder: Path, fresh: bool = False, **where: Path) -> list[Path]:
    """Draw one figure and return the files written; results stay next to them."""
    with style.context(["default", STYLE]):  # not the reader's own settings
        used: list[Path] = []

        def found(scene: str):
            used.append(folder / f"{scene}.nc")
            return result(scene, folder, fresh, **where)

        figure, caption = FIGURES[name](found)
        return [*save(figure, folder, name, caption), *used]


if __name__ == "__main__":
    main()
