from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from deamat.core.errors import FitRefused, OutOfRange
from deamat.estimators.least_squares.linear import fit_linear
from deamat.estimators.least_squares.polynomial import fit_polynomial

HOURS = np.linspace(1, 12, 12)
# Sylgard 184 (10:1), Sikulskyi et al. 2022, Table 2: viscosity in Pa.s over hours since mixing.
QUARTIC = np.array([2.5, 0.493, 0.207, -0.0674, 0.00743])


def curve(x: np.ndarray) -> np.ndarray:
    return np.asarray(np.polynomial.polynomial.polyval(x, QUARTIC))


@given(st.integers(0, 8), st.floats(-1e3, 1e3), st.floats(1e-3, 1e3), st.integers(0, 2**32 - 1))
def test_exact_polynomials_come_back(degree: int, centre: float, width: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    x = centre + width * np.sort(rng.uniform(-1, 1, size=degree + 6))
    y = np.polynomial.polynomial.polyval((x - centre) / width, rng.normal(size=degree + 1))
    fit = fit_polynomial(x, y, degree)
    np.testing.assert_allclose(fit(x)[0], y, atol=1e-9)


def test_values_and_slopes_agree_with_the_raw_coefficients() -> None:
    rng = np.random.default_rng(4)
    fit = fit_polynomial(HOURS, curve(HOURS) + 0.1 * rng.normal(size=12), 4)
    x = np.linspace(1, 12, 31)
    value, uncertainty = fit(x)
    powers = np.vander(x, 5, increasing=True)
    np.testing.assert_allclose(value, powers @ fit.coefficients, rtol=1e-12)
    variance = np.einsum("ij,jk,ik->i", powers, fit.covariance, powers)
    np.testing.assert_allclose(uncertainty, np.sqrt(variance), rtol=1e-9)
    slope = np.polynomial.polynomial.polyval(x, np.polynomial.polynomial.polyder(fit.coefficients))
    np.testing.assert_allclose(fit.derivative(x), slope, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(fit(HOURS)[0] + fit.residuals, fit.y, rtol=1e-14)


def test_answers_keep_the_shape_of_the_question() -> None:
    fit = fit_polynomial(HOURS, curve(HOURS), 2)
    assert fit(3.0)[0].shape == ()
    assert fit(np.ones((2, 3)))[1].shape == (2, 3)
    assert fit.derivative(3.0).shape == ()


def test_weights_are_those_of_the_linear_fit() -> None:
    rng = np.random.default_rng(5)
    y, sigma = curve(HOURS) * (1 + 0.02 * rng.normal(size=12)), 0.02 * curve(HOURS)
    fit = fit_polynomial(HOURS, y, 3, sigma, "known")
    linear = fit_linear(np.vander(HOURS, 4, increasing=True), y, sigma, "known")
    np.testing.assert_allclose(fit.coefficients, linear.parameters, rtol=1e-12)
    np.testing.assert_allclose(fit.standard_errors, linear.standard_errors, rtol=1e-12)
    np.testing.assert_allclose(fit.leverages, linear.leverages, rtol=1e-10)


def test_order_units_and_origin_of_x_change_nothing_but_themselves() -> None:
    rng = np.random.default_rng(6)
    y = curve(HOURS) + 0.1 * rng.normal(size=12)
    fit = fit_polynomial(HOURS, y, 4)
    back = fit_polynomial(HOURS[::-1], y[::-1], 4)
    np.testing.assert_allclose(back.coefficients, fit.coefficients, rtol=1e-15)
    seconds = fit_polynomial(HOURS * 3600, 1000 * y, 4)
    factors = 1000 / 3600.0 ** np.arange(5)
    np.testing.assert_allclose(seconds.coefficients, factors * fit.coefficients, rtol=1e-12)
    np.testing.assert_allclose(seconds.standard_errors, factors * fit.standard_errors, rtol=1e-12)
    later = fit_polynomial(HOURS + 1000, y, 4)
    np.testing.assert_allclose(later(HOURS + 1000)[0], fit(HOURS)[0], rtol=1e-13)
    np.testing.assert_allclose(later(HOURS + 1000)[1], fit(HOURS)[1], rtol=1e-12)


def test_intervals_of_coefficients_and_of_the_curve_cover_as_often_as_they_say() -> None:
    rng = np.random.default_rng(7)
    t = stats.t.ppf(0.975, 7)
    x = np.array([1.0, 4.7, 12.0])
    coefficients, values = [], []
    for _ in range(600):
        fit = fit_polynomial(HOURS, curve(HOURS) + 0.2 * rng.normal(size=12), 4)
        coefficients.append(np.abs(fit.coefficients - QUARTIC) <= t * fit.standard_errors)
        value, uncertainty = fit(x)
        values.append(np.abs(value - curve(x)) <= t * uncertainty)
    # 95 % of 600: +-0.9 % at one standard deviation.
    assert np.all(np.abs(np.mean(coefficients, axis=0) - 0.95) < 0.03)
    assert np.all(np.abs(np.mean(values, axis=0) - 0.95) < 0.03)


def test_a_constant_needs_no_window() -> None:
    fit = fit_polynomial([3.0, 3.0], [1.0, 2.0], 0)
    assert fit.coefficients == pytest.approx([1.5])
    assert float(fit(3.0)[1]) == pytest.approx(0.5)


def test_outside_the_window_there_is_no_answer() -> None:
    fit = fit_polynomial(HOURS, curve(HOURS), 2)
    with pytest.raises(OutOfRange) as refusal:
        fit([3.0, 12.5])
    assert str(refusal.value) == "the polynomial holds from 1 to 12, not 12.5"
    with pytest.raises(OutOfRange):
        fit.derivative(np.nan)


def test_bad_input_is_refused_with_its_reason() -> None:
    with pytest.raises(FitRefused) as refusal:
        fit_polynomial([1.0, 2, 2, 2], [1.0, 2, 3, 4], 2)
    assert str(refusal.value) == "degree 2 needs at least 3 distinct x, not 2"
    with pytest.raises(FitRefused) as refusal:
        fit_polynomial(HOURS, HOURS, -1)
    assert str(refusal.value) == "the degree of a polynomial is 0 or more, not -1"
    with pytest.raises(FitRefused) as refusal:
        fit_polynomial(HOURS, HOURS[:3], 1)
    assert str(refusal.value) == "y holds 3 values for 12 points"
    # Two clusters of points cannot tell a cubic.
    cluster = np.array([1.0, 1 + 1e-9, 1 + 2e-9, 2, 2 + 1e-9, 2 + 2e-9])
    with pytest.raises(FitRefused, match="the columns of the design depend on each other"):
        fit_polynomial(cluster, cluster, 4)
