"""What holds for a closure at almost every state: its invariances, how many modes a wave has, how they are reached.

All is decided at a random state and wave: a property that holds there to rounding holds everywhere but on a set of
measure zero.
"""

from collections.abc import Mapping
from functools import cache
from itertools import combinations
from typing import Any

import numpy as np
from sympy import Symbol, lambdify

from stability.closures.base import Closure
from stability.linearise import letters, pencil
from stability.symbols import gradient, hessian

STEP = 2e-3  # of differences of fourth order: their error is some 1e-11
ROUNDING = 1e-7  # relative: the entries of a random pencil are of order one


class Sample:
    """The pencil in numbers at arbitrary states: what holds at a random one holds at almost every one.

    Letters are evaluated from the raw state, in complex numbers, so that roots and logarithms exist everywhere. Their
    gradients along the base state are differences: written out they are long, and compiling them would take seconds.
    """

    def __init__(self, closure: Closure):
        P = pencil(closure)
        entries = [e for m in (*(m for row in P.L2 for m in row), *P.L1, P.L0) for e in m]
        self.letters = [(s, sorted(e.free_symbols, key=str), e) for s, e in letters(closure).items()]
        self.functions = [lambdify(names, e, "numpy", cse=True) for _, names, e in self.letters]
        self.names = sorted(set().union(*(e.free_symbols for e in entries)), key=str)
        self.entries = lambdify(self.names, entries, "numpy", cse=True)
        self.closure, self.shape = closure, P.E.shape
        known = {*closure.q, *closure.g, *(h for c in closure.q for row in hessian(c) for h in row)}
        known |= {s for letter, *_ in self.letters for s in (letter, *gradient(letter))}
        used = set(self.names).union(*(names for _, names, _ in self.letters))
        self.constants = sorted(used - known, key=str)

    def matrices(self, jets: Mapping[Symbol, tuple], constants: Mapping[Symbol, complex]) -> np.ndarray:
        """Return L2_xx, L2_xy, L2_yx, L2_yy, L1_x, L1_y and L0 for (value, gradient, second gradient) by component."""
        values = self.state(jets, constants)
        for a in (0, 1):
            steps = [self.state(jets, constants, a, n * STEP) for n in (-2, -1, 1, 2)]
            for s, *_ in self.letters:
                two, one, other, four = (step[s] for step in steps)
                values[gradient(s)[a]] = (8 * (other - one) - (four - two)) / (12 * STEP)
        with np.errstate(all="ignore"):
            found = self.entries(*(values[n] for n in self.names))
        return np.array(found, complex).reshape(7, *self.shape)

    def state(
        self, jets: Mapping[Symbol, tuple], constants: Mapping[Symbol, complex], axis: int = 0, step: float = 0.0
    ) -> dict[Symbol, Any]:
        """Return the raw state and the letters at a distance along an axis, where the state is quadratic."""
        values: dict[Symbol, Any] = {s: complex(v) for s, v in constants.items()}
        for c, (value, first, second) in jets.items():
            values[c] = complex(value + step * first[axis])
            for a in (0, 1):
                values[gradient(c)[a]] = complex(first[a] + step * second[a, axis])
                for b in (0, 1):
                    values[hessian(c)[a][b]] = complex(second[a, b])
        with np.errstate(all="ignore"):
            for (s, names, _), function in zip(self.letters, self.functions, strict=True):
                values[s] = function(*(values[n] for n in names))
        return values

    def random(self, rng: np.random.Generator) -> tuple[dict, dict]:
        """Return a random state and random constants, all within (0.2, 0.8)."""
        jets = {}
        for c in self.closure.q:
            value, first, second = rng.uniform(0.2, 0.8), rng.uniform(0.2, 0.8, 2), rng.uniform(0.1, 0.4, (2, 2))
            jets[c] = value, first, second + second.T
        # Off the real axis, so that no rounding decides on which side of a branch cut a root or a logarithm is taken.
        return jets, {s: rng.uniform(0.2, 0.8) * np.exp(0.2j) for s in self.constants}


