from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.polynomial import polynomial
from scipy.optimize import minimize

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.least_squares.monotone import fit_non_decreasing, is_non_decreasing
from deamat.estimators.least_squares.polynomial import fit_polynomial

HOURS = np.linspace(1, 12, 23)
DENSE = np.linspace(1, 12, 4001)
# Sylgard 184 (10:1), Sikulskyi et al. 2022, Table 2.
QUARTIC = np.array([2.5, 0.493, 0.207, -0.0674, 0.00743])


def noisy(noise: float, seed: int) -> FloatArray:
    rng = np.random.default_rng(seed)
    return np.asarray(polynomial.polyval(HOURS, QUARTIC)) + noise * rng.normal(size=len(HOURS))


def test_a_fit_that_obeys_is_left_as_it_is() -> None:
    found = fit_non_decreasing(HOURS, noisy(0.01, 1), 4, floor=0.0)
    assert not found.active
    assert found.fit is found.unconstrained


@pytest.mark.parametrize("degree", [1, 2, 3, 4, 5, 6])
def test_a_falling_fit_is_moved_until_it_does_not_fall(degree: int) -> None:
    y = noisy(0.0, 0) + 4 * np.sin(2 * HOURS)
    if degree < 4:
        y = y[::-1]  # data that fall from end to end
    found = fit_non_decreasing(HOURS, y, degree, floor=0.0)
    assert found.active
    assert found.touching
    assert not is_non_decreasing(found.unconstrained)
    assert is_non_decreasing(found.fit)
    assert np.all(found.fit.derivative(DENSE) >= -1e-12 * np.abs(y).max())
    assert found.fit.derivative(np.array(found.touching)) == pytest.approx(0, abs=1e-7)
    assert np.all(np.array(found.touching) >= 1)
    assert np.all(np.array(found.touching) <= 12)


@pytest.mark.parametrize("seed", range(4))
def test_no_other_non_decreasing_polynomial_lies_nearer(seed: int) -> None:
    y, sigma = noisy(8.0, seed), 1 + 0.3 * HOURS
    found = fit_non_decreasing(HOURS, y, 4, 1.0, sigma)
    powers = np.vander((HOURS - 6.5) / 5.5, 5, increasing=True) / sigma[:, None]
    slopes = polynomial.polyder(np.eye(5), axis=0)
    grid = np.vander(np.linspace(-1, 1, 401), 4, increasing=True) @ slopes
    start = np.zeros(5)
    start[0] = 2.0
    problem: dict[str, Any] = {
        "jac": lambda c: -2 * powers.T @ (y / sigma - powers @ c),
        "method": "SLSQP",
        "constraints": [
            {"type": "ineq", "fun": lambda c: grid @ c, "jac": lambda _: grid},
            {"type": "ineq", "fun": lambda c: polynomial.polyval(-1, c) - 1.0},
        ],
        "options": {"maxiter": 1000, "ftol": 1e-13},
    }

    def squares(c: FloatArray) -> float:
        return float(np.sum((y / sigma - powers @ c) ** 2))

    rival = minimize(squares, start, **problem)
    assert rival.success
    # The rival may fall a little between its grid points, so it may be nearer by that little.
    assert np.sum(found.fit.weighted_residuals**2) <= rival.fun * (1 + 1e-5)


def test_the_floor_holds_and_is_reported() -> None:
    y = -3 + HOURS
    found = fit_non_decreasing(HOURS, y, 2, floor=0.5)
    assert found.at_floor
    assert found.active
    assert float(found.fit(1.0)[0]) == pytest.approx(0.5, abs=1e-6)
    assert np.all(found.fit(DENSE)[0] >= 0.5)
    constant = fit_non_decreasing(HOURS, -y, 0, floor=0.5)
    assert constant.at_floor
    assert constant.fit.coefficients == pytest.approx([0.5])


