"""A strength that follows the thickness is found, and one that does not is left alone."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.weibull.fit import fit
from deamat.estimators.weibull.trend import trend, trend_p_value


def films(n: int, exponent: float, seed: int) -> tuple[FloatArray, FloatArray]:
    rng = np.random.default_rng(seed)
    thickness = rng.uniform(100.0, 150.0, n)
    return 70.0 * (thickness / 125.0) ** -exponent * rng.weibull(9.0, n), thickness


def test_false_alarms_are_as_rare_as_they_say() -> None:
    for n in (6, 20):
        p = np.array(
            [trend_p_value(x, None, t) for x, t in (films(n, 0.0, s) for s in range(1000))]
        )
        assert np.mean(p < 0.05) == pytest.approx(0.05, abs=0.02)
        assert np.mean(p < 0.005) < 0.01


def test_the_exponent_lies_in_its_interval_and_is_taken_out() -> None:
    hits, shapes = 0, []
    for seed in range(50):
        x, t = films(30, 0.8, seed)
        found = trend(x, None, t)
        hits += found.low <= 0.8 <= found.high
        shapes.append(found.at_centre.shape)
        assert found.low < found.exponent < found.high
    assert hits >= 43
    assert np.mean(shapes) == pytest.approx(9.0, rel=0.12)


def test_the_exponent_is_that_of_greatest_likelihood() -> None:
    x, t = films(25, 1.0, 3)
    marks = x > np.quantile(x, 0.8)
    found = trend(x, marks, t)
    z = np.log(t / found.centre)

    def log_likelihood(m: float) -> float:
        return fit(x * np.exp(m * z), marks).log_likelihood + m * float(z[~marks].sum())

    best = log_likelihood(found.exponent)
    assert best > max(log_likelihood(found.exponent + d) for d in (-1e-3, 1e-3))
    ends = [log_likelihood(found.low), log_likelihood(found.high)]
    assert ends[0] == pytest.approx(ends[1], abs=1e-3)
    # where the exact interval of a normal regression ends: Student's t of 20 failures less 3
    assert best - ends[0] == pytest.approx(0.5 * 20 * np.log1p(2.109816**2 / 17), rel=1e-3)


def test_too_few_specimens_are_refused() -> None:
    with pytest.raises(FitRefused, match="4 specimens; at least 5"):
        trend([50.0, 60.0, 61.0, 70.0], None, [1.0, 2.0, 3.0, 4.0])
