"""Enclosures of D, its invariants and N contain what other routes give, and shrink with the precision."""

import pytest
from mpmath import mpc, mpf

import stability as st
from stability import balls
from stability.arithmetic import multiprecision
from stability.model import Model
from stability.proof import enclosure
from stability.spectrum import evaluate, stability_polynomial
from tests.states import PAPER

POINT = {"r": 1, "theta": 3}
WAVE = (130.0, 41.0)


def middle(ball):
    """Return the centre of a ball in 50 digits."""
    return mpf(ball.mid().str(50, radius=False))


def number(pair):
    return mpc(middle(pair[0]), middle(pair[1]))


def question(hopper, closure):
    parameters = hopper | ({"epsilon": 2e-5} if closure == "perturbed" else {})
    return closure, "radial_hopper", parameters, POINT


@pytest.mark.parametrize("closure", PAPER)
def test_d_has_the_eigenvalues_that_are_enclosed(hopper, closure):
    found = enclosure(*question(hopper, closure), *WAVE, bits=400)
    (a, b), (c, d) = ((number(entry) for entry in row) for row in found.D)
    eigenvalues = [number(e) for e in found.eigenvalues] + ([mpc(0)] if closure == "rigid_plastic" else [])
    # the projection's other eigenvalue is the spurious zero; all to the 50 digits that `middle` keeps
    assert abs(a + d - sum(eigenvalues)) < mpf(10) ** -40 * abs(a + d)
    assert abs(a * d - b * c - eigenvalues[0] * eigenvalues[1]) < mpf(10) ** -38 * (abs(a * d) + abs(b * c))


@pytest.mark.parametrize("closure", PAPER)
def test_eigenvalues_and_n_agree_with_mpmath(hopper, closure):
    found = enclosure(*question(hopper, closure), *WAVE, bits=400)
    exact = st.eigenvalues(*question(hopper, closure), *WAVE, digits=45)
    ours = sorted((number(e) for e in found.eigenvalues), key=lambda e: -e.real)
    for one, other in zip(ours, exact, strict=True):
        assert abs(one - mpc(other)) < mpf(10) ** -40 * abs(one)
    a = multiprecision(60)
    form = Model(closure, "radial_hopper", a).base(*question(hopper, closure)[2:]).form(a.number(41))
    N = evaluate(stability_polynomial(form.coefficients), a.number(130))
    assert abs(middle(found.N) - mpf(N)) < mpf(10) ** -40 * abs(mpf(N))


def test_trace_and_determinant_belong_to_the_eigenvalues_at_rest(hopper):
    found = enclosure(*question(hopper, "perturbed"), *WAVE, bits=400)
    speed = (number(found.eigenvalues[0]) + number(found.eigenvalues[1]) - number(found.trace)) / 2  # the drift
    one, other = (number(e) - speed for e in found.eigenvalues)
    assert abs(speed.real) < mpf(10) ** -30 and abs(one * other - number(found.determinant)) < mpf(10) ** -35 * abs(
        other**2
    )
    assert enclosure(*question(hopper, "rigid_plastic"), *WAVE).trace is None


def test_more_bits_make_smaller_balls(hopper):
    wide, narrow = (enclosure(*question(hopper, "perturbed"), *WAVE, bits=b) for b in (64, 256))
    for one, other in zip(wide.D[0], narrow.D[0], strict=True):
        assert float(other[0].rad()) < 1e-40 * float(one[0].rad()) or float(one[0].rad()) == 0
        assert one[0].overlaps(other[0])
    assert wide.arithmetic == "Arb, 64 bits"


def test_intervals_serve_where_flint_is_absent(hopper, monkeypatch):
    arb = enclosure(*question(hopper, "perturbed"), *WAVE)
    monkeypatch.setattr(balls, "available", lambda: False)
    iv = enclosure(*question(hopper, "perturbed"), *WAVE)
    assert "mpmath" in iv.arithmetic
    for one, other in zip(iv.eigenvalues, arb.eigenvalues, strict=True):
        # both contain the exact value, with 128 bits
        assert abs(mpf(one[0].mid) - middle(other[0])) < mpf(10) ** -25 * abs(middle(other[0]))
