"""The rival power laws recover what they can; how good they are is for the charts."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from benchmarks.rivals.power_law import (
    law,
    log_log,
    plain_values,
    surface,
    weighted_values,
)
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused

T = np.repeat(np.linspace(1.0, 12.0, 12), 4)
Q = np.tile([0.05, 0.1, 0.27, 0.6], 12)
AT = np.array([[2.0, 0.1], [6.5, 0.3]])


@pytest.mark.parametrize("rival", [surface, log_log, weighted_values, plain_values])
def test_a_constant_law_is_recovered_by_all(rival: Callable[..., FloatArray]) -> None:
    truth = 50.0 * AT[:, 1] ** -0.6
    value, low, high = rival(T, Q, 50.0 * Q**-0.6, (0, 0), AT)
    np.testing.assert_allclose(value, truth, rtol=1e-6)
    assert np.all((low <= value) & (value <= high))


def test_the_values_recover_a_law_that_changes_with_time() -> None:
    b = np.array([30.0, 5.0, -0.7, 0.01])
    value = weighted_values(T, Q, law(T, Q, b, (1, 1)), (1, 1), AT)[0]
    np.testing.assert_allclose(value, law(AT[:, 0], AT[:, 1], b, (1, 1)), rtol=1e-6)


def test_a_surface_is_another_law() -> None:
    b = np.array([5.0, 10.0, -0.7, 0.0])
    value = surface(T, Q, law(T, Q, b, (1, 1)), (1, 1), AT)[0]
    assert np.abs(value / law(AT[:, 0], AT[:, 1], b, (1, 1)) - 1.0).max() > 0.05


def test_too_few_times_are_refused() -> None:
    few = T <= 3.0
    with pytest.raises(FitRefused, match=r"^4 parameters need more than 3 points$"):
        log_log(T[few], Q[few], Q[few] ** -0.6, (3, 0), AT)
