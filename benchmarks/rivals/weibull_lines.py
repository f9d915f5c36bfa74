"""Straight lines on Weibull paper: rank regression both ways and IEC 62539, for comparison only.

No card is made from these: with 20 specimens and more they spread wider than maximum likelihood.
They are here because laboratories and standards use them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import gammaln

from deamat.core.arrays import FloatArray
from deamat.estimators.weibull.plot import adjusted_ranks, weibull_axis
from deamat.estimators.weibull.sample import check_sample


@dataclass(frozen=True, slots=True)
class Line:
    """Parameters read from a straight line on Weibull paper: scale `[unit of x]`, shape `[1]`."""

    scale: float
    shape: float


def rank_regression(
    x: ArrayLike,
    censored: ArrayLike | None = None,
    direction: Literal["x on y", "y on x"] = "x on y",
) -> Line:
    """Draw the least-squares line through Benard's median ranks (i - 0.3)/(n + 0.4).

    Parameters
    ----------
    x, censored : as for `weibull.fit`, shape (n,)
    direction : `x on y` minimises distances in ln x, `y on x` those in ln(-ln(1 - F))

    Source: Abernethy, The New Weibull Handbook (2006).
    """
    values, failed = check_sample(x, censored)
    ranks = adjusted_ranks(values, failed)
    y = weibull_axis((ranks - 0.3) / (values.size + 0.4))
    log_x = np.log(np.sort(values[failed]))
    equal = np.ones_like(y)
    if direction == "x on y":
        return _line(log_x, y, equal)
    slope, intercept = _weighted_line(log_x, y, equal)
    return Line(float(np.exp(-intercept / slope)), slope)


def iec_62539(x: ArrayLike, censored: ArrayLike | None = None) -> Line:
    """Draw the weighted line of IEC 62539 (White): ln x on ln(-ln(1-F)), F = (i-0.44)/(n+0.25).

    The standard prints White's weights; they are the inverse variances of ln x_(i) and are
    computed here, interpolated at adjusted ranks when specimens are censored.

    Parameters
    ----------
    x, censored : as for `weibull.fit`, shape (n,)

    Source: IEC 62539:2007 / IEEE 930; White, Technometrics 11 (1969) 373-386.
    """
    values, failed = check_sample(x, censored)
    n = values.size
    ranks = adjusted_ranks(values, failed)
    weight = np.interp(ranks, np.arange(1, n + 1), 1.0 / log_weibull_variances(n))
    return _line(np.log(np.sort(values[failed])), weibull_axis((ranks - 0.44) / (n + 0.25)), weight)


def log_weibull_variances(n: int) -> FloatArray:
    """Return the variances of ln x_(i), i = 1..n, for scale 1 and shape 1, shape (n,)."""
    w = np.linspace(-45.0, 6.0, 2041)
    hazard = np.exp(w)
    i = np.arange(1.0, n + 1.0)[:, None]
    log_density = (
        gammaln(n + 1.0)
        - gammaln(i)
        - gammaln(n - i + 1.0)
        + (i - 1.0) * np.log(-np.expm1(-hazard))
        - (n - i + 1.0) * hazard
        + w
    )
    density = np.exp(log_density)
    density /= density.sum(axis=1, keepdims=True)
    mean = density @ w
    return np.asarray(np.einsum("ij,ij->i", density, (w - mean[:, None]) ** 2))


def _weighted_line(x: FloatArray, y: FloatArray, weight: FloatArray) -> tuple[float, float]:
    """Return slope and intercept of y on x."""
    x_mean, y_mean = (float(np.average(a, weights=weight)) for a in (x, y))
    slope = float(weight @ ((x - x_mean) * (y - y_mean)) / (weight @ (x - x_mean) ** 2))
    return slope, y_mean - slope * x_mean


def _line(log_x: FloatArray, y: FloatArray, weight: FloatArray) -> Line:
    """Regress ln x on y: ln x = ln scale + y / shape."""
    slope, intercept = _weighted_line(y, log_x, weight)
    return Line(float(np.exp(intercept)), 1.0 / slope)
