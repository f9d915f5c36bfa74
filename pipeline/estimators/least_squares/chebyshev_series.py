"""Chebyshev series on [-1, 1]: basis, derivative, and where a series is lowest."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev

from deamat.core.arrays import FloatArray


def basis(t: FloatArray, degree: int) -> FloatArray:
    """T_0 to T_degree at t, of the shape of t with one more axis for the degree."""
    # numpy's chebvander gives the same numbers in twice the time
    t = np.asarray(t, dtype=np.float64)
    rows = np.empty((degree + 1, *t.shape))
    rows[0] = 1.0
    if degree:
        rows[1] = t
    for k in range(2, degree + 1):
        rows[k] = 2.0 * t * rows[k - 1] - rows[k - 2]
    return rows.transpose((*range(1, t.ndim + 1), 0))


def derivative(coefficients: FloatArray) -> FloatArray:
    """Coefficients of the derivative by t, shape (p - 1,), or one zero for a constant."""
    return np.asarray(chebyshev.chebder(coefficients), dtype=np.float64)


def evaluate(t: FloatArray, coefficients: FloatArray) -> FloatArray:
    """Values of a series at t, of the shape of t."""
    return np.asarray(chebyshev.chebval(t, coefficients), dtype=np.float64)


def extremes(coefficients: FloatArray) -> FloatArray:
    """List where a series can be lowest or highest: both ends and where its derivative vanishes.

    The roots of the derivative are the eigenvalues of its companion matrix.

    Source: I. J. Good, Q. J. Math. 12 (1961) 61 (colleague matrix).
    """
    ends = np.array([-1.0, 1.0])
    slope = derivative(coefficients)
    largest = float(np.abs(slope).max())
    if largest == 0:
        return ends
    # Leading terms below rounding would only add roots far outside.
    roots = chebyshev.chebroots(chebyshev.chebtrim(slope, 1e-14 * largest))
    # A double root may come out as a complex pair; a point too many does no harm.
    inside = roots.real[(np.abs(roots.imag) < 1e-4) & (np.abs(roots.real) < 1)]
    return np.concatenate([ends, inside])


def lowest(coefficients: FloatArray) -> float:
    """Return the least value of a series on [-1, 1]."""
    return float(np.min(evaluate(extremes(coefficients), coefficients)))
