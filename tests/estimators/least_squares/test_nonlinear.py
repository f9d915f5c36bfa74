from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import stats

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.least_squares.linear import fit_linear
from deamat.estimators.least_squares.nonlinear import fit_nonlinear

X = np.array([0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 10.0, 14.0])
TRUTH = np.array([3.0, 0.4])


def growth(b: FloatArray) -> FloatArray:
    return np.asarray(b[0] * -np.expm1(-b[1] * X))


def growth_jacobian(b: FloatArray) -> FloatArray:
    return np.stack([-np.expm1(-b[1] * X), b[0] * X * np.exp(-b[1] * X)], axis=1)


def sample(noise: float, seed: int) -> FloatArray:
    return growth(TRUTH) + noise * np.random.default_rng(seed).normal(size=len(X))


Y = sample(0.05, 1)
SIGMA = np.linspace(0.5, 1.2, len(X))


def test_a_linear_model_gives_the_linear_answer() -> None:
    design = np.stack([np.ones(len(X)), X, np.sqrt(X)], axis=1)
    fit = fit_nonlinear(lambda b: design @ b, lambda _: design, [1.0, 1.0, 1.0], Y, SIGMA)
    linear = fit_linear(design, Y, SIGMA)
    np.testing.assert_allclose(fit.parameters, linear.parameters, rtol=1e-11)
    np.testing.assert_allclose(fit.covariance, linear.covariance, rtol=1e-10)
    np.testing.assert_allclose(fit.leverages, linear.leverages, rtol=1e-10)
    assert fit.residual_sd == pytest.approx(linear.residual_sd, rel=1e-12)
    assert fit.condition_number == pytest.approx(linear.condition_number, rel=1e-9)
    assert fit.curvature == pytest.approx(1, abs=1e-5)
    assert fit.elsewhere == 0


def test_every_start_gives_the_same_answer() -> None:
    fit = fit_nonlinear(growth, growth_jacobian, [1.0, 1.0], Y)
    for start in ([30.0, 0.01], [0.1, 5.0], [2.0, 0.001]):
        other = fit_nonlinear(growth, growth_jacobian, start, Y)
        np.testing.assert_allclose(other.parameters, fit.parameters, rtol=1e-12)
        np.testing.assert_allclose(other.covariance, fit.covariance, rtol=1e-10)
    assert fit.gradient < 1e-12
    assert fit.returned == 4


def test_half_the_sigma_weighs_like_four_measurements() -> None:
    repeated = np.repeat(np.arange(8), np.where(np.arange(8) == 3, 4, 1))
    sigma = np.where(np.arange(8) == 3, 0.05, 0.1)
    once = fit_nonlinear(growth, growth_jacobian, [1.0, 1.0], Y, sigma, "known")
    often = fit_nonlinear(
        lambda b: growth(b)[repeated],
        lambda b: growth_jacobian(b)[repeated],
        [1.0, 1.0],
        Y[repeated],
        np.full(len(repeated), 0.1),
        "known",
    )
    np.testing.assert_allclose(once.parameters, often.parameters, rtol=1e-12)
    np.testing.assert_allclose(once.covariance, often.covariance, rtol=1e-11)


@pytest.mark.parametrize("unit", [1e-9, 1e6])
def test_units_scale_parameters_and_standard_errors(unit: float) -> None:
    fit = fit_nonlinear(growth, growth_jacobian, [1.0, 1.0], Y)
    moved = fit_nonlinear(
        lambda b: unit * growth(b / [unit, 1]) / unit * unit,
        lambda b: unit * growth_jacobian(b / [unit, 1]) / [unit, 1],
        [unit, 1.0],
        unit * Y,
    )
    np.testing.assert_allclose(moved.parameters, fit.parameters * [unit, 1], rtol=1e-11)
    np.testing.assert_allclose(moved.standard_errors, fit.standard_errors * [unit, 1], rtol=1e-10)


def test_intervals_cover_as_often_as_they_say() -> None:
    t = stats.t.ppf(0.975, len(X) - 2)
    covered = []
    for seed in range(120):
        fit = fit_nonlinear(growth, growth_jacobian, [1.0, 1.0], sample(0.05, seed))
        covered.append(np.abs(fit.parameters - TRUTH) <= t * fit.standard_errors)
    # 95 % of 120: +-2 % at one standard deviation.
    assert np.all(np.abs(np.mean(covered, axis=0) - 0.95) < 0.05)


def test_data_without_noise_give_the_truth() -> None:
    fit = fit_nonlinear(growth, growth_jacobian, [1.0, 1.0], growth(TRUTH))
    np.testing.assert_allclose(fit.parameters, TRUTH, rtol=1e-13)
    assert np.all(fit.standard_errors < 1e-14)


def test_the_gradient_is_told_as_part_of_the_residuals_and_is_zero_without_any() -> None:
    assert 0.0 < fit_nonlinear(growth, growth_jacobian, [1.0, 1.0], Y).gradient < 1e-12
    line = X[:, None]
    assert fit_nonlinear(lambda b: b[0] * X, lambda _: line, [1.0], 2.0 * X).gradient == 0.0


def test_bounds_that_do_not_bind_change_nothing() -> None:
    free = fit_nonlinear(growth, growth_jacobian, [1.0, 1.0], Y)
    bounded = fit_nonlinear(
        growth, growth_jacobian, [1.0, 1.0], Y, lower=[0.0, 0.0], upper=[10.0, np.inf]
    )
    np.testing.assert_allclose(bounded.parameters, free.parameters, rtol=1e-12)
    np.testing.assert_allclose(bounded.covariance, free.covariance, rtol=1e-10)


def wave(b: FloatArray) -> FloatArray:
    return np.asarray(np.sin(b[0] * X))


