"""The tables of docs/closures.md are those that the package computes, and meet the stated numbers."""

import contextlib
import io
import re
from math import sqrt

import pytest
from mpmath import mp, mpf
from numpy.testing import assert_allclose
from sympy import Matrix, Rational

from docs import space
from docs.numbers import compared, friction, least_decay, turns, verdict
from docs.tables import DOCUMENT, document
from stability.closures import CLOSURES
from tests.closures.benchmarks import BENCHMARKS


def cells(name: str) -> list[list[str]]:
    """Return the rows of a table of the document, without head and rule."""
    text = DOCUMENT.read_text(encoding="utf-8").split(f"<!-- {name}: ")[1].split("<!-- end -->")[0]
    return [line.strip("| \n").split(" | ") for line in text.splitlines() if line.startswith("| ")][2:]


def test_every_closure_and_state_has_its_row_and_no_sign_is_left_open():
    rows = cells("exponents")
    assert [(row[0], row[2], row[-1]) for row in rows] == [(f"`{b.closure}`", b.state, b.why) for b in BENCHMARKS]
    assert {row[0].strip("`") for row in rows} == set(CLOSURES)
    assert {row[-2] for row in rows} == {"yes"}


def test_every_computed_exponent_is_the_stated_one():
    for row, benchmark in zip(cells("exponents"), BENCHMARKS, strict=True):
        stated = "decays" if benchmark.exponent is None else str(benchmark.exponent)
        assert row[3] == row[4] == stated


def test_every_number_meets_the_stated_one():
    rows = cells("numbers")
    assert len(rows) >= 30 and {row[-1] for row in rows} <= {"below 1e-14", "within 1e-12", "exact"}


@pytest.mark.parametrize(
    ("closure", "stated"),
    [
        ("`rigid_plastic`", "0.0467356247925884"),
        ("`rigid_plastic`", "36.0989355774566"),
        ("`mu_i`", "0.0193500918873711"),
        ("`mu_i`", "0.85226581486577"),
        ("`mu_i`", "0.0039717826838072"),
        ("`mu_i`", "0.280165773750758"),
        ("`mu_i`", "0.0184797007567896"),
        ("`mu_i_regularised`", "16.9918747418162"),
        ("`mu_i_regularised`", "17.9066600426969"),
        ("`critical_state`", "0.489897948556636"),
        ("`double_shearing`", "83.3524600575843"),
        ("`rigid_plastic` in 3-D", "0.816496580927726"),  # sqrt(2/3)
        ("`mu_i_phi_i`", "0.475"),  # 1 - 7 mu/6 of mu = 0.45
        ("`mu_i_phi_i` with the 2-D deviator", "0.55"),  # 1 - mu
    ],
)
def test_every_published_number_has_its_row(closure, stated):
    assert [closure, stated] in [[row[0], row[2]] for row in cells("numbers")]


def test_the_regularised_rheology_is_told_on_both_branches_and_where_it_ends():
    rows = {(row[0], row[1]): row[3] for row in cells("numbers")}
    assert rows["`mu_i_regularised_low`", "growth over η q² at I = 1e-300"].endswith(", stable")
    printed = rows["`mu_i_regularised`", "I where the printed condition fails"]
    assert printed == "holds, then fails; stable, then stable"
    assert rows["`mu_i_regularised`", "I where directions fail, d(μp)/dp = 1"] == "stable, then singular symbol"


def test_a_number_off_its_stated_one_is_not_passed():
    assert compared("2", 2.0) == ("2", "below 1e-14")
    assert compared("1", 1 + 5e-13)[1] == "within 1e-12" and compared("1", 1 + 2e-12)[1] == "2e-12"
    assert space.compared("1", mpf(1) + mpf(10) ** -9)[1] == "1.0e-9"


def test_a_threshold_that_is_off_does_not_turn():
    from tests.closures.benchmarks import COULOMB

    def viscous(value):
        return COULOMB | {"kinematic_viscosity": value}

    edge = verdict("rigid_plastic", "uniform_strain", COULOMB).coefficient
    for off, said in ((1, "within 1e-12"), (1 + 1e-11, "does not turn")):
        assert turns("viscous", "uniform_strain", edge * off, viscous, ("ill-posed", "stable"))[1] == said


def test_friction_and_least_decay_are_those_of_the_closure():
    def low(I):
        return mp.sqrt(1 / mp.log(4 / I))  # nu = mu^2/2

    with mp.workdps(30):
        mu, nu = low(mpf("0.1")), low(mpf("0.1")) ** 2 / 2
        K = mu * (1 - nu / 2)
        rates = [-(nu - K * c + (1 - nu) * c**2) / (2 * (1 - K * c)) for c in (mpf(n) / 1000 for n in range(1000))]
        assert max(rates) <= least_decay(mu, nu) < max(rates) + 1e-6
        mu, nu = friction(lambda I: I**3, "0.5")
        assert abs(mu - mpf("0.125")) < 1e-25 and abs(nu - 3) < 1e-25


def test_growth_in_space_is_that_of_the_stress():
    # in the plane: -c(c - s)/(2(1 - s c)) with c = cos 2phi; across it, where A chi = 0, -1/2
    A, s = Matrix.diag(1, -1, 0) / sqrt(2), 0.5
    for chi, c in (([2, 1, 0], 0.6), ([3, 1, 0], 0.8)):
        found = space.growth(A, Matrix(chi), sqrt(2) * s)
        assert_allclose(float(found), max(-0.5, -c * (c - s) / (2 * (1 - s * c))), rtol=1e-14)
    assert_allclose(float(space.growth(A, Matrix([0, 0, 1]), sqrt(2) * s)), -0.5, rtol=1e-14)


@pytest.mark.parametrize(("sign", "kappa", "grows"), [(1, "0.333", False), (1, "0.334", True), (-1, "0.57", False)])
def test_only_axisymmetric_extension_of_strong_friction_grows(sign, kappa, grows):
    assert space.grows(sign, Rational(kappa)) is grows


def test_the_code_of_the_page_runs_and_prints_what_follows_it():
    text = DOCUMENT.read_text(encoding="utf-8")
    pairs = re.findall(r"```python\n((?:(?!```).*\n)*)```\n\nprints\n\n((?:    .*\n)+)", text)
    assert len(pairs) == text.count("```python") == 2
    names: dict = {}
    for code, expected in pairs:
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(code, "closures.md", "exec"), names)  # noqa: S102
        assert printed.getvalue().split() == expected.split()  # sentences may be broken where the page is full


@pytest.mark.slow  # a verdict for each state, half a minute; compiling every closure comes first
def test_the_document_is_what_its_command_writes():
    assert DOCUMENT.read_text(encoding="utf-8") == document(), "run: python -m docs.tables"
