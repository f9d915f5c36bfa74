"""Tells whether the strength of the specimens of one sample follows a covariate, as E ~ t^-m.

The scale of specimen i is scale (t_i / t_0)^-m. Under m = 0 the martingale residuals d_i - H_i (1
for a failure, less the fitted hazard) do not follow ln t: their correlation is tested as one of n
exchangeable pairs, which is exact to second order for any distribution. Where it shows, m is that
of greatest likelihood, with the interval within which the likelihood ratio stays below what a
regression of as many normal values would allow, r ln(1 + t^2/(r - 3)).

Source: Lawless, Statistical Models and Methods for Lifetime Data, chapter 6; Pitman, J. R. Stat.
Soc. Suppl. 4 (1937) 225-232 on the correlation of exchangeable pairs.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.errors import FitRefused
from deamat.estimators.weibull.fit import WeibullFit, fit
from deamat.estimators.weibull.sample import as_arrays

_FEWEST = 5  # specimens
_STEP = 0.25  # of m, by which the interval is walked out
_FARTHEST = 20.0  # of m
_CONVERGED = 1e-6
_GOLDEN = 0.6180339887498949


@dataclass(frozen=True, slots=True)
class Trend:
    """An inverse power law of the covariate.

    Parameters
    ----------
    exponent, low, high : m and its 95 % interval
    p_value : of the test that m is 0
    centre : geometric mean of the covariate
    at_centre : the fit at the centre, the power law taken out
    """

    exponent: float
    low: float
    high: float
    p_value: float
    centre: float
    at_centre: WeibullFit


def trend_p_value(x: ArrayLike, censored: ArrayLike | None, covariate: ArrayLike) -> float:
    """Test whether the sample follows a covariate; two-sided p-value.

    Parameters
    ----------
    x, censored : as for `weibull.fit`, shape (n,)
    covariate : positive, shape (n,), not all equal

    Raises
    ------
    FitRefused : as `weibull.fit`, or fewer than 5 values
    """
    from scipy.special import stdtr  # with the rest of the fit only

    best = fit(x, censored)
    values, failed = as_arrays(x, censored, ndim=1)
    if values.size < _FEWEST:
        raise FitRefused(
            f"{values.size} specimens; at least {_FEWEST} are needed to see a trend",
            {"n": values.size},
        )
    residual = failed - (values / best.scale) ** best.shape
    z = np.log(np.asarray(covariate, dtype=np.float64))
    z = z - z.mean()
    residual = residual - residual.mean()
    r = float(z @ residual) / float(np.linalg.norm(z) * np.linalg.norm(residual))
    dof = values.size - 2
    t = abs(r) * (dof / max(1.0 - r * r, 1e-12)) ** 0.5
    return float(2.0 * stdtr(dof, -t))


def trend(x: ArrayLike, censored: ArrayLike | None, covariate: ArrayLike) -> Trend:
    """Fit the inverse power law by maximum likelihood.

    Parameters
    ----------
    x, censored : as for `weibull.fit`, shape (n,)
    covariate : positive, shape (n,), not all equal

    Raises
    ------
    FitRefused : as `weibull.fit`, or fewer than 5 values
    """
    p_value = trend_p_value(x, censored, covariate)
    values, failed = as_arrays(x, censored, ndim=1)
    log_t = np.log(np.asarray(covariate, dtype=np.float64))
    z = log_t - log_t.mean()

    def profile(m: float) -> float:
        """Log-likelihood of m, the other two at their best."""
        return fit(values * np.exp(m * z), censored).log_likelihood + m * float(z[failed].sum())

    from scipy.special import stdtrit

    dof = max(int(failed.sum()) - 3, 1)
    allowed = (dof + 3) * np.log1p(float(stdtrit(dof, 0.975)) ** 2 / dof)
    m = _greatest(profile, *_bracket(profile))
    least = profile(m) - 0.5 * float(allowed)
    low, high = (_crossing(profile, m, least, sign) for sign in (-1.0, 1.0))
    at_centre = fit(values * np.exp(m * z), censored)
    return Trend(m, low, high, p_value, float(np.exp(log_t.mean())), at_centre)


def _bracket(f: Callable[[float], float]) -> tuple[float, float]:
    """Walk uphill from 0 until the function falls."""
    step = _STEP if f(_STEP) > f(-_STEP) else -_STEP
    at, here = 0.0, f(0.0)
    while abs(at) < _FARTHEST:
        there = f(at + step)
        if there < here:
            break
        at, here = at + step, there
    return min(at - step, at + step), max(at - step, at + step)


def _greatest(f: Callable[[float], float], low: float, high: float) -> float:
    """Golden-section search."""
    a, b = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    fa, fb = f(a), f(b)
    while high - low > _CONVERGED:
        if fa > fb:
            high, b, fb = b, a, fa
            a = high - _GOLDEN * (high - low)
            fa = f(a)
        else:
            low, a, fa = a, b, fb
            b = low + _GOLDEN * (high - low)
            fb = f(b)
    return 0.5 * (low + high)


def _crossing(f: Callable[[float], float], start: float, level: float, sign: float) -> float:
    """Where the function falls to a level, by bisection."""
    inside, outside = start, start + sign * _STEP
    while f(outside) > level and abs(outside) < _FARTHEST:
        inside, outside = outside, outside + sign * _STEP
    while abs(outside - inside) > _CONVERGED:
        middle = 0.5 * (inside + outside)
        inside, outside = (middle, outside) if f(middle) > level else (inside, middle)
    return 0.5 * (inside + outside)
