"""The closed form of `fast.pair` compiled by numba (extra ``fast``): same tables, same rule for what stays open.

It saves some 7 ns a sample and costs 1.3 s of importing and compiling, so it is chosen beyond 2e8 samples. A sample
whose sign roundings could turn is left open by either path and evaluated by `spectrum`: signs do not depend on it.
"""

from functools import cache
from importlib.util import find_spec
from typing import Any

import numpy as np

from stability import fast

PAYS = 2 * 10**8
STRIP = 512  # wavenumbers at once: the polynomials' values stay in the first-level cache


def pays(grid: Any) -> bool:
    """Return whether a sweep is long enough, and numba there."""
    long = grid.rows * grid.wavenumber.size >= PAYS
    return long and not grid.draft and grid.base.model.modes == 2 and find_spec("numba") is not None


def pair(t: fast.Table, rows: slice, growth: np.ndarray, frequency: np.ndarray | None, new: fast.Scratch) -> np.ndarray:
    """Write growth rates of the leading of two modes; return where they hold."""
    ok = new("ok", growth.shape, bool)
    wanted = ("trace", "gap", "twist") + (() if frequency is None else ("shift",))
    factors = tuple((t.factors[part][0][rows], t.factors[part][1]) for part in wanted)
    if frequency is None:
        kernels()[0](factors, growth, ok)
    else:
        kernels()[1](factors, growth, frequency, ok)
    return ok


@cache
def kernels() -> tuple[Any, Any]:
    """Return the compiled functions, without and with the frequency; numba is imported here.

    Loops run from 0 over slices: LLVM makes vectors only of indices that cannot be negative.
    """
    from numba import njit

    near, tie, strip = 2 * fast.NEAR, fast.TIE, STRIP
    compiled = njit(nogil=True, error_model="numpy")

    @compiled
    def evaluate(coefficients, powers, start, out):
        c = coefficients[0]
        p = powers[0, start : start + out.size]
        for j in range(out.size):
            out[j] = c * p[j]
        for k in range(1, coefficients.size):
            c = coefficients[k]
            p = powers[k, start : start + out.size]
            for j in range(out.size):
                out[j] += c * p[j]

    @compiled
    def squares(gap, twist, larger, smaller):
        """Leave the squares of the real part of the root in ``larger``, of the imaginary part in ``smaller``."""
        for j in range(gap.size):
            g, w = gap[j], twist[j] * twist[j]
            a = np.sqrt(g * g + w) + abs(g)
            b = w / a
            larger[j] = np.sqrt(a if g > 0 else b)
            smaller[j] = np.sqrt(b if g > 0 else a)

    @compiled
    def growth_only(factors, growth, ok):
        work = np.empty((3, strip))
        for i in range(growth.shape[0]):
            for start in range(0, growth.shape[1], strip):
                g, o = growth[i, start : start + strip], ok[i, start : start + strip]
                T, G, W = work[0, : g.size], work[1, : g.size], work[2, : g.size]
                evaluate(factors[0][0][i], factors[0][1], start, T)
                evaluate(factors[1][0][i], factors[1][1], start, G)
                evaluate(factors[2][0][i], factors[2][1], start, W)
                for j in range(g.size):
                    gap, w = G[j], W[j] * W[j]
                    a = np.sqrt(gap * gap + w) + abs(gap)
                    b = w / a
                    g[j] = np.sqrt(a if gap > 0 else b) + T[j]
                for j in range(g.size):
                    o[j] = abs(g[j]) >= -near * T[j]

    @compiled
    def both(factors, growth, frequency, ok):
        work = np.empty((6, strip))
        for i in range(growth.shape[0]):
            twisted = np.any(factors[2][0][i] != 0)
            for start in range(0, growth.shape[1], strip):
                g, f, o = (
                    growth[i, start : start + strip],
                    frequency[i, start : start + strip],
                    ok[i, start : start + strip],
                )
                n = g.size
                T, G, W, S, A, B = work[0, :n], work[1, :n], work[2, :n], work[3, :n], work[4, :n], work[5, :n]
                evaluate(factors[0][0][i], factors[0][1], start, T)
                evaluate(factors[1][0][i], factors[1][1], start, G)
                evaluate(factors[2][0][i], factors[2][1], start, W)
                evaluate(factors[3][0][i], factors[3][1], start, S)
                squares(G, W, A, B)
                for j in range(n):
                    g[j] = A[j] + T[j]
                    f[j] = S[j] + (-B[j] if W[j] < 0 else B[j])
                for j in range(n):
                    o[j] = (abs(g[j]) >= -near * T[j]) & ((A[j] >= tie * (B[j] + abs(T[j]))) | (not twisted))

    return growth_only, both
