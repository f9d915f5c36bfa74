"""Channels that hold one value while the test goes on: a saturated load cell, a frozen position."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.estimators.curves.noise import noise_sd

_FEWEST = 3  # repetitions
_ASKED = 3  # longest stretches that are looked at: where readings are coarse there are many
_LOST = 0.01  # of the greatest stress: what the other channel would have meant meanwhile
_STEPS = 10.0  # of the channel's resolution, likewise: coarse readings repeat on a flat curve
_SEEN = 0.25  # of the stretch: the load rises in front of it over so much, and over all of it
_CERTAIN = 6.0  # standard deviations of the load's noise, by which it rose in front
_LOADED = 0.1  # of the greatest stress: below it a load that does not change may be slack


@dataclass(frozen=True, slots=True)
class Held:
    """A stretch over which a channel held one value: indices of its first and last sample."""

    first: int
    last: int


def held_load(strain: FloatArray, stress: FloatArray, last: int) -> Held | None:
    r"""Find a stretch of equal loads while the crosshead went on.

    It is one where the load rose in front of it so steeply that over the stretch it would rise by
    1 % of its greatest value and 10 of its steps at least: a coarse or flat curve does not.

    Parameters
    ----------
    strain, stress : loading positive, shape (n,)
    last : index of the last sample that carries load

    Returns
    -------
    None where there is none
    """
    y = stress[: last + 1]
    runs = _runs(y, 0)
    if not runs:
        return None
    least, noise = _least(y), _CERTAIN * noise_sd(y)
    for first, end in runs:
        moved = float(strain[end] - strain[first])
        if moved <= 0.0 or y[first] < _LOADED * y.max():
            continue
        near = max(first - 1, 0)  # the first sample held may lie half-way
        rises = [_rise(strain, y, near, part * moved, noise) for part in (_SEEN, 1.0)]
        if min(rises) * moved >= least:
            return Held(first, end)
    return None


def held_position(strain: FloatArray, stress: FloatArray, first: int, last: int) -> Held | None:
    """Find a stretch of equal positions while the load rose as if the crosshead went on.

    Parameters
    ----------
    strain, stress : loading positive, shape (n,)
    first : index of the last sample before the machine moves
    last : index of the last sample that carries load

    Returns
    -------
    None where there is none; a pause, over which the load falls, is none
    """
    x, y = strain[: last + 1], stress[: last + 1]
    runs = _runs(x, first + 1)
    if not runs:
        return None
    steps = np.abs(np.diff(x))
    resolution = float(steps[steps > 0.0].min()) if steps.any() else 0.0
    greatest = float(y.max())
    for start, end in runs:
        rise = float(y[start : end + 1].max() - y[start])
        if rise < _LOST * greatest or not y[start] > 0.0 or not x[start] > x[first]:
            continue
        stiffness = float(y[start] - y[first]) / float(x[start] - x[first])
        if rise >= _STEPS * resolution * stiffness:
            return Held(start, end)
    return None


def _rise(strain: FloatArray, y: FloatArray, near: int, stretch: float, noise: float) -> float:
    """Slope over a stretch that ends at a sample; 0 where it is no more than noise."""
    before = int(np.searchsorted(strain[: near + 1], strain[near] - stretch))
    before = max(min(before, near - 1), 0)
    travelled, risen = float(strain[near] - strain[before]), float(y[near] - y[before])
    return risen / travelled if travelled > 0.0 and risen >= noise else 0.0


def _least(y: FloatArray) -> float:
    """Change of a load that is no rounding."""
    steps = np.abs(np.diff(y))
    return max(_LOST * float(y.max()), _STEPS * float(steps[steps > 0.0].min(initial=np.inf)))


def _runs(values: FloatArray, start: int) -> list[tuple[int, int]]:
    """List the longest stretches of equal values from a sample on, as first and last index."""
    same = np.flatnonzero(values[start + 1 :] == values[start:-1]) + start
    if same.size < _FEWEST:
        return []
    cuts = np.flatnonzero(np.diff(same) > 1)
    firsts = same[np.concatenate([[0], cuts + 1])]
    lasts = same[np.concatenate([cuts, [same.size - 1]])] + 1
    long = np.argsort(firsts - lasts, kind="stable")[:_ASKED]
    return [(int(firsts[i]), int(lasts[i])) for i in long if lasts[i] - firsts[i] >= _FEWEST]
