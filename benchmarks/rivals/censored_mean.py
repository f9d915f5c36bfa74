"""Other ways to a mean of strips of which some did not break, for charts of what they lose.

No card is made from these. Each takes values and which of them are lower limits, shape (n,).
"""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import minimize
from scipy.special import log_ndtr

from benchmarks.rivals.slope import Slope
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.censored_mean import FEWEST_EXACT, BoolArray
from deamat.estimators.mean import mean_with_shared


def as_values(x: FloatArray, _limit: BoolArray) -> Slope:
    """Take every limit for a value."""
    return _mean(x)


def without_limits(x: FloatArray, limit: BoolArray) -> Slope:
    """Leave the limits out."""
    return _mean(x[~limit])


def _mean(x: FloatArray) -> Slope:
    if x.size < FEWEST_EXACT:
        raise FitRefused("fewer than three values")
    found = mean_with_shared(x.tolist(), 0.0, 0.0)
    return Slope(found.value, *found.ci95)


def nelder_mead(x: FloatArray, limit: BoolArray) -> Slope:
    """Maximise the same likelihood by scipy's simplex, with normal limits from its curvature."""
    if (~limit).sum() < FEWEST_EXACT:
        raise FitRefused("fewer than three values")
    start = [float(x[~limit].mean()), math.log(float(x[~limit].std()))]

    def cost(p: FloatArray) -> float:
        z = (x - p[0]) / math.exp(p[1])
        return float(np.sum(0.5 * z[~limit] ** 2 + p[1]) - np.sum(log_ndtr(-z[limit])))

    best = minimize(cost, start, method="Nelder-Mead").x
    step = 1e-3 * math.exp(best[1])
    sides = [cost(best + np.array([s, 0.0])) for s in (-step, 0.0, step)]
    half = 1.96 * step / math.sqrt(max(sides[0] - 2.0 * sides[1] + sides[2], 1e-300))
    return Slope(float(best[0]), float(best[0]) - half, float(best[0]) + half)
