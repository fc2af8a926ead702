"""Guaranteed eigenvalues: enclosures contain the truth, shrink with the precision, and the promise of rtol is kept."""

import numpy as np
import pytest
from mpmath import mp, mpf

import stability as st
from stability import spectrum
from stability.balls import enclosing, exact_float
from stability.certified import Certifier
from stability.enclosures import ball_pair, bounded_eigenvalues, enclosed_eigenvalues, ordered, within
from stability.guaranteed import guaranteed
from tests.extremes import truth
from tests.extremes.samples import cases

FAMILIES = ("wavenumber", "det_m_zero", "nearly_double", "neutral", "any_jet")


@pytest.mark.parametrize("family", FAMILIES)
def test_enclosures_contain_the_truth_and_shrink_with_the_precision(family):
    for case in cases(family, 90):
        exact = [truth.as_mpf(ball) for ball in truth.by_balls(case.wave(0, 0))[0]][0]
        widths = []
        for bits in (128, 256, 512):
            a = enclosing(bits)
            form = case.base(a).form(exact_float(float(case.wave_angle[0]), a))
            (value, radius), *_ = enclosed_eigenvalues(form, case.wavenumber[0])
            assert abs(mpf(value.real) - exact) <= mpf(radius)
            ball = truth.of_form(form, exact_float(float(case.wavenumber[0]), a))
            widths.append(mpf(float(ball.rad())) if ball is not None else mpf("inf"))
        assert widths[2] < widths[1] * mpf(2) ** -100 < widths[0] * mpf(2) ** -200


@pytest.mark.parametrize("family", FAMILIES)
def test_the_running_error_bound_of_an_eigenvalue_is_never_smaller_than_its_error(family):
    ratios = []
    for case in cases(family, 300):
        form = Certifier(*case.question).float_base.form(np.repeat(case.wave_angle, case.wavenumber.size))
        with np.errstate(all="ignore"):
            found, bound = bounded_eigenvalues(form, np.tile(case.wavenumber, case.wave_angle.size))
        exact = [truth.as_mpf(ball) for row in truth.by_balls(case) for ball in row]
        for value, reach, true in zip(found[:, 0], bound[:, 0], exact, strict=True):
            if np.isfinite(reach):
                error = abs(mpf(float(value.real)) - true)
                assert error <= mpf(float(reach))
                ratios += [float(mpf(float(reach)) / error)] if error else []
    assert not ratios or np.median(ratios) < 1e4  # bounds of residual and slope multiply; a coefficient's is 65


@pytest.mark.parametrize("rtol", [1e-15, 1e-13, 1e-6, 0.5])
def test_a_guaranteed_growth_rate_is_within_rtol_of_the_truth(rtol):
    for family in FAMILIES:
        for case in cases(family, 60):
            found, tally = guaranteed(*case.question, case.wavenumber, case.wave_angle[:, None], "full", rtol)
            assert sum(tally.by.values()) == case.wave_angle.size * case.wavenumber.size and not tally.undecided
            for i, row in enumerate(truth.by_balls(case)):
                for j, ball in enumerate(row):
                    exact = truth.as_mpf(ball)
                    assert abs(mpf(float(found[i, j, 0].real)) - exact) <= rtol * abs(exact)


def test_both_eigenvalues_are_guaranteed_and_not_one_of_them_twice():
    case = next(iter(cases("nearly_double", 30)))
    found, _ = guaranteed(*case.question, case.wavenumber, case.wave_angle, "full", 1e-9)
    exact = st.eigenvalues(*case.question, case.wavenumber[0], float(case.wave_angle[0]), digits=60)
    a = enclosing(512)
    form = case.base(a).form(exact_float(float(case.wave_angle[0]), a))
    for q, values in zip(case.wavenumber, found, strict=True):
        reals = sorted((truth.as_mpf(real) for real, _ in ball_pair(form, exact_float(float(q), a))), reverse=True)
        for value, true in zip(values, reals, strict=True):
            assert abs(mpf(float(value.real)) - true) <= mpf(1e-9) * abs(true)
    assert exact.shape == (2,)


