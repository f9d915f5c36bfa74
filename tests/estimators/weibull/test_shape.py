from __future__ import annotations

import numpy as np
import pytest

from deamat.estimators.weibull.fit import fit, fit_batch, solve_shape
from deamat.estimators.weibull.sample import log_samples
from deamat.estimators.weibull.shape import modified_ratio, ross_factor, unbiased_shape
from tests.estimators.weibull.samples import CABLE_I, simulated


@pytest.mark.parametrize(
    ("n", "bias_of_fit", "tolerance"), [(5, 0.45, 0.02), (10, 0.17, 0.012), (20, 0.077, 0.008)]
)
def test_ross_removes_the_bias_of_complete_samples(
    n: int, bias_of_fit: float, tolerance: float
) -> None:
    x, _ = simulated(n, 20_000, seed=51)
    shape = fit_batch(x).shape / 8.0
    assert shape.mean() - 1 == pytest.approx(bias_of_fit, abs=tolerance)
    assert ross_factor(n) * shape.mean() - 1 == pytest.approx(0.0, abs=tolerance)


@pytest.mark.parametrize(
    ("n", "stop_at", "bias_of_fit", "tolerance"),
    [(20, 15, 0.124, 0.015), (10, 7, 0.32, 0.025), (8, 6, 0.39, 0.04)],
)
def test_the_modified_profile_removes_the_bias_of_censored_samples(
    n: int, stop_at: int, bias_of_fit: float, tolerance: float
) -> None:
    x, censored = simulated(n, 20_000, seed=52, stop_at=stop_at)
    shape = fit_batch(x, censored).shape / 8.0
    assert shape.mean() - 1 == pytest.approx(bias_of_fit, abs=tolerance)
    samples = log_samples(x, ~censored)
    corrected, _ = solve_shape(samples, modified_ratio(samples.failures))
    assert corrected.mean() / 8.0 - 1 == pytest.approx(0.0, abs=tolerance)


def test_the_method_follows_the_censoring() -> None:
    complete = unbiased_shape(CABLE_I)
    assert complete.method == "Ross"
    assert complete.value == pytest.approx(fit(CABLE_I).shape * 18 / 19.32, rel=1e-14)
    censored = unbiased_shape(CABLE_I, np.arange(20) == 19)
    assert censored.method == "modified profile likelihood"
    # on one sample the two methods agree far better than the shape is known
    assert complete.value == pytest.approx(
        solve_shape(log_samples(CABLE_I[None, :], None), np.array([18 / 20]))[0].item(), rel=0.02
    )


def test_the_modified_profile_is_the_maximum_of_its_likelihood() -> None:
    censored = np.arange(20) > 14
    k = np.linspace(2.0, 20.0, 180_001)
    log_sum = np.log(sum(np.exp(k * z) for z in np.log(CABLE_I)))
    likelihood = 13 * np.log(k) + k * np.log(CABLE_I[:15]).sum() - 15 * log_sum
    assert unbiased_shape(CABLE_I, censored).value == pytest.approx(
        k[likelihood.argmax()], abs=1e-4
    )
