"""The lowest point of a function of one parameter: a grid, then golden section."""

from __future__ import annotations

import math
from collections.abc import Callable

from deamat.core.arrays import FloatArray

_GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
_NARROW = 1e-9  # of the grid's spacing, where a parabola's minimum is flat to rounding already


def lowest(cost: Callable[[float], float], grid: FloatArray) -> tuple[float, int]:
    """Find the minimum next to the lowest point of a grid.

    Parameters
    ----------
    cost : function of one parameter; may be infinite where it has no meaning
    grid : rising, shape (n,), dense enough for one minimum between neighbours

    Returns
    -------
    the parameter, and the index of the lowest grid point (at either end, the minimum may lie
    outside and the parameter is that grid point)
    """
    points = grid.tolist()
    best = min(range(len(points)), key=lambda i: cost(points[i]))
    if best in (0, len(points) - 1):
        return points[best], best
    low, high = points[best - 1], points[best + 1]
    narrow = _NARROW * (high - low)
    a, b = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_a, at_b = cost(a), cost(b)
    while high - low > narrow:
        if at_a < at_b:
            high, b, at_b = b, a, at_a
            a = high - _GOLDEN * (high - low)
            at_a = cost(a)
        else:
            low, a, at_a = a, b, at_b
            b = low + _GOLDEN * (high - low)
            at_b = cost(b)
    return 0.5 * (low + high), best
