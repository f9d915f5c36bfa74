from __future__ import annotations

import numpy as np
import pytest
from scipy.special import betainc

from deamat.core.errors import OutOfRange
from deamat.estimators.weibull.intervals import infer
from deamat.estimators.weibull.plot import (
    adjusted_ranks,
    confidence_band,
    plotting_positions,
    weibull_axis,
)
from tests.estimators.weibull.samples import CABLE_I, simulated


def test_positions_are_the_medians_of_the_order_statistics() -> None:
    found = plotting_positions(CABLE_I[::-1])
    i = np.arange(1, 21)
    assert found.value.tolist() == sorted(CABLE_I)
    assert betainc(i, 21 - i, found.fraction) == pytest.approx(0.5, abs=1e-12)
    assert found.fraction == pytest.approx((i - 0.3) / 20.4, abs=1e-3)  # Benard's approximation
    x, _ = simulated(20, 4000, seed=71)
    below = np.sort(x, axis=1) < 97.0 * (-np.log1p(-found.fraction)) ** (1 / 8)
    assert below.mean(axis=0) == pytest.approx(0.5, abs=0.035)


def test_ranks_of_johnson() -> None:
    """Worked by hand: after one of four left at 2, the last two ranks share what is left."""
    values = np.array([3.0, 1.0, 2.0, 4.0])
    failed = np.array([True, True, False, True])
    assert adjusted_ranks(values, failed) == pytest.approx([1.0, 1 + 4 / 3, 1 + 8 / 3])
    assert adjusted_ranks(values, np.ones(4, dtype=np.bool_)).tolist() == [1.0, 2.0, 3.0, 4.0]
    tied = np.array([1.0, 2.0, 2.0, 4.0])
    assert adjusted_ranks(tied, np.array([True, False, True, True]))[1] == 2.0


def test_the_band_is_the_interval_of_each_quantile_and_rises() -> None:
    p = np.array([0.01, 0.1, 0.5, 0.9])
    low, high = confidence_band(CABLE_I, p)
    asked = infer(CABLE_I)
    for i, value in enumerate(p):
        assert low[i] == pytest.approx(asked.quantile(value).low, rel=1e-14)
        assert high[i] == pytest.approx(asked.quantile(value).high, rel=1e-14)
    assert (np.diff(low) > 0).all()
    assert (np.diff(high) > 0).all()


def test_the_axis_makes_the_fit_a_straight_line() -> None:
    x = 97.0 * np.array([0.5, 0.8, 1.2])
    p = -np.expm1(-((x / 97.0) ** 8))
    assert weibull_axis(p) == pytest.approx(8 * np.log(x / 97.0), rel=1e-12)


def test_impossible_probabilities_are_out_of_range() -> None:
    with pytest.raises(OutOfRange, match=r"a probability must lie between 0 and 1, not 1.5"):
        confidence_band(CABLE_I, [0.5, 1.5])
    with pytest.raises(OutOfRange, match="a level must lie between 0 and 1, not 95"):
        confidence_band(CABLE_I, [0.5], level=95)
