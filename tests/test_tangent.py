"""D, D' and M against the paper's closed forms (as corrected in `derivations`), and the price of the compiled form."""

import mpmath
import numpy as np
import pytest
from numpy.testing import assert_allclose
from sympy import I, Matrix, Rational, cancel, count_ops, cse, expand, eye, rem, simplify, sqrt, zeros

from stability import eigenvalues, well_posedness
from stability.arithmetic import multiprecision
from stability.certified import Certifier, Tally
from stability.closures import CLOSURES
from stability.closures.base import Closure, norm
from stability.closures.plane_flow import V, grad_p, grad_u, momentum_and_mass, velocity
from stability.errors import SceneError
from stability.flows import FLOWS
from stability.linearise import pencil
from stability.model import Base, Model
from stability.parameters import EPSILON, Parameter
from stability.symbols import A, epsilon, k, mu, p, q, symbol
from stability.tangent import MATRICES, Pair, Single, blocks, in_powers, on_flow, reduced_form, tangent
from tests.states import PAPER, nested, random_jet

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


NU = Parameter("viscosity", "nu", "m2/s", 0, 10, "viscosity of a test", "this test")
nu = symbol("nu")
STRESSES = {
    "inviscid": p * eye(2),
    "viscosity p": p * eye(2) - 2 * nu * p * V,
    "viscosity 1 + p": p * eye(2) - 2 * nu * (1 + p) * V,
    "viscosity 1 + p^2 + V:V": p * eye(2) - 2 * nu * (1 + p**2 + norm(V) ** 2) * V,
    "Coulomb and viscosity p": p * eye(2) - nu * p * (V / norm(V) + V),
}
FLUXES = {"div u = 0": velocity, "div u = epsilon Lap p": velocity - epsilon * grad_p}


def of_stress(name: str, flux: str) -> Closure:
    laws = momentum_and_mass(STRESSES[name], FLUXES[flux])
    return Closure(name="own", title="own", source="this test", parameters=(NU, EPSILON), **laws)


def base_of(closure: Closure, jet: dict, **model) -> Base:
    model = Model(closure, "uniform_strain", **model)
    number = model.arithmetic.number
    values = {"viscosity": number(0.3), "epsilon": number(0.2)}
    return Base(model, values, nested({n: number(v) for n, v in jet.items()}), (0, 0), {})


def still(jet: dict) -> dict:
    """Return the jet with the same pressure and strain rate, at rest, and uniform: gradients of moduli vanish."""
    kept = ("p", "u_x", "u_y", "v_x", "v_y")
    return {n: v if n in kept else 0.0 for n, v in jet.items()}


def wave_matrix(base: Base, wavenumber, angle: int) -> mpmath.matrix:
    """Return L of a wave from the pencil."""
    L2, L1, L0 = (np.array(part, dtype=object) for part in base.pencil())
    chi = np.array(base.model.arithmetic.direction(angle, base.model.arithmetic), dtype=object)
    s = base.model.arithmetic.complex(0, wavenumber)
    L = s**2 * np.einsum("a,b,abij->ij", chi, chi, L2) + s * np.einsum("a,aij->ij", chi, L1) + L0
    return mpmath.matrix(L.tolist())


def finite_modes(L: mpmath.matrix, size) -> list:
    """Return the growth rates over ``size``: roots of det(lambda E - L), of degree one or two in lambda."""

    def determinant(z):
        M = mpmath.diag([z * size, z * size, 0]) - L
        turns = ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        return sum(M[0, i] * (M[1, j] * M[2, k] - M[1, k] * M[2, j]) for i, j, k in turns)

    zero, one, other = map(determinant, (0, 1, -1))
    a, b, c = (one + other) / 2 - zero, (one - other) / 2, zero
    if abs(a) < mpmath.mpf(10) ** -60 * abs(b):  # div u = 0 leaves one mode; 90 digits are at hand
        return [(-c / b).real]
    root = mpmath.sqrt(b * b - 4 * a * c)
    return sorted([((-b - root) / (2 * a)).real, ((-b + root) / (2 * a)).real])


def both_modes(stress: str, flux: str, matrix: str, angle: int, wavenumber: int) -> tuple[Base, dict, list]:
    """Return a random base state in 90 digits, its jet, and the growth rates of its closed form."""
    closure, jet = of_stress(stress, flux), random_jet("rigid_plastic", np.random.default_rng(angle))
    base = base_of(closure, jet, arithmetic=multiprecision(90))
    return base, jet, sorted(z.real for z in base.form(angle, matrix).eigenvalues(wavenumber))


