"""Other ways to a slope with a 95 % interval, for charts of what they lose and for comparison only.

No card is made from these. Each takes x and y, shape (n,), in the order of sampling, and asks for
what it needs of them; `deamat.estimators.slope.fit_line` is the one that techniques use.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.curves.slope import fit_line
from deamat.estimators.curves.stress_strain import bin_slopes, zero_of_tangent
from deamat.estimators.mean import coverage_factor

_HUBER = 1.345  # 95 % efficient on normal errors
_MOST_STEPS = 50


@dataclass(frozen=True, slots=True)
class Slope:
    """A slope and the ends of its nominal 95 % interval `[y/x]`."""

    value: float
    low: float
    high: float


def naive(x: FloatArray, y: FloatArray) -> Slope:
    """Take the least squares slope with the standard error of independent residuals."""
    dx, residual, slope = _least_squares(x, y)
    error = math.sqrt(float(residual @ residual) / ((x.size - 2) * float(dx @ dx)))
    return _around(slope, error, x.size - 2)


def generalised(x: FloatArray, y: FloatArray) -> Slope:
    r"""Weight by the covariance of first-order autoregression: least squares of the changes.

    $\tilde y_i = y_i - \rho y_{i-1}$ with the first sample kept as $\sqrt{1 - \rho^2} y_1$; rho
    is that of `fit_line`.

    Source: S. J. Prais, C. B. Winsten, Cowles Commission Discussion Paper 383 (1954).
    """
    line = fit_line(x, y)
    rho = line.autocorrelation
    columns = np.column_stack((np.ones(x.size), x - line.mean_x, y))
    changes = columns.copy()
    changes[1:] -= rho * columns[:-1]
    changes[0] *= math.sqrt(1.0 - rho * rho)
    one, slope_column, side = changes.T
    ones = float(one @ one)
    dx = slope_column - float(one @ slope_column) / ones * one
    dy = side - float(one @ side) / ones * one
    sxx = float(dx @ dx)
    slope = float(dx @ dy) / sxx
    residual = dy - slope * dx
    error = math.sqrt(float(residual @ residual) / ((x.size - 2) * sxx))
    return _around(slope, error, line.degrees_of_freedom)


def theil_sen(x: FloatArray, y: FloatArray) -> Slope:
    """Take the median of the slopes through all pairs, with Kendall's ranks for the interval.

    Source: P. K. Sen, J. Am. Stat. Assoc. 63 (1968) 1379.
    """
    first, second = np.triu_indices(x.size, 1)
    run = x[second] - x[first]
    slopes = np.sort((y[second] - y[first])[run != 0.0] / run[run != 0.0])
    if slopes.size == 0:
        raise FitRefused(f"all {x.size} samples lie at one x: a line needs a range")
    n = x.size
    reach = float(ndtri(0.975)) * math.sqrt(n * (n - 1) * (2 * n + 5) / 18.0)
    low = max(round(0.5 * (slopes.size - reach)) - 1, 0)
    high = min(round(0.5 * (slopes.size + reach)), slopes.size - 1)
    return Slope(float(np.median(slopes)), float(slopes[low]), float(slopes[high]))


def huber(x: FloatArray, y: FloatArray) -> Slope:
    """Count residuals beyond 1.345 standard deviations less, by repeated weighting.

    Source: P. J. Huber, Robust Statistics (Wiley 1981), 7.6 and 7.8.
    """
    design = np.column_stack((np.ones(x.size), x - x.mean()))
    b = np.linalg.lstsq(design, y, rcond=None)[0]
    size = 0.0
    for _ in range(_MOST_STEPS):
        residual = y - design @ b
        size = 1.4826 * float(np.median(np.abs(residual)))
        if size == 0.0:
            break
        weight = np.minimum(1.0, _HUBER * size / np.maximum(np.abs(residual), 1e-300))
        root = np.sqrt(weight)
        moved = np.linalg.lstsq(design * root[:, None], y * root, rcond=None)[0]
        done = bool(np.all(np.abs(moved - b) <= 1e-10 * np.maximum(np.abs(moved), 1e-300)))
        b = moved
        if done:
            break
    residual = y - design @ b
    clipped = np.clip(residual, -_HUBER * size, _HUBER * size)
    inside = max(float(np.mean(np.abs(residual) <= _HUBER * size)), 1.0 / x.size)
    variance = float(clipped @ clipped) / (x.size - 2) / inside**2
    error = math.sqrt(variance / float(design[:, 1] @ design[:, 1]))
    return _around(float(b[1]), error, x.size - 2)


def bin_wise(x: FloatArray, y: FloatArray, bins: int = 5) -> Slope:
    """Average the least squares slopes of equal bins of x; their scatter gives the interval."""
    low, high = float(x.min()), float(x.max())
    found = bin_slopes(x, y, low, high, (high - low) / bins)
    slopes = np.array([s for s in found.slope if not math.isnan(s)])
    if slopes.size < 2:
        raise FitRefused(f"{slopes.size} of {bins} bins have 3 samples; an average needs 2 slopes")
    error = float(slopes.std(ddof=1)) / math.sqrt(slopes.size)
    return _around(float(slopes.mean()), error, slopes.size - 1)


def toe_compensated(x: FloatArray, y: FloatArray, bins: int = 5) -> Slope:
    """Leave out what lies below the zero of the steepest bin's tangent, then as `fit_line`.

    Source: ASTM D638, annex A1.
    """
    low, high = float(x.min()), float(x.max())
    zero = zero_of_tangent(bin_slopes(x, y, low, high, (high - low) / bins))
    inside = x >= zero
    line = fit_line(x[inside], y[inside])
    return _around(line.slope, line.standard_error, line.degrees_of_freedom)


def _least_squares(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """Centred x, residuals and slope."""
    dx, dy = x - x.mean(), y - y.mean()
    slope = float(dx @ dy) / float(dx @ dx)
    return dx, dy - slope * dx, slope


def _around(value: float, standard_error: float, degrees_of_freedom: float) -> Slope:
    half = coverage_factor(degrees_of_freedom) * standard_error
    return Slope(value, value - half, value + half)
