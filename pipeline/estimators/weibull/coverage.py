"""How often the intervals of a sample with censoring of its own hold the truth, by simulation.

Failures are drawn from the fitted distribution and limits from the product-limit estimate of the
limits of the sample, whose mass beyond the last one stands for specimens without a limit.

Source: Efron, J. Am. Stat. Assoc. 76 (1981) 312-319, on drawing censored samples.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.weibull.conditional import condition
from deamat.estimators.weibull.fit import fit
from deamat.estimators.weibull.sample import BoolArray, accepted, as_arrays

_DRAWS = 400  # a coverage of 95 % is good to 1 %
_MOST_VALUES = 100_000
_FEWEST_DRAWS = 100
_SEED = 62539
_DIGITS = 6  # of the hazards of the limits: the same sample in another unit is the same question


@dataclass(frozen=True, slots=True)
class Coverage:
    """Fraction of simulated samples whose interval holds the truth.

    Parameters
    ----------
    shape, scale, quantile_10, quantile_1 : of these
    draws : simulated samples that could be fitted
    """

    shape: float
    scale: float
    quantile_10: float
    quantile_1: float
    draws: int

    @property
    def least(self) -> float:
        """Least of the four."""
        return min(self.shape, self.scale, self.quantile_10, self.quantile_1)

    @property
    def greatest(self) -> float:
        """Greatest of the four."""
        return max(self.shape, self.scale, self.quantile_10, self.quantile_1)


def coverage(x: ArrayLike, censored: ArrayLike, level: float = 0.95) -> Coverage:
    """Simulate how often intervals hold the truth under the censoring of a sample.

    Parameters
    ----------
    x, censored : as for `weibull.fit`, shape (n,)
    level : that the intervals claim

    Raises
    ------
    FitRefused : as `weibull.fit`, or no simulated sample can be fitted
    """
    best = fit(x, censored)
    values, failed = as_arrays(x, censored, ndim=1)
    hazard = (values / best.scale) ** best.shape
    order = np.argsort(hazard, kind="stable")
    told = tuple(float(f"{h:.{_DIGITS}g}") for h in hazard[order])
    return _simulated(told, tuple(failed[order].tolist()), level)


@lru_cache(maxsize=64)
def _simulated(hazard: tuple[float, ...], failed: tuple[bool, ...], level: float) -> Coverage:
    n = len(hazard)
    draws = min(_DRAWS, max(_FEWEST_DRAWS, _MOST_VALUES // n))
    rng = np.random.default_rng(_SEED)
    limits = _limits(np.array(hazard), np.array(failed), rng, draws)
    broke = rng.standard_exponential((draws, n))
    values, marks = np.minimum(broke, limits), broke > limits
    usable = accepted(values, ~marks)
    if not usable.any():
        raise FitRefused("no simulated sample of this censoring can be fitted", {"n": n})
    held = np.zeros(4)
    for given in condition(values[usable], marks[usable]):
        below = (
            given.shape_below(1.0),
            *(given.quantile_below(a, np.exp(a)) for a in _LOG_HAZARDS),
        )
        held += [np.count_nonzero(np.abs(p - 0.5) <= 0.5 * level) for p in below]
    draws = int(usable.sum())
    shape, scale, quantile_10, quantile_1 = (held / draws).tolist()
    return Coverage(shape, scale, quantile_10, quantile_1, draws)


_LOG_HAZARDS = (0.0, float(np.log(-np.log1p(-0.1))), float(np.log(-np.log1p(-0.01))))


def _limits(
    hazard: FloatArray, failed: BoolArray, rng: np.random.Generator, draws: int
) -> FloatArray:
    """Draw limits from their product-limit estimate, shape (draws, n); infinite beyond the last."""
    left = np.where(failed, 1.0, 1.0 - 1.0 / np.arange(hazard.size, 0, -1.0))
    survival = np.concatenate([[1.0], np.cumprod(left)])
    mass = -np.diff(survival)
    places = np.append(hazard, np.inf)
    return rng.choice(places, size=(draws, hazard.size), p=np.append(mass, survival[-1]))