@pytest.mark.parametrize("angle", [0, 33, 131])
@pytest.mark.parametrize("flux", FLUXES)
@pytest.mark.parametrize("stress", STRESSES)
def test_the_truncation_has_the_modes_of_the_pencil_with_moduli_frozen_and_without_inertia(stress, flux, angle):
    # The independent route: det(lambda E - L) about the same pressure and strain rate, with no gradient besides.
    with mpmath.workdps(90):
        base, jet, found = both_modes(stress, flux, "truncated", angle, 3)
        L = wave_matrix(base_of(base.model.closure, still(jet), arithmetic=base.model.arithmetic), 3, angle)
        for i, c in enumerate("uv"):
            for j, a in enumerate("xy"):
                L[i, j] += mpmath.mpf(base.model.arithmetic.number(jet[f"{c}_{a}"]))  # inertia is -(u.grad) u
        expected = finite_modes(L, 1)
        assert len(found) == len(expected)
        assert all(abs(one - other) < mpmath.mpf(10) ** -40 for one, other in zip(found, expected, strict=True))


@pytest.mark.parametrize("angle", [0, 33, 131])
@pytest.mark.parametrize("flux", FLUXES)
@pytest.mark.parametrize("stress", STRESSES)
def test_m_is_what_the_modes_of_the_whole_pencil_tend_to_over_the_wavenumber_squared(stress, flux, angle):
    with mpmath.workdps(90):
        base, _, found = both_modes(stress, flux, "leading", angle, 1)
        size = mpmath.mpf(10) ** 30
        expected = finite_modes(wave_matrix(base, size, angle), size**2)
        assert len(found) == len(expected)
        # What M leaves out is smaller by 1e30; where its two modes coincide, by the root of that.
        assert all(abs(one - other) < 1e-13 for one, other in zip(found, expected, strict=True))


STRAIN = {"delta": 0.0, "strain_rate": 1.0, "pressure": 9.0}


@pytest.mark.parametrize(("stress", "coefficient"), [("viscosity 1 + p", -1.0), ("viscosity p", -0.9)])
@pytest.mark.parametrize("matrix", ["full", "truncated"])
def test_short_waves_decay_at_the_viscosity_of_the_point_in_either_matrix(stress, coefficient, matrix):
    laws = momentum_and_mass(STRESSES[stress], velocity)
    closure = Closure(name="own", title="own", source="this test", parameters=(NU,), **laws)
    found = well_posedness(closure, "uniform_strain", STRAIN | {"viscosity": 0.1}, {}, matrix)
    assert found.kind == "stable" and found.certified
    assert abs(found.coefficient / coefficient - 1) < 1e-15  # exact: nu (1 + p) or nu p with nu = 0.1 and p = 9


def test_an_inviscid_fluid_grows_at_its_strain_rate_and_its_truncation_is_zero():
    laws = momentum_and_mass(STRESSES["inviscid"], velocity)
    question = Closure(name="own", title="own", source="this test", parameters=(), **laws), "uniform_strain", STRAIN, {}
    wave_angle = np.array([0.0, 20.0, 70.0])
    # exact: on a tau, lambda = -tau.(grad u).tau = cos(2 theta)/sqrt 2 with extension along x at ||V|| = 1
    exact = np.cos(2 * np.deg2rad(wave_angle)) / np.sqrt(2)
    signs = {m: Certifier(*question, m).signs(np.array([1.0, 10.0]), wave_angle, Tally()) for m in MATRICES}
    for wavenumber in (1.0, 10.0):
        assert_allclose(eigenvalues(*question, wavenumber, wave_angle)[:, 0], exact, rtol=0, atol=1e-15)
    assert signs["full"].tolist() == [[1, 1], [1, 1], [-1, -1]]
    assert not signs["truncated"].any() and not signs["leading"].any()


def test_a_law_that_sees_the_velocity_has_no_truncation():
    laws = momentum_and_mass(STRESSES["inviscid"], velocity)
    drag = laws["supply"] - Matrix([*(symbol("nu") * (velocity.T * velocity)[0] * velocity), 0])
    closure = Closure(name="drag", title="own", source="this test", parameters=(NU,), **laws | {"supply": drag})
    assert tangent(closure, xi).shape == (2, 2)
    with pytest.raises(SceneError, match="closure drag has no D': the velocity enters it by more than inertia"):
        tangent(closure, xi, "truncated")


def test_slow_flow_without_inertia_has_nothing_to_truncate_but_gradients():
    laws = momentum_and_mass(STRESSES["viscosity p"], velocity - epsilon * grad_p)
    slow = laws["supply"] + Matrix([*(grad_u * velocity), 0])
    fast, closure = (
        Closure(name="own", title="own", source="this test", parameters=(NU, EPSILON), **laws | {"supply": s})
        for s in (laws["supply"], slow)
    )
    assert tangent(closure, xi, "truncated") == tangent(fast, xi, "truncated")
