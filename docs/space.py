"""Coulomb flow in three dimensions: rows computed from the derivation, as the package's closures are plane."""

from collections.abc import Iterator

from mpmath import mp, mpf
from sympy import Matrix, Poly, Rational, lambdify, pi, roots, sin, sqrt

from derivations import three_dimensions as space
from derivations.verdict import Kind
from stability.symbols import k, mu, q

NAME = "`rigid_plastic` in 3-D"
STEP = Rational(1, 10**12)  # relative, how near the threshold is tried


def growth(A: Matrix, chi: Matrix, friction: object) -> mpf:
    """Return the largest growth over mu q^2 along chi from the differentiated stress, for V/||V|| = A."""
    first = chi / chi.norm()
    across = next(e for e in (Matrix([0, 0, 1]), Matrix([1, 0, 0])) if e.cross(first) != Matrix([0, 0, 0]))
    second = across.cross(first)
    second = second / second.norm()
    frame = Matrix.hstack(first, second, first.cross(second))
    turned = frame.T * A * frame
    names = (space.a, space.b, space.c, space.d, space.e, space.f, k, mu, q)
    places = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
    values = [*(turned[i] for i in places), friction, 1, 1]
    numbers = (mpf(str(v.evalf(40))) if hasattr(v, "evalf") else v for v in values)
    D = lambdify(names, space.transverse(), "mpmath")(*numbers)
    half, det = (D[0, 0] + D[1, 1]) / 2, D[0, 0] * D[1, 1] - D[0, 1] * D[1, 0]
    return mp.re(half + mp.sqrt(half**2 - det))


def closed(along: object, square: object, friction: object) -> str:
    """Return the growth formula in numbers, to 15 digits."""
    return str(space.rate(along, square).subs(k, friction).evalf(15))


def compared(stated: str, value: mpf) -> tuple[str, str]:
    """Return a computed number and how far it is from the stated one."""
    off = abs(value / mpf(stated) - 1)
    return mp.nstr(value, 15), "below 1e-14" if off < 1e-14 else "within 1e-12" if off < 1e-12 else mp.nstr(off, 1)


def grows(sign: int, kappa: Rational) -> bool:
    """Return whether some wave grows in axisymmetric extension (1) or compression (-1): exact, by Sturm's theorem."""
    above, _ = space.axisymmetric(sign)
    return bool(Poly(above.subs(space.kappa, kappa), space.y).count_roots(0, 1) > 0)


def rows() -> Iterator[tuple]:
    """Yield (closure, what, stated, (computed, relative difference))."""
    formula = "−[1/2 − (∣Aχ∣² − (χ·Aχ)²)/(1 − kχ·Aχ)]"
    with mp.workdps(40):
        plane = sqrt(2) * sin(34 * pi / 180)
        t = sin(17 * pi / 180) / sin(73 * pi / 180)  # cos 2phi = tan(varphi/2) is the worst direction
        A, chi = Matrix.diag(1, -1, 0) / sqrt(2), Matrix([sqrt((1 + t) / 2), sqrt((1 - t) / 2), 0])
        stated = closed(t / sqrt(2), Rational(1, 2), plane)
        yield NAME, f"plane strain, {formula} at its largest", stated, compared(stated, growth(A, chi, plane))
        steep = sqrt(2) * sin(40 * pi / 180)
        y = (1 + steep / sqrt(6)) / 2
        A, chi = Matrix.diag(2, -1, -1) / sqrt(6), Matrix([sqrt(y), sqrt(1 - y), 0])
        stated = closed((3 * y - 1) / sqrt(6), (1 + 3 * y) / 6, steep)
        what = "axisymmetric extension, the same at φ_f = 40° and cos² = (1 + k/√6)/2"
        yield NAME, what, stated, compared(stated, growth(A, chi, steep))
    above, _ = space.axisymmetric(1)
    edge = max(roots(space.discriminant(above), space.kappa))  # kappa = k/sqrt 6
    stated = str(sqrt(Rational(2, 3)).evalf(15))
    found = [grows(1, edge * (1 + side * STEP)) for side in (-1, 1)]
    said = ", then ".join("grows" if one else "decays" for one in found)
    value, off = compared(stated, mpf(str((sqrt(6) * edge).evalf(30))))
    off = off if found == [False, True] else "does not turn"
    yield NAME, "axisymmetric extension is well-posed iff k < √(2/3)", stated, (f"{value}; {said}", off)
    for what, derived, says in (
        ("plane strain, whatever k", space.plane_strain(), "never well-posed"),
        ("axisymmetric compression, whatever k", space.compression(), "always well-posed"),
    ):
        holds = derived.kind is Kind.HOLDS
        yield NAME, what, says, (f"{says}, derived" if holds else derived.right, "exact" if holds else "differs")
