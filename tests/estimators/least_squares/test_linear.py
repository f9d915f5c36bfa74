from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import stats

from deamat.core.errors import FitRefused
from deamat.estimators.least_squares.linear import fit_linear

X = np.stack([np.ones(8), [1.0, 2, 3, 4, 5, 6, 7, 9], [2.0, 1, 5, 3, 8, 2, 7, 4]], axis=1)
Y = np.array([3.0, 4.1, 7.9, 7.2, 12.6, 9.4, 14.2, 14.1])
SIGMA = np.array([0.1, 0.2, 0.1, 0.3, 0.2, 0.1, 0.2, 0.4])


def test_parameters_satisfy_the_normal_equations_and_bring_their_covariance() -> None:
    fit = fit_linear(X, Y)
    np.testing.assert_allclose(X.T @ fit.residuals, 0, atol=1e-13)
    np.testing.assert_allclose(
        fit.covariance, fit.residual_sd**2 * np.linalg.inv(X.T @ X), rtol=1e-12
    )
    assert fit.dof == 5
    assert fit.parameter_count == 3
    assert fit.leverages.sum() == pytest.approx(3, rel=1e-13)


def test_a_known_error_scale_takes_the_covariance_from_sigma_alone() -> None:
    fit = fit_linear(X, Y, SIGMA, "known")
    weighted = X / SIGMA[:, None]
    np.testing.assert_allclose(fit.covariance, np.linalg.inv(weighted.T @ weighted), rtol=1e-12)
    scaled = fit_linear(X, Y, SIGMA, "estimated")
    np.testing.assert_allclose(scaled.covariance, fit.covariance * fit.residual_sd**2, rtol=1e-14)


def test_half_the_sigma_weighs_like_four_measurements() -> None:
    repeated = np.repeat(np.arange(8), np.where(np.arange(8) == 3, 4, 1))
    sigma = np.where(np.arange(8) == 3, 0.5, 1.0)
    once = fit_linear(X, Y, sigma, "known")
    often = fit_linear(X[repeated], Y[repeated], np.ones(len(repeated)), "known")
    np.testing.assert_allclose(once.parameters, often.parameters, rtol=1e-14)
    np.testing.assert_allclose(once.covariance, often.covariance, rtol=1e-14)


def test_the_order_of_points_and_of_terms_does_not_matter() -> None:
    fit = fit_linear(X, Y, SIGMA)
    rows, terms = np.array([3, 0, 7, 1, 6, 2, 5, 4]), np.array([2, 0, 1])
    other = fit_linear(X[rows][:, terms], Y[rows], SIGMA[rows])
    np.testing.assert_allclose(other.parameters, fit.parameters[terms], rtol=1e-15)
    np.testing.assert_allclose(other.covariance, fit.covariance[terms][:, terms], rtol=1e-14)


@pytest.mark.parametrize("unit", [1e-12, 0.0254, 1e9])
def test_units_scale_parameters_and_standard_errors(unit: float) -> None:
    fit, moved = fit_linear(X, Y), fit_linear(X * [1, unit, 1], 7 * Y)
    factors = 7 / np.array([1, unit, 1])
    np.testing.assert_allclose(moved.parameters, factors * fit.parameters, rtol=1e-13)
    np.testing.assert_allclose(moved.standard_errors, factors * fit.standard_errors, rtol=1e-13)
    assert moved.condition_number == pytest.approx(fit.condition_number, rel=1e-9)


def test_a_model_without_intercept_has_no_hidden_one() -> None:
    x = np.array([1.0, 2.0, 3.0])
    fit = fit_linear(x[:, None], [3.0, 5.0, 7.0])
    assert fit.parameters[0] == pytest.approx((x @ [3, 5, 7]) / (x @ x), rel=1e-15)
    assert fit.dof == 2


def test_as_many_points_as_parameters_need_a_known_error_scale() -> None:
    fit = fit_linear(X[:3], Y[:3], SIGMA[:3], "known")
    np.testing.assert_allclose(fit.residuals, 0, atol=1e-15)
    assert np.isnan(fit.residual_sd)
    with pytest.raises(FitRefused) as refusal:
        fit_linear(X[:3], Y[:3], SIGMA[:3])
    assert str(refusal.value) == (
        "3 parameters need at least 4 points, not 3 (one more than parameters, to estimate the "
        "error)"
    )


def test_intervals_cover_as_often_as_they_say() -> None:
    rng = np.random.default_rng(11)
    truth = np.array([1.5, -0.3, 0.8])
    t, z = stats.t.ppf(0.975, 5), stats.norm.ppf(0.975)
    estimated, known = [], []
    for _ in range(1000):
        y = X @ truth + SIGMA * rng.normal(size=8)
        fit = fit_linear(X, y, SIGMA)
        estimated.append(np.abs(fit.parameters - truth) <= t * fit.standard_errors)
        factor = z / fit.residual_sd  # the same cofactors with the scale that is known
        known.append(np.abs(fit.parameters - truth) <= factor * fit.standard_errors)
    # 95 % of 1000: +-0.7 % at one standard deviation.
    assert np.all(np.abs(np.mean(estimated, axis=0) - 0.95) < 0.025)
    assert np.all(np.abs(np.mean(known, axis=0) - 0.95) < 0.025)


def refused(*arguments: Any) -> str:
    with pytest.raises(FitRefused) as refusal:
        fit_linear(*arguments)
    return str(refusal.value)


def test_columns_that_depend_on_each_other_are_refused() -> None:
    told = refused(np.stack([X[:, 0], X[:, 1], X[:, 0] + X[:, 1]], axis=1), Y)
    assert told.startswith("the columns of the design depend on each other: condition number ")
    assert told.endswith(", at most 1e+12 is accepted; leave a parameter out or spread the data")


@pytest.mark.parametrize("angle", [1e-3, 1e-9, 3e-11])
def test_nearly_dependent_columns_are_solved_up_to_the_stated_limit(angle: float) -> None:
    # Powers of two keep the sum exact, so that the truth is known to the last digit.
    tilt = 2.0 ** round(np.log2(angle))
    direction = np.array([1.0, -1, 0, 2, -2, 1, -1, 0])
    design = np.stack([X[:, 1], X[:, 1] + tilt * direction], axis=1)
    fit = fit_linear(design, design @ [3.0, -1.0])
    assert 1 / angle < fit.condition_number < 1e12
    np.testing.assert_allclose(fit.parameters, [3.0, -1.0], rtol=1e-15 * fit.condition_number)


def test_bad_input_is_refused_with_its_reason() -> None:
    assert refused(X * [1, 0, 1], Y) == (
        "column 1 of the design is zero: its parameter is not determined"
    )
    assert refused(X, Y[:5]) == "y holds 5 values for 8 points"
    assert refused(X, np.where(Y > 14.15, np.nan, Y)) == "y must be finite, not nan at 6"
    assert refused(np.where(X == 9, np.inf, X), Y) == ("the design must be finite, not inf at 7, 1")
    assert refused(X, Y, np.where(SIGMA == 0.3, 0, SIGMA)) == (
        "sigma must be positive, not 0.0 at 3"
    )
    assert refused(X, Y, None, "known") == (
        "a known error scale needs sigma, the standard deviations"
    )
    assert refused(X[:2], Y[:2], SIGMA[:2], "known") == (
        "3 parameters need at least 3 points, not 2"
    )
    assert refused(Y, Y) == (
        "the design must have 2 dimensions and hold values, not the shape (8,)"
    )
