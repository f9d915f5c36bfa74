r"""Points and steps of a frequency sweep that no material makes.

A film's capacitance runs smoothly over log f. The rise over each gap between neighbouring points,
$\Delta y_i$, is held against what the slopes of the gaps around it say, by a line through them that
one bad slope cannot move (Theil and Sen). What is left, $J_i$, is a jump if it exceeds

$$ \max\big(y_0,\; 5\,\hat\sigma,\; 2\,s_i\,\Delta x_i\big) $$

with a floor $y_0$, the scatter $\hat\sigma = 1.4826\,\mathrm{median}|J|$ of the whole sweep, and
$s_i$ how far the six slopes around it are from their own line (the third-largest departure, which
two bad neighbours cannot move), with an eighth of what their line adds at the ends of the sweep,
where it is extrapolated. In sweeps of fewer than eight points the median of the slopes stands for
the line, and $4 s_i$ with the largest departure. Two opposite jumps on both sides
of a point are one outlying point; a jump beside the last point of either end is that point; any
other jump is a step.

Source: H. Theil, Proc. K. Ned. Akad. Wet. A 53 (1950) 386; P. K. Sen, J. Am. Stat. Assoc. 63 (1968)
1379, for the line.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray

_AROUND = 6  # gaps that tell the slope of one between them
_FEWEST = 3  # of them, or there is nothing to hold a gap against
_SCATTERS = 5.0
_DEPARTURES = 2.0
_DEPARTURES_OF_FEW = 4.0
_EXTRAPOLATED = 0.125  # of a bend, where the gaps around lie all on one side
_ALIKE = 3.0  # one outlying point makes two jumps of about this ratio at most


@dataclass(frozen=True, slots=True)
class Jumps:
    """What is not smooth in a sweep.

    Parameters
    ----------
    outlying : points off their neighbours, as indices into the sweep
    departures : of these points from their neighbours, in y
    steps : gap i lies between points i and i + 1
    heights : rise of y over each step towards higher x that no slope explains
    """

    outlying: tuple[int, ...]
    departures: tuple[float, ...]
    steps: tuple[int, ...]
    heights: tuple[float, ...]


NONE = Jumps((), (), (), ())


def jumps(x: FloatArray, y: FloatArray, floor: float) -> Jumps:
    """Find outlying points and steps.

    Parameters
    ----------
    x : rising strictly, such as ln f, shape (n,)
    y : such as ln C, shape (n,)
    floor : departures of y below it are of no interest

    Returns
    -------
    nothing for fewer than five points
    """
    left = _unexplained(x, y, floor)
    if left is None:
        return NONE
    bad = np.flatnonzero(left)
    outlying: dict[int, float] = {}
    steps: dict[int, float] = {}
    last = x.size - 2
    at = 0
    while at < bad.size:
        gap = int(bad[at])
        jump = float(left[gap])
        after = float(left[gap + 1]) if gap < last else 0.0
        if jump * after < 0.0 and 1.0 / _ALIKE < abs(jump / after) < _ALIKE:
            outlying[gap + 1] = 0.5 * (jump - after)
            at += 1  # both gaps are explained
        elif gap == 0:
            outlying[0] = -jump
        elif gap == last:
            outlying[x.size - 1] = jump
        else:
            steps[gap] = jump
        at += 1
    return Jumps(tuple(outlying), tuple(outlying.values()), tuple(steps), tuple(steps.values()))


def _unexplained(x: FloatArray, y: FloatArray, floor: float) -> FloatArray | None:
    """Return each gap's jump, zero where it is within what is allowed; None where none is."""
    gaps = x.size - 1
    around = min(_AROUND, gaps - 1)
    if around < _FEWEST:
        return None
    dx, dy = x[1:] - x[:-1], y[1:] - y[:-1]
    slope = dy / dx
    if not _suspicious(dx, slope, floor):
        return None
    expected, departure = _expected(0.5 * (x[1:] + x[:-1]), slope, _others(gaps, around))
    left = dy - expected * dx
    few = around < _AROUND
    # of few gaps most are held against one that jumps, and only the smoothest are clean
    scatter = 1.4826 * float(np.quantile(np.abs(left), 0.25 if few else 0.5))
    times = _DEPARTURES_OF_FEW if few else _DEPARTURES
    allowed = np.maximum(max(floor, _SCATTERS * scatter), times * departure * dx)
    left[np.abs(left) <= allowed] = 0.0
    return left if left.any() else None


def _suspicious(dx: FloatArray, slope: FloatArray, floor: float) -> bool:
    """Tell quickly whether any slope differs from both of its neighbours by half the floor."""
    turn = np.empty(slope.size + 1)
    turn[1:-1] = np.abs(slope[1:] - slope[:-1])
    turn[0], turn[-1] = turn[1], turn[-2]
    return bool((np.minimum(turn[1:], turn[:-1]) * dx > 0.5 * floor).any())


def _others(gaps: int, around: int) -> NDArray[np.intp]:
    """Indices of the gaps nearest to each gap, itself left out, shape (gaps, around)."""
    own = np.arange(gaps)[:, None]
    first = np.clip(own - around // 2, 0, gaps - 1 - around)
    window = first + np.arange(around)
    result: NDArray[np.intp] = window + (window >= own)
    return result


def _expected(
    middle: FloatArray, slope: FloatArray, others: NDArray[np.intp]
) -> tuple[FloatArray, FloatArray]:
    """Slope that the gaps around each gap tell, and how far these are from their own line."""
    at, s = middle[others], slope[others]
    if others.shape[1] < _AROUND:
        expected = np.median(s, axis=1)
        return expected, np.abs(s - expected[:, None]).max(axis=1)
    i, j = np.triu_indices(_AROUND, 1)
    bend = np.median((s[:, j] - s[:, i]) / (at[:, j] - at[:, i]), axis=1)
    rest = s - bend[:, None] * (at - middle[:, None])
    expected = np.median(rest, axis=1)
    departure = np.sort(np.abs(rest - expected[:, None]), axis=1)[:, -3]
    beyond = np.abs(bend * (at.mean(axis=1) - middle))
    return expected, departure + _EXTRAPOLATED * beyond
