"""Both tests accuse sound fits rarely and find what they are made for."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.errors import FitRefused
from deamat.estimators.curves.slope import fit_line, outlying
from deamat.estimators.least_squares.lack_of_fit import outlying_points, residual_runs
from deamat.estimators.least_squares.polynomial import fit_polynomial

X = np.linspace(1.0, 12.0, 40)


def test_sound_fits_are_accused_at_most_as_often_as_the_level_says() -> None:
    rng = np.random.default_rng(41)
    fits = [fit_polynomial(X, 2.0 + 0.3 * X + 0.1 * rng.standard_normal(40), 1) for _ in range(400)]
    assert np.mean([residual_runs(X, fit).found for fit in fits]) <= 0.065
    assert not any(outlying_points(fit).size for fit in fits)


def test_a_law_too_stiff_leaves_residuals_that_run_together() -> None:
    fit = fit_polynomial(X, X**2 + 0.1 * np.sin(50.0 * X), 1)
    runs = residual_runs(X, fit)
    assert runs.found
    assert runs.ratio < 0.2
    shuffled = np.random.default_rng(2).permutation(40)
    again = fit_polynomial(X[shuffled], fit.y[shuffled], 1)
    assert residual_runs(X[shuffled], again).ratio == pytest.approx(runs.ratio, rel=1e-9)


def test_an_exact_law_shows_no_pattern_of_rounding() -> None:
    fit = fit_polynomial(X, 2.0 + 3.0 * X, 2)
    assert not residual_runs(X, fit).found
    assert outlying_points(fit).size == 0


def test_a_wrong_point_is_found_and_named() -> None:
    rng = np.random.default_rng(43)
    y = 2.0 + 0.3 * X + 0.02 * rng.standard_normal(40)
    y[17] *= 0.5
    assert outlying_points(fit_polynomial(X, y, 1)).tolist() == [17]
    assert outlying(X, y, fit_line(X, y)).tolist() == [17]


def test_a_wrong_point_that_draws_the_line_to_itself_is_found_by_its_leverage() -> None:
    # the line follows the far point three quarters of its way: 16 deviations off, it stays within 5
    x = np.append(np.linspace(0.0, 1.0, 400), [11.0])
    y = 2.0 * x + 0.1 * np.random.default_rng(46).standard_normal(401)
    y[400] = 2.0 * 11.0 + 1.6
    fit = fit_polynomial(x, y, 1)
    assert 0.7 < fit.leverages[400] < 0.8
    assert abs(fit.residuals[400]) < 5.0 * 0.1
    assert outlying_points(fit).tolist() == [400]


def test_sound_lines_have_no_outlying_reading() -> None:
    rng = np.random.default_rng(44)
    found: list[int] = []
    for _ in range(500):
        y = X + rng.standard_normal(40)
        found += outlying(X, y, fit_line(X, y)).tolist()
    assert found == []
    assert outlying(X, 2.0 * X, fit_line(X, 2.0 * X)).size == 0


def test_x_of_another_length_is_refused() -> None:
    with pytest.raises(FitRefused, match=r"^x holds 3 values for 40 points$"):
        residual_runs(X[:3], fit_polynomial(X, X, 1))


def test_an_uncertainty_is_never_less_than_what_rounding_hides() -> None:
    rng = np.random.default_rng(45)
    hits = 0
    for _ in range(60):  # three clusters so narrow that the variances cancel in double precision
        x = np.repeat([1.0, 6.0, 12.0], 8) + 1e-8 * rng.uniform(0.0, 1.0, 24)
        fit = fit_polynomial(x, 2.0 + 0.05 * rng.standard_normal(24), 4)
        value, u = fit(x[8])
        hits += bool(abs(value - 2.0) <= 2.1 * u)
    assert hits >= 50
