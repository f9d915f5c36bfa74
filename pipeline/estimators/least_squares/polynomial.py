"""Polynomials by least squares: fitted and evaluated in a Chebyshev basis, reported as raw ones."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange
from deamat.estimators.least_squares.chebyshev_series import basis, derivative, evaluate
from deamat.estimators.least_squares.checks import (
    ErrorScale,
    degrees_of_freedom,
    error_sizes,
    finite_array,
    same_length,
)
from deamat.estimators.least_squares.double_double import DoubleDouble, add, divide, multiply
from deamat.estimators.least_squares.fit import Fit, error_variance, weighted_residual_sd
from deamat.estimators.least_squares.linear import solve_weighted

_EPSILON = float(np.finfo(np.float64).eps)


@dataclass(frozen=True, slots=True, kw_only=True)
class PolynomialFit(Fit):
    r"""A polynomial $y(x) = \sum_k c_k x^k = \sum_k a_k T_k(t)$, $t = (x - m) / h$.

    Raw coefficients of a window far from zero cancel when they are summed up, so values and
    derivatives are taken from the Chebyshev ones.

    Parameters
    ----------
    coefficients : c, lowest order first, shape (p,) `[unit of y / unit of x^k]`
    covariance : of c, shape (p, p)
    chebyshev_coefficients : a, shape (p,) `[unit of y]`
    chebyshev_cofactors : covariance of a for an error variance of one, shape (p, p)
    low, high : range of the fitted x, with m its middle and h half its width
    """

    coefficients: FloatArray
    covariance: FloatArray
    chebyshev_coefficients: FloatArray
    chebyshev_cofactors: FloatArray
    low: float
    high: float

    @property
    def degree(self) -> int:
        """Highest power."""
        return len(self.coefficients) - 1

    @property
    def standard_errors(self) -> FloatArray:
        """Of the raw coefficients, shape (p,)."""
        return np.sqrt(np.diag(self.covariance))

    def __call__(self, x: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return value and standard uncertainty at x, both of the shape of x `[unit of y]`.

        Raises
        ------
        OutOfRange : an x outside [low, high]
        """
        terms = basis(self._standard(x), self.degree)
        cofactor = np.einsum("...i,ij,...j->...", terms, self.chebyshev_cofactors, terms)
        # Where x lie in narrow clusters the terms cancel: what rounding may have eaten is unknown.
        size = np.abs(self.chebyshev_cofactors)
        unknown = _EPSILON * np.einsum("...i,ij,...j->...", np.abs(terms), size, np.abs(terms))
        value = terms @ self.chebyshev_coefficients
        return value, np.sqrt(self.error_variance * (np.maximum(cofactor, 0.0) + unknown))

    def derivative(self, x: ArrayLike) -> FloatArray:
        """Return dy/dx at x, of the shape of x.

        Raises
        ------
        OutOfRange : an x outside [low, high]
        """
        slopes = derivative(self.chebyshev_coefficients) / half_width(self.low, self.high)
        return evaluate(self._standard(x), slopes)

    def _standard(self, x: ArrayLike) -> FloatArray:
        """Map x to t in [-1, 1], refusing what lies outside the window."""
        points = np.asarray(x, dtype=np.float64)
        inside = (points >= self.low) & (points <= self.high)
        if not inside.all():
            found = float(points[~inside].flat[0])
            raise OutOfRange(
                f"the polynomial holds from {self.low:g} to {self.high:g}, not {found}"
            )
        t = (points - middle(self.low, self.high)) / half_width(self.low, self.high)
        return np.asarray(np.clip(t, -1.0, 1.0))


