"""The time-stepper's fluxes, supplies and moduli against SymPy's derivatives, above and below the floor under ||V||."""

from itertools import product

import numpy as np
import pytest
from numpy.testing import assert_allclose
from sympy import Expr, lambdify

from stability import codegen
from stability.arithmetic import NUMPY
from stability.closures import CLOSURES
from stability.closures.base import Closure, norm
from stability.closures.plane_flow import V
from stability.errors import SceneError
from stability.pointwise import source
from stability.symbols import body_force, gradient, symbol
from stability.timestepper.law import FIELDS, Law

# Ordinary values of everything that a closure may ask for, in SI units and radians.
PARAMETERS = {
    "friction_angle": 0.6,
    "epsilon": 1e-2,
    "kinematic_viscosity": 0.3,
    "grain_diameter": 1e-3,
    "solid_fraction": 0.6,
    "static_friction": 0.34,
    "dynamic_friction": 0.56,
    "reference_inertial_number": 0.07,
    "high_rate_friction": 0.05,
    "low_rate_exponent": 1.9,
    "branch_inertial_number": 0.01,
}
FORCE = (0.3, -9.7)
FLOOR = 1.5
PAPERS = ("perturbed", "rigid_plastic")


def names(closure: Closure) -> tuple:
    """Return the fields of a closure in words."""
    return tuple(tuple(map(str, f)) if isinstance(f, tuple) else str(f) for f in closure.fields)


SOLVABLE = [n for n in CLOSURES if names(CLOSURES[n]) == FIELDS]
OTHERS = [n for n in CLOSURES if n not in SOLVABLE]


def states(strain: float, count: int = 7) -> tuple[np.ndarray, np.ndarray]:
    """Return random q (3, count) with p > 0 and g (2, 3, count) with ||V|| = strain."""
    rng = np.random.default_rng(5)
    q, g = rng.normal(size=(3, count)), rng.normal(size=(2, 3, count))
    q[2] = rng.uniform(0.5, 2, count)
    g[:, :2] *= strain / exact_norm(g)
    return q, g


def exact_norm(g: np.ndarray) -> np.ndarray:
    """Return ||V|| from its definition."""
    rate = (g[:, :2] + np.swapaxes(g[:, :2], 0, 1)) / 2
    return np.sqrt((rate**2).sum(axis=(0, 1)))


def raw(closure: Closure, expression: Expr, floor: float = 0) -> Expr:
    """Return an expression without letters; ||V|| below a floor is replaced by its parabola."""
    for letter, definition in reversed(closure.letters.items()):
        expression = expression.subs(letter, definition)
    return expression.subs(norm(V), (norm(V) ** 2 + floor**2) / (2 * floor)) if floor else expression


def numbers(closure: Closure, expressions: list[Expr], q: np.ndarray, g: np.ndarray) -> list[np.ndarray]:
    """Return the values of expressions in the raw state."""
    known = dict(zip(closure.q, q, strict=True))
    known |= {gradient(c)[b]: g[b, j] for b, (j, c) in product((0, 1), enumerate(closure.q))}
    known |= dict(zip(body_force, FORCE, strict=True))
    known |= {symbol(r.symbol): PARAMETERS[r.word] for r in closure.parameters}
    values = lambdify(list(known), expressions, "numpy")(*known.values())
    return [np.broadcast_to(value, q.shape[1:]) for value in values]


def law(name: str, floor: float = FLOOR) -> Law:
    return Law(name, PARAMETERS, FORCE, floor)


