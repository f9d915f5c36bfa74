"""Promises of the line fit: least squares to the last digit, an interval that covers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.curves.slope import FEW_INDEPENDENT, curvature, fit_line
from deamat.estimators.mean import coverage_factor


def correlated(rng: np.random.Generator, shape: tuple[int, int], rho: float) -> FloatArray:
    """Stationary AR(1) noise of unit variance along the second axis."""
    noise = rng.standard_normal(shape)
    for i in range(1, shape[1]):
        noise[:, i] = rho * noise[:, i - 1] + np.sqrt(1.0 - rho**2) * noise[:, i]
    return noise


@pytest.mark.parametrize("n", [3, 10, 91, 2000])
def test_point_estimate_and_naive_error_are_those_of_least_squares(n: int) -> None:
    rng = np.random.default_rng(n)
    x = np.sort(rng.uniform(0.0, 0.05, n))
    y = 100.0 + 1.6e5 * x + rng.normal(0.0, 50.0, n)
    line = fit_line(x, y)
    design = np.column_stack((x, np.ones(n)))
    slope, intercept = np.polyfit(x, y, 1)
    assert line.slope == pytest.approx(slope, rel=1e-12)
    assert line.intercept == pytest.approx(intercept, rel=1e-9)
    rss = float(np.sum((y - design @ (slope, intercept)) ** 2))
    naive = np.sqrt(np.linalg.inv(design.T @ design)[0, 0] * rss / (n - 2))
    assert line.naive_standard_error == pytest.approx(naive, rel=1e-8)
    assert line.residual_sd == pytest.approx(np.sqrt(rss / (n - 2)), rel=1e-10)


@pytest.mark.parametrize("rho", [0.0, 0.4, 0.95])
def test_standard_error_is_the_one_of_the_full_covariance_matrix(rho: float) -> None:
    rng = np.random.default_rng(7)
    n = 120
    x = np.sort(rng.uniform(0.0, 0.05, n))
    y = 3e4 * x + 20.0 * correlated(rng, (1, n), rho)[0]
    line = fit_line(x, y)
    matrix = line.autocorrelation ** np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    design = np.column_stack((np.ones(n), x))
    hat = design @ np.linalg.pinv(design)
    residual = y - hat @ y
    sigma2 = residual @ residual / np.trace((np.eye(n) - hat) @ matrix)
    variance = sigma2 * (np.linalg.pinv(design) @ matrix @ np.linalg.pinv(design).T)[1, 1]
    assert line.standard_error == pytest.approx(np.sqrt(variance), rel=1e-9)


@pytest.mark.parametrize(
    ("n", "rho"),
    [(20, 0.0), (20, 0.3), (50, 0.0), (50, 0.6), (91, 0.3), (200, 0.9), (500, 0.6), (500, 0.9)],
)
def test_interval_covers_where_eight_samples_are_independent(n: int, rho: float) -> None:
    assert n * (1.0 - rho) / (1.0 + rho) >= FEW_INDEPENDENT
    rng = np.random.default_rng(100 * n + int(10 * rho))
    x = np.linspace(0.0, 0.05, n)
    truth = 5e4
    hits = 0
    repeats = 1500
    for noise in correlated(rng, (repeats, n), rho):
        line = fit_line(x, truth * x + 30.0 * noise)
        half = coverage_factor(line.degrees_of_freedom) * line.standard_error
        hits += abs(line.slope - truth) < half
    assert 0.93 <= hits / repeats <= 0.975


def test_naive_error_would_not_cover() -> None:
    rng = np.random.default_rng(3)
    n, rho = 91, 0.6
    x = np.linspace(0.0, 0.05, n)
    lines = [fit_line(x, noise) for noise in correlated(rng, (500, n), rho)]
    naive = np.mean([abs(line.slope) < 1.99 * line.naive_standard_error for line in lines])
    assert naive < 0.75
    found = np.mean([line.autocorrelation for line in lines])
    assert found == pytest.approx(rho, abs=0.02)  # the fit's bias is undone


def test_strong_correlation_leaves_few_independent_samples() -> None:
    x = np.linspace(0.0, 0.05, 91)
    line = fit_line(x, 1e6 * x**2)
    assert line.independent_samples < FEW_INDEPENDENT
    assert line.standard_error > 3.0 * line.naive_standard_error


def test_units_only_scale() -> None:
    rng = np.random.default_rng(5)
    x = np.linspace(0.0, 0.05, 60)
    y = 2e4 * x + rng.normal(0.0, 10.0, 60)
    line, scaled = fit_line(x, y), fit_line(100.0 * x + 7.0, y / 1e3 - 2.0)
    assert scaled.slope == pytest.approx(line.slope / 1e5, rel=1e-12)
    assert scaled.standard_error == pytest.approx(line.standard_error / 1e5, rel=1e-9)
    assert scaled.autocorrelation == pytest.approx(line.autocorrelation, abs=1e-9)


def test_exact_line_has_no_error() -> None:
    line = fit_line(np.arange(16.0), 2.0 * np.arange(16.0) - 1.0)
    assert (line.slope, line.intercept, line.standard_error) == (2.0, -1.0, 0.0)
    assert line.autocorrelation == 0.0


def test_refusals() -> None:
    with pytest.raises(FitRefused, match=r"^a line with an uncertainty needs at least 3 samples, "):
        fit_line(np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    with pytest.raises(
        FitRefused, match=r"^all 4 samples lie at one x, 0\.5: a line needs a range"
    ):
        fit_line(np.full(4, 0.5), np.arange(4.0))
    with pytest.raises(FitRefused, match=r"^a curvature needs at least 3 different x"):
        curvature(np.array([0.0, 1.0, 0.0, 1.0]), np.arange(4.0))


def test_curvature_is_that_of_the_fitted_parabola() -> None:
    rng = np.random.default_rng(9)
    x = np.sort(rng.uniform(0.0, 0.05, 80))
    y = 1e3 + 4e4 * x + 3e5 * x**2 + rng.normal(0.0, 5.0, 80)
    assert curvature(x, y) == pytest.approx(2.0 * np.polyfit(x, y, 2)[0], rel=1e-8)


@pytest.mark.shared
def test_norris_comes_out_as_certified(shared: Path) -> None:
    lines = (shared / "reference" / "nist" / "linear" / "Norris.dat").read_text().splitlines()
    y, x = np.array([[float(v) for v in line.split()] for line in lines[60:96]]).T
    line = fit_line(x, y)
    # NIST StRD, certified to 15 digits
    assert line.slope == pytest.approx(1.00211681802045, rel=1e-13)
    assert line.intercept == pytest.approx(-0.262323073774029, rel=1e-11)
    assert line.naive_standard_error == pytest.approx(0.429796848199937e-3, rel=1e-10)
    assert line.residual_sd == pytest.approx(0.884796396144373, rel=1e-10)
