"""Units, order, copies, shifts: each changes the answer of a default estimator as mathematics says.

The Weibull estimators have theirs in `test_weibull` and `test_weibull_intervals`.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.estimators.curves.slope import fit_line
from deamat.estimators.least_squares.linear import fit_linear
from deamat.estimators.least_squares.monotone import fit_non_decreasing
from deamat.estimators.least_squares.nonlinear import NonlinearFit, fit_nonlinear
from deamat.estimators.least_squares.polynomial import PolynomialFit, fit_polynomial
from deamat.estimators.least_squares.power_law import ErrorModel, fit_power_law
from deamat.estimators.mean import mean_with_shared, outliers
from deamat.estimators.selection import choose
from deamat.estimators.weibull.goodness import goodness_of_fit, low_outlier

UNITS = st.floats(1e-6, 1e6)
SEEDS = st.integers(0, 2**20)
few = settings(deadline=None, derandomize=True, max_examples=20)
fewest = settings(deadline=None, derandomize=True, max_examples=4)


def series(seed: int, n: int = 23) -> tuple[np.random.Generator, FloatArray, FloatArray]:
    rng = np.random.default_rng(seed)
    x = np.sort(rng.uniform(1.0, 12.0, n))
    return rng, x, 2.0 + 0.5 * x + 0.05 * x**2 + 0.1 * rng.standard_normal(n)


@few
@given(seed=SEEDS, unit=UNITS, factor=UNITS, shift=st.floats(-100.0, 100.0))
def test_a_slope_takes_its_units_and_ignores_shifts(
    seed: int, unit: float, factor: float, shift: float
) -> None:
    _, x, y = series(seed)
    line, moved = fit_line(x, y), fit_line(unit * (x + shift), factor * (y - shift))
    assert moved.slope * unit / factor == pytest.approx(line.slope, rel=1e-9)
    assert moved.standard_error * unit / factor == pytest.approx(line.standard_error, rel=1e-6)
    assert moved.degrees_of_freedom == pytest.approx(line.degrees_of_freedom, rel=1e-6)


@few
@given(seed=SEEDS)
def test_a_slope_read_backwards_is_the_same(seed: int) -> None:
    _, x, y = series(seed)
    line, back = fit_line(x, y), fit_line(x[::-1].copy(), y[::-1].copy())
    assert back.slope == pytest.approx(line.slope, rel=1e-12)
    assert back.standard_error == pytest.approx(line.standard_error, rel=1e-9)


@few
@given(seed=SEEDS)
def test_readings_that_are_copies_add_no_independent_samples(seed: int) -> None:
    _, x, y = series(seed, 60)
    line = fit_line(x, y)
    twice = fit_line(np.repeat(x, 2), np.repeat(y, 2))
    assert twice.slope == pytest.approx(line.slope, rel=1e-12)
    assert twice.naive_standard_error < 0.75 * line.naive_standard_error  # as if 60 more were there
    assert twice.standard_error > 0.8 * line.standard_error


@few
@given(seed=SEEDS, unit=UNITS, shift=st.floats(-10.0, 10.0), shared=st.floats(0.0, 1.0))
def test_a_mean_takes_units_and_shifts_and_no_order(
    seed: int, unit: float, shift: float, shared: float
) -> None:
    rng = np.random.default_rng(seed)
    values = rng.normal(10.0, 1.0, 6)
    plain = mean_with_shared(values.tolist(), 0.5, shared)
    order = rng.permutation(6)
    moved = mean_with_shared((unit * (values[order] + shift)).tolist(), unit * 0.5, unit * shared)
    assert moved.value == pytest.approx(unit * (plain.value + shift), rel=1e-9, abs=unit * 1e-12)
    assert moved.u_independent == pytest.approx(unit * plain.u_independent, rel=1e-9)
    assert moved.degrees_of_freedom == pytest.approx(plain.degrees_of_freedom, rel=1e-8)
    assert np.diff(moved.ci95) == pytest.approx(unit * np.diff(plain.ci95), rel=1e-8)
    assert [order[i] for i in outliers(moved_values(values, order, unit, shift))] == list(
        outliers(values.tolist())
    )


def moved_values(
    values: FloatArray, order: NDArray[np.intp], unit: float, shift: float
) -> list[float]:
    return [float(v) for v in unit * (values[order] + shift)]


def test_a_mean_of_copies_has_the_scatter_of_more_specimens() -> None:
    values = [9.0, 10.0, 11.5]
    once, twice = (mean_with_shared(values * k, 0.0, 0.3) for k in (1, 2))
    assert twice.value == once.value
    assert twice.u_independent == pytest.approx(once.u_independent * math.sqrt(2 / 5), rel=1e-12)
    assert twice.u_shared == once.u_shared


@few
@given(seed=SEEDS, unit=UNITS)
def test_linear_parameters_follow_units_order_and_copies(seed: int, unit: float) -> None:
    rng, x, y = series(seed)
    design = np.column_stack((np.ones_like(x), x))
    fit = fit_linear(design, y)
    order = rng.permutation(len(x))
    moved = fit_linear(design[order] * (1.0, unit), y[order])
    assert moved.parameters[1] * unit == pytest.approx(fit.parameters[1], rel=1e-9)
    assert moved.standard_errors[1] * unit == pytest.approx(fit.standard_errors[1], rel=1e-9)
    copied = fit_linear(np.repeat(design, 2, axis=0), np.repeat(y, 2))
    np.testing.assert_allclose(copied.parameters, fit.parameters, rtol=1e-9)
    # half the cofactors, and twice the squares over more degrees of freedom
    np.testing.assert_allclose(copied.covariance, fit.covariance * fit.dof / copied.dof, rtol=1e-9)


@few
@given(seed=SEEDS, unit=UNITS, time=UNITS, shift=st.floats(-50.0, 50.0))
def test_a_polynomial_predicts_the_same_in_any_unit_origin_and_order(
    seed: int, unit: float, time: float, shift: float
) -> None:
    rng, x, y = series(seed)
    order = rng.permutation(len(x))
    plain, moved = (
        fit_polynomial(x, y, 3),
        fit_polynomial(time * (x + shift)[order], unit * y[order], 3),
    )
    at = np.linspace(x[1], x[-2], 5)
    value, u = plain(at)
    value_moved, u_moved = moved(time * (at + shift))
    np.testing.assert_allclose(value_moved, unit * value, rtol=1e-8)
    np.testing.assert_allclose(u_moved, unit * u, rtol=1e-7)
    copied = fit_polynomial(np.repeat(x, 2), np.repeat(y, 2), 3)
    np.testing.assert_allclose(copied(at)[0], value, rtol=1e-10)
    np.testing.assert_allclose(copied(at)[1], u * math.sqrt(plain.dof / copied.dof), rtol=1e-9)


@few
@given(seed=SEEDS, unit=UNITS)
def test_a_non_decreasing_polynomial_follows_units_and_no_order(seed: int, unit: float) -> None:
    rng, x, y = series(seed)
    y = y + 3.0 * rng.standard_normal(len(x))
    order = rng.permutation(len(x))
    plain = fit_non_decreasing(x, y, 4, -100.0)
    moved = fit_non_decreasing(x[order], unit * y[order], 4, -100.0 * unit)
    assert moved.active == plain.active
    at = np.linspace(x[0], x[-1], 7)
    size = float(np.abs(plain.fit(at)[0]).max())
    np.testing.assert_allclose(moved.fit(at)[0] / unit, plain.fit(at)[0], atol=1e-6 * size)


def decay(t: FloatArray, y: FloatArray, start: FloatArray) -> NonlinearFit:
    def jacobian(b: FloatArray) -> FloatArray:
        e = np.exp(-b[1] * t)
        return np.stack([e, -b[0] * t * e, np.ones(len(t))], axis=1)

    return fit_nonlinear(lambda b: b[0] * np.exp(-b[1] * t) + b[2], jacobian, start, y)


@fewest
@given(seed=SEEDS, unit=UNITS, time=UNITS)
def test_a_decay_follows_units_order_and_copies(seed: int, unit: float, time: float) -> None:
    rng = np.random.default_rng(seed)
    t = np.linspace(0.0, 8.0, 20)
    y = 5.0 * np.exp(-0.7 * t) + 2.0 + 0.05 * rng.standard_normal(20)
    start, units = np.array([4.0, 1.0, 1.5]), np.array([unit, 1.0 / time, unit])
    plain = decay(t, y, start)
    order = rng.permutation(20)
    moved = decay(time * t[order], unit * y[order], units * start)
    np.testing.assert_allclose(moved.parameters, units * plain.parameters, rtol=1e-7)
    np.testing.assert_allclose(moved.standard_errors, units * plain.standard_errors, rtol=1e-6)
    copied = decay(np.repeat(t, 2), np.repeat(y, 2), start)
    np.testing.assert_allclose(copied.parameters, plain.parameters, rtol=1e-7)


@pytest.mark.parametrize("errors", ["of reading", "of full scale"])
@fewest
@given(seed=SEEDS, time=st.floats(1e-3, 1e4), unit=st.floats(1e-3, 1e3))
def test_a_power_law_follows_units_order_and_copies(
    errors: ErrorModel, seed: int, time: float, unit: float
) -> None:
    rng = np.random.default_rng(seed)
    t, q = np.repeat(np.linspace(1.0, 12.0, 8), 3), np.tile([0.1, 0.3, 0.6], 8)
    y = (30.0 + 4.0 * t) * q**-0.6 * np.exp(0.03 * rng.standard_normal(24))
    plain = fit_power_law(t, q, y, 1, 0, errors)
    order = rng.permutation(24)
    moved = fit_power_law(time * t[order], q[order], unit * y[order], 1, 0, errors)
    value, u = plain(5.0, 0.2)
    assert moved(5.0 * time, 0.2)[0] == pytest.approx(unit * value, rel=1e-7)
    assert moved(5.0 * time, 0.2)[1] == pytest.approx(unit * u, rel=1e-6)
    assert moved.exponent[0] == pytest.approx(plain.exponent[0], rel=1e-6)
    copied = fit_power_law(np.tile(t, 2), np.tile(q, 2), np.tile(y, 2), 1, 0, errors)
    assert copied(5.0, 0.2)[0] == pytest.approx(value, rel=1e-7)


@few
@given(seed=SEEDS, unit=UNITS, time=UNITS)
def test_the_order_chosen_depends_on_no_unit_and_no_order(
    seed: int, unit: float, time: float
) -> None:
    rng, x, y = series(seed)
    order = rng.permutation(len(x))

    def chosen(a: FloatArray, b: FloatArray) -> PolynomialFit:
        return choose([(f"{k}", partial(fit_polynomial, a, b, k)) for k in range(5)]).fit

    assert chosen(time * x[order], unit * y[order]).degree == chosen(x, y).degree


@few
@given(seed=SEEDS, unit=UNITS, power=st.floats(0.2, 5.0))
def test_the_weibull_tests_do_not_see_units_powers_or_order(
    seed: int, unit: float, power: float
) -> None:
    rng = np.random.default_rng(seed)
    x = rng.weibull(8.0, 12)
    moved = unit * rng.permutation(x) ** power
    assert goodness_of_fit(moved).statistic == pytest.approx(goodness_of_fit(x).statistic, rel=1e-6)
    assert low_outlier(moved).hazard == pytest.approx(low_outlier(x).hazard, rel=1e-6)
