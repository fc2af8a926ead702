"""The pencil against derivatives of the nonlinear balance laws taken without SymPy, over random base states."""

import numpy as np
import pytest
from mpmath import mpf
from sympy import diff, lambdify

from stability.closures import CLOSURES
from stability.flows import FLOWS
from stability.flows.radial_hopper import pressure, speed
from stability.linearise import along, imbalance, moduli, pencil
from stability.symbols import A, mu, r, symbol
from tests.states import PAPER, random_base


def nonlinear_residual(closure, values):
    """Return S - div F for numbers in place of the jet, div by the chain rule on the raw flux (no letters)."""
    return lambdify([symbol(n) for n in values], -imbalance(closure), "mpmath")(*values.values())


@pytest.mark.parametrize("name", PAPER)
@pytest.mark.parametrize("seed", range(3))
def test_the_pencil_is_the_derivative_of_the_nonlinear_residual(name, seed):
    # A plane wave of amplitude h adds h a_i (1, i xi, -xi xi) to the jet of field i; the residual is analytic, so its
    # complex derivative is the central difference, here with 60 digits and h = 1e-20: truncation 1e-40.
    closure, rng = CLOSURES[name], np.random.default_rng(seed)
    base, jet, constants = random_base(name, rng)
    xi = [mpf(v) for v in rng.normal(size=2) * 10.0 ** rng.uniform(-2, 2)]
    L2, L1, L0 = base.pencil()
    n = len(closure.q)
    h = mpf(10) ** -20
    for j, field in enumerate(closure.q):
        shifted = []
        for sign in (1, -1):
            moved = dict(jet)
            moved[str(field)] += sign * h
            for a, axis in enumerate("xy"):
                moved[f"{field}_{axis}"] += sign * h * 1j * xi[a]
                for b, other in enumerate("xy"):
                    if a <= b:
                        moved[f"{field}_{axis}{other}"] -= sign * h * xi[a] * xi[b]
            shifted.append(nonlinear_residual(closure, moved | constants))
        for i in range(n):
            expected = (shifted[0][i] - shifted[1][i]) / (2 * h)
            found = L0[i][j] + sum(
                1j * xi[a] * L1[a][i][j] - sum(xi[a] * xi[b] * L2[a][b][i][j] for b in (0, 1)) for a in (0, 1)
            )
            scale = 1 + abs(expected)
            assert abs(found - expected) < mpf(10) ** -30 * scale, (name, i, j)


def test_stress_moduli_are_the_papers_tensor():
    # dF/d(grad u) = -mu (delta_i(j delta_l)k - A_ik A_jl): the order of indices that (L2.3) needs, not the printed one
    def d(i, j):
        return int(i == j)

    Fg = moduli(CLOSURES["perturbed"]).Fg
    for i, j, k_, m in np.ndindex(2, 2, 2, 2):  # flux component (i, k), velocity gradient (j, m)
        expected = -mu * ((d(i, j) * d(m, k_) + d(i, m) * d(j, k_)) / 2 - A[i, k_] * A[j, m])
        assert (Fg[k_][m][i, j] - expected).expand().nsimplify() == 0


def test_gradients_along_the_base_state_follow_the_chain_rule():
    closure = CLOSURES["perturbed"]
    expression = symbol("mu") * symbol("u_x") * symbol("k")
    expected = symbol("k") * (symbol("mu_y") * symbol("u_x") + symbol("mu") * symbol("u_xy"))
    assert (along(closure, expression, 1) - expected).expand() == 0


@pytest.mark.parametrize("name", PAPER)
def test_the_pencil_is_real_in_powers_of_i_xi(name):
    P = pencil(CLOSURES[name])
    assert all(e.is_real for e in (*P.L0, *P.L1[0], *P.L1[1], *(e for row in P.L2 for m in row for e in m)))


def test_the_hopper_jet_agrees_with_derivatives_in_polar_coordinates():
    # On the ray y = 0 the local x axis is the radius, so d/dx of u and p are radial derivatives of the printed
    # formulas.
    flow, rho, angle = FLOWS["radial_hopper"], symbol("rho"), symbol("angle")
    given = {"varphi": 0.6, "varphi_w": 0.15, "theta_w": 0.3, "r_0": 0.5, "r_1": 1.5, "g": 9.81, "theta": 0.1}
    values = {symbol(n): v for n, v in given.items()} | {r: 0.9}
    for letter, definition in flow.letters.items():
        values[letter] = definition.subs(values)
    here = {rho: values[r], angle: values[symbol("theta")]}
    jet = {str(s): e.subs(values) for s, e in flow.jet().items()}
    for order, name in ((1, "_x"), (2, "_xx")):
        # doubles: derivatives of order 100 carry a few roundings of the powers
        assert abs(jet["p" + name] - diff(pressure(rho), rho, order).subs(here).subs(values)) < 1e-11
        assert abs(jet["u" + name] + diff(speed(rho, angle), rho, order).subs(here).subs(values)) < 1e-11
    assert jet["p_y"] == 0
