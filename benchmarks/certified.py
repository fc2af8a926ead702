"""Certified signs against the growth map, against all-Arb and all-mpmath; spot checks by another formula in Arb."""

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from benchmarks.cases import Case, polar, zoom
from benchmarks.maps import PACKAGE, package
from benchmarks.rows import Group, Limit, Row, timed
from benchmarks.timing import interleaved, per_sample
from stability import balls
from stability.arithmetic import multiprecision
from stability.balls import exact_float
from stability.certified import Certifier, Tally, ball_signs
from stability.model import Form, Model

CERTIFIED, ARB, MPMATH = "certified signs", "every sample in Arb, 128 bits", "every sample in mpmath, 38 digits"
SPOT_CHECKS = 300
REFEREE_BITS = 2048
SUBSAMPLE = (10, 1000)  # directions, wavenumbers: what an arithmetic without arrays gets

FULL, NEAR = Limit(2), Limit(20)


def cases(samples: int) -> dict[str, tuple[str, Case, Limit | None]]:
    """Return the maps: name -> (what it is, the case, the target of the ratio to the growth map)."""
    return {
        "certified": ("All directions, epsilon = 2e-5.", polar(samples), FULL),
        "certified-stiff": ("All directions, epsilon = 1e-8.", polar(samples, 1e-8), FULL),
        "certified-1e-6": ("Within 1e-6 degrees of a characteristic, up to 1e10 /m.", zoom(samples, 1e-6), None),
        "certified-1e-9": ("Within 1e-9 degrees of a characteristic, up to 1e10 /m.", zoom(samples, 1e-9), NEAR),
    }


def signs(case: Case) -> tuple[np.ndarray, Tally]:
    """Return certified signs of a map, everything from the base state on included."""
    tally = Tally()
    return Certifier(*case.question).signs(case.wavenumber, case.wave_angle, tally), tally


def referee(case: Case) -> Callable[[float, float], int]:
    """Return a function (wave_angle, wavenumber) -> sign by another route: the entries of D, in Arb.

    Then the quadratic formula. No reduced form, no stability polynomial, no frame of the wave's own: all that it shares
    is the pencil.
    """
    from flint import acb, ctx

    with ctx.workprec(REFEREE_BITS):
        arithmetic = balls.arb_balls(REFEREE_BITS)
        L2, L1, L0 = Model(case.closure, case.flow, arithmetic).base(case.parameters, case.point).pencil()

    def sign(wave_angle: float, wavenumber: float) -> int:
        with ctx.workprec(REFEREE_BITS):
            q = exact_float(wavenumber, arithmetic)
            c, s = arithmetic.direction(exact_float(wave_angle, arithmetic), arithmetic)
            x, y = q * c, q * s

            def entry(i: int, j: int) -> acb:
                second = x * x * L2[0][0][i][j] + x * y * (L2[0][1][i][j] + L2[1][0][i][j]) + y * y * L2[1][1][i][j]
                return acb(L0[i][j] - second, x * L1[0][i][j] + y * L1[1][i][j])

            L = [[entry(i, j) for j in range(3)] for i in range(3)]
            (a, b), (c, d) = ([L[i][j] - L[i][2] * L[2][j] / L[2][2] for j in (0, 1)] for i in (0, 1))
            growth = (a + d).real / 2 + abs((((a - d) / 2) ** 2 + b * c).sqrt().real)
            return 1 if growth > 0 else -1 if growth < 0 else 0

    return sign


def spot_checks(case: Case, sign: np.ndarray) -> Row:
    """Return how many of some random samples the referee contradicts, or cannot decide either."""
    rng, decide = np.random.default_rng(3), referee(case)
    i, j = (rng.integers(0, n, SPOT_CHECKS) for n in sign.shape)
    waves = zip(case.wave_angle[i].tolist(), case.wavenumber[j].tolist(), sign[i, j], strict=True)
    wrong = sum(decide(angle, q) != found for angle, q, found in waves)
    return Row(f"disagreements with Arb in {SPOT_CHECKS} samples", measured=float(wrong), limit=Limit(0))


def one_by_one(form: Callable[[float], Form], case: Case) -> Callable[[], np.ndarray]:
    """Return the call that decides a subsample of a map in an arithmetic without arrays."""
    some = [
        np.linspace(0, v.size - 1, n).astype(int)
        for v, n in zip((case.wave_angle, case.wavenumber), SUBSAMPLE, strict=True)
    ]
    angles, waves = case.wave_angle[some[0]].tolist(), case.wavenumber[some[1]]

    def call() -> np.ndarray:
        return np.array([ball_signs(reduced, waves) for reduced in map(form, angles)])

    return call


def exact_form(case: Case, wave_angle: float) -> Form:
    """Return the reduced form of a direction in mpmath."""
    arithmetic = multiprecision(38)
    base = Model(case.closure, case.flow, arithmetic).base(case.parameters, case.point)
    return base.form(exact_float(wave_angle, arithmetic))


def measure(quick: bool) -> Iterator[Group]:
    """Yield a group per map, then the arithmetics against each other."""
    rounds = 3 if quick else 7
    for name, (text, case, limit) in cases(10**5 if quick else 10**6).items():
        group = Group(name, f"{text} {case.size:,} samples; base state and precision beyond float64 included.")
        sign, tally = signs(case)
        growth = package(case, frequency=False)
        timings = interleaved({PACKAGE: growth, CERTIFIED: partial(signs, case)}, rounds)
        group.rows += timed(
            per_sample(timings, dict.fromkeys(timings, case.size)),
            PACKAGE,
            limits={(CERTIFIED, PACKAGE): limit} if limit else {},
        )
        group.rows.append(Row("undecided samples", measured=float(tally.by.get("undecided", 0)), limit=Limit(0)))
        if balls.available():
            group.rows.append(spot_checks(case, sign))
        beyond = case.size - tally.by.get("float64", 0)
        group.rows.append(Row("samples that float64 could not decide", measured=float(beyond)))
        group.rows.append(
            Row("wrong signs of the growth map", measured=float(np.count_nonzero(np.sign(growth()) != sign)))
        )
        yield group
    yield arithmetics(rounds)


def arithmetics(rounds: int) -> Group:
    """Return what a sample costs in float64 with bounds, in Arb and in mpmath."""
    case = polar(10**6)
    group = Group(
        "arithmetics",
        "All directions, epsilon = 2e-5: certified signs of 1,000,000 samples, the others on 10 x 1,000 of them.",
    )
    certifier = Certifier(*case.question)
    calls = {CERTIFIED: partial(signs, case), MPMATH: one_by_one(partial(exact_form, case), case)}
    if balls.available():
        calls[ARB] = one_by_one(lambda angle: certifier.form(angle, balls.FIRST_BITS), case)
    for call in calls.values():
        call()
    samples = {name: case.size if name == CERTIFIED else SUBSAMPLE[0] * SUBSAMPLE[1] for name in calls}
    limits = {
        (ARB, CERTIFIED): Limit(80, at_least=True),
        (MPMATH, CERTIFIED): Limit(500, at_least=True),
        (MPMATH, ARB): Limit(6, at_least=True),
    }
    group.rows += timed(per_sample(interleaved(calls, rounds), samples), CERTIFIED, limits=limits)
    return group
