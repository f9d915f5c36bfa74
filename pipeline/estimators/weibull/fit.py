"""Two-parameter Weibull distribution by maximum likelihood, complete or right-censored.

F(x) = 1 - exp(-(x / scale)^shape). Given the shape k the best scale is known, and the shape solves
k (S1/S0 - mean_failed z) = 1 with z = ln(x / max x) and S_j = sum over all of z^j exp(k z).

Source: IEC 62539; Lawless, Statistical Models and Methods for Lifetime Data, chapter 5.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange
from deamat.estimators.weibull.sample import (
    BoolArray,
    Censoring,
    LogSamples,
    Warnings,
    accepted,
    as_arrays,
    censoring_of,
    check_sample,
    log_samples,
    sample_warnings,
)

_BLOCK = 40_000  # values at once: small enough for the cache
_MAX_STEPS = 200
_LOG_CERTAIN = 10.0  # exp(-exp(10)) is 0
_CONVERGED = 1e-8  # Newton squares it in the last step


@dataclass(frozen=True, slots=True)
class WeibullFit:
    """The maximum-likelihood fit of one sample.

    Parameters
    ----------
    scale : the value that 63.2 % do not survive `[unit of x]`
    shape : Weibull modulus `[1]`; biased upwards in small samples, see `weibull_shape`
    n, failures : specimens, and those of them that failed
    log_likelihood : at the maximum, for x in its unit
    censoring : `complete`, `type II` (all stopped at the last failure) or `type I or random`
    warnings : what weakens the fit, as (name, detail)
    """

    scale: float
    shape: float
    n: int
    failures: int
    log_likelihood: float
    censoring: Censoring
    warnings: Warnings


@dataclass(frozen=True, slots=True)
class WeibullFits:
    """The fits of m samples, shape (m,) each; a refused sample holds NaN.

    Parameters
    ----------
    scale, shape, log_likelihood : as in `WeibullFit`
    failures : number of failures
    refused : samples that `fit` would refuse
    """

    scale: FloatArray
    shape: FloatArray
    log_likelihood: FloatArray
    failures: FloatArray
    refused: BoolArray


def fit(x: ArrayLike, censored: ArrayLike | None = None) -> WeibullFit:
    """Fit one sample by maximum likelihood.

    Parameters
    ----------
    x : values, or the values at which a specimen left the test unbroken, shape (n,)
    censored : true where a specimen left the test unbroken, shape (n,)

    Raises
    ------
    FitRefused : values that are not finite and positive, fewer than 3 distinct failures, or
        failures that differ by less than 1e-6 of the largest
    """
    values, failed = check_sample(x, censored)
    complete = bool(failed.all())
    samples = log_samples(values[None, :], None if complete else failed[None, :])
    shape, log_sum = (part.item() for part in solve_shape(samples, np.ones(1)))
    if math.isnan(shape):
        raise FitRefused("the likelihood equation did not converge", {"n": values.size})
    failures, mean, largest = (
        part.item() for part in (samples.failures, samples.mean_failed, samples.largest)
    )
    scale, log_likelihood = _scale_and_likelihood(math, shape, log_sum, failures, mean, largest)
    return WeibullFit(
        scale=scale,
        shape=shape,
        n=values.size,
        failures=int(failures),
        log_likelihood=log_likelihood,
        censoring="complete" if complete else censoring_of(values, failed),
        warnings=sample_warnings(values, failed),
    )


def fit_batch(x: ArrayLike, censored: ArrayLike | None = None) -> WeibullFits:
    """Fit m samples of n values at once; `refused` marks those that `fit` would refuse.

    Parameters
    ----------
    x, censored : as for `fit`, shape (m, n)

    Raises
    ------
    FitRefused : arrays of another shape or kind
    """
    values, failed = as_arrays(x, censored, ndim=2)
    m, n = values.shape
    result = np.full((3, m), np.nan)
    usable = np.zeros(m, dtype=np.bool_)
    rows = max(1, _BLOCK // n)
    for start in range(0, m, rows):
        block = slice(start, start + rows)
        mask = None if censored is None else failed[block]
        good = accepted(values[block], mask)
        usable[block] = good
        if good.all():
            result[:, block] = _maximise(log_samples(values[block], mask))
        elif good.any():
            chosen = start + np.flatnonzero(good)
            mask = None if censored is None else failed[chosen]
            result[:, chosen] = _maximise(log_samples(values[chosen], mask))
    scale, shape, log_likelihood = result
    refused = ~usable | np.isnan(shape)
    return WeibullFits(scale, shape, log_likelihood, failed.sum(axis=1, dtype=float), refused)


def _maximise(samples: LogSamples) -> tuple[FloatArray, FloatArray, FloatArray]:
    shape, log_sum = solve_shape(samples, np.ones_like(samples.failures))
    scale, log_likelihood = _scale_and_likelihood(
        np, shape, log_sum, samples.failures, samples.mean_failed, samples.largest
    )
    return scale, shape, log_likelihood


def _scale_and_likelihood(
    library: Any, shape: Any, log_sum: Any, failures: Any, mean_failed: Any, largest: Any
) -> tuple[Any, Any]:
    """Scale and log-likelihood at the shape; `math` does for one sample what numpy does for many.

    For one sample arrays would take a tenth of the whole fit.
    """
    log_mean_power = log_sum - library.log(failures)
    per_failure = (
        library.log(shape)
        + (shape - 1.0) * mean_failed
        - library.log(largest)
        - log_mean_power
        - 1.0
    )
    return largest * library.exp(log_mean_power / shape), failures * per_failure


def solve_shape(samples: LogSamples, ratio: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Solve k (S1/S0 - mean_failed z) = ratio by Newton within a bracket.

    The left side minus the right changes sign once, for any ratio in (0, 1].

    Parameters
    ----------
    samples : m samples
    ratio : 1 for maximum likelihood; (r-1)/r and (r-2)/r for its marginal and modified forms, (m,)

    Returns
    -------
    shape, log_sum : k and ln S0 at k, shape (m,) each; NaN where 200 steps were not enough
    """
    shape = _start(samples)
    low, high = np.zeros_like(shape), np.full_like(shape, np.inf)
    for _ in range(_MAX_STEPS):
        s0, mean, variance = samples.power_sums(shape)
        drift = mean - samples.mean_failed
        excess = shape * drift - ratio
        np.copyto(low, shape, where=excess < 0)
        np.copyto(high, shape, where=excess >= 0)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            change = -excess / (drift + shape * variance)
            done = np.abs(change) <= _CONVERGED * shape
            proposed = shape + change
            stray = ~(done | ((proposed > low) & (proposed < high)))
            if stray.any():
                halved = np.where(low > 0, np.sqrt(low * high), shape / 2.0)
                inner = np.where(np.isinf(high), shape * 2.0, halved)
                proposed = np.where(stray, inner, proposed)
        if done.all():
            # S0 was summed one step of 1e-8 or less before: first order is exact
            return proposed, np.log(s0) + change * mean
        shape = proposed
    return np.where(done, proposed, np.nan), np.where(done, np.log(s0) + change * mean, np.nan)


