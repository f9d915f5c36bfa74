"""Promises of the mean over specimens: intervals that cover, shared errors that stay."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from deamat.core.errors import FitRefused
from deamat.estimators.mean import (
    apart_of_few,
    coverage_factor,
    mean_with_shared,
    outliers,
    positive_interval,
)


@pytest.mark.parametrize(
    ("dof", "quantile"),  # tables of Student's t, two-sided 95 %
    [(1, 12.7062047), (2, 4.30265273), (9, 2.26215716), (30, 2.04227246), (math.inf, 1.95996398)],
)
def test_coverage_factor_is_students(dof: float, quantile: float) -> None:
    assert coverage_factor(dof) == pytest.approx(quantile, rel=3e-6)


def test_without_a_shared_error_it_is_students_interval() -> None:
    mean = mean_with_shared([10.0, 11.0, 12.0, 15.0], u_own=9.0, u_shared=0.0)
    assert mean.value == 12.0
    assert mean.sd == pytest.approx(math.sqrt(14.0 / 3.0))
    assert mean.u_independent == pytest.approx(math.sqrt(14.0 / 12.0))
    assert mean.degrees_of_freedom == 3.0
    half = 3.182446305 * math.sqrt(14.0 / 12.0)
    assert mean.ci95 == pytest.approx((12.0 - half, 12.0 + half))


@pytest.mark.parametrize("n", [3, 5, 10])
@pytest.mark.parametrize("shared", [0.0, 0.3, 1.0, 3.0])
def test_interval_covers_with_and_without_a_shared_error(n: int, shared: float) -> None:
    rng = np.random.default_rng(100 * n + int(10 * shared))
    repeats = 4000
    u_shared = shared / math.sqrt(n)  # in units of the standard error of the mean
    values = rng.normal(50.0, 1.0, (repeats, n)) + rng.normal(0.0, u_shared, (repeats, 1))
    hits = 0
    for row in values.tolist():
        low, high = mean_with_shared(row, 0.0, u_shared).ci95
        hits += low < 50.0 < high
    assert 0.935 <= hits / repeats <= 0.975


def test_effective_degrees_of_freedom_are_those_of_welch_and_satterthwaite() -> None:
    # s^2 / n = 14 / 12 as above; with a shared part as large u_c^2 doubles, so nu = 3 x 2^2 = 12
    equal = mean_with_shared([10.0, 11.0, 12.0, 15.0], 0.0, math.sqrt(14.0 / 12.0))
    assert equal.degrees_of_freedom == pytest.approx(12.0)
    # and with one of three times the variance it is fourfold: nu = 3 x 4^2 = 48
    larger = mean_with_shared([10.0, 11.0, 12.0, 15.0], 0.0, math.sqrt(42.0 / 12.0))
    assert larger.degrees_of_freedom == pytest.approx(48.0)
    half = 2.010634758 * math.sqrt(56.0 / 12.0)  # Student's t, 48 degrees of freedom, 97.5 %
    assert larger.ci95 == pytest.approx((12.0 - half, 12.0 + half))


def test_shared_error_never_averages_away() -> None:
    rng = np.random.default_rng(1)
    mean = mean_with_shared(rng.normal(5.0, 1.0, 10_000).tolist(), 0.0, 0.2)
    assert mean.u_shared == 0.2
    assert (mean.ci95[1] - mean.ci95[0]) / 2.0 == pytest.approx(1.96 * 0.2, rel=0.01)


def test_order_does_not_show_in_the_last_digit() -> None:
    values = [0.1, 1e8, 0.3, -1e8, 7.7]
    results = {mean_with_shared(list(p), 0.0, 0.1) for p in itertools.permutations(values)}
    assert len(results) == 1


def test_one_value_keeps_its_own_uncertainty_and_no_scatter() -> None:
    mean = mean_with_shared([7.0], u_own=0.3, u_shared=0.4)
    assert mean.sd is None
    assert (mean.u_independent, mean.u_shared) == (0.3, 0.4)
    assert mean.ci95 == pytest.approx((7.0 - 1.959964 * 0.5, 7.0 + 1.959964 * 0.5), rel=1e-6)


def test_identical_values_leave_the_shared_error() -> None:
    mean = mean_with_shared([2.0, 2.0, 2.0], 0.0, 0.5)
    assert (mean.sd, mean.u_independent, mean.degrees_of_freedom) == (0.0, 0.0, math.inf)
    assert mean.ci95 == pytest.approx((2.0 - 0.979982, 2.0 + 0.979982), rel=1e-5)


def test_no_values_are_refused() -> None:
    with pytest.raises(FitRefused, match=r"^a mean needs at least one value$"):
        mean_with_shared([], 0.0, 0.0)


def test_outliers_are_named_from_five_values_on() -> None:
    assert outliers([10.0, 10.2, 9.9, 10.1, 20.0]) == (4,)
    assert outliers([10.0, 10.2, 9.9, 10.1, 10.3]) == ()
    assert outliers([10.0, 10.2, 9.9, 20.0]) == ()


def test_one_of_few_stands_apart_where_it_is_another_number_altogether() -> None:
    assert apart_of_few([10.0, 10.3, 41.0]) == (2,)
    assert apart_of_few([2.4, 10.0, 10.3, 9.9]) == (0,)
    assert apart_of_few([10.0, 10.01, 14.0]) == ()
    assert apart_of_few([10.0, 10.01, 17.4]) == ()
    assert apart_of_few([10.0, 10.01, 17.6]) == (2,)
    assert apart_of_few([10.0, 20.0, 40.0]) == ()
    assert apart_of_few([10.0, 41.0]) == ()
    rng = np.random.default_rng(5)
    samples = rng.normal(1.0, 0.15, (4000, 3))
    assert sum(bool(apart_of_few(sample.tolist())) for sample in samples) < 20


def test_outliers_agree_with_the_published_table() -> None:
    # Grubbs, two-sided 1 %: n = 5 gives 1.764 (ASTM E178, table 1, upper 0.5 %)
    base = np.array([-1.0, 0.5, 1.0, -0.5])
    grid = np.linspace(1.5, 60.0, 4000)
    first = next(x for x in grid if outliers([*base, float(x)]))
    sample = np.array([*base, first])
    assert (sample[-1] - sample.mean()) / sample.std(ddof=1) == pytest.approx(1.764, abs=1e-3)


def test_one_clean_sample_in_a_hundred_is_accused() -> None:
    rng = np.random.default_rng(5)
    accused = sum(bool(outliers(list(rng.normal(size=8)))) for _ in range(4000))
    assert 0.006 < accused / 4000 < 0.014


def test_intervals_of_positive_quantities_do_not_cross_zero() -> None:
    far = mean_with_shared([1.0, 1.02], 0.0, 0.0)
    assert positive_interval(far) == far.ci95
    near = mean_with_shared([0.8, 1.2], 0.0, 0.0)  # Student's t for two values is 12.7
    half = near.ci95[1] - 1.0
    assert near.ci95[0] < 0.0
    assert positive_interval(near) == pytest.approx((math.exp(-half), math.exp(half)))
    lost = mean_with_shared([0.1, 0.9], 0.0, 0.0)
    assert positive_interval(lost) == (0.0, lost.ci95[1])
    assert positive_interval(mean_with_shared([-1.0, -2.0], 0.0, 0.0))[0] < 0.0
