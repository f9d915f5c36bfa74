"""Least squares by QR, refined with double-double residuals until only the data round.

A float QR solves the problem to about kappa * 1e-16. Its answer is then improved on the augmented
system, parameters and cofactors together:

    [ I    A ] [ U ]   [ F ]       F = [ f  0 ]    the answer: B = [ b   (A^T A)^-1 ]
    [ A^T  0 ] [ B ] = [ G ]       G = [ 0 -I ]                U = [ f - A b   ...  ]

with residuals in 106 bits and corrections from the float QR, each step gaining a factor
1 / (kappa * 1e-16). So the standard errors are as good as the parameters, and no normal matrix is
formed or inverted.

Source: A. Bjorck, BIT 7 (1967) 257 and 8 (1968) 8; J. Demmel et al., ACM Trans. Math. Softw. 35
(2009) 28.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.least_squares.checks import scaled_condition
from deamat.estimators.least_squares.double_double import DoubleDouble

# Of the design with its columns scaled to equal length. Beyond it data that are right to 16 digits
# leave fewer than 4 in the parameters, whatever the arithmetic.
CONDITION_LIMIT = 1e12
_ENOUGH = 1e-26  # relative error at which refinement stops: ten digits beyond a float
_BELOW_THE_DATA = 1e-18  # a standstill here is harmless: the rounding of the data is larger
_MOST_STEPS = 12


@dataclass(frozen=True, slots=True)
class Solution:
    """What minimises |f - A b|.

    Parameters
    ----------
    parameters : b, shape (p,)
    cofactors : (A^T A)^-1, shape (p, p); times the error variance it is the covariance of b
    residuals : f - A b, shape (n,)
    leverages : diagonal of the hat matrix A (A^T A)^-1 A^T, shape (n,)
    condition_number : 2-norm condition of A with its columns scaled to equal length
    """

    parameters: DoubleDouble
    cofactors: DoubleDouble
    residuals: FloatArray
    leverages: FloatArray
    condition_number: float


def solve(design: DoubleDouble, rhs: DoubleDouble) -> Solution:
    """Minimise |f - A b| over b, with the cofactor matrix, both right to the last bit of a float.

    Parameters
    ----------
    design : A, shape (n, p)
    rhs : f, shape (n,)

    Raises
    ------
    FitRefused : fewer rows than columns, or columns that depend on each other
    """
    rows, columns = design.shape
    if rows < columns:
        raise FitRefused(
            f"{columns} parameters need at least {columns} points, not {rows}",
            {"points": rows, "parameters": columns},
        )
    scale = _column_scale(design.high)
    scaled = DoubleDouble(design.high * scale, design.low * scale)
    q, r = np.linalg.qr(scaled.high)
    condition = _condition_number(r)
    b, u = _refine(scaled, rhs, q, r)
    both = np.concatenate([[1.0], scale])
    b = DoubleDouble(scale[:, None] * b.high * both, scale[:, None] * b.low * both)
    return Solution(
        parameters=b[:, 0],
        cofactors=b[:, 1:],
        residuals=u.high[:, 0] + u.low[:, 0],
        leverages=np.einsum("ij,ij->i", q, q),
        condition_number=condition,
    )


def _column_scale(design: FloatArray) -> FloatArray:
    """Powers of two that bring every column to a length near one: scaling without rounding."""
    # Largest entry first, so that the squares neither overflow nor vanish.
    largest = np.abs(design).max(axis=0)
    if not np.all(largest > 0):
        empty = int(np.flatnonzero(~(largest > 0))[0])
        raise FitRefused(f"column {empty} of the design is zero: its parameter is not determined")
    length = largest * np.sqrt(np.square(design / largest).sum(axis=0))
    return np.asarray(np.ldexp(1.0, -np.frexp(length)[1]), dtype=np.float64)


def _condition_number(r: FloatArray) -> float:
    """Condition of the scaled design, refused beyond `CONDITION_LIMIT`."""
    condition = scaled_condition(r)
    if condition > CONDITION_LIMIT:
        raise FitRefused(
            f"the columns of the design depend on each other: condition number {condition:.1e}, "
            f"at most {CONDITION_LIMIT:.0e} is accepted; leave a parameter out or spread the data",
            {"condition_number": condition, "limit": CONDITION_LIMIT},
        )
    return condition


def _refine(
    a: DoubleDouble, f: DoubleDouble, q: FloatArray, r: FloatArray
) -> tuple[DoubleDouble, DoubleDouble]:
    """Iterate the augmented system to B, shape (p, 1 + p), and U, shape (n, 1 + p)."""
    n, p = a.shape
    top = np.zeros((n, 1 + p))
    bottom = np.zeros((p, 1 + p))
    bottom[:, 1:] = -np.eye(p)
    r_inverse = np.linalg.solve(r, np.eye(p))
    f_all = DoubleDouble(top.copy(), top.copy())
    f_all.high[:, 0], f_all.low[:, 0] = f.high, f.low
    g_all = DoubleDouble.exact(bottom)
    u, b = DoubleDouble.exact(top), DoubleDouble.exact(np.zeros((p, 1 + p)))
    at = a.transposed
    above, below = f_all.high, bottom  # residuals of U = 0, B = 0
    step, previous, first = 1.0, 1.0, True
    for _ in range(_MOST_STEPS):
        inner = q.T @ above - r_inverse.T @ below
        u = u + DoubleDouble.exact(above - q @ inner)
        b = b + DoubleDouble.exact(r_inverse @ inner)
        step = _relative_size(inner, r @ b.high)
        if step * step / previous <= _ENOUGH:  # the change that the next step would bring
            return b, u
        if step > 0.5 * previous and not first:
            if step < _BELOW_THE_DATA:
                return b, u
            break
        previous, first = step, False
        above = (f_all - u - a @ b).high
        below = (g_all - at @ u).high
    raise FitRefused(
        f"refinement of the least-squares solution did not converge (last change {step:.1e}); "
        "the columns of the design nearly depend on each other",
        {"last_change": step},
    )


def _relative_size(change: FloatArray, value: FloatArray) -> float:
    """Largest change of a column against the column itself, both in the metric of the fit."""
    size = np.sqrt(np.square(value).sum(axis=0))
    moved = np.sqrt(np.square(change).sum(axis=0))
    return float(np.max(moved[size > 0] / size[size > 0], initial=0.0))
