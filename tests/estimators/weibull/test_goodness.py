from __future__ import annotations

import numpy as np
import pytest

from deamat.core.errors import FitRefused
from deamat.estimators.weibull.fit import fit
from deamat.estimators.weibull.goodness import curved, goodness_of_fit, low_outlier
from deamat.estimators.weibull.reference import anderson_darling, reference, thinned
from deamat.estimators.weibull.simulate import at_risk, standard_samples, withdrawals
from tests.estimators.weibull.samples import CABLE_I, CABLE_II, simulated


def test_the_statistic_is_the_usual_sum_for_complete_samples() -> None:
    found = fit(CABLE_I)
    u = -np.expm1(-((CABLE_I / found.scale) ** found.shape))
    i = np.arange(1, 21)
    usual = -20 - np.mean((2 * i - 1) * (np.log(u) + np.log1p(-u[::-1])))
    assert goodness_of_fit(CABLE_I).statistic == pytest.approx(usual, rel=1e-12)


def test_the_statistic_of_censored_samples_is_its_integral() -> None:
    hazard = np.array([0.05, 0.3, 0.7])
    removed = (2, 0, 1)  # 7, then 4, then 3 under test
    assert at_risk(removed).tolist() == [6.0, 3.0, 2.0]
    u = np.linspace(1e-9, 1 - np.exp(-0.7), 2_000_001)
    failed = 1 - np.cumprod([1.0, 5 / 6, 2 / 3])
    steps = failed[np.searchsorted(-np.expm1(-hazard[:2]), u)]
    y = (steps - u) ** 2 / (u * (1 - u))
    integral = 6 * float(np.sum((y[1:] + y[:-1]) / 2) * (u[1] - u[0]))
    assert anderson_darling(hazard[None, :], removed).item() == pytest.approx(integral, rel=1e-4)


def test_p_values_agree_with_the_critical_values_of_stephens() -> None:
    """D'Agostino and Stephens, Goodness-of-Fit Techniques (1986), table 4.17: A^2 (1+0.2/sqrt n)."""
    found = []
    for seed in range(40):
        x, _ = simulated(50, 1, seed=seed)
        answer = goodness_of_fit(x[0])
        found.append((answer.statistic * (1 + 0.2 / np.sqrt(50)), answer.p_value))
    for critical, p in ((0.474, 0.25), (0.637, 0.10), (0.757, 0.05)):
        above = [q for a, q in found if a > critical]
        below = [q for a, q in found if a <= critical]
        assert max(above, default=0.0) < 1.15 * p + 0.005
        assert min(below, default=1.0) > 0.85 * p - 0.005


@pytest.mark.parametrize(
    ("n", "stop_at"), [(5, None), (20, None), (20, 15)], ids=["5", "20", "20 stopped at 15"]
)
def test_both_tests_raise_as_many_false_alarms_as_they_say(n: int, stop_at: int | None) -> None:
    x, censored = simulated(n, 1500, seed=61, stop_at=stop_at)
    form = [goodness_of_fit(v, c).p_value for v, c in zip(x, censored, strict=True)]
    low = [low_outlier(v, c).p_value for v, c in zip(x, censored, strict=True)]
    for p_values in (np.array(form), np.array(low)):
        assert np.mean(p_values < 0.05) == pytest.approx(0.05, abs=0.02)
        assert np.mean(p_values < 0.5) == pytest.approx(0.5, abs=0.04)


def test_one_specimen_far_too_low_is_found_and_one_at_half_strength_sometimes() -> None:
    x, _ = simulated(20, 1000, seed=62)
    for factor, power in ((0.3, 0.97), (0.5, 0.36)):
        weak = x.copy()
        weak[:, 4] *= factor
        found = [low_outlier(v) for v in weak]
        assert np.mean([f.found for f in found]) == pytest.approx(power, abs=0.05)
        assert np.mean([f.index == 4 for f in found]) > 0.8


def test_a_low_outlier_is_named_and_kept() -> None:
    weak = CABLE_I.copy()
    weak[7] = 12.0
    found = low_outlier(weak)
    assert (found.index, found.value, found.found) == (7, 12.0, True)
    assert found.p_value < 0.01
    assert weak[7] == 12.0
    assert not low_outlier(weak, level=0.0001).found
    assert not low_outlier(CABLE_I).found
    assert not low_outlier(CABLE_II).found


def test_a_wrong_form_has_small_p_values() -> None:
    lognormal = np.exp(np.random.default_rng(63).normal(0.0, 0.15, (200, 60)))
    p_values = np.array([goodness_of_fit(v).p_value for v in lognormal])
    assert np.mean(p_values < 0.05) > 0.5


