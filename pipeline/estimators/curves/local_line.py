"""What a curve says at one point by its neighbours alone, and which points leave their neighbours.

Neither needs a law: they judge one, and answer where none holds.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from deamat.core.errors import FitRefused
from deamat.estimators.least_squares.checks import finite_array, same_length

# So many standard deviations off its neighbours a point is not noise; of fewer points the scale is
# less well known. Of clean runs of 12 to 100 readings fewer than 0.3 % then have such a point.
_ISOLATED = 6.0
_FEW = 12.0


@dataclass(frozen=True, slots=True)
class Local:
    """A local estimate.

    Parameters
    ----------
    value, standard_uncertainty : of the curve `[unit of y]`
    residual_sd : of a single point about the line `[unit of y]`
    dof : degrees of freedom of both
    """

    value: float
    standard_uncertainty: float
    residual_sd: float
    dof: int


def local_line(x: ArrayLike, y: ArrayLike, at: float, count: int) -> Local:
    r"""Fit a line to the nearest points, weighted by their distance d over that of the next, D.

    $w = (1 - (d / D)^3)^3$; the line's value at the point and its uncertainty from the scatter of
    these points.

    Parameters
    ----------
    x, y : shape (n,)
    at : where
    count : of points to use, 4 to n

    Raises
    ------
    FitRefused : fewer than 4 points, or all of them at one x

    Source: W. S. Cleveland, J. Am. Stat. Assoc. 74 (1979) 829.
    """
    points, values = finite_array("x", x), finite_array("y", y)
    same_length("y", values, len(points))
    if not 4 <= count <= len(points):
        raise FitRefused(f"a local line needs 4 points or more, not {min(count, len(points))}")
    distance = np.abs(points - at)
    order = np.argsort(distance, kind="stable")
    near = order[:count]
    reach = float(distance[order[min(count, len(points) - 1)]])
    if reach == 0 or np.ptp(points[near]) == 0:
        raise FitRefused(f"the {count} nearest points are all at one x")
    reach = max(reach, 1.001 * float(distance[near].max()))
    weight = (1.0 - (distance[near] / reach) ** 3) ** 3
    offset = (points[near] - at) / reach
    design = np.stack([np.ones(count), offset], axis=1)
    root = np.sqrt(weight)
    inverse = np.linalg.pinv(design * root[:, None]) * root
    found = inverse @ values[near]
    residuals = values[near] - design @ found
    dof = count - 2
    sd = math.sqrt(float(residuals @ residuals) / dof)
    return Local(float(found[0]), sd * float(np.linalg.norm(inverse[0])), sd, dof)


def isolated_points(y: ArrayLike, least: float = 0.0, window: int = 7) -> NDArray[np.intp]:
    r"""Find points far off the median of their neighbours, in the order they were taken.

    $|e_i| > 6 (1 + 12 / n) \cdot 1.4826\, \mathrm{med}|e|$ with $e_i = y_i - \mathrm{med}$ of the
    points around i: bubbles, knocks, a lost contact. The first and last point have neighbours on
    one side only and are not judged.

    Parameters
    ----------
    y : without its trend, shape (n,)
    least : |e| that matters `[unit of y]`
    window : of points, odd

    Returns
    -------
    indices, shape (k,); fewer than twice the window of points are not judged at all

    Source: F. R. Hampel, J. Am. Stat. Assoc. 69 (1974) 383.
    """
    values = finite_array("y", y)
    n = len(values)
    if n < window + 4:
        return np.zeros(0, dtype=np.intp)
    around = np.lib.stride_tricks.sliding_window_view(values, window)
    start = np.clip(np.arange(n) - window // 2, 0, n - window)
    off = np.abs(values - np.median(around, axis=1)[start])
    limit = max(least, _ISOLATED * (1.0 + _FEW / n) * 1.4826 * float(np.median(off)))
    off[[0, -1]] = 0.0
    return np.flatnonzero((off > limit) & (off > 0))
