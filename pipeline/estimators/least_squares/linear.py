"""Weighted linear least squares whose parameters and standard errors are right to 13 digits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.arrays import FloatArray
from deamat.estimators.least_squares.checks import (
    ErrorScale,
    degrees_of_freedom,
    error_sizes,
    finite_array,
    same_length,
)
from deamat.estimators.least_squares.double_double import DoubleDouble
from deamat.estimators.least_squares.fit import Fit, error_variance, weighted_residual_sd
from deamat.estimators.least_squares.refined_qr import Solution, solve


@dataclass(frozen=True, slots=True, kw_only=True)
class LinearFit(Fit):
    """Parameters b of y = X b with their covariance.

    Parameters
    ----------
    parameters : b, shape (p,) `[unit of y / unit of each column]`
    covariance : shape (p, p)
    """

    parameters: FloatArray
    covariance: FloatArray

    @property
    def standard_errors(self) -> FloatArray:
        """Square roots of the diagonal of the covariance, shape (p,)."""
        return np.sqrt(np.diag(self.covariance))


def fit_linear(
    design: ArrayLike,
    y: ArrayLike,
    sigma: ArrayLike | None = None,
    error_scale: ErrorScale = "estimated",
) -> LinearFit:
    r"""Minimise $\sum_i ((y_i - X_i b) / \sigma_i)^2$ over b.

    The design holds every term of the model: a model with an intercept has a column of ones, one
    without has none.

    Parameters
    ----------
    design : X, shape (n, p)
    y : shape (n,)
    sigma : standard deviations, shape (n,) `[unit of y]`; equal ones if not given
    error_scale : whether sigma is known, or only up to a factor that the residuals give

    Raises
    ------
    FitRefused : too few points, values that are not finite, or columns that depend on each other
        (scaled condition number above `refined_qr.CONDITION_LIMIT`, 1e12)

    Source: A. Bjorck, Numerical Methods for Least Squares Problems (SIAM 1996), 2.9.
    """
    x = finite_array("the design", design, 2)
    values = finite_array("y", y)
    n, p = x.shape
    same_length("y", values, n)
    sizes = error_sizes(sigma, n, error_scale)
    dof = degrees_of_freedom(n, p, error_scale)
    solution = solve_weighted(DoubleDouble.exact(x), values, sizes)
    residual_sd = weighted_residual_sd(solution.residuals, dof)
    return LinearFit(
        parameters=solution.parameters.high,
        covariance=error_variance(residual_sd, error_scale) * solution.cofactors.high,
        y=values,
        sigma=sizes,
        residuals=solution.residuals * sizes,
        leverages=solution.leverages,
        residual_sd=residual_sd,
        dof=dof,
        condition_number=solution.condition_number,
        error_scale=error_scale,
    )


def solve_weighted(design: DoubleDouble, y: FloatArray, sigma: FloatArray) -> Solution:
    """Solve rows divided by their sigma, shapes (n, p), (n,) and (n,), without rounding them."""
    if np.all(sigma == 1.0):
        return solve(design, DoubleDouble.exact(y))
    columns = DoubleDouble.exact(np.repeat(sigma[:, None], design.shape[1], axis=1))
    return solve(design / columns, DoubleDouble.exact(y) / DoubleDouble.exact(sigma))
