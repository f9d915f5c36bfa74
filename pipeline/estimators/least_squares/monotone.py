"""Polynomials that may not fall: the unconstrained fit if it obeys, else the nearest that does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.least_squares.chebyshev_series import (
    basis,
    derivative,
    evaluate,
    extremes,
    lowest,
)
from deamat.estimators.least_squares.checks import ErrorScale
from deamat.estimators.least_squares.polynomial import (
    PolynomialFit,
    fit_polynomial,
    half_width,
    middle,
    with_chebyshev_coefficients,
)

# Constraints are held this far inside, relative to the largest value: what the exchange leaves
# between its points then still has a slope of zero or more.
_MARGIN = 1e-9
_MOST_EXCHANGES = 60
_NOWHERE = np.zeros(0)


@dataclass(frozen=True, slots=True)
class NonDecreasingFit:
    """A polynomial with y >= floor and dy/dx >= 0 on its window.

    Parameters
    ----------
    fit : the polynomial to use. Its cofactors, residual_sd and leverages are those of the
        unconstrained fit, which bound its errors from above: moving to the nearest admissible
        polynomial never moves away from an admissible truth
    unconstrained : the plain least-squares polynomial; the same object where it obeys
    touching : x at which the slope is held at zero, rising; empty where it obeys
    at_floor : whether y(low) is held at the floor
    """

    fit: PolynomialFit
    unconstrained: PolynomialFit
    touching: tuple[float, ...]
    at_floor: bool

    @property
    def active(self) -> bool:
        """Whether the constraint moved the answer: the data alone say something else."""
        return bool(self.touching) or self.at_floor


def fit_non_decreasing(
    x: ArrayLike,
    y: ArrayLike,
    degree: int,
    floor: float,
    sigma: ArrayLike | None = None,
    error_scale: ErrorScale = "estimated",
) -> NonDecreasingFit:
    r"""Minimise the weighted squares of `fit_polynomial` subject to y >= floor and dy/dx >= 0.

    Where the plain fit disobeys, the slope is held at the points where it is lowest, found exactly
    from the roots of the second derivative, until it is nowhere negative: an exchange over
    least-distance problems.

    Parameters
    ----------
    x, y, degree, sigma, error_scale : as in `fit_polynomial`
    floor : least value allowed anywhere in the window; a little above 0 for a law that must be
        positive `[unit of y]`

    Raises
    ------
    FitRefused : as in `fit_polynomial`, or an exchange that does not end

    Source: C. L. Lawson, R. J. Hanson, Solving Least Squares Problems (SIAM 1995), chapter 23.
    """
    if not np.isfinite(floor):
        raise FitRefused(f"the floor must be finite, not {floor}")
    plain = fit_polynomial(x, y, degree, sigma, error_scale)
    if is_non_decreasing(plain) and float(plain(plain.low)[0]) >= floor:
        return NonDecreasingFit(plain, plain, (), False)
    coefficients, touching, at_floor = _exchange(plain, floor)
    points = middle(plain.low, plain.high) + half_width(plain.low, plain.high) * touching
    return NonDecreasingFit(
        fit=with_chebyshev_coefficients(plain, coefficients, np.asarray(x, dtype=np.float64)),
        unconstrained=plain,
        touching=tuple(float(v) for v in np.clip(np.sort(points), plain.low, plain.high)),
        at_floor=at_floor,
    )


def is_non_decreasing(fit: PolynomialFit) -> bool:
    """Tell whether dy/dx >= 0 on the whole window, from its exact minima."""
    return lowest(derivative(fit.chebyshev_coefficients)) >= 0


def _exchange(plain: PolynomialFit, floor: float) -> tuple[FloatArray, FloatArray, bool]:
    """Hold the slope where it is lowest, solve, look again: coefficients, touching t, at floor."""
    best = plain.chebyshev_coefficients
    try:
        root = np.linalg.cholesky(plain.chebyshev_cofactors)
    except np.linalg.LinAlgError:
        raise FitRefused(
            f"x hardly determine a polynomial of degree {plain.degree} (condition number "
            f"{plain.condition_number:.1e}), so that it cannot be held to a shape; lower the degree"
        ) from None
    margin = _MARGIN * max(float(np.abs(plain.y).max()), abs(floor))
    units = np.eye(plain.degree + 1)
    at_low = basis(np.array([-1.0]), plain.degree)
    # A constant has no slope to hold: its only constraint is the floor.
    points = np.cos(np.pi * np.linspace(0, 1, 2 * plain.degree + 1)) if plain.degree else _NOWHERE
    for _ in range(_MOST_EXCHANGES):
        slopes = np.stack([evaluate(points, derivative(unit)) for unit in units], axis=1)
        rows = np.concatenate([slopes, at_low])
        bounds = np.concatenate([np.full(len(points), margin), [floor + margin]])
        step = _least_distance(rows @ root, bounds - rows @ best)
        coefficients = best + root @ step
        slope = derivative(coefficients)
        where = extremes(slope)
        slopes_there = evaluate(where, slope)
        if np.all(slopes_there >= 0):
            at_floor = float((at_low @ coefficients)[0]) <= floor + 2 * margin
            return coefficients, where[slopes_there <= 2 * margin], at_floor
        points = np.union1d(points, where[slopes_there < 0])
    raise FitRefused(
        f"no non-decreasing polynomial of degree {plain.degree} was found in {_MOST_EXCHANGES} "
        "exchanges; lower the degree"
    )


def _least_distance(rows: FloatArray, bounds: FloatArray) -> FloatArray:
    """Find the shortest z with rows @ z >= bounds, shapes (m, p) and (m,)."""
    from scipy.optimize import nnls

    lengths = np.sqrt(np.square(rows).sum(axis=1))
    lengths[lengths == 0] = 1.0
    size = float(np.abs(bounds / lengths).max())
    system = np.concatenate([rows.T / lengths, [bounds / lengths / size]])
    target = np.zeros(len(system))
    target[-1] = 1.0
    try:
        multipliers, _ = nnls(system, target)
    except RuntimeError as error:
        raise FitRefused(f"the constrained fit did not end: {error}; lower the degree") from error
    rest = system @ multipliers - target
    return np.asarray(-size * rest[:-1] / rest[-1])
