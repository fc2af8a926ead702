"""Richardson extrapolation on polynomials, where it is exact."""

import numpy as np
from numpy.testing import assert_allclose

from stability.crosscheck.orders import extrapolated, observed


def test_extrapolation_is_exact_for_an_error_of_the_given_orders():
    sizes = np.array([0.3, 0.2, 0.1])
    values = np.stack([7 + sizes**2 - 5 * sizes**4, 2j - 3 * sizes**2], axis=1)
    assert_allclose(extrapolated(sizes, values, (2, 4)), [7, 2j], rtol=1e-13)  # some roundings of a 3 x 3 inverse


def test_order_of_an_error_is_observed_on_sizes_of_any_ratio():
    sizes = np.array([1.0, 0.5, 0.2])
    assert_allclose(observed(sizes, 4j * sizes**1.5), 1.5, rtol=1e-13)  # exact but for roundings
