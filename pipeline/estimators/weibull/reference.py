"""Statistics of the Weibull form, and their distribution where the form is true.

Simulated with a fixed seed for the failures and withdrawals of a sample, and kept. Of more than 400
failures every so many are simulated with their share of the withdrawals: the distributions of A^2,
of n times the lowest hazard and of the score over sqrt(r) no longer change with n.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.estimators.weibull.fit import fit_batch
from deamat.estimators.weibull.sample import BoolArray
from deamat.estimators.weibull.simulate import Withdrawals, at_risk, standard_samples

_DRAWS = 10_000  # a p-value of 0.05 is good to 0.002
_FEWEST_DRAWS = 1_000
_MOST_VALUES = 1_000_000
_MOST_FAILURES = 400
_SEED = 62539


@dataclass(frozen=True, slots=True)
class Reference:
    """What Weibull samples show, sorted, shape (draws,) each.

    Parameters
    ----------
    anderson_darling, curvature : the statistics
    lowest : hazard of the lowest failure
    """

    anderson_darling: FloatArray
    curvature: FloatArray
    lowest: FloatArray

    @property
    def draws(self) -> int:
        """Number of simulated samples."""
        return int(self.lowest.size)


@lru_cache(maxsize=64)
def reference(removed: Withdrawals) -> Reference:
    """Simulate what Weibull samples show.

    Parameters
    ----------
    removed : specimens withdrawn after each failure, length r
    """
    thin = thinned(removed, _MOST_FAILURES)
    n = int(at_risk(thin)[0])
    draws = min(_DRAWS, max(_FEWEST_DRAWS, _MOST_VALUES // n))
    failures, values, censored = standard_samples(thin, draws, _SEED)
    hazard = fitted_hazards(failures, values, censored)
    share = n / float(at_risk(removed)[0])
    return Reference(
        np.sort(anderson_darling(hazard, thin)),
        np.sort(curvature(hazard, thin)),
        share * np.sort(hazard[:, 0]),
    )


def thinned(removed: Withdrawals, most: int) -> Withdrawals:
    """Take at most so many failures, each with its share of the withdrawals."""
    if len(removed) <= most:
        return removed
    edges = np.linspace(0, len(removed), most + 1).round().astype(int)
    total = np.concatenate([[0], np.cumsum(removed)])[edges]
    share = total * most / len(removed)
    return tuple(np.diff(share.round().astype(int)).tolist())


def fitted_hazards(
    failures: FloatArray, values: FloatArray, censored: BoolArray | None
) -> FloatArray:
    """Hazards (x / scale)^shape of the failures under the fit to each sample, shape (m, r)."""
    fits = fit_batch(values, censored)
    kept = ~fits.refused
    hazard: FloatArray = (failures[kept] / fits.scale[kept, None]) ** fits.shape[kept, None]
    return hazard


def anderson_darling(hazard: FloatArray, removed: Withdrawals) -> FloatArray:
    """Integrate A^2 in closed form between failures, where F_n = c is constant.

    The integral of (c - u)^2 / (u (1 - u)) is c^2 ln u - (1 - c)^2 ln(1 - u) - u.

    Parameters
    ----------
    hazard : -ln(1 - F) at the failures in rising order, shape (m, r)
    removed : specimens withdrawn after each failure, length r

    Returns
    -------
    A^2, shape (m,)
    """
    n = at_risk(removed)
    c = 1.0 - np.cumprod(1.0 - 1.0 / n)[:-1]
    u = -np.expm1(-hazard)
    log_u = np.log(u)
    rise = c**2 * np.diff(log_u) + (1.0 - c) ** 2 * np.diff(hazard) - np.diff(u)
    total: FloatArray = hazard[:, 0] - u[:, 0] + rise.sum(axis=1)
    if removed[-1] == 0:  # the last one failed too: F_n = 1 from there to F = 1
        total += u[:, -1] - log_u[:, -1] - 1.0
    return float(n[0]) * total


def curvature(hazard: FloatArray, removed: Withdrawals) -> FloatArray:
    """Score of the curvature of the Weibull plot, over sqrt(r); see `goodness.curved`.

    Parameters
    ----------
    hazard : -ln(1 - F) at the failures in rising order, shape (m, r)
    removed : specimens withdrawn after each failure, length r

    Returns
    -------
    the score, shape (m,)
    """
    y = np.log(hazard)
    left = np.asarray(removed, dtype=np.float64) + 1.0
    half_square = 0.5 * y * y
    score: FloatArray = (left * hazard * half_square - half_square - y).sum(axis=1)
    score /= np.sqrt(hazard.shape[1])
    return score
