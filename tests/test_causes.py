"""What an instability comes from, in toys with one term to blame."""

from stability.balls import enclosing
from stability.causes import causes, makers, silent
from stability.directions import Directions
from stability.model import Model
from stability.puiseux import Numbers
from tests import toys


def asked(closure, **parameters):
    base = Model(closure, toys.REST, enclosing(256)).base(parameters, {})
    return base, Directions(base.model.evolves, base.pencil(), Numbers(base.model.arithmetic, 256))


def blamed(closure, exponent, angle=10.0, **parameters):
    base, d = asked(closure, **parameters)
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


def test_a_coefficient_is_made_of_the_terms_without_which_it_is_gone():
    base, d = asked(toys.FREE_ALONG_Y)  # i q cos lambda = 1
    assert list(makers(base, "full", d, (1, 1))) == ["the response of first order to b in the balance of b"]
    base, d = asked(toys.HYPERVISCOUS)  # lambda = q^2 - q^4/10: both in the coefficient of lambda^0
    made = list(makers(base, "full", d, (0, 4)))
    assert made == [
        "the response of the flux to the gradient of b in the balance of a",
        "the response of the flux to the gradient of a in the balance of b",
    ]


def test_a_law_that_says_nothing_is_named():
    assert list(silent(asked(toys.FREE)[0], "full")) == ["the balance of b responds to nothing here"]
    assert list(silent(asked(toys.HYPERVISCOUS)[0], "full")) == []
