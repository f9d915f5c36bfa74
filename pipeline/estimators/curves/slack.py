"""Slack: the path that a strip needs to become taut, found as a hinge in the loading curve."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.special import fdtrc

from deamat.core.arrays import FloatArray

_REACH = 12  # windows over which slack is looked for
_TAUT = 0.5  # of the steepest window: the first window as steep is where the strip is taut
_LOOSE = 0.8  # of the slope behind the hinge: a start that is less steep is loose
_BEYOND = 3  # windows behind the hinge that show the slope of the taut strip
_CERTAIN = 1e-4  # false alarms among sound curves
_GRID = 60
_LEFT = 0.3  # of a step of the grid: what one step to the minimum leaves
_FEWEST = 8


@dataclass(frozen=True, slots=True)
class Slack:
    """What a loading curve shows of slack.

    Parameters
    ----------
    strain, u_strain : path until the strip is taut, over its length, and its standard uncertainty
    slope_before_Pa, slope_after_Pa : on either side
    """

    strain: float
    u_strain: float
    slope_before_Pa: float
    slope_after_Pa: float


def find_slack(strain: FloatArray, stress: FloatArray, window: float) -> Slack | None:
    r"""Fit a hinge $\sigma = a + b_0 \varepsilon + b_1 \max(\varepsilon - \varepsilon_0, 0)$.

    It is slack where the hinge lies beyond a twentieth of the window, the curve is less steep in
    front of it than behind by a fifth at least, and the hinge explains so much more than a
    straight line that noise would do so once in 10 000 curves (F test).

    Parameters
    ----------
    strain, stress : of one loading, loading positive, from its first sample, shape (n,)
    window : width of the window of the modulus `[1]`

    Returns
    -------
    None where the strip is taut from the start, or too few samples could show it
    """
    if _looks_taut(strain, stress, window):
        return None
    reach = _where_taut(strain, stress, window)
    inside = strain <= reach
    x, y = strain[inside], stress[inside]
    n = x.size
    if n < _FEWEST:
        return None
    places = np.linspace(0.05 * window, reach - window, _GRID)
    # least squares of the hinge at each place: what its column adds to a straight line
    basis, _ = np.linalg.qr(np.stack([np.ones(n), x], axis=1))
    hinge = np.maximum(x[:, None] - places, 0.0)
    hinge -= basis @ (basis.T @ hinge)
    off_line = y - basis @ (basis.T @ y)
    line = float(off_line @ off_line)
    size = np.square(hinge).sum(axis=0)
    change = (hinge.T @ off_line) / np.maximum(size, np.finfo(np.float64).tiny)
    rss = line - change * change * size
    best = int(rss.argmin())
    place, turn = float(places[best]), float(change[best])
    before = _slope(x, y - turn * np.maximum(x - place, 0.0))
    after = before + turn
    if not (after > 0.0 and before < _LOOSE * after):
        return None
    noise2 = max(float(rss[best]), 0.0) / (n - 4)  # of an exact hinge, rounding may leave less
    if noise2 > 0.0 and fdtrc(2, n - 4, turn * turn * size[best] / 2.0 / noise2) > _CERTAIN:
        return None
    near = np.flatnonzero(rss <= rss[best] + noise2)
    step = float(places[1] - places[0])
    # beside level, slopes and turn: of a sharp hinge by linear propagation, of a rounder one by
    # where the sum of squares rises
    shift, scatter = _place(x, y, place, turn, noise2)
    scatter = max(scatter, 0.5 * float(near[-1] - near[0]) * step)
    place += min(max(shift, -0.5 * step), 0.5 * step)
    return Slack(place, math.hypot(scatter, _LEFT * step), before, after)


def steepest_behind(strain: FloatArray, stress: FloatArray, start: float, window: float) -> float:
    """Greatest slope over three windows behind a strain, up to twelve; 0 where nothing lies there.

    Where it is greater than that of the window itself the hinge is round, and the strip not taut.

    Parameters
    ----------
    strain, stress : of one loading, loading positive, shape (n,)
    start : strain from which on the strip is taken for taut
    window : width of the window of the modulus `[1]`
    """
    edges = np.searchsorted(strain, start + window * np.arange(1, _REACH + 1)).tolist()
    slopes = [0.0]
    for first, end in zip(edges, edges[_BEYOND:], strict=False):
        x = strain[first:end]
        if x.size >= _FEWEST and x[-1] > x[0]:
            slopes.append(_slope(x, stress[first:end]))
    return max(slopes)


def _place(
    x: FloatArray, y: FloatArray, place: float, turn: float, noise2: float
) -> tuple[float, float]:
    """One step of Gauss and Newton from a place on the grid, and the standard deviation there."""
    ones, behind = np.ones(x.size), np.asarray(x > place, dtype=np.float64)
    basis, _ = np.linalg.qr(np.stack([ones, x, behind * (x - place)], axis=1))
    alone = behind - basis @ (basis.T @ behind)
    size = float(alone @ alone)
    return -float(alone @ y) / (size * turn), math.sqrt(noise2 / size) / abs(turn)


def _looks_taut(strain: FloatArray, stress: FloatArray, window: float) -> bool:
    """Say whether the first half window is as steep as what follows: most curves end here."""
    half, end = np.searchsorted(strain, (0.5 * window, _BEYOND * window)).tolist()
    if half < _FEWEST or end - half < _FEWEST:
        return False
    first = _slope(strain[:half], stress[:half])
    return first >= 0.95 * _slope(strain[half:end], stress[half:end]) > 0.0


def _slope(x: FloatArray, y: FloatArray) -> float:
    dx = x - x.mean()
    return float(dx @ y) / float(dx @ dx)


def _where_taut(strain: FloatArray, stress: FloatArray, window: float) -> float:
    """End of the stretch of curve that shows slack and the taut strip behind it."""
    slopes = []
    edges = np.searchsorted(strain, window * np.arange(_REACH + 1)).tolist()  # of rising strain
    for first, end in pairwise(edges):
        x = strain[first:end]
        rises = x.size >= 3 and x[-1] > x[0]
        slopes.append(_slope(x, stress[first:end]) if rises else 0.0)
    steepest = max(slopes)
    first = next((k for k, slope in enumerate(slopes) if slope >= _TAUT * steepest), 0)
    return (first + _BEYOND) * window
