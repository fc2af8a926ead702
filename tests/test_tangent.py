"""D, D' and M against the paper's closed forms (as corrected in `derivations`), and the price of the compiled form."""

import pytest
from sympy import I, Matrix, Rational, cancel, count_ops, cse, expand, eye, rem, simplify, sqrt, zeros

from stability.closures import CLOSURES
from stability.flows import FLOWS
from stability.linearise import pencil
from stability.symbols import A, epsilon, k, mu, q, symbol
from stability.tangent import MATRICES, Pair, Single, blocks, in_powers, on_flow, reduced_form, tangent
from tests.states import PAPER

xi = (symbol("xi_x"), symbol("xi_y"))
a, b, d = A[0, 0], A[0, 1], A[1, 1]  # A in the wave's frame
UNIT = a**2 + 2 * b**2 + d**2 - 1


def at(series: dict, wavenumber):
    return sum(c * (I * wavenumber) ** n for n, c in series.items())


def modulo_unit_norm(expression):
    return rem(expand(expression), UNIT, b).expand()


def test_trace_and_determinant_of_m_are_p5_and_p6():
    form = reduced_form(CLOSURES["perturbed"], "leading")
    Lambda, delta = mu * q**2 / 2, a + d
    C = d - a  # s cos 2phi: a = (delta - C)/2
    assert modulo_unit_norm(at(form.trace, q) + Lambda * (2 + delta * C)) == 0  # (P5)
    assert modulo_unit_norm(at(form.determinant, q) - Lambda**2 / 2 * (C + delta) ** 2) == 0  # (P6)


def test_trace_and_determinant_of_the_truncation_are_p8t_and_half_of_p8d():
    form = reduced_form(CLOSURES["perturbed"], "truncated")
    Lambda, delta, C = mu * q**2 / 2, a + d, d - a
    trace = -Lambda * (2 + delta * C) - (1 + k / 2 * (C - delta)) / epsilon
    determinant = Lambda**2 / 2 * (C + delta) ** 2 + Lambda / (2 * epsilon) * (C**2 + k * C + delta * (delta - k))
    assert modulo_unit_norm((at(form.trace, q) - trace) * epsilon) == 0  # (P8T)
    assert modulo_unit_norm((at(form.determinant, q) - determinant) * epsilon) == 0  # (P8D), Lambda/(2 epsilon)


def test_the_determinant_of_m_is_compiled_without_cancellation():
    assert reduced_form(CLOSURES["perturbed"]).determinant[4] == mu**2 * d**2 / 2


def test_the_short_wave_limit_of_rigid_plastic_flow_is_l5():
    found = reduced_form(CLOSURES["rigid_plastic"]).regular[2]  # coefficient of (i q)^2
    assert cancel(-found + mu * a * (a - k / 2) / (1 - k * a)) == 0


@pytest.mark.parametrize("name", PAPER)
@pytest.mark.parametrize("matrix", MATRICES)
def test_reduced_forms_agree_with_trace_and_determinant_of_the_tangent_matrix(name, matrix):
    # a = b = 1/2 and d = 1/2 (or -1/2 where A is trace-free) satisfy A:A = 1 in exact rationals.
    closure = CLOSURES[name]
    values = {a: Rational(1, 2), b: Rational(1, 2), d: Rational(1, 2 if name == "perturbed" else -2)}
    D = tangent(closure, (q, 0), matrix).subs({symbol("u"): 0, symbol("v"): 0})
    form = reduced_form(closure, matrix)
    others = sorted(
        D.free_symbols | set().union(*(c.free_symbols for s in vars(form).values() for c in s.values())), key=str
    )
    values |= {s: Rational(i + 3, i + 7) for i, s in enumerate(others) if s not in values}
    D = D.subs(values)
    form = {part: at({n: c.subs(values) for n, c in s.items()}, values.get(q, q)) for part, s in vars(form).items()}
    if isinstance(reduced_form(closure, matrix), Single):
        assert simplify(D.trace() - (form["regular"] - form.get("numerator", 0) / form["denominator"])) == 0
        assert simplify(D.det()) == 0  # the spurious zero
    else:
        assert simplify(D.trace() - form["trace"]) == 0
        assert simplify(D.det() - form["determinant"]) == 0
        assert simplify((D.trace() / 2) ** 2 - D.det() - form["discriminant"]) == 0


@pytest.mark.parametrize("matrix", MATRICES)
def test_the_powers_of_the_wavenumber_add_up_to_the_tangent_matrix(matrix):
    closure = CLOSURES["perturbed"]
    chi = Rational(3, 5), Rational(4, 5)  # an exact unit direction
    powers = in_powers(closure, matrix, chi)
    total = sum((m * (I * q) ** n for n, m in powers.items()), zeros(2, 2))
    expected = tangent(closure, (q * chi[0], q * chi[1]), matrix)
    assert (total - expected).applyfunc(lambda e: simplify(expand(e))) == zeros(2, 2)
    assert set(powers) == {"full": {2, 1, 0, -1}, "truncated": {2, 0}, "leading": {2}}[matrix]


def test_the_projection_has_no_powers_of_its_own():
    with pytest.raises(ValueError, match="through a Laplacian"):
        in_powers(CLOSURES["rigid_plastic"])


def test_d_is_p3():
    # D_ij = C_ij - i B_i xi_j/(epsilon xi^2): B and C are the blocks of the pencil
    closure = CLOSURES["perturbed"]
    C, B, _, _ = blocks(closure, pencil(closure).L(xi))
    expected = C - I * B * Matrix([xi]) / (epsilon * (xi[0] ** 2 + xi[1] ** 2))
    assert (tangent(closure, xi) - expected).applyfunc(simplify) == zeros(2, 2)


def test_d_of_rigid_plastic_flow_is_the_projection_l31():
    closure = CLOSURES["rigid_plastic"]
    C, B, _, _ = blocks(closure, pencil(closure).L(xi))
    row = Matrix([xi])
    expected = (eye(2) - B * row / (row * B)[0]) * C
    values = {s: Rational(i + 2, i + 5) for i, s in enumerate(sorted(expected.free_symbols, key=str))}
    assert (tangent(closure, xi) - expected).subs(values).applyfunc(simplify) == zeros(2, 2)


# Measured with SymPy 1.14; a rise means that a change made every run slower.
OPERATIONS = {"rigid_plastic": 60, "perturbed": 235}


@pytest.mark.parametrize("name", PAPER)
def test_the_compiled_d_costs_a_few_hundred_operations(name):
    form = reduced_form(CLOSURES[name])
    shared, results = cse([c for part in vars(form).values() for c in part.values()])
    assert count_ops([e for _, e in shared] + list(results)) <= OPERATIONS[name]


def test_d_written_out_in_raw_fields_is_hundreds_of_times_longer():
    closure = CLOSURES["perturbed"]
    written_out = on_flow(closure, FLOWS["uniform_strain"], tangent(closure, xi))
    assert {symbol("delta"), symbol("pressure")} <= written_out.free_symbols
    assert not written_out.free_symbols & {mu, a, b, d}


def test_forms_are_pairs_or_singles():
    assert isinstance(reduced_form(CLOSURES["perturbed"]), Pair)
    assert isinstance(reduced_form(CLOSURES["rigid_plastic"]), Single)


def test_uniform_strain_has_the_axes_that_its_docstring_promises():
    V = FLOWS["uniform_strain"].jet()
    s = sqrt(2 - symbol("delta") ** 2)
    assert simplify(V[symbol("u_x")] - V[symbol("v_y")] - symbol("strain_rate") * s) == 0