def wave(matrices: np.ndarray, xi: tuple[float, float]) -> np.ndarray:
    """Return L for the wavevector xi from `Sample.matrices`."""
    x, y = xi
    factors = (-x * x, -x * y, -x * y, -y * y, 1j * x, 1j * y, 1)
    return sum(f * m for f, m in zip(factors, matrices, strict=True))


@cache
def sampled(closure: Closure) -> Sample:
    """Return the closure's pencil in numbers."""
    return Sample(closure)


@cache
def galilean(closure: Closure) -> bool:
    """Return whether a velocity (the first field) merely shifts the frequency by -u.xi, at a random state."""
    velocity = closure.fields[0]
    if not isinstance(velocity, tuple):
        return not any(isinstance(f, tuple) for f in closure.fields)
    sample = sampled(closure)
    jets, constants = sample.random(np.random.default_rng(2))
    xi, speed = (0.7, 0.4), (0.3, -0.5)
    one = wave(sample.matrices(jets, constants), xi)
    moving = {c: (jets[c][0] + v, *jets[c][1:]) for c, v in zip(velocity, speed, strict=True)}
    other = wave(sample.matrices(jets | moving, constants), xi)
    shift = 1j * (xi[0] * speed[0] + xi[1] * speed[1]) * np.diag(closure.evolves)
    return bool(np.allclose(other + shift, one, rtol=0, atol=ROUNDING * np.abs(one).max()))


@cache
def frame_indifferent(closure: Closure) -> bool:
    """Return whether turning state and wave together turns the pencil, at a random state."""
    sample = sampled(closure)
    jets, constants = sample.random(np.random.default_rng(0))
    c, s = 0.6, 0.8
    R = np.array([[c, s], [-s, c]])
    turned: dict[Symbol, tuple] = {}
    blocks, at = np.zeros(sample.shape), 0
    for f in closure.fields:
        components = f if isinstance(f, tuple) else (f,)
        Q = R if isinstance(f, tuple) else np.eye(1)
        blocks[at : at + len(Q), at : at + len(Q)] = Q
        at += len(Q)
        value, first, second = (np.array([jets[n][i] for n in components]) for i in range(3))
        value, first, second = Q @ value, Q @ first @ R.T, np.einsum("ij,ac,jcd,bd->iab", Q, R, second, R)
        turned |= {n: (value[i], first[i], second[i]) for i, n in enumerate(components)}
    xi = (0.7, 0.4)
    one = blocks @ wave(sample.matrices(jets, constants), xi) @ blocks.T
    other = wave(sample.matrices(turned, constants), tuple(R @ xi))
    return bool(np.allclose(one, other, rtol=0, atol=ROUNDING * np.abs(one).max()))


@cache
def modes(closure: Closure) -> tuple[int, int]:
    """Return how many finite eigenvalues a wave has, and the rank of the constraints' block of their unknowns.

    Both are those of a random state and wave; a state at which constraints degenerate has fewer.
    """
    sample = sampled(closure)
    L = wave(sample.matrices(*sample.random(np.random.default_rng(1))), (0.7, 0.4))
    if not np.all(np.isfinite(L)):
        raise ValueError(f"closure {closure.name}: its moduli are not finite at a random state")
    e, c = ([i for i, on in enumerate(closure.evolves) if bool(on) is kind] for kind in (True, False))
    rank = int(np.linalg.matrix_rank(L[np.ix_(c, c)], ROUNDING * np.abs(L).max())) if c else 0
    for j in range(len(e), -1, -1):  # the coefficient of lambda^j in det(lambda E - L): a sum of minors
        minors = []
        for kept in combinations(e, j):
            rest = [i for i in range(len(L)) if i not in kept]
            minors.append(np.linalg.det(L[np.ix_(rest, rest)]) if rest else 1.0)
        if abs(sum(minors)) > ROUNDING * sum(map(abs, minors)) and np.max(np.abs(minors)) > 0:
            return j, rank
    raise ValueError(f"closure {closure.name}: its balance laws do not determine its fields (det(lambda E - L) = 0)")