def fit_polynomial(
    x: ArrayLike,
    y: ArrayLike,
    degree: int,
    sigma: ArrayLike | None = None,
    error_scale: ErrorScale = "estimated",
) -> PolynomialFit:
    r"""Minimise $\sum_i ((y_i - \sum_k c_k x_i^k) / \sigma_i)^2$ over c.

    Basis, solution and the change to raw coefficients are in double-double arithmetic, so the raw
    coefficients and their standard errors are those of the exact solution for the given floats.

    Parameters
    ----------
    x, y : shape (n,)
    degree : 0 or more; needs that many distinct x and one more
    sigma, error_scale : as in `fit_linear`

    Raises
    ------
    FitRefused : a negative degree, too few distinct x or points, values that are not finite, or x
        in clusters so narrow that the basis is rank-deficient (condition above 1e12)

    Source: A. Bjorck, Numerical Methods for Least Squares Problems (SIAM 1996), 2.9 and 8.2.
    """
    points, values = finite_array("x", x), finite_array("y", y)
    same_length("y", values, len(points))
    if degree < 0:
        raise FitRefused(f"the degree of a polynomial is 0 or more, not {degree}")
    sizes = error_sizes(sigma, len(points), error_scale)
    dof = degrees_of_freedom(len(points), degree + 1, error_scale)
    distinct = len(np.unique(points))
    if distinct <= degree:
        raise FitRefused(
            f"degree {degree} needs at least {degree + 1} distinct x, not {distinct}",
            {"degree": degree, "distinct": distinct},
        )
    low, high = float(points.min()), float(points.max())
    solution = solve_weighted(chebyshev_design(points, low, high, degree), values, sizes)
    to_raw = raw_from_chebyshev(low, high, degree)
    residual_sd = weighted_residual_sd(solution.residuals, dof)
    factor = error_variance(residual_sd, error_scale)
    return PolynomialFit(
        coefficients=_times(to_raw, solution.parameters),
        covariance=factor * (to_raw @ solution.cofactors @ to_raw.transposed).high,
        chebyshev_coefficients=solution.parameters.high,
        chebyshev_cofactors=solution.cofactors.high,
        low=low,
        high=high,
        y=values,
        sigma=sizes,
        residuals=solution.residuals * sizes,
        leverages=solution.leverages,
        residual_sd=residual_sd,
        dof=dof,
        condition_number=solution.condition_number,
        error_scale=error_scale,
    )


def with_chebyshev_coefficients(
    fit: PolynomialFit, coefficients: FloatArray, x: FloatArray
) -> PolynomialFit:
    """Put other Chebyshev coefficients, shape (p,), in the place of a fit's own; x as fitted."""
    to_raw = raw_from_chebyshev(fit.low, fit.high, fit.degree)
    moved = replace(
        fit,
        coefficients=_times(to_raw, DoubleDouble.exact(coefficients)),
        chebyshev_coefficients=coefficients,
    )
    return replace(moved, residuals=fit.y - moved(x)[0])


def middle(low: float, high: float) -> float:
    """Middle of the window, as a float that the basis takes as exact."""
    return 0.5 * (low + high)


def half_width(low: float, high: float) -> float:
    """Half the width of the window, as a float that the basis takes as exact; 1 for one point."""
    return 0.5 * (high - low) if high > low else 1.0


def chebyshev_design(x: FloatArray, low: float, high: float, degree: int) -> DoubleDouble:
    """T_0 to T_degree at x, shape (n, degree + 1), right to about 30 digits."""
    m = DoubleDouble.exact(np.full_like(x, middle(low, high)))
    h = DoubleDouble.exact(np.full_like(x, half_width(low, high)))
    t = (DoubleDouble.exact(x) - m) / h
    twice = DoubleDouble(2.0 * t.high, 2.0 * t.low)
    columns = [DoubleDouble.exact(np.ones_like(x)), t]
    while len(columns) <= degree:
        columns.append(twice * columns[-1] - columns[-2])
    return DoubleDouble(
        np.stack([c.high for c in columns[: degree + 1]], axis=1),
        np.stack([c.low for c in columns[: degree + 1]], axis=1),
    )


def raw_from_chebyshev(low: float, high: float, degree: int) -> DoubleDouble:
    """Matrix M, shape (p, p), of c = M a: column k holds T_k((x - m) / h) in powers of x."""
    slope = divide((2.0, 0.0), (half_width(low, high), 0.0))
    offset = multiply(slope, (-middle(low, high), 0.0))
    zero = (0.0, 0.0)
    below = [(1.0, 0.0)] + [zero] * degree
    columns = [below]
    if degree:
        # T_1 is half of what the recurrence 2 t T_k - T_{k-1} makes of T_0.
        columns.append([(0.5 * u, 0.5 * v) for u, v in (offset, slope)] + [zero] * (degree - 1))
    while len(columns) <= degree:
        k = len(columns)
        last, before = columns[-1], columns[-2]
        column = [zero] * (degree + 1)
        for power in range(k + 1):
            term = multiply(offset, last[power])
            if power:
                term = add(term, multiply(slope, last[power - 1]))
            column[power] = add(term, (-before[power][0], -before[power][1]))
        columns.append(column)
    matrix = np.array(columns)  # (column, row, part)
    return DoubleDouble(matrix[:, :, 0].T.copy(), matrix[:, :, 1].T.copy())


def _times(matrix: DoubleDouble, vector: DoubleDouble) -> FloatArray:
    """Multiply shapes (p, p) and (p,) and round once."""
    column = DoubleDouble(vector.high[:, None], vector.low[:, None])
    return (matrix @ column).high[:, 0]