def test_raw_coefficients_and_residuals_belong_to_the_constrained_curve() -> None:
    y = noisy(8.0, 2)
    found = fit_non_decreasing(HOURS, y, 4, floor=0.0)
    assert found.active
    value = found.fit(HOURS)[0]
    np.testing.assert_allclose(polynomial.polyval(HOURS, found.fit.coefficients), value, atol=1e-9)
    np.testing.assert_allclose(found.fit.residuals, y - value, atol=1e-12)
    assert np.sum(found.fit.residuals**2) > np.sum(found.unconstrained.residuals**2)


@pytest.mark.parametrize("unit", [1e-6, 1e6])
def test_units_do_not_matter(unit: float) -> None:
    y = noisy(8.0, 3)
    found = fit_non_decreasing(HOURS, y, 4, floor=1.0)
    moved = fit_non_decreasing(HOURS * 3600, unit * y, 4, floor=unit)
    np.testing.assert_allclose(moved.fit(HOURS * 3600)[0], unit * found.fit(HOURS)[0], rtol=1e-6)
    np.testing.assert_allclose(moved.touching, np.array(found.touching) * 3600, rtol=1e-3)


def test_a_moved_curve_is_nearer_the_truth_and_its_intervals_cover_at_least_as_often() -> None:
    truth = np.asarray(polynomial.polyval(HOURS, QUARTIC))
    before, after, covered, active = 0.0, 0.0, [], 0
    for seed in range(200):
        found = fit_non_decreasing(HOURS, noisy(6.0, 100 + seed), 4, floor=0.0)
        active += found.active
        value, uncertainty = found.fit(HOURS)
        before += float(np.sum((found.unconstrained(HOURS)[0] - truth) ** 2))
        after += float(np.sum((value - truth) ** 2))
        covered.append(np.mean(np.abs(value - truth) <= 2.1 * uncertainty))
    assert active > 50
    assert after < before
    assert np.mean(covered) > 0.94


def test_what_the_plain_fit_refuses_is_refused() -> None:
    with pytest.raises(FitRefused, match="degree 4 needs at least 5 distinct x, not 2"):
        fit_non_decreasing([1.0, 2, 2, 2, 2, 2], [1.0, 2, 3, 4, 5, 6], 4, floor=0.0)
    with pytest.raises(FitRefused, match="the floor must be finite, not nan"):
        fit_non_decreasing(HOURS, HOURS, 1, floor=np.nan)


def test_x_in_clusters_too_narrow_for_a_shape_are_refused() -> None:
    x = np.repeat([1.0, 2.0, 3.0], 3) + 1e-6 * np.tile([0.0, 1.0, 2.0], 3)
    y = np.cos(40 * np.arange(9.0))
    assert fit_polynomial(x, y, 6).condition_number < 1e12
    with pytest.raises(FitRefused, match="x hardly determine a polynomial of degree 6 "):
        fit_non_decreasing(x, y, 6, floor=0.0)
    with pytest.raises(FitRefused, match="no non-decreasing polynomial of degree 4 was found in "):
        fit_non_decreasing(x, y, 4, floor=0.0)


def test_each_place_where_the_curve_is_held_is_told_once() -> None:
    # The cube falls around its middle: held there, and nowhere else.
    x = np.linspace(-1, 1, 21)
    found = fit_non_decreasing(x, x**3 - 0.2 * x, 3, floor=-10.0)
    assert found.touching == pytest.approx([0.0], abs=1e-6)
    assert not found.at_floor


def test_slopes_are_checked_at_their_exact_minima() -> None:
    # The slope of x^3 / 3 - e x is -e at zero only: no grid that misses zero would see it.
    x = np.linspace(-1, 1.3, 12)
    assert not is_non_decreasing(fit_polynomial(x, x**3 / 3 - 1e-9 * x, 3))
    assert is_non_decreasing(fit_polynomial(x, x**3 / 3 + 1e-9 * x, 3))
