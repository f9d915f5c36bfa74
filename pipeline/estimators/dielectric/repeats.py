"""Readings of one frequency more than once: sweeps that follow each other, and their drift."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray

_SAME = 1e-4  # relative, between readings at one frequency
_FEWEST = 4  # points of a sweep of its own


def sweep_numbers(frequency_Hz: FloatArray) -> NDArray[np.intp]:
    """Number the sweeps in a list of frequencies, in the order of time.

    A sweep ends where the frequency turns (back to the start, or down again after going up).
    Stretches that have no frequency in common are one sweep whose points were set out of order,
    unless each is a sweep of its own: four points or more, over half of the other's range.

    Parameters
    ----------
    frequency_Hz : in the order of the file, shape (n,)

    Returns
    -------
    number of the sweep of each point, from 0, shape (n,)
    """
    numbers = np.zeros(frequency_Hz.size, dtype=np.intp)
    signs = np.sign(np.diff(frequency_Hz))
    if not (signs[signs != 0.0] < 0.0).any() or not (signs > 0.0).any():
        return numbers  # one way only
    way, number, repeated = 0.0, 0, 0
    for i, sign in enumerate(signs.tolist(), start=1):
        if sign and way and sign != way:
            number, way = number + 1, 0.0
            if signs[i - 2] == 0.0 and repeated == 1:
                # the only frequency read twice is the one where it turns: once on either way
                numbers[i - 1], way = number, sign
            repeated = 0
        elif sign:
            way = sign
        else:
            repeated += 1
        numbers[i] = number
    several = _meet(frequency_Hz, numbers) or _interleave(frequency_Hz, numbers)
    return numbers if several else np.zeros_like(numbers)


def _meet(frequency_Hz: FloatArray, numbers: NDArray[np.intp]) -> bool:
    """Tell whether two sweeps have a frequency in common."""
    order = np.argsort(frequency_Hz, kind="stable")
    f, n = frequency_Hz[order], numbers[order]
    near = np.diff(f) <= _SAME * f[1:]
    return bool((near & (np.diff(n) != 0)).any())


def _interleave(frequency_Hz: FloatArray, numbers: NDArray[np.intp]) -> bool:
    """Tell whether all stretches are sweeps over the same range at other frequencies."""
    if np.bincount(numbers).min() < _FEWEST:
        return False
    stretches = [np.log(frequency_Hz[numbers == number]) for number in range(numbers.max() + 1)]
    low, high = (max(x.min() for x in stretches), min(x.max() for x in stretches))
    return bool(high - low > 0.5 * max(float(np.ptp(x)) for x in stretches))


def drift_between(
    frequency_Hz: FloatArray, values: FloatArray, sweep: NDArray[np.intp]
) -> FloatArray:
    """Return how far later sweeps lie off the first one, read between its points over ln f.

    Parameters
    ----------
    frequency_Hz : rising, shape (n,)
    values : shape (n,)
    sweep : number of the sweep of each point, from 0, shape (n,)

    Returns
    -------
    absolute difference for each point of a later sweep within the range of the first
    """
    x, first = np.log(frequency_Hz), sweep == 0
    other = ~first & (x >= x[first][0]) & (x <= x[first][-1])
    found: FloatArray = np.abs(values[other] - np.interp(x[other], x[first], values[first]))
    return found


def same_frequency(frequency_Hz: FloatArray) -> NDArray[np.intp]:
    """Number the distinct frequencies of a rising list, from 0, shape (n,)."""
    group = np.zeros(frequency_Hz.size, dtype=np.intp)
    np.cumsum(frequency_Hz[1:] * (1.0 - _SAME) > frequency_Hz[:-1], out=group[1:])
    return group


def spread(values: FloatArray, group: NDArray[np.intp]) -> FloatArray:
    """Return largest minus smallest value of each group that has several.

    Parameters
    ----------
    values : shape (n,)
    group : rising, as `same_frequency` numbers them, shape (n,)

    Returns
    -------
    one spread for each group with more than one value, in their order
    """
    starts = np.flatnonzero(np.diff(group, prepend=-1))
    size = np.diff(starts, append=group.size)
    found: FloatArray = np.maximum.reduceat(values, starts) - np.minimum.reduceat(values, starts)
    return found[size > 1]
