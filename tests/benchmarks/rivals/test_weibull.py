from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.rivals.weibull import (
    bootstrap_intervals,
    likelihood_ratio_intervals,
    wald_covariance,
    wald_intervals,
)
from benchmarks.rivals.weibull_lines import iec_62539, log_weibull_variances, rank_regression
from deamat.core.errors import OutOfRange
from deamat.estimators.weibull.fit import fit
from tests.estimators.weibull.samples import CABLE_I, NAMES, open_sample, simulated

B1_B10 = (0.01, 0.1)


@pytest.mark.shared
@pytest.mark.parametrize("name", NAMES)
def test_wald_intervals_are_those_of_r(shared: Path, name: str) -> None:
    sample = open_sample(shared, name)
    found = wald_intervals(sample.x, sample.censored, 0.95, B1_B10)
    names = ("shape", "scale", "B1", "B10")
    for what, bounds in zip(names, (found.shape, found.scale, *found.quantiles), strict=True):
        low, high = sample.by_r(f"{what}_wald95_lo"), sample.by_r(f"{what}_wald95_hi")
        assert bounds == pytest.approx((low, high), rel=1e-9)
    covariance = wald_covariance(sample.x, sample.censored)
    assert covariance[0, 0] ** 0.5 == pytest.approx(sample.by_r("se_log_scale"), rel=1e-9)
    assert covariance[1, 1] ** 0.5 == pytest.approx(sample.by_r("se_log_shape"), rel=1e-9)
    assert -covariance[0, 1] == pytest.approx(sample.by_r("cov_logscale_logsigma"), rel=1e-9)


@pytest.mark.shared
def test_rank_regression_is_that_of_weibulltools_with_johnson_ranks(shared: Path) -> None:
    sample = open_sample(shared, "shock_absorber")
    expected = {e.quantity: e.value for e in sample.expected}
    line = rank_regression(sample.x, sample.censored)
    assert np.log(line.scale) == pytest.approx(expected["MRR_log_scale"], rel=1e-8)
    assert 1 / line.shape == pytest.approx(expected["MRR_sigma=1/shape"], rel=1e-7)


def test_all_lines_run_through_points_on_a_line() -> None:
    ranks = np.arange(1, 12)
    benard = 97.0 * (-np.log1p(-(ranks - 0.3) / 11.4)) ** (1 / 8)
    iec = 97.0 * (-np.log1p(-(ranks - 0.44) / 11.25)) ** (1 / 8)
    lines = [
        rank_regression(benard),
        rank_regression(benard, direction="y on x"),
        iec_62539(iec),
        iec_62539(iec, ranks > 8),
    ]
    for line in lines[:3]:
        assert line.scale == pytest.approx(97.0, rel=1e-12)
        assert line.shape == pytest.approx(8.0, rel=1e-12)
    assert lines[3].shape == pytest.approx(8.0, rel=1e-12)


def test_regressing_the_other_way_gives_the_steeper_line() -> None:
    assert (
        rank_regression(CABLE_I, direction="y on x").shape
        < rank_regression(CABLE_I, direction="x on y").shape
    )


def test_variances_of_log_weibull_order_statistics() -> None:
    assert log_weibull_variances(20)[0] == pytest.approx(np.pi**2 / 6, rel=1e-9)
    assert log_weibull_variances(2)[1] == pytest.approx(np.pi**2 / 6 - 2 * np.log(2) ** 2, rel=1e-9)
    drawn = np.log(np.sort(simulated(20, 20_000, seed=91, shape=1.0)[0], axis=1))
    assert log_weibull_variances(20) == pytest.approx(drawn.var(axis=0), rel=0.06)


def test_likelihood_ratio_bounds_lie_where_the_profile_has_dropped() -> None:
    censored = np.arange(20) > 15
    found = likelihood_ratio_intervals(CABLE_I, censored, 0.95, B1_B10)
    log_x, failed = np.log(CABLE_I), ~censored
    k = np.linspace(1.0, 25.0, 48_001)[:, None]

    def log_likelihood(log_scale: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> float:
        v = k * (log_x - log_scale)
        terms = (np.log(k) + v - log_x) * failed - np.exp(v)
        return float(terms.sum(axis=1).max())

    drop = fit(CABLE_I, censored).log_likelihood - 0.5 * 3.841458820694124
    for p, bounds in zip((1 - np.exp(-1), *B1_B10), (found.scale, *found.quantiles), strict=True):
        for bound in bounds:
            log_scale = np.log(bound) - np.log(-np.log1p(-p)) / k
            assert log_likelihood(log_scale) == pytest.approx(drop, abs=1e-6)
    for bound in found.shape:
        h = CABLE_I**bound
        scale = (h.sum() / failed.sum()) ** (1 / bound)
        v = bound * (log_x - np.log(scale))
        profile = ((np.log(bound) + v - log_x) * failed - np.exp(v)).sum()
        assert profile == pytest.approx(drop, abs=1e-8)


def test_bootstrap_percentiles_are_those_of_refitted_samples() -> None:
    found = bootstrap_intervals(CABLE_I, level=0.9, probabilities=B1_B10, draws=400, seed=5)
    best = fit(CABLE_I)
    spacings = np.random.default_rng(5).standard_exponential((400, 20))
    standard = np.cumsum(spacings / np.arange(20, 0, -1), axis=1)
    refits = [fit(best.scale * h ** (1 / best.shape)) for h in standard]
    shapes = np.array([f.shape for f in refits])
    b10 = np.array([f.scale for f in refits]) * (-np.log(0.9)) ** (1 / shapes)
    assert found.shape == pytest.approx(np.quantile(shapes, [0.05, 0.95]), rel=1e-10)
    assert found.quantiles[1] == pytest.approx(np.quantile(b10, [0.05, 0.95]), rel=1e-10)
    assert bootstrap_intervals(CABLE_I, np.arange(20) > 15).shape[0] > 0


def test_the_rivals_cover_too_seldom_with_five_specimens() -> None:
    x, _ = simulated(5, 600, seed=92)
    wald = [wald_intervals(v).shape for v in x]
    bootstrap = [bootstrap_intervals(v, draws=300).shape for v in x]
    ratio = [likelihood_ratio_intervals(v).shape for v in x[:200]]
    for bounds, usual in ((wald, 0.85), (bootstrap, 0.72), (ratio, 0.89)):
        low, high = np.array(bounds).T
        assert np.mean((low < 8) & (high > 8)) == pytest.approx(usual, abs=0.06)


def test_impossible_levels_are_out_of_range() -> None:
    with pytest.raises(OutOfRange, match="a level must lie between 0 and 1, not 95"):
        wald_intervals(CABLE_I, level=95)
    with pytest.raises(OutOfRange, match="a probability must lie between 0 and 1, not 0"):
        likelihood_ratio_intervals(CABLE_I, probabilities=(0.0,))