def entries(name: str, q: np.ndarray, g: np.ndarray, floor: float = FLOOR) -> dict[tuple, np.ndarray]:
    """Return flux (i, a), supply (i,) and all their derivatives as one dict."""
    found = {}
    for axis, area in enumerate(np.eye(2)):
        flux = law(name, floor).flux(q, g, area)
        found |= {("F", i, axis): v for (i,), v in flux.items()}
        for kind, table in zip("q01", law(name, floor).flux_moduli(q, g, area), strict=True):
            found |= {("F", i, axis, kind, j): v for (i, j), v in table.items()}
    found |= {("S", i): v for (i,), v in law(name, floor).supply(q, g).items()}
    for kind, table in zip("q01", law(name, floor).supply_moduli(q, g), strict=True):
        found |= {("S", i, kind, j): v for (i, j), v in table.items()}
    return found


def expected_entries(name: str, q: np.ndarray, g: np.ndarray, floor: float) -> dict[tuple, np.ndarray]:
    """Return the same by SymPy's derivatives of the closure as it is written."""
    closure = CLOSURES[name]
    rows = range(3)
    laws = {("F", i, a): raw(closure, closure.flux[i, a], floor) for i, a in product(rows, (0, 1))}
    laws |= {("S", i): raw(closure, closure.supply[i], floor) for i in rows}
    by = {("q", j): c for j, c in enumerate(closure.q)}
    by |= {(str(b), j): gradient(c)[b] for b, (j, c) in product((0, 1), enumerate(closure.q))}
    table = laws | {(*i, *k): e.diff(s) for (i, e), (k, s) in product(laws.items(), by.items())}
    return dict(zip(table, numbers(closure, list(table.values()), q, g), strict=True))


# SymPy takes two seconds for mu(I): the complex step below sees all closures each time.
@pytest.mark.parametrize("name", [n if n in PAPERS else pytest.param(n, marks=pytest.mark.slow) for n in SOLVABLE])
@pytest.mark.parametrize("strain", [2.0, 0.7], ids=["above the floor", "below the floor"])
def test_fluxes_supplies_and_moduli_are_those_of_the_closure(name, strain):
    q, g = states(strain)
    assert_allclose(exact_norm(g), strain, rtol=1e-14)  # roundings of the scaling
    found, expected = entries(name, q, g), expected_entries(name, q, g, FLOOR if strain < FLOOR else 0)
    size = max(abs(v).max() for v in expected.values())
    for index, value in expected.items():
        # Two orders of evaluation of the same expression: some tens of roundings, of terms up to the largest entry.
        assert_allclose(np.broadcast_to(found.get(index, 0.0), value.shape), value, rtol=1e-12, atol=1e-14 * size)


