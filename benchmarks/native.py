"""The hand-written C kernel, compiled on the spot where there is a compiler: the practical limit of a CPU."""

import ctypes
import shutil
import subprocess
from collections.abc import Callable
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from benchmarks.cases import Case
from stability.arithmetic import NUMPY, cosine_sine
from stability.model import Model

FLAGS = ("-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math", "-shared", "-fPIC")


def compiler() -> str | None:
    """Return the name of a C compiler, or None."""
    return next((name for name in ("cc", "gcc", "clang") if shutil.which(name)), None)


@cache
def kernel() -> Callable:
    """Return the compiled function `map` of kernel.c."""
    with TemporaryDirectory() as folder:
        library = Path(folder) / "kernel.so"
        source = Path(__file__).with_name("kernel.c")
        subprocess.run([str(compiler()), *FLAGS, str(source), "-o", str(library), "-lm"], check=True)
        found = ctypes.CDLL(str(library)).map
    found.argtypes = [ctypes.c_long] * 3 + [ctypes.c_void_p] * 6
    found.restype = ctypes.c_int
    return found


def tensors(case: Case) -> np.ndarray:
    """Return the 30 numbers of D at each position: orders 2, 1, 0 of the velocities' block, then B1/g and -B0/g.

    With ``L = [[C, B], [-i xi, -g |xi|^2]]`` the reduction is ``D = C - i B xi^T/(g |xi|^2)`` (P3).
    """
    L2, L1, L0 = Model(case.closure, case.flow).base(case.parameters, case.point).pencil()
    g = L2[0][0][2][2]

    def block(*tables: Any) -> list:
        return [sum(t[i][j] for t in tables) for i in (0, 1) for j in (0, 1)]

    second = [-e for e in (*block(L2[0][0]), *block(L2[0][1], L2[1][0]), *block(L2[1][1]))]
    column = [L1[a][i][2] / g for a in (0, 1) for i in (0, 1)] + [-L0[i][2] / g for i in (0, 1)]
    parts = (*second, *block(L1[0]), *block(L1[1]), *block(L0), *column)
    return np.ascontiguousarray(np.stack(np.broadcast_arrays(*parts), axis=-1), dtype=float).reshape(-1, 30)


def growth(case: Case, frequency: bool = False) -> Callable[[], np.ndarray]:
    """Return the call that fills a map, tensors included in what is given and coefficients in what is timed."""
    table, directions = tensors(case), [np.ascontiguousarray(a) for a in cosine_sine(case.wave_angle, NUMPY)]
    rate, turn = (np.zeros(case.shape) for _ in range(2))  # touched now: page faults are nobody's arithmetic
    wavenumber = np.ascontiguousarray(case.wavenumber)
    run, arrays = kernel(), (table, *directions, wavenumber, rate)

    def call() -> np.ndarray:
        addresses = [a.ctypes.data for a in arrays] + [turn.ctypes.data if frequency else None]
        if not run(len(table), case.wave_angle.size, wavenumber.size, *addresses):
            raise MemoryError("the C kernel found no memory for its table of powers")
        return rate

    return call
