"""What an instability comes from, in toys with one term to blame."""

from stability.balls import enclosing
from stability.causes import causes
from stability.directions import Directions
from stability.model import Model
from stability.puiseux import Numbers
from tests import toys


def blamed(closure, exponent, angle=10.0, **parameters):
    base = Model(closure, toys.REST, enclosing(256)).base(parameters, {})
    d = Directions(base.model.evolves, base.pencil(), Numbers(base.model.arithmetic, 256))
    return list(causes(base, "full", d, angle, exponent))


def test_antidiffusion_is_blamed_on_the_flux():
    assert blamed(toys.DIFFUSION, 2, growth=-1.0) == [
        "the response of the flux to the gradient of a in the balance of a"
    ]


def test_a_negative_damping_is_blamed_and_the_wave_is_not():
    found = blamed(toys.TELEGRAPH, 0, growth=2.0)
    assert found == ["the response of zeroth order to b in the balance of b"]


def test_every_link_of_a_loop_is_blamed():
    assert len(blamed(toys.ELLIPTIC, 1)) == 2