@pytest.mark.parametrize("name", SOLVABLE)
@pytest.mark.parametrize("strain", [2.0, 0.7], ids=["above the floor", "below the floor"])
def test_moduli_are_the_complex_step_derivatives_of_the_flux(name, strain):
    q, g = states(strain)
    h = 1e-30  # no difference is formed, so that nothing is lost by a tiny step
    found = entries(name, q, g)
    for j in range(3):
        for kind, (dq, dg) in {"q": (h, (0, 0)), "0": (0, (h, 0)), "1": (0, (0, h))}.items():
            moved_q, moved_g = q + 0j, g + 0j
            moved_q[j] += 1j * dq
            moved_g[:, j] += 1j * np.array(dg)[:, None]
            for axis, area in enumerate(np.eye(2)):
                for (i,), value in law(name).flux(moved_q, moved_g, area).items():
                    modulus = found.get(("F", i, axis, kind, j), 0.0)
                    # As above: roundings of sums whose terms cancel in part.
                    assert_allclose(np.imag(value) / h + 0 * q[0], modulus + 0 * q[0], rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize("name", PAPERS)
def test_flux_and_moduli_are_continuous_at_the_floor(name):
    gap = 1e-8
    above, below = (entries(name, *states(FLOOR * (1 + s * gap))) for s in (1, -1))
    assert above.keys() == below.keys()
    for index, value in above.items():
        # Both have bounded derivatives on either side, some ten times the entries: a jump would be of order one.
        assert_allclose(value, below[index], rtol=1e2 * gap, atol=1e2 * gap)
    # The derivative of the derivative does jump, so that the floor is seen at all: ||V||'' = 0 above, 1/d below.
    q, g = states(FLOOR * (1 - 1e-3))
    floored, free = entries(name, q, g)["F", 0, 0, "0", 0], entries(name, q, g, floor=0.0)["F", 0, 0, "0", 0]
    assert 1e-5 < abs(floored / free - 1).max() < 1e-1


@pytest.mark.parametrize("name", PAPERS)
def test_without_a_floor_the_norm_is_left_alone(name):
    q, g = states(1e-6)
    closure = CLOSURES[name]
    expected = numbers(closure, [raw(closure, closure.flux[0, 0])], q, g)[0]
    without = law(name, floor=0.0).flux(q, g, (1, 0))[(0,)]
    assert_allclose(without, expected, rtol=1e-13)  # roundings of one flux
    assert abs(law(name).flux(q, g, (1, 0))[(0,)] - expected).max() > 0.1, "the floor would have been seen"


@pytest.mark.parametrize("name", SOLVABLE)
def test_at_rest_a_floor_keeps_flux_and_moduli_finite(name):
    q, g = states(1.0)
    found = entries(name, q, 0 * g)
    assert all(np.isfinite(value).all() for value in found.values())
    assert_allclose(found["F", 0, 0], q[2], rtol=1e-14)  # no deviator: one rounding of the pressure
    assert abs(found["F", 0, 0, "0", 0]).max() > 0


def test_the_norm_is_the_one_of_the_strain_rate():
    _, g = states(3.0)
    assert_allclose(law("perturbed").strain_rate_norm(g), 3.0, rtol=1e-14)  # a square root and five products
    g[:] = 0
    g[0, 1] = g[1, 0] = 1.0  # pure shear at rate 2: V = [[0, 1], [1, 0]]
    assert_allclose(law("perturbed").strain_rate_norm(g), np.sqrt(2), rtol=1e-15)


@pytest.mark.parametrize("name", OTHERS)
def test_a_closure_with_other_fields_is_refused_in_words(name):
    with pytest.raises(SceneError, match=rf'closure = "{name}" has the fields .*\(u, v, p\) alone'):
        law(name)


def test_every_registered_closure_is_either_generated_or_refused():
    assert set(PAPERS) < set(SOLVABLE) and OTHERS
    assert {*SOLVABLE, *OTHERS} == set(CLOSURES)
    for name in SOLVABLE:
        assert codegen.load(CLOSURES, name, codegen.POINTWISE)["FIELDS"] == FIELDS


def test_entries_that_vanish_identically_are_not_computed():
    made = codegen.load(CLOSURES, "rigid_plastic", codegen.POINTWISE)
    assert (2, 0, 2) not in made["FLUX_G0"] and not [i for i in made["FLUX_G0"] if i[0] == 2]  # no grad p in (I7.1)
    perturbed = codegen.load(CLOSURES, "perturbed", codegen.POINTWISE)
    assert [i for i in perturbed["FLUX_G0"] if i[0] == 2] == [(2, 0, 2)]  # (P1.1): -epsilon dp/dx in the flux along x
    assert perturbed["SUPPLY_Q"] == ((0, 0), (0, 1), (1, 0), (1, 1))  # -u.grad u by u, nothing by p


def test_the_generated_text_is_the_same_each_time():
    assert source(CLOSURES["perturbed"]) == source(CLOSURES["perturbed"])


def test_pointwise_functions_have_a_cache_file_of_their_own(tmp_path, monkeypatch):
    monkeypatch.setenv("STABILITY_CACHE", str(tmp_path))
    made = codegen.namespace.__wrapped__(CLOSURES, "rigid_plastic", codegen.POINTWISE)
    (path,) = tmp_path.iterdir()
    assert path.name.startswith("pointwise_closure_rigid_plastic_")
    assert set(made["build"](NUMPY)) == {"strain_rate_norm", "flux", "supply", "flux_moduli", "supply_moduli"}
