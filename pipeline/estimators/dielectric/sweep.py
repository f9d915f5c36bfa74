"""Reading a frequency sweep: its value at one frequency, its slope, and a resistance in series."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused

_FEWEST = 4  # points that can tell a straight line with its error from its noise


@dataclass(frozen=True, slots=True)
class Position:
    """Where in a sweep a frequency stands: a weighted mean of some of its points.

    Parameters
    ----------
    indices : of the points, in the order of the sweep, shape (k,)
    weights : of these points, adding up to 1, shape (k,)
    interpolated : between two neighbours rather than measured
    extrapolated : beyond the last of its neighbours
    """

    indices: NDArray[np.intp]
    weights: FloatArray
    interpolated: bool
    extrapolated: bool = False

    def of(self, values: FloatArray) -> float:
        """Return the value of a column (n,) at this position."""
        return float(self.weights @ values[self.indices])


def position(
    frequency_Hz: FloatArray, target_Hz: float, tolerance: float, widest_gap_decades: float
) -> Position:
    """Find a frequency in a sweep: measured if near enough, else between neighbours in log f.

    Points that share one frequency count alike; their order does not matter.

    Parameters
    ----------
    frequency_Hz : all above zero, shape (n,)
    target_Hz : the frequency that is asked for
    tolerance : a point within this fraction of the target is a measurement of it
    widest_gap_decades : neighbours farther apart than this do not tell what lies between them

    Raises
    ------
    FitRefused : the target lies outside the sweep, or in too wide a gap
    """
    distance = np.abs(frequency_Hz / target_Hz - 1.0)
    if distance.size and distance.min() <= tolerance:
        near = np.flatnonzero(distance == distance.min())
        return Position(near, np.full(near.size, 1.0 / near.size), interpolated=False)
    below, above = frequency_Hz[frequency_Hz < target_Hz], frequency_Hz[frequency_Hz > target_Hz]
    if not (below.size and above.size):
        span = (
            f"the sweep goes from {frequency_Hz.min():g} to {frequency_Hz.max():g} Hz"
            if frequency_Hz.size
            else "no point is left"
        )
        raise FitRefused(
            f"{target_Hz:g} Hz is not measured: {span}, and nothing is extrapolated",
            {"points": int(frequency_Hz.size)},
        )
    low, high = float(below.max()), float(above.min())
    gap = math.log10(high / low)
    if gap > widest_gap_decades:
        raise FitRefused(
            f"{target_Hz:g} Hz lies in a gap from {low:g} to {high:g} Hz, {gap:.2g} decades wide "
            f"({widest_gap_decades:g} are bridged); measure nearer to {target_Hz:g} Hz",
            {"gap_decades": gap},
        )
    share = math.log(target_Hz / low) / math.log(high / low)
    pairs = ((np.flatnonzero(frequency_Hz == low), 1.0 - share),
             (np.flatnonzero(frequency_Hz == high), share))  # fmt: skip
    return Position(
        np.concatenate([points for points, _ in pairs]),
        np.concatenate([np.full(points.size, part / points.size) for points, part in pairs]),
        interpolated=True,
    )


def beyond_end(frequency_Hz: FloatArray, target_Hz: float, reach_decades: float) -> Position | None:
    """Continue a sweep over a gap at its end by a line over log f through the nearest points.

    Parameters
    ----------
    frequency_Hz : rising, shape (n,)
    target_Hz : below or above all of them
    reach_decades : farthest that the line is trusted

    Returns
    -------
    None where it would reach farther, or where fewer than four points tell it
    """
    order = np.argsort(np.abs(np.log(frequency_Hz / target_Hz)), kind="stable")[:_FEWEST]
    x = np.log10(frequency_Hz[order] / target_Hz)
    centred = x - x.mean()
    if order.size < _FEWEST or not centred.any() or abs(x[0]) > reach_decades:
        return None
    weights = 1.0 / x.size - x.mean() * centred / float(centred @ centred)
    return Position(order, weights, interpolated=False, extrapolated=True)


def slope_per_decade(
    frequency_Hz: FloatArray, values: FloatArray, u: FloatArray
) -> tuple[float, float]:
    """Fit a line over log10 f, each point weighted by its uncertainty.

    Parameters
    ----------
    frequency_Hz, values : shape (n,)
    u : standard uncertainty of each value, above zero, shape (n,); only their ratios matter

    Returns
    -------
    slope per decade and its standard error from the residuals

    Raises
    ------
    FitRefused : fewer than four points, or all at one frequency
    """
    x = np.log10(frequency_Hz)
    if x.size < _FEWEST or np.ptp(x) == 0.0:
        raise FitRefused(f"a slope needs {_FEWEST} points at several frequencies, not {x.size}")
    return _line(x, values, 1.0 / u**2)


def series_resistance(
    frequency_Hz: FloatArray, series_capacitance_F: FloatArray, loss_tangent: FloatArray
) -> tuple[float, float] | None:
    r"""Estimate a resistance in series with the film from the top decade of a sweep.

    A resistance leaves the series capacitance as it is and adds to the loss in proportion to f:
    $D = \tan\delta + R_s \omega C_s$; a line through D over $\omega C_s$ has the slope R_s. The
    film's own loss is taken as constant over that decade. (A relaxation far above the sweep looks
    the same; no sweep below it can tell the two apart.)

    Parameters
    ----------
    frequency_Hz, series_capacitance_F, loss_tangent : shape (n,) each

    Returns
    -------
    R_s and its standard error `[ohm]`; None with fewer than four points in the top decade
    """
    top = frequency_Hz >= frequency_Hz.max() / 10.0
    x = 2.0 * math.pi * frequency_Hz[top] * series_capacitance_F[top]
    if x.size < _FEWEST or np.ptp(x) == 0.0:
        return None
    return _line(x, loss_tangent[top], np.ones(x.size))


def _line(x: FloatArray, y: FloatArray, weights: FloatArray) -> tuple[float, float]:
    """Weighted least squares: slope and its standard error."""
    w = weights / weights.sum()
    dx, dy = x - w @ x, y - w @ y
    sxx = float(w @ dx**2)
    slope = float(w @ (dx * dy)) / sxx
    rest = float(w @ (dy - slope * dx) ** 2) / (x.size - 2)
    return slope, math.sqrt(rest / sxx)
