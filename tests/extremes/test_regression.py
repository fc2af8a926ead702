"""Samples that some path of the toolkit failed on once: the guaranteed and the certified path answer all of them."""

import numpy as np
import pytest
from mpmath import mp, mpf

from stability.certified import Certifier, Tally
from stability.guaranteed import guaranteed
from tests.extremes import truth
from tests.extremes.methods import RTOL
from tests.extremes.regression import FILE, case_of, load

ENTRIES = load() if FILE.exists() else []


@pytest.mark.parametrize("entry", ENTRIES, ids=[f"{e['family']}-{n}" for n, e in enumerate(ENTRIES)])
def test_a_sample_that_failed_once_is_answered(entry):
    case = case_of(entry)
    exact = truth.by_balls(case)[0][0]
    with mp.workdps(60):
        assert abs(truth.as_mpf(exact) - mpf(entry["value"])) <= mpf(10) ** -38 * abs(mpf(entry["value"]))  # as printed
        found, tally = guaranteed(*case.question, case.wavenumber, case.wave_angle, "full", RTOL)
        value = mpf(float(found[0, 0].real))
        assert abs(value - mpf(entry["value"])) <= RTOL * abs(mpf(entry["value"])) and not tally.undecided
    sign = Certifier(*case.question).signs(case.wavenumber, case.wave_angle, Tally())
    assert sign[0, 0] == entry["sign"] == np.sign(float(value))
