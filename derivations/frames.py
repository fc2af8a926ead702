"""Letters and identities the derivations share: the tensor A in three sets of coordinates.

In the frame (chi, tau) of the wave A = [[a, b], [b, d]] with a = A_xx, b = A_xy, d = A_yy. With delta = tr A,
s = sqrt(2 - delta^2) and phi the angle from the major principal stress axis to chi, a = (delta - s cos 2phi)/2.
"""

from sympy import Expr, Matrix, Rational, eye, symbols

from derivations.algebra import Given
from stability.closures.drucker_prager import PERTURBED, RIGID_PLASTIC
from stability.symbols import AXES, A, k, mu, q, symbol, u, v

a, b, d = A[0, 0], A[0, 1], A[1, 1]
tensor_A = Matrix(A.tolist())
delta, s, c, S = symbol("delta"), symbol("s"), symbol("c"), symbol("S")  # c = cos 2phi, S = sin 2phi
s_f = k / 2 ** Rational(1, 2)  # (I2): sin of the angle of friction
Lambda = mu * q**2 / 2  # after (P6)
X, Y = symbol("chi_x"), symbol("chi_y")
chi = Matrix([X, Y])
_m, _n, _h = (symbol(name) for name in ("m", "n", "h"))  # parameters of rational points

_span = 2 / (1 + 2 * _m**2 + _n**2)
_chord = -(1 + _m) / (1 + _m**2)
_arc = -2 * (1 - _m) / (1 + _m**2)
_UNIT_A = {a: _span - 1, b: _m * _span, d: _n * _span}
_FLAT_A = {a: Rational(1, 2) + _chord, b: Rational(1, 2) + _m * _chord, d: -Rational(1, 2) - _chord}
_UNIT_CHI = {X: (1 - _h**2) / (1 + _h**2), Y: 2 * _h / (1 + _h**2)}

UNIT = Given(relations=(*PERTURBED.relations, (Y, X**2 + Y**2 - 1)), rational=_UNIT_A | _UNIT_CHI)  # A:A = 1
FLAT = Given(relations=(*RIGID_PLASTIC.relations, (Y, X**2 + Y**2 - 1)), rational=_FLAT_A | _UNIT_CHI)  # and tr A = 0

# A trace-free unit tensor can only turn: its derivative is the rate of turn times the perpendicular tensor.
_turn = {axis: symbol(f"turn_{axis}") for axis in AXES}
FLAT_SMOOTH = Given(
    substitution={d: -a}
    | {symbol(f"A_xx_{i}"): -b * t for i, t in _turn.items()}
    | {symbol(f"A_xy_{i}"): a * t for i, t in _turn.items()}
    | {symbol(f"A_yy_{i}"): b * t for i, t in _turn.items()}
    | {symbol("v_y"): -symbol("u_x")},  # (I7.1)
    relations=((b, 2 * a**2 + 2 * b**2 - 1),),
    rational={a: _FLAT_A[a], b: _FLAT_A[b]},
)

_PHI = {c: (1 - _h**2) / (1 + _h**2), S: 2 * _h / (1 + _h**2)}
PRINCIPAL = Given(
    substitution={a: (delta - s * c) / 2, b: s * S / 2, d: (delta + s * c) / 2},
    relations=((s, s**2 + delta**2 - 2), (S, S**2 + c**2 - 1)),
    rational={delta: 1 + _arc, s: 1 - _arc * _m} | _PHI,
)
AT_YIELD = Given(  # delta = 0: a = -c/sqrt 2
    substitution={a: -c / 2 ** Rational(1, 2), b: S / 2 ** Rational(1, 2), d: c / 2 ** Rational(1, 2)},
    relations=((S, S**2 + c**2 - 1),),
    rational=_PHI,
)
BY = "`A:A = 1`"  # how the evidence names UNIT and PRINCIPAL
ANGLES = "`s² = 2 − δ², cos² + sin² = 1`"
K_DRAG = k * tensor_A - eye(2)  # kA - 1 of (P7)
TWO = range(2)
XI = symbols("xi_x xi_y", real=True)
xi = Matrix(XI)
velocity = (u, v)
WAVE = (q, 0)  # the wavevector in its own frame


def dirac(i: int, j: int) -> int:
    """Return delta_ij."""
    return int(i == j)


def symmetriser(i: int, j: int, l: int, k_: int) -> Expr:
    """Return delta_i(j delta_l)k."""
    return Rational(dirac(i, j) * dirac(l, k_) + dirac(i, l) * dirac(j, k_), 2)


def contracted(vector: Matrix, matrix: Matrix, other: Matrix) -> Expr:
    """Return vector . matrix . other."""
    return (vector.T * matrix * other)[0]
