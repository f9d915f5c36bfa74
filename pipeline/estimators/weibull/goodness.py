"""Does the Weibull form fit, and is the weakest specimen too weak for it? Nothing is ever deleted.

Both statistics are computed after fitting and compared with simulated samples of the same size and
censoring, drawn with a fixed seed and kept: the same question gets the same answer. A large p-value
proves little: with 20 specimens a lognormal truth is told from a Weibull in one sample of five.

Source: Anderson and Darling, J. Am. Stat. Assoc. 49 (1954) 765-769; Pettitt and Stephens,
Biometrika 63 (1976) 291-298 for censored samples.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.arrays import FloatArray
from deamat.estimators.weibull.fit import fit, fit_batch
from deamat.estimators.weibull.sample import as_arrays
from deamat.estimators.weibull.simulate import (
    Withdrawals,
    at_risk,
    standard_samples,
    withdrawals,
)

_DRAWS = 10_000  # a p-value of 0.05 is good to 0.002
_FEWEST_DRAWS = 1_000
_MOST_VALUES = 1_000_000
_SEED = 62539


@dataclass(frozen=True, slots=True)
class GoodnessOfFit:
    """How far a sample lies from its own Weibull fit.

    Parameters
    ----------
    statistic : Anderson-Darling A^2, up to the last failure
    p_value : fraction of Weibull samples that lie at least as far
    draws : simulated samples behind the p-value
    exact : False when the censoring makes the simulation an approximation
    """

    statistic: float
    p_value: float
    draws: int
    exact: bool


@dataclass(frozen=True, slots=True)
class LowOutlier:
    """Whether the lowest failure is too low for the Weibull fitted to all.

    Parameters
    ----------
    index : place of the lowest failure in the sample, from 0
    value : the lowest failure `[unit of x]`
    hazard : (value / scale)^shape, the statistic
    p_value : fraction of Weibull samples whose lowest failure has at most this hazard
    found : whether the p-value is below the level asked for
    exact : False when the censoring makes the simulation an approximation
    """

    index: int
    value: float
    hazard: float
    p_value: float
    found: bool
    exact: bool


def goodness_of_fit(x: ArrayLike, censored: ArrayLike | None = None) -> GoodnessOfFit:
    """Test the Weibull form by the Anderson-Darling statistic with fitted parameters.

    A^2 = n integral (F_n - F)^2 / (F (1 - F)) dF, with F_n the product-limit estimate.

    Parameters
    ----------
    x, censored : as for `weibull.fit`, shape (n,)

    Raises
    ------
    FitRefused : as `weibull.fit`
    """
    best = fit(x, censored)
    values, failed = as_arrays(x, censored, ndim=1)
    removed = withdrawals(values, failed)
    hazard = (np.sort(values[failed]) / best.scale) ** best.shape
    statistic = anderson_darling(hazard[None, :], removed).item()
    reference, _ = _reference(removed)
    beyond = reference.size - int(np.searchsorted(reference, statistic))
    return GoodnessOfFit(
        statistic,
        (1 + beyond) / (1 + reference.size),
        reference.size,
        best.censoring != "type I or random",
    )


def low_outlier(x: ArrayLike, censored: ArrayLike | None = None, level: float = 0.05) -> LowOutlier:
    """Test whether the lowest failure is too low; it stays in the sample all the same.

    The statistic is its hazard (x_1 / scale)^shape under the fit to all; of those tried (Dixon
    ratios, gaps, fits without the lowest) none found more. One specimen of 20 at half strength
    (shape 8) is found in 36 % of samples at level 0.05, where knowing the true parameters would
    give 51 %; one at 0.3 in 97 %. Two low ones mask each other: look at the goodness of fit too.

    Parameters
    ----------
    x, censored : as for `weibull.fit`, shape (n,)
    level : rate of false alarms

    Raises
    ------
    FitRefused : as `weibull.fit`
    """
    best = fit(x, censored)
    values, failed = as_arrays(x, censored, ndim=1)
    index = int(np.argmin(np.where(failed, values, np.inf)))
    hazard = float((values[index] / best.scale) ** best.shape)
    _, reference = _reference(withdrawals(values, failed))
    as_low = int(np.searchsorted(reference, hazard, side="right"))
    p_value = (1 + as_low) / (1 + reference.size)
    return LowOutlier(
        index,
        float(values[index]),
        hazard,
        p_value,
        p_value < level,
        best.censoring != "type I or random",
    )


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


@lru_cache(maxsize=64)
def _reference(removed: Withdrawals) -> tuple[FloatArray, FloatArray]:
    """Sorted A^2 and lowest hazards of simulated Weibull samples."""
    n = int(at_risk(removed)[0])
    draws = min(_DRAWS, max(_FEWEST_DRAWS, _MOST_VALUES // n))
    failures, values, censored = standard_samples(removed, draws, _SEED)
    fits = fit_batch(values, censored)
    fitted = ~fits.refused
    hazard = (failures[fitted] / fits.scale[fitted, None]) ** fits.shape[fitted, None]
    return np.sort(anderson_darling(hazard, removed)), np.sort(hazard[:, 0])
