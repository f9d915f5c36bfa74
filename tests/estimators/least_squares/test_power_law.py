from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.polynomial import polynomial
from scipy import stats

from deamat.core.errors import FitRefused, OutOfRange
from deamat.estimators.least_squares import power_law
from deamat.estimators.least_squares.linear import fit_linear
from deamat.estimators.least_squares.power_law import ErrorModel, fit_power_law

# Sylgard 186 (10:1), Sikulskyi et al. 2022, Table 2, the printed exponent read as n: n - 1 here.
FACTOR = np.array([34.95, 35.31, -15.99, 2.372])
EXPONENT = np.array([0.3125 - 1, -0.01294, 0.002466])
TIME = np.repeat(np.linspace(1, 12, 12), 4)
RATE = np.tile([0.05, 0.1, 0.27, 0.6], 12)


def law(time: Any, rate: Any) -> Any:
    return polynomial.polyval(time, FACTOR) * rate ** polynomial.polyval(time, EXPONENT)


@pytest.mark.parametrize("errors", ["of reading", "of full scale"])
def test_exact_data_give_the_law_back(errors: ErrorModel) -> None:
    fit = fit_power_law(TIME, RATE, law(TIME, RATE), 3, 2, errors)
    np.testing.assert_allclose(fit.factor, FACTOR, rtol=1e-9)
    np.testing.assert_allclose(fit.exponent, EXPONENT, rtol=1e-9)
    assert fit(6.5, 0.3)[0] == pytest.approx(law(6.5, 0.3), rel=1e-11)


def test_a_constant_law_with_errors_of_reading_is_the_straight_line_of_logarithms() -> None:
    rng = np.random.default_rng(31)
    y = 5 * RATE**-0.6 * np.exp(0.03 * rng.normal(size=len(RATE)))
    fit = fit_power_law(TIME, RATE, y, 0, 0, "of reading")
    line = fit_linear(np.stack([np.ones(len(RATE)), np.log(RATE)], axis=1), np.log(y))
    assert fit.factor[0] == pytest.approx(np.exp(line.parameters[0]), rel=1e-10)
    assert fit.exponent[0] == pytest.approx(line.parameters[1], rel=1e-10)
    assert fit.covariance[1, 1] == pytest.approx(line.covariance[1, 1], rel=1e-9)
    values = fit_power_law(TIME, RATE, y, 0, 0, "of full scale")
    assert abs(values.exponent[0] - fit.exponent[0]) > 1e-4  # the other estimator is another one


@pytest.mark.parametrize("errors", ["of reading", "of full scale"])
def test_intervals_cover_as_often_as_they_say(errors: ErrorModel) -> None:
    rng = np.random.default_rng(32)
    mean = law(TIME, RATE)
    t = stats.t.ppf(0.975, len(TIME) - 7)
    parameters, values = [], []
    for _ in range(60):
        noise = rng.normal(size=len(TIME))
        y = mean * np.exp(0.02 * noise) if errors == "of reading" else mean + 2.0 * noise
        fit = fit_power_law(TIME, RATE, y, 3, 2, errors)
        truth = np.concatenate([FACTOR, EXPONENT])
        found = np.concatenate([fit.factor, fit.exponent])
        parameters.append(np.abs(found - truth) <= t * np.sqrt(np.diag(fit.covariance)))
        value, uncertainty = fit(6.5, 0.3)
        values.append(abs(value - law(6.5, 0.3)) <= t * uncertainty)
    # 95 % of 60: +-2.8 % at one standard deviation.
    assert np.all(np.abs(np.mean(parameters, axis=0) - 0.95) < 0.085)
    assert abs(np.mean(values) - 0.95) < 0.085


@pytest.mark.parametrize("errors", ["of reading", "of full scale"])
def test_more_searches_find_nothing_lower(
    errors: ErrorModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(34)
    for noise in (0.01, 0.03, 0.1):
        for _ in range(8):
            y = law(TIME, RATE) * np.exp(noise * rng.normal(size=len(TIME)))
            monkeypatch.setattr(power_law, "_CONFIRMATIONS", 1)
            once = fit_power_law(TIME, RATE, y, 3, 2, errors)
            monkeypatch.setattr(power_law, "_CONFIRMATIONS", 4)
            often = fit_power_law(TIME, RATE, y, 3, 2, errors)
            assert once.fit.returned == 1
            assert often.fit.returned > 1
            assert often.fit.elsewhere == 0
            np.testing.assert_array_equal(once.factor, often.factor)


def test_units_scale_the_factor_and_leave_the_exponent() -> None:
    rng = np.random.default_rng(33)
    y = law(TIME, RATE) * np.exp(0.02 * rng.normal(size=len(TIME)))
    fit = fit_power_law(TIME, RATE, y, 3, 2, "of full scale")
    moved = fit_power_law(3600 * TIME, RATE, 1000 * y, 3, 2, "of full scale")
    np.testing.assert_allclose(moved.factor, 1000 * fit.factor / 3600.0 ** np.arange(4), rtol=1e-7)
    np.testing.assert_allclose(moved.exponent, fit.exponent / 3600.0 ** np.arange(3), rtol=1e-7)


def test_outside_the_fitted_times_and_rates_there_is_no_answer() -> None:
    fit = fit_power_law(TIME, RATE, law(TIME, RATE), 3, 2, "of reading")
    with pytest.raises(OutOfRange) as refusal:
        fit(6.5, 1.0)
    assert str(refusal.value) == (
        "the power law holds for times from 1 to 12 and rates from 0.05 to 0.6, not at 6.5 and 1"
    )
    with pytest.raises(OutOfRange):
        fit(13.0, 0.1)
    for time in (1.0, 12.0):
        for rate in (0.05, 0.6):
            assert fit(time, rate)[0] == pytest.approx(law(time, rate), rel=1e-9)


def refused(*arguments: Any) -> str:
    with pytest.raises(FitRefused) as refusal:
        fit_power_law(*arguments)
    return str(refusal.value)


def test_bad_input_is_refused_with_its_reason() -> None:
    y = law(TIME, RATE)
    assert refused(TIME, np.full(len(TIME), 0.27), y, 1, 0, "of reading") == (
        "a power law needs at least two rates, not 0.27 alone: the exponent is not determined"
    )
    assert refused(TIME, RATE, y - y.min(), 1, 0, "of reading") == (
        "a power law needs positive values, not y 0"
    )
    assert refused(TIME, -RATE, y, 1, 0, "of reading") == (
        "a power law needs positive values, not rate -0.05"
    )
    assert refused(TIME, RATE[:5], y, 1, 0, "of reading") == "rate holds 5 values for 48 points"
    # Two rates at the first hour and one later: a changing exponent is not determined.
    rate = np.where((TIME > 1) | (RATE < 0.2), 0.1, 0.27)
    assert refused(TIME, rate, y, 3, 1, "of reading") == (
        "the readings do not determine a factor of degree 3 and an exponent of degree 1 in time: "
        "lower a degree, or measure several rates at more times"
    )
