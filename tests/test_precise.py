"""Any number of digits: settled ones only, and refusals."""

import pytest
from mpmath import mpf

import stability as st
from stability.errors import SceneError

POINT = {"r": 1, "theta": 0}


def ask(hopper, wavenumber, digits, point=POINT, angle=33):
    return st.eigenvalues("perturbed", "radial_hopper", hopper, point, wavenumber, angle, digits=digits)


def test_fewer_digits_are_the_first_of_more(perturbed_hopper):
    for q in ("1e-3", "17", "1e9"):
        rough, fine = ask(perturbed_hopper, q, 20), ask(perturbed_hopper, q, 60)
        for a, b in zip(rough, fine, strict=True):
            assert abs(a - b) <= mpf(10) ** -19 * abs(b)


@pytest.mark.parametrize("friction_angle", [75, 85, "89.9"])
def test_steep_friction_costs_guard_digits_and_no_digit_asked_for(perturbed_hopper, friction_angle):
    # w is 140, 960 and 1.2e6 there: powers such as 3^w enter p0. The balls of the guaranteed path are the referee.
    steep = perturbed_hopper | {"friction_angle": friction_angle}
    found = ask(steep, 100.0, 20, {"r": 1.4, "theta": 0})
    sure = st.eigenvalues("perturbed", "radial_hopper", steep, {"r": 1.4, "theta": 0}, 100.0, 33.0, rtol=1e-13)
    for a, b in zip(found, sure, strict=True):
        assert abs(a.real - mpf(b.real)) <= 2e-13 * abs(mpf(b.real))


def test_decimals_are_not_floats(perturbed_hopper):
    # 0.1 as a decimal and the float64 nearest to it differ by 5e-18; forty digits see that
    exact, rounded = (ask(perturbed_hopper, q, 40)[0].imag for q in ("0.1", "0.1000000000000000055511151231257827"))
    assert 0 < abs(exact - rounded) < mpf(10) ** -14


@pytest.mark.parametrize(
    ("digits", "point", "sentence"),
    [
        (0, POINT, "digits = 0"),
        (True, POINT, "digits = True"),
        (20, {"r": [1, 1.1], "theta": [0, 0]}, "takes one point"),
    ],
)
def test_what_cannot_be_asked_is_refused(perturbed_hopper, digits, point, sentence):
    with pytest.raises(SceneError, match=sentence):
        ask(perturbed_hopper, 1.0, digits, point)