def wave_jacobian(b: FloatArray) -> FloatArray:
    return np.asarray((X * np.cos(b[0] * X))[:, None])


WAVE = wave(np.array([1.0])) + 1e-3 * SIGMA


def test_a_lower_minimum_nearby_takes_the_place_of_the_first() -> None:
    # A search from 1.5 alone ends at 3.2 with residuals of 0.7.
    fit = fit_nonlinear(wave, wave_jacobian, [1.5], WAVE)
    assert fit.parameters[0] == pytest.approx(1.0, abs=1e-3)
    assert fit.elsewhere > 0  # and says that there are others


def test_one_confirmation_is_enough_only_where_nothing_ends_elsewhere() -> None:
    once = fit_nonlinear(growth, growth_jacobian, [1.0, 1.0], Y, confirmations=1)
    assert (once.returned, once.elsewhere) == (1, 0)
    several = fit_nonlinear(wave, wave_jacobian, [1.5], WAVE, confirmations=1)
    assert several.parameters[0] == pytest.approx(1.0, abs=1e-3)


def test_a_second_start_of_the_caller_finds_what_the_first_misses() -> None:
    alone = fit_nonlinear(wave, wave_jacobian, [0.3], WAVE)
    assert alone.residual_sd > 0.1
    helped = fit_nonlinear(wave, wave_jacobian, [0.3], WAVE, second_start=[1.02])
    assert helped.parameters[0] == pytest.approx(1.0, abs=1e-3)


def refused(model: Any, jacobian: Any, *arguments: Any, **options: Any) -> str:
    with pytest.raises(FitRefused) as refusal:
        fit_nonlinear(model, jacobian, *arguments, **options)
    return str(refusal.value)


def test_a_wrong_jacobian_is_refused() -> None:
    told = refused(growth, lambda b: growth_jacobian(b) * [1, 1.5], [1.0, 1.0], Y)
    assert told.startswith("the Jacobian is not the derivative of the model at (")
    assert told.endswith(" %, at most 1 % is accepted")


def test_parameters_that_the_data_do_not_tell_apart_are_refused() -> None:
    def twice(b: FloatArray) -> FloatArray:
        return growth(np.array([b[0] * b[2], b[1]]))

    def twice_jacobian(b: FloatArray) -> FloatArray:
        first = growth_jacobian(np.array([b[0] * b[2], b[1]]))
        return np.stack([first[:, 0] * b[2], first[:, 1], first[:, 0] * b[0]], axis=1)

    told = refused(twice, twice_jacobian, [1.0, 1.0, 1.0], Y)
    assert told.startswith("the Jacobian is rank-deficient at (")
    assert told.endswith("at most 1e+10 is accepted; the data do not determine all parameters")


def test_a_parameter_without_effect_is_refused() -> None:
    told = refused(
        lambda b: growth(b[:2]),
        lambda b: np.concatenate([growth_jacobian(b[:2]), np.zeros((len(X), 1))], axis=1),
        [3.0, 0.4, 7.0],
        Y,
    )
    assert told.startswith("the model does not depend on parameter 2 at (")


def test_a_maximum_is_refused() -> None:
    # Points on a circle, seen from outside: the far side has no gradient either.
    told = refused(
        lambda b: np.array([np.cos(b[0]), np.sin(b[0])]),
        lambda b: np.array([[-np.sin(b[0])], [np.cos(b[0])]]),
        [0.0],
        [-2.0, 0.0],
    )
    assert told == "the point (0) is no minimum: curvature -2 in one direction"


def test_a_minimum_on_a_bound_is_refused() -> None:
    told = refused(growth, growth_jacobian, [1.0, 1.0], Y, upper=[2.0, np.inf])
    assert told == (
        "parameter 0 ended on its bound 2, where no standard error holds; widen the bound or take "
        "a model without this parameter"
    )


def test_a_minimum_at_infinity_is_refused() -> None:
    line = X.copy()  # the growth that never ends is a straight line
    with pytest.raises(FitRefused):
        fit_nonlinear(growth, growth_jacobian, [1.0, 1.0], line)


def test_bad_input_is_refused_with_its_reason() -> None:
    assert refused(growth, growth_jacobian, [1.0, 1.0], Y, lower=[2.0, 0.0]) == (
        "the start (1, 1) does not lie inside the bounds"
    )
    assert refused(growth, growth_jacobian, [1.0, 1.0], Y, lower=[np.nan, 0.0]) == (
        "a bound must be a number or infinite, not nan"
    )
    assert refused(growth, growth_jacobian, [1.0, 1.0], Y, lower=[0.0]) == (
        "a bound holds 1 values for 2 parameters"
    )
    assert refused(growth, growth_jacobian, [1.0, 1.0], Y, second_start=[1.0]) == (
        "second_start holds 1 values for 2 parameters"
    )
    assert refused(growth, growth_jacobian, [1.0, -1e4], Y) == (
        "the model is not finite at the start (1, -10000)"
    )
    assert (
        refused(growth, growth_jacobian, [1.0, np.nan], Y) == "start must be finite, not nan at 1"
    )
    assert refused(lambda b: growth(b)[:3], growth_jacobian, [1.0, 1.0], Y) == (
        "the model gives shape (3,) for 8 points"
    )
    assert refused(growth, lambda b: growth_jacobian(b).T, [1.0, 1.0], Y) == (
        "the Jacobian has shape (2, 8), not (8, 2)"
    )
    assert refused(growth, lambda b: growth_jacobian(b) * np.nan, [1.0, 1.0], Y) == (
        "the Jacobian is not finite at (1, 1)"
    )
    assert refused(growth, growth_jacobian, [1.0, 1.0], Y[:2]) == (
        "2 parameters need at least 3 points, not 2 (one more than parameters, to estimate the "
        "error)"
    )
