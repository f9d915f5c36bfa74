"""Does a law miss the shape of its data, and do some points lie far off the others? Two flags."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import ndtr

from deamat.estimators.least_squares.checks import finite_array, same_length
from deamat.estimators.least_squares.fit import Fit

_FAR = 6.0  # standard deviations
_ROUNDING = 1e-20  # part of the data's squares that arithmetic alone leaves; it has no pattern


@dataclass(frozen=True, slots=True)
class Runs:
    """How neighbouring residuals differ.

    Parameters
    ----------
    ratio : von Neumann's, mean squared difference of neighbours over mean square: 2 for noise
    p_value : of a ratio as low, were the residuals independent
    found : whether the p-value is below the level asked for
    """

    ratio: float
    p_value: float
    found: bool


def residual_runs(x: ArrayLike, fit: Fit, level: float = 0.05) -> Runs:
    r"""Test whether the residuals of a fit follow each other along x: a law too stiff, or drift.

    $d = \sum (r_{i+1} - r_i)^2 / \sum r_i^2$ of the weighted residuals has mean 2 and variance
    $4 (n - 2) / (n^2 - 1)$ if they are independent. Fitting raises d a little, so that sound fits
    are accused less often than the level says.

    Parameters
    ----------
    x : what the residuals are ordered by, shape (n,)
    fit : any fit of n points
    level : rate of false alarms

    Raises
    ------
    FitRefused : x of another length, or not finite

    Source: J. von Neumann, Ann. Math. Stat. 12 (1941) 367.
    """
    points = finite_array("x", x)
    same_length("x", points, len(fit.y))
    residuals = fit.weighted_residuals[np.argsort(points, kind="stable")]
    n = len(residuals)
    squares = float(residuals @ residuals)
    if n < 4 or squares <= _ROUNDING * float(np.square(fit.y / fit.sigma).sum()):
        return Runs(2.0, 1.0, found=False)
    ratio = float(np.square(np.diff(residuals)).sum()) / squares
    p_value = float(ndtr((ratio - 2.0) / math.sqrt(4.0 * (n - 2) / (n * n - 1.0))))
    return Runs(ratio, p_value, p_value < level)


def outlying_points(fit: Fit) -> NDArray[np.intp]:
    r"""Find points far off a fit: standardised residuals beyond 6 deviations of their majority.

    $|r_i| / (\sigma_i \sqrt{1 - h_i})$ with the leverages h, over 1.4826 times its median. A point
    with a leverage of 1 has no residual and cannot be found.

    Parameters
    ----------
    fit : any fit of n points with more points than parameters

    Returns
    -------
    indices, shape (k,); nothing is ever removed
    """
    free = np.sqrt(np.maximum(1.0 - fit.leverages, 1e-10))
    off = np.abs(fit.weighted_residuals) / free
    rounding = math.sqrt(_ROUNDING) * float(np.abs(fit.y / fit.sigma).max())
    return np.flatnonzero(off > _FAR * max(1.4826 * float(np.median(off)), rounding))
