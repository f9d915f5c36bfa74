"""Leaves out the samples of a curve that nobody could see."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray

TOLERANCE_px = 0.45
_OF_RUNS_px = 0.3  # of it for the runs, the rest for what is left
_OF_CHORDS_px = TOLERANCE_px - _OF_RUNS_px
_RUN = 16  # samples that are looked at together at first

Indices = NDArray[np.intp]


def thin(x: FloatArray, y: FloatArray, starts: Indices) -> Indices:
    """Return the samples that must stay so that no curve moves by more than `TOLERANCE_px`.

    Short runs of samples that lie on a straight line go first, all at once; of the rest, the
    samples farthest from the chords between those kept stay, until none is farther than allowed.

    Parameters
    ----------
    x, y : of all curves, end to end, shape (n,) each `[px]`, finite
    starts : index of the first sample of each curve, none of them empty

    Source: Douglas and Peucker 1973, Cartographica 10, 112.
    """
    ends = np.append(starts[1:], x.size) - 1
    rest = _without_straight_runs(x, y, np.concatenate([starts, ends]))
    return rest[_farthest(x[rest], y[rest], np.searchsorted(rest, starts))]


def _without_straight_runs(x: FloatArray, y: FloatArray, fixed: Indices) -> Indices:
    runs = (x.size - 1) // _RUN
    kept = np.ones(x.size, bool)
    if runs:
        inside = slice(0, runs * _RUN)
        px, py = _from_first(x, runs), _from_first(y, runs)
        cx, cy = (v[_RUN::_RUN][:runs] - v[::_RUN][:runs] for v in (x, y))
        length = np.hypot(cx, cy)
        with np.errstate(divide="ignore", invalid="ignore"):
            cx, cy = (cx / length)[:, None], (cy / length)[:, None]
            away = np.abs(px * cy - py * cx).max(axis=1)
            along = px * cx + py * cy
            straight = (away < _OF_RUNS_px) & (along.min(axis=1) > -_OF_RUNS_px)
            straight &= along.max(axis=1) < length + _OF_RUNS_px
        kept[inside].reshape(runs, _RUN)[straight, 1:] = False
    kept[fixed] = True
    return np.flatnonzero(kept)


def _from_first(values: FloatArray, runs: int) -> FloatArray:
    rows = values[: runs * _RUN].reshape(runs, _RUN)
    return rows - rows[:, :1]


def _farthest(x: FloatArray, y: FloatArray, starts: Indices) -> NDArray[np.bool_]:
    kept = np.zeros(x.size, bool)
    kept[starts] = True
    kept[np.append(starts[1:], x.size) - 1] = True
    fixed = np.flatnonzero(kept)
    wide = np.flatnonzero(np.diff(fixed) > 1)
    start, end = fixed[wide], fixed[wide + 1]
    while start.size:
        lengths = end - start - 1
        first = np.cumsum(lengths) - lengths
        chord = np.repeat(np.arange(start.size), lengths)
        inner = np.arange(chord.size) - first[chord] + start[chord] + 1
        away = _distance(x, y, inner, start[chord], end[chord])
        farthest = np.maximum.reduceat(away, first)
        far = np.flatnonzero((away == farthest[chord]) & (away > _OF_CHORDS_px))
        of_chord, which = np.unique(chord[far], return_index=True)
        middle = inner[far[which]]
        kept[middle] = True
        before = np.concatenate([start[of_chord], middle])
        after = np.concatenate([middle, end[of_chord]])
        order = np.argsort(before)
        start, end = before[order], after[order]
        open_ = end - start > 1
        start, end = start[open_], end[open_]
    return kept


def _distance(
    x: FloatArray, y: FloatArray, point: Indices, start: Indices, end: Indices
) -> FloatArray:
    """Distance of samples from the straight stretch between two others `[px]`."""
    px, py = x[point] - x[start], y[point] - y[start]
    cx, cy = x[end] - x[start], y[end] - y[start]
    square = cx * cx + cy * cy
    along = np.clip((px * cx + py * cy) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    away: FloatArray = np.hypot(px - along * cx, py - along * cy)
    return away
