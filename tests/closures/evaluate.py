"""Growth rates from a closure's own symbolic pencil, with as many digits as asked: no compiled code on the way.

A wave much shorter than every length of the problem (q = 1e20 here) shows the leading term of a growth rate alone;
nothing about the closure's structure is assumed, constraints included.
"""

from functools import cache, cached_property

from mpmath import mp, mpc, mpf
from sympy import Expr, lambdify

from stability.closures import CLOSURES
from stability.flows import FLOWS
from stability.linearise import letters, pencil
from stability.parameters import merged
from stability.symbols import gradient

SHORT = mpf(10) ** 20  # wavenumber at which each order stands 20 digits apart from the next


@cache
def function(expression: Expr):
    """Return (names of the symbols, mpmath function) of an expression."""
    free = sorted(expression.free_symbols, key=str)
    return [str(s) for s in free], lambdify(free, expression, "mpmath")


def number(expression: Expr, values: dict) -> mpf:
    """Return the value of an expression."""
    names, compute = function(expression)
    return mp.mpmathify(compute(*(values[n] for n in names)))


class Waves:
    """Plane waves of a closure on a uniform flow.

    Both are registered names or objects; parameters are decimals or mpmath numbers. Constraints show up as
    1/lambda = 0, spoilt by a root of the last digit where they form Jordan blocks: hence so many digits.
    """

    def __init__(self, closure, flow, parameters: dict, digits: int = 150):
        self.digits = digits
        self.closure = CLOSURES[closure] if isinstance(closure, str) else closure
        flow = FLOWS[flow] if isinstance(flow, str) else flow
        self.values: dict = {"g_x": mpf(0), "g_y": mpf(0)}
        with mp.workdps(self.digits):
            for word, record in merged(self.closure.parameters, flow.parameters).items():
                value = mp.mpmathify(parameters[word])
                self.values[record.symbol] = mp.radians(value) if record.unit == "deg" else value
            for s, e in {**flow.letters, **flow.jet(), **letters(self.closure)}.items():
                self.values[str(s)] = number(e, self.values)
            # Letters are functions of the strain rate and of scalars, all of them uniform here.
            self.values |= {str(g): mpf(0) for s in letters(self.closure) for g in gradient(s)}

    def __getitem__(self, name: str) -> mpf:
        return self.values[name]

    @cached_property
    def matrices(self) -> tuple:
        """E, L2[a][b], L1[a] and L0 in numbers."""
        P = pencil(self.closure)

        def numbers(m):
            return mp.matrix([[number(m[i, j], self.values) for j in range(m.cols)] for i in range(m.rows)])

        with mp.workdps(self.digits):
            return (
                numbers(P.E),
                [[numbers(P.L2[a][b]) for b in (0, 1)] for a in (0, 1)],
                [numbers(P.L1[a]) for a in (0, 1)],
                numbers(P.L0),
            )

    def eigenvalues(self, angle, q=SHORT) -> list[mpc]:
        """Return the finite eigenvalues of ``lambda E a = L a`` by decreasing real part; angle in degrees from x."""
        with mp.workdps(self.digits):
            E, L2, L1, L0 = self.matrices
            q, radians = mp.mpmathify(q), mp.radians(mp.mpmathify(angle))
            xi = (q * mp.cos(radians), q * mp.sin(radians))
            L = L0.copy()
            for a in (0, 1):
                L += 1j * xi[a] * L1[a]
                for b in (0, 1):
                    L -= xi[a] * xi[b] * L2[a][b]
            shift = mpc("0.7310585786300049", "0.2689414213699951") * q  # no eigenvalue, but for bad luck
            theta, _ = mp.eig(mp.inverse(L - shift * E) * E)
            scale = max(abs(t) for t in theta)
            return sorted(
                (shift + 1 / t for t in theta if abs(t) > scale * mpf(10) ** (-self.digits / 5)), key=lambda z: -z.real
            )

    def growth(self, angle, exponent=2, q=SHORT) -> mpf:
        """Return the largest Re lambda/q^exponent of a wave."""
        return self.eigenvalues(angle, q)[0].real / mp.mpmathify(q) ** exponent

    def peak(self, angle, power: float, exponent=2, q=SHORT) -> mpf:
        """Return the growth on top of a peak that narrows as q^-power around a direction, from a geometric grid."""
        with mp.workdps(self.digits):
            offsets = [0, *(sign * mpf(10) ** (mpf(n) / 4) for n in range(-12, 13) for sign in (-1, 1))]
            return max(self.growth(mpf(angle) + y / mpf(q) ** power, exponent, q) for y in offsets)

    def worst(self, exponent=2, q=SHORT, low=0, high=90, count=45) -> tuple[mpf, mpf]:
        """Return (angle, growth) of the largest growth between two directions, from a grid and a Newton search."""
        rate = cache(lambda angle: self.growth(angle, exponent, q))
        with mp.workdps(self.digits):
            width = mpf(high - low) / count
            start = max((low + (i + mpf(1) / 3) * width for i in range(count)), key=rate)
            return maximum(rate, start, width)


def maximum(rate, x: mpf, limit: mpf) -> tuple[mpf, mpf]:
    """Return place and value of the maximum of a smooth function near x: Newton steps on central differences."""
    h = mpf(10) ** -12
    for _ in range(60):
        low, mid, high = rate(x - h), rate(x), rate(x + h)
        slope, curve = (high - low) / (2 * h), (high - 2 * mid + low) / h**2
        move = -slope / curve if curve < 0 else mp.sign(slope) * limit
        x += max(-limit, min(limit, move))
        if abs(move) < mpf(10) ** -16:  # the rate errs by the square of that
            break
    return x, rate(x)
