"""What every least-squares estimator asks of its data before it starts."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused

# "known": sigma are the standard deviations of the data. "estimated": sigma are known up to a
# common factor, which the residuals give.
ErrorScale = Literal["known", "estimated"]


def finite_array(name: str, values: ArrayLike, dimensions: int = 1) -> FloatArray:
    """Take values as floats of the wanted number of dimensions.

    Raises
    ------
    FitRefused : another shape, no values, or one that is not finite
    """
    array = np.asarray(values, dtype=np.float64)
    if array.ndim != dimensions or array.size == 0:
        raise FitRefused(
            f"{name} must have {dimensions} dimension{'s' * (dimensions > 1)} and hold values, "
            f"not the shape {array.shape}"
        )
    wrong = ~np.isfinite(array)
    if wrong.any():
        first = tuple(int(i) for i in np.argwhere(wrong)[0])
        raise FitRefused(
            f"{name} must be finite, not {array[first]} at {', '.join(map(str, first))}"
        )
    return array


def same_length(name: str, array: FloatArray, n: int, of: str = "points") -> None:
    """Refuse an array whose first dimension is not n."""
    if len(array) != n:
        raise FitRefused(f"{name} holds {len(array)} values for {n} {of}")


def error_sizes(sigma: ArrayLike | None, n: int, error_scale: ErrorScale) -> FloatArray:
    """Return the standard deviation of every point, shape (n,); ones where none is stated.

    Raises
    ------
    FitRefused : not n positive values, or a known scale without values
    """
    if sigma is None:
        if error_scale == "known":
            raise FitRefused("a known error scale needs sigma, the standard deviations")
        return np.ones(n)
    sizes = finite_array("sigma", sigma)
    same_length("sigma", sizes, n)
    if not np.all(sizes > 0):
        first = int(np.flatnonzero(~(sizes > 0))[0])
        raise FitRefused(f"sigma must be positive, not {sizes[first]} at {first}")
    return sizes


def degrees_of_freedom(n: int, p: int, error_scale: ErrorScale) -> int:
    """Count n - p, which the residuals need to be positive where they give the error scale.

    Raises
    ------
    FitRefused : too few points
    """
    least = p if error_scale == "known" else p + 1
    if n < least:
        raise FitRefused(
            f"{p} parameters need at least {least} points, not {n}"
            + (" (one more than parameters, to estimate the error)" if least > p else ""),
            {"points": n, "parameters": p},
        )
    return n - p


def scaled_condition(columns: FloatArray) -> float:
    """Return the condition number of a matrix whose columns are scaled to length one `[1]`."""
    lengths = np.sqrt(np.square(columns).sum(axis=0))
    singular = np.linalg.svd(columns / lengths, compute_uv=False)
    return float(singular[0] / singular[-1]) if singular[-1] > 0 else float("inf")
