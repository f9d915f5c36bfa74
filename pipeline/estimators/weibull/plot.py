"""What a Weibull probability plot shows: plotting positions and the confidence band, as arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import betaincinv

from deamat.core.arrays import FloatArray
from deamat.core.errors import OutOfRange
from deamat.estimators.weibull.conditional import condition
from deamat.estimators.weibull.sample import BoolArray, check_sample


@dataclass(frozen=True, slots=True)
class PlottingPositions:
    """The failures of a sample and the fraction failed that each stands for.

    Parameters
    ----------
    value : failures in rising order, shape (r,) `[unit of x]`
    fraction : median rank of each, shape (r,)
    """

    value: FloatArray
    fraction: FloatArray


def adjusted_ranks(values: FloatArray, failed: BoolArray) -> FloatArray:
    """Return the ranks of the failures among all specimens, shape (r,).

    A specimen that left unbroken might have failed anywhere beyond, so each later rank grows by
    (n + 1 - last rank) / (1 + specimens left). Complete samples keep 1, 2, ..., n.

    Source: Johnson, The Statistical Treatment of Fatigue Experiments (1964).
    """
    n = values.size
    order = np.lexsort((~failed, values))  # at a tie, failures come first
    ranks = []
    rank = 0.0
    for position, has_failed in enumerate(failed[order]):
        if has_failed:
            rank += (n + 1.0 - rank) / (n - position + 1.0)
            ranks.append(rank)
    return np.array(ranks)


def weibull_axis(p: ArrayLike) -> FloatArray:
    """Return ln(-ln(1 - p)), the upright axis of Weibull paper, on which the fit is straight.

    Raises
    ------
    OutOfRange : a probability outside (0, 1)
    """
    fraction = np.asarray(p, dtype=float)
    wrong = ~((fraction > 0) & (fraction < 1))
    if wrong.any():
        raise OutOfRange(f"a probability must lie between 0 and 1, not {fraction[wrong].flat[0]:g}")
    return np.asarray(np.log(-np.log1p(-fraction)))


def plotting_positions(x: ArrayLike, censored: ArrayLike | None = None) -> PlottingPositions:
    """Return each failure its exact median rank: the median of a beta(i, n - i + 1) variable.

    Parameters
    ----------
    x, censored : as for `weibull.fit`, shape (n,)

    Raises
    ------
    FitRefused : as `weibull.fit`
    """
    values, failed = check_sample(x, censored)
    ranks = adjusted_ranks(values, failed)
    fraction = np.asarray(betaincinv(ranks, values.size - ranks + 1.0, 0.5), dtype=float)
    return PlottingPositions(np.sort(values[failed]), fraction)


def confidence_band(
    x: ArrayLike,
    probabilities: ArrayLike,
    censored: ArrayLike | None = None,
    level: float = 0.95,
) -> tuple[FloatArray, FloatArray]:
    """Return the exact conditional interval of the quantile at each probability.

    Parameters
    ----------
    x, censored : as for `weibull.fit`, shape (n,)
    probabilities : fractions failed, between 0 and 1, shape (q,)
    level : of each interval by itself

    Returns
    -------
    low, high : shape (q,) each `[unit of x]`

    Raises
    ------
    FitRefused : as `weibull.fit`
    OutOfRange : a probability or level outside (0, 1)
    """
    values, failed = check_sample(x, censored)
    if not 0.0 < level < 1.0:
        raise OutOfRange(f"a level must lie between 0 and 1, not {level:g}")
    (given,) = condition(values[None, :], ~failed[None, :])
    bounds = [given.quantile(a, level) for a in weibull_axis(probabilities)]
    return np.concatenate([b[0] for b in bounds]), np.concatenate([b[1] for b in bounds])
