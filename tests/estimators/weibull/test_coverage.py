"""The coverage that a sample states is what other samples of its kind show."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.errors import FitRefused
from deamat.estimators.weibull.coverage import coverage
from deamat.estimators.weibull.intervals import infer


def test_the_stated_coverage_is_that_of_independent_samples() -> None:
    rng = np.random.default_rng(81)
    limit = 70.0  # of all, as of one amplifier: a third of them bear it
    held = np.zeros(4)
    draws = 300
    truth = [9.0, 70.0, *(70.0 * (-np.log1p(-p)) ** (1.0 / 9.0) for p in (0.1, 0.01))]
    for _ in range(draws):
        x = 70.0 * rng.weibull(9.0, 15)
        given = infer(np.minimum(x, limit), x > limit)
        found = (given.shape(), given.scale(), given.quantile(0.1), given.quantile(0.01))
        held += [i.low <= t <= i.high for i, t in zip(found, truth, strict=True)]
    x = 70.0 * (-np.log1p(-(np.arange(15) + 0.5) / 15)) ** (1.0 / 9.0)
    stated = coverage(np.minimum(x, limit), x > limit)
    told = [stated.shape, stated.scale, stated.quantile_10, stated.quantile_1]
    assert told == pytest.approx((held / draws).tolist(), abs=0.04)
    assert stated.least == min(told)
    assert stated.greatest == max(told)


def test_the_same_sample_in_another_unit_gets_the_same_answer() -> None:
    x = np.array([40.0, 50.0, 55.0, 60.0, 61.0, 66.0, 70.0])
    marks = np.array([False, False, True, False, True, False, False])
    assert coverage(x, marks) == coverage(1e6 * x[::-1], marks[::-1])


def test_a_sample_that_cannot_be_fitted_is_refused() -> None:
    with pytest.raises(FitRefused, match="only 2 distinct"):
        coverage([50.0, 60.0, 70.0], [False, False, True])
