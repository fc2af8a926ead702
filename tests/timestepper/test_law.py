"""A closure at points: arrays of any shape, contraction with area vectors, the floor, and what is refused."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from stability.closures import CLOSURES
from stability.errors import SceneError
from stability.timestepper.law import Law, contracted

PARAMETERS = {"friction_angle": np.deg2rad(30), "epsilon": 1e-3}
K = np.sqrt(2) * 0.5  # (I2) at 30 degrees


def pure_shear(shape: tuple = ()) -> tuple[np.ndarray, np.ndarray]:
    """Return u = (x, -y) and p = 3 with grad p = (2, 5) at points of that shape: V = diag(1, -1), ||V|| = sqrt 2."""
    q, g = np.zeros((3, *shape)), np.zeros((2, 3, *shape))
    q[0], q[1], q[2] = 0.7, -0.2, 3.0
    g[0, 0], g[1, 1], g[0, 2], g[1, 2] = 1.0, -1.0, 2.0, 5.0
    return q, g


def test_pure_shear_has_the_stress_and_the_mass_flux_of_the_paper():
    law = Law("perturbed", PARAMETERS)
    q, g = pure_shear()
    x, y = (law.flux(q, g, area) for area in np.eye(2))
    # (I5) over density and (P1.1), by hand: sigma = p (I - k diag(1, -1)/sqrt 2), u - epsilon grad p; roundings
    assert_allclose([x[(0,)], x[(1,)], x[(2,)]], [3 * (1 - 0.5), 0, 0.7 - 2e-3], rtol=1e-14)
    assert_allclose([y[(0,)], y[(1,)], y[(2,)]], [0, 3 * (1 + 0.5), -0.2 - 5e-3], rtol=1e-14)


def test_the_supply_is_gravity_less_advection():
    q, g = pure_shear()
    supply = Law("perturbed", PARAMETERS, body_force=(-9.81, 1.0)).supply(q, g)
    assert_allclose([supply[(0,)], supply[(1,)]], [-9.81 - 0.7, 1.0 - 0.2], rtol=1e-15)  # exact: g - u.grad u
    assert supply[(2,)] == 0


def test_a_flux_is_linear_in_the_area_vector():
    law, rng = Law("perturbed", PARAMETERS), np.random.default_rng(0)
    q, g, area = rng.normal(size=(3, 4, 5)), rng.normal(size=(2, 3, 4, 5)), rng.normal(size=(2, 4, 5))
    x, y = (law.flux(q, g, np.broadcast_to(e[:, None, None], area.shape)) for e in np.eye(2))
    for row, value in law.flux(q, g, area).items():
        assert value.shape == (4, 5)
        assert_allclose(value, area[0] * x[row] + area[1] * y[row], rtol=1e-14, atol=1e-15)  # roundings


def test_contraction_sums_over_the_axis_of_the_flux():
    found = contracted((1.0, 10.0, 100.0), ((0, 0, 2), (0, 1, 2), (1, 1, 2)), (3.0, 7.0))
    assert found == {(0, 2): 73.0, (1, 2): 700.0}


def test_the_floor_bounds_the_viscosity_and_nothing_above_it():
    q, g = pure_shear()
    free, high, low = (Law("perturbed", PARAMETERS, floor=f).flux(q, g, (1, 0))[(0,)] for f in (0, 2.0, 1.4))
    assert free == low, "||V|| = 1.414 lies above 1.4"
    # With m = 2 the norm is (2 + 4)/4 = 1.5 in place of sqrt 2: exact.
    assert_allclose(high, 3 * (1 - K / 1.5), rtol=1e-15)


@pytest.mark.parametrize("floor", [0.0, 0.05])
def test_points_do_not_see_each_other(floor):
    rng = np.random.default_rng(1)
    law = Law("perturbed", PARAMETERS, floor=floor)
    q, g = rng.normal(size=(3, 6)), rng.normal(size=(2, 3, 6)) * 10.0 ** rng.integers(-3, 2, 6)
    together = law.flux(q, g, np.ones((2, 6)))
    for i in range(6):
        alone = law.flux(q[:, i : i + 1], g[..., i : i + 1], np.ones((2, 1)))
        for row, value in together.items():
            assert_array_equal(value[i : i + 1], alone[row])


def test_laws_by_name_and_by_object_are_the_same():
    q, g = pure_shear((2,))
    named, given = (Law(c, PARAMETERS).flux(q, g, (1, 2)) for c in ("perturbed", CLOSURES["perturbed"]))
    assert named.keys() == given.keys() and all((named[i] == given[i]).all() for i in named)


def test_momentum_evolves_and_mass_does_not():
    assert Law("perturbed", PARAMETERS).evolves == (1, 1, 0)


def test_a_closure_with_more_fields_is_refused_when_the_law_is_made():
    with pytest.raises(SceneError, match=r"hyperstress.*solves for velocity and pressure \(u, v, p\) alone"):
        Law("hyperstress", PARAMETERS)
