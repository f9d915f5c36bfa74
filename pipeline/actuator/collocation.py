"""Gauss-Legendre points on a strip of unit length, and exact integration of polynomials there.

A function is known by its values at N points, or by the N coefficients of its Legendre series;
integrals are exact up to degree N - 1, so smooth shapes converge faster than any power of N.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre

from deamat.core.arrays import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """Points `t` from root (0) to tip (1), and the matrices that act on values there.

    Parameters
    ----------
    points, weights : of Gauss-Legendre quadrature on 0..1, shape (N,)
    to_series : values to Legendre coefficients, shape (N, N)
    sag : `f` to `int_0^t int_u^1 f`, the answer of `-y'' = f, y(0) = 0, y'(1) = 0`, shape (N, N)
    from_root : `f` to `int_0^t f`, shape (N, N)
    """

    points: FloatArray
    weights: FloatArray
    to_series: FloatArray
    sag: FloatArray
    from_root: FloatArray


@lru_cache(maxsize=32)
def grid(n: int) -> Grid:
    """Build the grid of `n` points; built once, as it depends on nothing else."""
    nodes, weights = legendre.leggauss(n)
    to_series = (np.arange(n) + 0.5)[:, None] * legendre.legvander(nodes, n - 1).T * weights
    # Half the interval per integration: the series live on -1..1, the strip on 0..1
    above = -0.5 * legendre.legint(to_series, lbnd=1)
    return Grid(
        points=0.5 * (1.0 + nodes),
        weights=0.5 * weights,
        to_series=to_series,
        sag=legendre.legvander(nodes, n + 1) @ (0.5 * legendre.legint(above, lbnd=-1)),
        from_root=legendre.legvander(nodes, n) @ (0.5 * legendre.legint(to_series, lbnd=-1)),
    )


def on_grid(series: FloatArray, n: int) -> FloatArray:
    """Evaluate Legendre series `(..., N)` at the points of `grid(n)`, giving `(..., n)`."""
    return series @ _legendre(n, series.shape[-1]).T


@lru_cache(maxsize=64)
def _legendre(n: int, degrees: int) -> FloatArray:
    return np.asarray(legendre.legvander(2.0 * grid(n).points - 1.0, degrees - 1))


def evaluate(series: FloatArray, points: FloatArray) -> FloatArray:
    """Evaluate Legendre series `(..., N)` at points on 0..1, giving `(..., points)`."""
    return series @ legendre.legvander(2.0 * points - 1.0, series.shape[-1] - 1).T


def integral(series: FloatArray) -> FloatArray:
    """Integrate Legendre series `(..., N)` from the root, giving `(..., N + 1)`."""
    return np.asarray(0.5 * legendre.legint(series, lbnd=-1, axis=-1), np.float64)
