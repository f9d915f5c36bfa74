"""Readings of one frequency more than once: sweeps that follow each other, and their drift."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray

_SAME = 1e-4  # relative, between readings at one frequency


def sweep_numbers(frequency_Hz: FloatArray) -> NDArray[np.intp]:
    """Number the sweeps in a list of frequencies, in the order of time.

    A sweep ends where the frequency turns (back to the start, or down again after going up).
    Stretches that have no frequency in common are one sweep whose points were set out of order.

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
    if np.diff(np.sort(frequency_Hz)).min() > _SAME * float(frequency_Hz.max()):
        return numbers
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
    return numbers if _meet(frequency_Hz, numbers) else np.zeros_like(numbers)


def _meet(frequency_Hz: FloatArray, numbers: NDArray[np.intp]) -> bool:
    """Tell whether two sweeps have a frequency in common."""
    order = np.argsort(frequency_Hz, kind="stable")
    f, n = frequency_Hz[order], numbers[order]
    near = np.diff(f) <= _SAME * f[1:]
    return bool((near & (np.diff(n) != 0)).any())


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
