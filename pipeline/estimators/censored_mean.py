"""Mean of values of which some are only known to be exceeded: strips that did not break."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.mean import Mean, coverage_factor, mean_with_shared

BoolArray = NDArray[np.bool_]

FEWEST_EXACT = 3
_STEPS = 200
_CONVERGED = 1e-12


def mean_with_limits(values: Sequence[float], is_limit: Sequence[bool], u_shared: float) -> Mean:
    r"""Estimate the mean of a normal sample, some values of which are lower limits.

    Maximum likelihood of $\mu$ and $\sigma$,

    $$ \ell = \sum_\mathrm{exact} \ln\frac{\varphi(z_i)}{\sigma} + \sum_\mathrm{limits}
    \ln(1 - \Phi(z_i)), \quad z_i = (x_i - \mu)/\sigma, $$

    by expectation and maximisation. The variance of $\mu$ is that of the observed information,
    times $r/(r-1)$ for the r exact values whose mean was estimated, and the interval is Student's
    with r - 1 degrees of freedom. Without limits this is `mean_with_shared`.

    Parameters
    ----------
    values : one per specimen, exact or a lower limit, shape (n,)
    is_limit : which values are lower limits, shape (n,)
    u_shared : standard uncertainty of the error common to all values

    Raises
    ------
    FitRefused : fewer than three different exact values

    Source: A. C. Cohen, Technometrics 1 (1959) 217.
    """
    limit = np.asarray(is_limit, dtype=np.bool_)
    if not limit.any():
        return mean_with_shared(values, 0.0, u_shared)
    x = np.asarray(values, dtype=np.float64)
    exact = x[~limit]
    r = int(exact.size)
    if np.unique(exact).size < FEWEST_EXACT:
        raise FitRefused(
            f"{r} exact values beside {x.size - r} lower limits; a mean needs at least "
            f"{FEWEST_EXACT} different exact ones",
            {"exact": r, "limits": x.size - r},
        )
    mean, sd = _maximise(x, limit)
    variance = _variance_of_mean(x, limit, mean, sd) * r / (r - 1)
    independent = math.sqrt(variance)
    ratio = u_shared / independent
    dof = (r - 1) * (1.0 + ratio * ratio) ** 2
    half = max(
        coverage_factor(dof) * math.hypot(independent, u_shared),
        coverage_factor(r - 1) * independent,
    )
    spread = sd * math.sqrt(r / (r - 1))
    return Mean(mean, len(values), spread, independent, u_shared, dof, (mean - half, mean + half))


def _hazard(z: FloatArray) -> FloatArray:
    """Return phi(z) / (1 - Phi(z)) without overflow."""
    return np.asarray(np.exp(-0.5 * z * z - 0.5 * math.log(2.0 * math.pi) - log_ndtr(-z)))


def _maximise(x: FloatArray, limit: BoolArray) -> tuple[float, float]:
    """Replace each limit by its expectation beyond it, until nothing changes."""
    origin, scale = float(x[~limit].mean()), float(x[~limit].std())
    y = (x - origin) / scale
    mean, sd = 0.0, 1.0
    for _ in range(_STEPS):
        z = (y[limit] - mean) / sd
        h = _hazard(z)
        filled = y.copy()
        filled[limit] = mean + sd * h
        extra = float((sd * sd * (1.0 + z * h - h * h)).sum())
        new_mean = float(filled.mean())
        new_sd = math.sqrt((float(np.square(filled - new_mean).sum()) + extra) / y.size)
        moved = abs(new_mean - mean) + abs(new_sd - sd)
        mean, sd = new_mean, new_sd
        if moved < _CONVERGED:
            break
    return origin + scale * mean, scale * sd


def _variance_of_mean(x: FloatArray, limit: BoolArray, mean: float, sd: float) -> float:
    """Return the (mean, mean) entry of the inverse observed information in (mean, ln sd)."""
    z = (x - mean) / sd
    u, c = z[~limit], z[limit]
    h = _hazard(c)
    slope = h * (h - c)
    mm = (u.size + slope.sum()) / sd**2
    ms = (2.0 * u.sum() + (h + c * slope).sum()) / sd
    ss = 2.0 * np.square(u).sum() + (c * h + c * c * slope).sum()
    return float(ss / (mm * ss - ms * ms))