@pytest.mark.parametrize("bits", [32, 64, 128])
def test_balls_of_any_width_enclose_a_double_eigenvalue(bits):
    # lambda^2 - 2 lambda + 1: with balls around the discriminant 0 the root is only known to its square root
    from flint import arb

    a = enclosing(bits)
    blur = arb(0, 2.0**-bits)

    class Form:
        coefficients = {"trace": {0: arb(2)}, "determinant": {0: 1 + blur}, "discriminant": {0: blur}}
        arithmetic, speed = a, arb(0)

    for real, _ in ball_pair(Form, arb(1)):
        assert real.contains(arb(1)) and real.rad() < 2.0 ** (1 - bits / 2)
    enclosing(128)


def test_eigenvalues_are_ordered_by_real_part_unless_the_bounds_leave_it_open():
    found = np.array([[1 + 1j, 2 + 0j], [2 + 0j, 1 + 1j], [1 - 1j, 1 + 1j], [1 + 0j, 1.5 + 1j]])
    error = np.array([[0.1, 0.1], [0.1, 0.1], [0.0, 0.0], [0.3, 0.3]])
    value, reach = ordered(found, error)
    assert value[:, 0].tolist() == [2, 2, 1 + 1j, 1.5 + 1j]
    assert reach[2].tolist() == [0, 0] and reach[3].tolist() == [0.8, 0.8]  # the gap left open is an error too
    assert within(1.0 + 0j, 0.499, 0.999) and not within(1.0 + 0j, 0.51, 0.999)  # relative to the exact number


def test_the_two_paths_list_the_modes_in_one_order():
    for case in cases("any_jet", 300):
        q, angle = case.wavenumber, case.wave_angle[:, None]
        plain, sure = st.eigenvalues(*case.question, q, angle), st.eigenvalues(*case.question, q, angle, rtol=1e-12)
        size = np.abs(sure).max(axis=-1, keepdims=True)
        assert np.all(np.abs(plain - sure) <= 1e-9 * size)  # a swap would show as the gap between the modes


def test_numpy_floats_are_read_like_floats():
    parameters = {"friction_angle": 34.0, "epsilon": 2e-5, "delta": 0.3, "strain_rate": 1.0, "pressure": 1.0}
    wrapped = {word: np.float64(value) for word, value in parameters.items()}
    found = [st.eigenvalues("perturbed", "uniform_strain", p, {}, 3.0, 20.0, rtol=1e-12) for p in (parameters, wrapped)]
    assert np.array_equal(*found)


def test_intervals_give_the_same_guaranteed_values(monkeypatch):
    from stability import balls

    expected = [
        (c, guaranteed(*c.question, c.wavenumber, c.wave_angle, "full", 1e-13)[0]) for c in cases("neutral", 60)
    ]
    monkeypatch.setattr(balls, "available", lambda: False)
    for case, values in expected:
        found, tally = guaranteed(*case.question, case.wavenumber, case.wave_angle, "full", 1e-13)
        assert all(name == "float64" or name.startswith("mpmath intervals") for name in tally.by)
        assert np.all(np.abs(found.real - values.real) <= 3e-13 * np.abs(values.real))


def test_the_characteristic_polynomial_vanishes_at_an_eigenvalue():
    # the identity behind the bound: x^2 - g x + f = 0 for the distance x from lambda to a root
    with mp.workdps(30):
        f_r, f_i, g_r, g_i = spectrum.characteristic((mpf(3), 0), (mpf(2), 0), mpf(2) + mpf("0.1"), mpf(0))
        assert abs(mpf("0.1") ** 2 - g_r * mpf("0.1") + f_r) < mpf(10) ** -28 and f_i == g_i == 0
