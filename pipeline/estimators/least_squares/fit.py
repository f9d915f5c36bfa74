"""What every least-squares fit can say of itself, whatever its model."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.estimators.least_squares.checks import ErrorScale


@dataclass(frozen=True, slots=True, kw_only=True)
class Fit:
    r"""Data, residuals and how well the data determine the parameters.

    Parameters
    ----------
    y, sigma : data and their standard deviations (ones where none were given), shape (n,)
    residuals : y - model, shape (n,) `[unit of y]`
    leverages : diagonal of the hat matrix of the weighted problem, shape (n,)
    residual_sd : $\sqrt{\sum_i (r_i / \sigma_i)^2 / (n - p)}$: `[unit of y]` where no sigma was
        given, else `[1]` and near 1 if sigma is right; NaN where n = p
    dof : n - p
    condition_number : of the weighted design or Jacobian with its columns scaled to equal length
    error_scale : `"known"` (covariance from sigma alone) or `"estimated"` (times residual_sd^2)
    """

    y: FloatArray
    sigma: FloatArray
    residuals: FloatArray
    leverages: FloatArray
    residual_sd: float
    dof: int
    condition_number: float
    error_scale: ErrorScale

    @property
    def parameter_count(self) -> int:
        """Number p of fitted parameters."""
        return len(self.y) - self.dof

    @property
    def weighted_residuals(self) -> FloatArray:
        """Residuals over their standard deviations, shape (n,)."""
        return self.residuals / self.sigma

    @property
    def error_variance(self) -> float:
        """What the cofactors are multiplied with to give the covariance."""
        return error_variance(self.residual_sd, self.error_scale)


def error_variance(residual_sd: float, error_scale: ErrorScale) -> float:
    """Return 1 for a known error scale, else the variance of the residuals."""
    return 1.0 if error_scale == "known" else residual_sd**2


def weighted_residual_sd(weighted_residuals: FloatArray, dof: int) -> float:
    """Root of the sum of squares over the degrees of freedom; NaN where there is none."""
    if dof == 0:
        return math.nan
    return math.sqrt(math.fsum(np.square(weighted_residuals)) / dof)
