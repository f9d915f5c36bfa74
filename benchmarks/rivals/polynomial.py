"""Other ways to fit a polynomial, for charts of what they lose and as an oracle in tests.

No technique uses them. Each returns raw coefficients, lowest order first, and their standard
errors (error scale estimated from the residuals).
"""

from __future__ import annotations

import math
import warnings
from fractions import Fraction

import numpy as np

from deamat.core.arrays import FloatArray


def numpy_polyfit(x: FloatArray, y: FloatArray, degree: int) -> tuple[FloatArray, FloatArray]:
    """Fit by `numpy.polyfit`: scaled Vandermonde columns, singular values cut, inverted normals."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", np.exceptions.RankWarning)
        coefficients, covariance = np.polyfit(x, y, degree, cov=True)
    return coefficients[::-1], np.sqrt(np.diag(covariance))[::-1]


def raw_normal_equations(
    x: FloatArray, y: FloatArray, degree: int
) -> tuple[FloatArray, FloatArray]:
    """Fit by the normal equations of the raw Vandermonde matrix, as textbooks write them."""
    design = np.vander(x, degree + 1, increasing=True)
    inverse = np.linalg.inv(design.T @ design)
    coefficients = inverse @ (design.T @ y)
    return coefficients, _standard_errors(y - design @ coefficients, np.diag(inverse), degree)


def scaled_qr(x: FloatArray, y: FloatArray, degree: int) -> tuple[FloatArray, FloatArray]:
    """Fit by the QR of the raw Vandermonde matrix with its columns scaled to unit length."""
    design = np.vander(x, degree + 1, increasing=True)
    lengths = np.sqrt(np.square(design).sum(axis=0))
    q, r = np.linalg.qr(design / lengths)
    coefficients = np.linalg.solve(r, q.T @ y) / lengths
    diagonal = np.square(np.linalg.inv(r)).sum(axis=1) / np.square(lengths)
    return coefficients, _standard_errors(y - design @ coefficients, diagonal, degree)


def exact_rationals(x: FloatArray, y: FloatArray, degree: int) -> tuple[FloatArray, FloatArray]:
    """Fit by the normal equations in rational numbers: no rounding until the answer is printed."""
    p = degree + 1
    points = [Fraction(float(v)) for v in x]
    values = [Fraction(float(v)) for v in y]
    moments = [sum((v**k for v in points), Fraction(0)) for k in range(2 * p - 1)]
    sides = [
        sum((v**k * w for v, w in zip(points, values, strict=True)), Fraction(0)) for k in range(p)
    ]
    rows = [
        [moments[i + j] for j in range(p)] + [sides[i]] + [Fraction(int(i == j)) for j in range(p)]
        for i in range(p)
    ]
    solved = _gauss_jordan(rows)
    coefficients = [row[p] for row in solved]
    squares = Fraction(0)
    for v, w in zip(points, values, strict=True):
        squares += (w - sum((c * v**k for k, c in enumerate(coefficients)), Fraction(0))) ** 2
    variance = squares / (len(points) - p)
    errors = [_root(variance * row[p + 1 + i]) for i, row in enumerate(solved)]
    return np.array([float(c) for c in coefficients]), np.array(errors)


def _gauss_jordan(rows: list[list[Fraction]]) -> list[list[Fraction]]:
    """Bring the left square of the rows to the identity; exact, so any pivot but zero will do."""
    for i in range(len(rows)):
        pivot = next(k for k in range(i, len(rows)) if rows[k][i])
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [v / rows[i][i] for v in rows[i]]
        for k in range(len(rows)):
            if k != i and rows[k][i]:
                factor = rows[k][i]
                rows[k] = [a - factor * b for a, b in zip(rows[k], rows[i], strict=True)]
    return rows


def _root(value: Fraction) -> float:
    """Square root of a rational, right to the last bit or so whatever its size."""
    shift = 2 * (60 - (value.numerator.bit_length() - value.denominator.bit_length()) // 2)
    scaled = value * Fraction(2) ** shift
    return math.ldexp(math.isqrt(int(scaled)), -shift // 2)


def _standard_errors(residuals: FloatArray, cofactors: FloatArray, degree: int) -> FloatArray:
    """Scale the diagonal of the cofactors by the residual variance; NaN for a negative one."""
    variance = float(residuals @ residuals) / (len(residuals) - degree - 1)
    with np.errstate(invalid="ignore"):
        return np.sqrt(variance * cofactors)