def test_the_same_question_gets_the_same_answer_in_any_unit_and_order() -> None:
    first = goodness_of_fit(CABLE_I)
    again = goodness_of_fit(1e6 * CABLE_I[::-1])
    assert again.p_value == first.p_value
    assert again.statistic == pytest.approx(first.statistic, rel=1e-10)
    assert first.exact


def test_withdrawals_are_counted_after_the_failure_before_them() -> None:
    values = np.array([1.0, 2.0, 2.0, 3.0, 0.5, 2.5, 9.0, 8.0])
    failed = np.array([True, True, False, True, False, False, False, False])
    assert withdrawals(values, failed) == (0, 2, 2)
    assert at_risk((0, 2, 2)).tolist() == [7.0, 6.0, 3.0]
    assert not goodness_of_fit(values, ~failed).exact


def test_simulated_censored_samples_have_the_moments_of_their_spacings() -> None:
    failures, values, censored = standard_samples((1, 0, 2), 40_000, seed=64)
    assert censored is not None
    assert values.shape == (40_000, 6)
    assert censored[0].tolist() == [False, True, False, False, True, True]
    assert failures.mean(axis=0) == pytest.approx(np.cumsum([1 / 6, 1 / 4, 1 / 3]), rel=0.02)


def test_what_cannot_be_fitted_cannot_be_tested() -> None:
    with pytest.raises(FitRefused, match=r"only 2 distinct failure\(s\) among 2 values"):
        goodness_of_fit([50.0, 60.0])
    with pytest.raises(FitRefused, match="all 3 values are censored"):
        low_outlier([50.0, 60.0, 70.0], [True, True, True])


@pytest.mark.parametrize(("n", "stop_at"), [(8, None), (20, None), (20, 15)])
def test_a_straight_plot_is_called_curved_as_rarely_as_it_says(n: int, stop_at: int | None) -> None:
    x, censored = simulated(n, 1500, seed=65, stop_at=stop_at)
    p = np.array([curved(v, c).p_value for v, c in zip(x, censored, strict=True)])
    assert np.mean(p < 0.05) == pytest.approx(0.05, abs=0.02)
    assert np.mean(p < 0.005) < 0.01


def test_a_threshold_and_a_tail_of_weak_specimens_curve_the_plot_to_either_side() -> None:
    rng = np.random.default_rng(66)
    threshold = 40.0 + 30.0 * rng.weibull(2.0, (100, 60))
    found = [curved(v) for v in threshold]
    assert np.mean([f.p_value < 0.05 for f in found]) > 0.8
    assert np.mean([f.score > 0.0 for f in found]) > 0.98
    mixed = 70.0 * rng.weibull(9.0, (100, 60)) * np.where(np.arange(60) < 6, 0.4, 1.0)
    found = [curved(v) for v in mixed]
    assert np.mean([f.p_value < 0.05 for f in found]) > 0.9
    assert all(f.score < 0.0 for f in found)


def test_the_score_is_the_slope_of_the_likelihood_of_the_curved_form() -> None:
    """By finite differences of the log-likelihood of y = (H^c - 1)/c, complete and censored."""
    x, censored = CABLE_I, np.arange(20) > 15
    x = np.sort(x)
    x[16:] = x[15]
    best = fit(x, censored)
    y = best.shape * np.log(x / best.scale)

    def log_likelihood(c: float) -> float:
        hazard = np.log1p(c * y) / c  # ln H
        density = np.where(censored, 0.0, hazard - np.log1p(c * y))
        return float((density - np.exp(hazard)).sum())

    slope = (log_likelihood(1e-5) - log_likelihood(-1e-5)) / 2e-5
    assert curved(x, censored).score * np.sqrt(16.0) == pytest.approx(slope, rel=1e-4)


def test_many_failures_are_thinned_with_their_withdrawals() -> None:
    assert thinned((0, 1, 2), 5) == (0, 1, 2)
    assert thinned((0,) * 1000, 400) == (0,) * 400
    thin = thinned((1, 0) * 500, 400)
    assert (len(thin), sum(thin)) == (400, 200)


def test_the_distributions_hardly_change_beyond_four_hundred_failures() -> None:
    x, _ = simulated(1500, 300, seed=67)
    p = np.array([(goodness_of_fit(v).p_value, low_outlier(v).p_value) for v in x])
    assert np.mean(p < 0.05, axis=0) == pytest.approx(0.05, abs=0.035)
    assert np.mean(p < 0.5, axis=0) == pytest.approx(0.5, abs=0.09)
    assert reference((0,) * 1500).lowest.mean() == pytest.approx(1.0 / 1500.0, rel=0.1)
