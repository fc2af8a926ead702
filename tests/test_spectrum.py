"""Eigenvalues against QZ and against mpmath, and the verdict polynomial against both, over random closures' states."""

import numpy as np
import pytest
from mpmath import mpf
from numpy.testing import assert_allclose

from stability import spectrum
from stability.arithmetic import cosine_sine, multiprecision
from stability.closures import CLOSURES
from tests.states import PAPER, base_of, random_jet

EPS = 2.0**-52
EXACT = multiprecision(80)


def random_case(name, rng):
    jet = random_jet(name, rng)
    friction, epsilon = float(rng.uniform(0.05, 1.5)), float(10 ** rng.uniform(-6, 0))
    return jet, friction, epsilon, float(10 ** rng.uniform(-2, 5)), float(rng.uniform(0, 360))


def exact_eigenvalues(name, jet, friction, epsilon, wavenumber, angle):
    base = base_of(name, jet, friction, epsilon, EXACT)
    return base.form(EXACT.number(angle)).eigenvalues(EXACT.number(wavenumber))


@pytest.mark.parametrize("name", PAPER)
def test_float64_agrees_with_80_digits_over_random_states(name):
    rng = np.random.default_rng(1)
    errors = []
    for _ in range(300):
        case = random_case(name, rng)
        jet, friction, epsilon, q, angle = case
        found = base_of(name, jet, friction, epsilon).form(angle).eigenvalues(q)
        exact = exact_eigenvalues(*((name,) + case))
        size = max(abs(e) for e in exact)
        for value, truth in zip(found, exact, strict=True):
            # backward stable against the largest eigenvalue: the states are random, most are far from neutral
            assert abs(complex(value) - complex(truth)) <= 1e-12 * float(size)
            errors.append(float(abs(mpf(float(value.real)) - truth.real) / abs(truth.real)))
    assert np.median(errors) < 1e-14  # the relative error of the growth rate itself


@pytest.mark.parametrize("name", PAPER)
def test_the_pencils_qz_eigenvalues_agree(name):
    # The independent referee: the general pencil in the unturned frame, no reduction, no closed form.
    rng = np.random.default_rng(2)
    E = np.diag(CLOSURES[name].evolves)
    for _ in range(200):
        jet, friction, epsilon, q, angle = random_case(name, rng)
        q = min(q, 1e2)
        base = base_of(name, jet, friction, epsilon)
        L2, L1, L0 = (np.array(part, dtype=float) for part in base.pencil())
        xi = q * np.array([np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle))])
        L = L0 + 1j * np.einsum("a,aij->ij", xi, L1) - np.einsum("a,b,abij->ij", xi, xi, L2)
        size = np.abs(L[:2, :2]).max()
        L[2] *= (
            size / np.abs(L[2, :2]).max()
        )  # rows and columns of the constraint may be scaled at will: E is zero there
        L[:, 2] *= size / np.abs(L[:2, 2]).max()
        referee = spectrum.pencil_eigenvalues(E, L)
        found = np.array(base.form(angle).eigenvalues(q))
        assert len(referee) == len(found)
        gap = np.abs(referee[:, None] - found[None, :]).min(axis=0)
        scale = np.abs(found).max() + size
        # nearly double eigenvalues lose half of QZ's digits; 1e-9 separates that from any wrong term
        assert np.all(gap <= 1e-9 * scale)


def test_the_sign_of_the_margin_is_the_sign_of_the_growth():
    rng = np.random.default_rng(3)
    for name in PAPER:
        for _ in range(300):
            case = random_case(name, rng)
            jet, friction, epsilon, q, angle = case
            margin = spectrum.margin(base_of(name, jet, friction, epsilon).form(angle).coefficients, q)
            growth = max(e.real for e in exact_eigenvalues(*((name,) + case)))
            if abs(margin) > 1e-13:
                assert (margin < 0) == (growth > 0)


def test_the_stability_polynomial_is_the_margins_numerator():
    rng = np.random.default_rng(4)
    for name in PAPER:
        jet, friction, epsilon, _, angle = random_case(name, rng)
        form = base_of(name, jet, friction, epsilon, EXACT).form(EXACT.number(angle))
        polynomial = spectrum.stability_polynomial(form.coefficients)
        assert sorted(n % 2 for n in polynomial) == [0] * len(polynomial)
        for q in ("0.1", "3", "700"):
            value = spectrum.evaluate(polynomial, EXACT.number(q))
            (tr, _) = spectrum.values(form.coefficients.get("trace", {0: mpf(-1)}), EXACT.number(q))
            if tr < 0:
                assert (value > 0) == (spectrum.margin(form.coefficients, EXACT.number(q), EXACT) > 0)


def double(gap: float) -> dict:
    """Return the form of a matrix with eigenvalues -1 and -1 + gap at every wavenumber."""
    return {"trace": {0: -2 + gap}, "determinant": {0: 1 - gap}, "discriminant": {0: (gap / 2) ** 2}}


@pytest.mark.parametrize("gap", [0.0, 1e-16, 1e-12, 1e-8, 1e-4, 0.1])
def test_nearly_double_eigenvalues_keep_all_digits(gap):
    found = np.sort(np.real(spectrum.pair(double(gap), 1.0)))
    assert_allclose(found, [-1, -1 + gap], rtol=4 * EPS, atol=0)


@pytest.mark.parametrize("small", [1e-3, 1e-9, 1e-15, 1e-200])
def test_a_small_eigenvalue_beside_a_large_one_keeps_all_digits(small):
    form = {"trace": {0: -1e8 - small}, "determinant": {0: 1e8 * small}, "discriminant": {0: ((1e8 - small) / 2) ** 2}}
    assert_allclose(spectrum.pair(form, 1.0)[1].real, -small, rtol=4 * EPS, atol=0)


def test_a_zero_matrix_has_two_zero_eigenvalues():
    assert spectrum.pair({"trace": {0: 0.0}, "determinant": {0: 0.0}, "discriminant": {0: 0.0}}, 1.0) == (0, 0)


def test_equal_real_parts_are_ordered_by_the_imaginary_part():
    one, other = spectrum.leading_first(np.array(-3 - 2j), np.array(-3 * (1 + EPS) + 2j))
    assert one.imag == 2 and other.imag == -2


@pytest.mark.parametrize("degrees", [0, 45, 90, 135, 180, 225, 270, 315, 360, -45, 720 + 45])
def test_directions_at_multiples_of_45_degrees_are_exact(degrees):
    from stability.arithmetic import NUMPY

    c, s = cosine_sine(float(degrees), NUMPY)
    assert {abs(float(c)), abs(float(s))} <= {0.0, 1.0, 0.5**0.5}
    assert_allclose(
        [c, s], [np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))], atol=1e-14
    )  # many roundings at 765
