"""Several flow curves below each other in one file: parted, and held against each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray

# A rate that goes the other way by more than this, relative to where it turned, begins a sweep.
_TURNS = 0.02
_LEAST_READINGS = 3


def parted(rate_per_s: FloatArray) -> list[NDArray[np.intp]]:
    """Part readings into sweeps: up, down, and from the start again.

    Rates in no order, each turning after a reading or two, are one sweep. Where every rate of one
    way was read equally often, its first readings are a sweep, its second ones another, and so on.

    Parameters
    ----------
    rate_per_s : positive, in the order of the file, shape (n,)

    Returns
    -------
    indices of each sweep
    """
    logs = np.log(rate_per_s)
    moves = [0]
    for i in range(1, len(logs)):
        if abs(logs[i] - logs[moves[-1]]) > _TURNS:
            moves.append(i)
    steps = np.sign(np.diff(logs[moves]))
    times = np.unique(np.diff([*moves, len(logs)]))
    one_way = len(moves) >= _LEAST_READINGS and abs(float(steps.sum())) == steps.size
    if one_way and times.size == 1 and times[0] > 1:
        return [np.arange(first, len(logs), times[0]) for first in range(int(times[0]))]
    starts, way = [0], 0.0
    for k, step in enumerate(steps.tolist()):
        if way and step != way:
            starts.append(moves[k + 1])
            # one step back to the start, or the way back from here on
            back = k + 1 < len(steps) and steps[k + 1] == way
            way = 0.0 if back else step
        elif not way:
            way = step
    found = [
        np.arange(first, end)
        for first, end in zip(starts, [*starts[1:], len(logs)], strict=True)
        if end > first
    ]
    if len(found) > 1 and np.median([len(s) for s in found]) < _LEAST_READINGS:
        return [np.arange(len(logs))]
    return [s for s in found if len(s) >= _LEAST_READINGS] or [np.arange(len(logs))]


def levels(
    sweeps: Sequence[NDArray[np.intp]], rate_per_s: FloatArray, viscosity_Pas: FloatArray
) -> FloatArray:
    """Logarithm of each sweep's viscosity over that of all, at the rates that all have in common.

    Returns
    -------
    shape (sweeps,); zeros where no rates are common
    """
    if len(sweeps) < 2:
        return np.zeros(len(sweeps))
    low = max(float(rate_per_s[s].min()) for s in sweeps)
    high = min(float(rate_per_s[s].max()) for s in sweeps)
    if not low < high:
        return np.zeros(len(sweeps))
    at = np.linspace(np.log(low), np.log(high), 9)
    curves = []
    for s in sweeps:
        order = s[np.argsort(rate_per_s[s], kind="stable")]
        curves.append(np.interp(at, np.log(rate_per_s[order]), np.log(viscosity_Pas[order])))
    means = np.array([float(np.mean(c)) for c in curves])
    return np.asarray(means - means.mean())
