"""Contact stiffness at peak load from the unloading of an indentation."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.curves.contact import independent_samples, standard_errors
from deamat.estimators.curves.search import lowest

# of the load: 1 is a flat punch, 1/2 a pyramid; noise must not reach the ends
_EXPONENTS = np.linspace(0.3, 1.05, 76)


@dataclass(frozen=True, slots=True)
class Unloading:
    """The unloading curve `h = h_f + C P^q` and its slope at peak load.

    Parameters
    ----------
    stiffness : S = dP/dh at peak load `[N/m]`
    u_stiffness : its standard error `[N/m]`
    peak_load, peak_depth : the load, and the depth of the fitted curve at it `[N]`, `[m]`
    exponent : 1/q, that of the load over depth
    first, last : samples that were fitted, as indices into the whole curve
    residual_sd : scatter of the depth about the curve `[m]`
    independent_samples : as `estimators.contact.Contact`
    """

    stiffness: float
    u_stiffness: float
    peak_load: float
    peak_depth: float
    exponent: float
    first: int
    last: int
    residual_sd: float
    independent_samples: float


def fit_unloading(
    depth: FloatArray, load: FloatArray, fraction: tuple[float, float], min_samples: int
) -> Unloading:
    r"""Fit the unloading by a power law and take its slope at peak load.

    $h = h_f + C (P/P_m)^q$ is fitted with the depth as the uncertain side, for it is the depth
    that drifts and scatters while the load is controlled; $S = P_m / (C q)$.

    Parameters
    ----------
    depth, load : from contact to the end, in the order of time, load zero in air, shape (n,)
    fraction : lowest and highest part of the peak load that is fitted
    min_samples : fewest samples there

    Raises
    ------
    FitRefused : too few samples in the window, or a depth that does not return in it

    Source: W. C. Oliver, G. M. Pharr, J. Mater. Res. 7 (1992) 1564, whose law this is, solved for
    the depth.
    """
    low, high = fraction
    peak_load = float(load.max())
    start = int(np.flatnonzero(load >= 0.99 * peak_load)[-1])
    below = np.flatnonzero(load[start:] < low * peak_load)
    end = start + int(below[0]) if below.size else load.size
    chosen = start + np.flatnonzero(load[start:end] <= high * peak_load)
    where = f"{100 * low:g}-{100 * high:g} % of the peak load of the unloading"
    if chosen.size < min_samples:
        raise FitRefused(
            f"{chosen.size} samples in {where}, {min_samples} are needed; record the unloading, "
            "or sample it faster",
            {"samples": int(chosen.size), "samples_needed": min_samples},
        )
    x, y = load[chosen] / peak_load, depth[chosen]
    q, _ = lowest(lambda q: _line(x**q, y)[0], _EXPONENTS)
    _, slope = _line(x**q, y)
    if not slope > 0.0:
        raise FitRefused(f"the depth does not return over {where}")
    level = float(y.mean() - slope * (x**q).mean())
    residual = y - level - slope * x**q
    independent = independent_samples(residual, 3, float(np.square(y - y.mean()).sum()))
    # in terms of ln S = ln P_m - ln C - ln q instead of C, so that its error is a parameter's own
    rise = slope * x**q
    jacobian = np.column_stack([np.ones_like(x), -rise, rise * (np.log(x) - 1.0 / q)])
    stiffness = peak_load / (slope * q)
    relative = float(standard_errors(jacobian, residual, independent)[1])
    return Unloading(
        stiffness=stiffness,
        u_stiffness=stiffness * relative,
        peak_load=peak_load,
        peak_depth=level + slope,
        exponent=1.0 / q,
        first=int(chosen[0]),
        last=int(chosen[-1]),
        residual_sd=math.sqrt(float(residual @ residual) / (chosen.size - 3)),
        independent_samples=independent,
    )


def _line(x: FloatArray, y: FloatArray) -> tuple[float, float]:
    """Sum of squares and slope of a line through y over x."""
    dx, dy = x - x.mean(), y - y.mean()
    slope = float(dx @ dy) / float(dx @ dx)
    rest = dy - slope * dx
    return float(rest @ rest), slope
