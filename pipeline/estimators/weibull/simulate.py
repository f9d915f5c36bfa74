"""Samples of a standard Weibull variable with the failures and withdrawals of a real sample.

Shape and scale of the truth cancel in every statistic that is computed after fitting, so scale 1
and shape 1 stand for all. Specimens leave a simulated test right after the same failure as in the
real one (progressive type-II censoring): exact for complete and type-II samples, an approximation
where the true limits were set beforehand.

Source: Balakrishnan and Aggarwala, Progressive Censoring (2000), chapter 3.
"""

from __future__ import annotations

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.estimators.weibull.sample import BoolArray

Withdrawals = tuple[int, ...]


def withdrawals(values: FloatArray, failed: BoolArray) -> Withdrawals:
    """Count the specimens that left unbroken between each failure and the next, length r.

    Those that left before the first failure tell nothing and are not counted.
    """
    failures = np.sort(values[failed])
    after = np.searchsorted(failures, values[~failed], side="right")
    counts = np.bincount(after, minlength=failures.size + 1)
    return tuple(counts[1:].tolist())


def at_risk(removed: Withdrawals) -> FloatArray:
    """Count the specimens under test just before each failure, shape (r,)."""
    leaving = np.asarray(removed, dtype=float) + 1.0
    return np.cumsum(leaving[::-1])[::-1]


def standard_samples(
    removed: Withdrawals, draws: int, seed: int
) -> tuple[FloatArray, FloatArray, BoolArray | None]:
    """Draw samples of scale 1 and shape 1.

    Returns
    -------
    failures : in rising order, shape (draws, r)
    values, censored : the whole samples for `weibull.fit_batch`, shape (draws, n); `censored` is
        None for complete samples
    """
    rng = np.random.default_rng(seed)
    spacings = rng.standard_exponential((draws, len(removed)))
    failures = np.cumsum(spacings / at_risk(removed), axis=1)
    if not any(removed):
        return failures, failures, None
    copies = np.asarray(removed) + 1
    values = np.repeat(failures, copies, axis=1)
    marks = np.ones(values.shape[1], dtype=np.bool_)
    marks[np.cumsum(copies) - copies] = False
    return failures, values, np.broadcast_to(marks, values.shape)
