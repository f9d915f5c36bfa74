"""Promises about means of values of which some are only exceeded."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.stats import norm

from deamat.core.errors import FitRefused
from deamat.estimators.censored_mean import mean_with_limits
from deamat.estimators.mean import mean_with_shared

BROKEN = [3.0, 3.1, 2.9]


def test_without_limits_it_is_the_plain_mean() -> None:
    for values in (BROKEN, BROKEN[:1]):
        found = mean_with_limits(values, [False] * len(values), 0.02)
        assert found == mean_with_shared(values, 0.0, 0.02)


def test_limits_far_below_say_nothing() -> None:
    found = mean_with_limits([*BROKEN, 1.0, 1.0], [False] * 3 + [True] * 2, 0.0)
    plain = mean_with_shared(BROKEN, 0.0, 0.0)
    assert found.value == pytest.approx(3.0, rel=1e-9)
    assert found.ci95 == pytest.approx(plain.ci95, rel=1e-6)
    assert found.n == 5


def test_limits_above_some_breaks_raise_the_mean_to_the_maximum_of_the_likelihood() -> None:
    x = np.array([2.4, 2.9, 3.1, 3.3, 2.8, 3.2])
    limit = np.array([False, False, False, False, True, True])

    def loss(p: np.ndarray) -> float:
        z = (x - p[0]) / np.exp(p[1])
        exact = norm.logpdf(z[~limit]).sum() - p[1] * (~limit).sum()
        return -float(exact + norm.logsf(z[limit]).sum())

    best = minimize(
        loss, [3.0, -1.0], method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-13}
    )
    found = mean_with_limits(x.tolist(), limit.tolist(), 0.0)
    assert found.value == pytest.approx(best.x[0], rel=1e-6)
    assert found.sd == pytest.approx(np.exp(best.x[1]) * np.sqrt(4 / 3), rel=1e-5)
    assert found.value > x.mean()


@pytest.mark.parametrize(("n", "limits"), [(5, 2), (12, 4)])
def test_95_percent_intervals_hold_the_truth_in_93_to_97_percent(n: int, limits: int) -> None:
    rng = np.random.default_rng(42)
    hits = tries = 0
    for _ in range(1500):
        x = rng.normal(3.0, 0.3, n)
        cap = np.where(np.arange(n) < limits, rng.uniform(2.0, 3.6, n), np.inf)
        if np.sum(cap >= x) < 3:
            continue
        low, high = mean_with_limits(np.minimum(x, cap).tolist(), (cap < x).tolist(), 0.0).ci95
        tries += 1
        hits += low <= 3.0 <= high
    assert 0.93 < hits / tries < 0.975


def test_fewer_than_three_different_breaks_are_refused() -> None:
    with pytest.raises(FitRefused) as caught:
        mean_with_limits([3.0, 3.0, 3.1, 2.0], [False, False, False, True], 0.0)
    assert str(caught.value) == (
        "3 exact values beside 1 lower limits; a mean needs at least 3 different exact ones"
    )