def _start(samples: LogSamples) -> FloatArray:
    """Menon's moment estimate, pi / (sqrt 6 sd(ln x)), over all values."""
    deviation = samples.log_ratio.std(axis=0)
    start: FloatArray = np.pi / (np.sqrt(6.0) * deviation)
    return start


def quantile(scale: float, shape: float, p: float) -> float:
    """Return the value that a fraction p does not survive: scale (-ln(1-p))^(1/shape).

    Raises
    ------
    OutOfRange : a scale or shape that is not positive, or p outside (0, 1)
    """
    check_parameters(scale, shape)
    if not 0.0 < p < 1.0:
        raise OutOfRange(f"a probability must lie between 0 and 1, not {p:g}")
    return float(scale * np.exp(np.log(-np.log1p(-p)) / shape))


def failure_probability(scale: float, shape: float, field: float) -> float:
    """Return the fraction that does not survive a value: 1 - exp(-(field/scale)^shape).

    Raises
    ------
    OutOfRange : a scale or shape that is not positive, or a negative field
    """
    check_parameters(scale, shape)
    if not 0.0 <= field < np.inf:
        raise OutOfRange(f"a field must not be negative and must be finite, not {field:g}")
    return 0.0 if field == 0.0 else probability_of(shape * np.log(field / scale))


def probability_of(log_hazard: float) -> float:
    """Return 1 - exp(-exp(log_hazard)) to all digits."""
    return float(-np.expm1(-np.exp(min(log_hazard, _LOG_CERTAIN))))


def check_parameters(scale: float, shape: float) -> None:
    """Raise `OutOfRange` for a scale or shape that is not positive and finite."""
    for name, value in (("scale", scale), ("shape", shape)):
        if not 0.0 < value < np.inf:
            raise OutOfRange(f"{name} must be above 0 and finite, not {value:g}")
