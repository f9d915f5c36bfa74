"""Single readings that stand off both of their neighbours: lost digits, spikes, dropouts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray

_OFF = 0.02  # of the channel's range: what stands off by less moves no value much
_USUAL = 8.0  # times the median step: noise does not
_FEWEST = 8  # samples
_AGREE = 0.25  # of the smaller step: neighbours that differ by less are one curve without it


def lone_readings(values: FloatArray) -> NDArray[np.intp]:
    r"""Find single samples off both neighbours, which agree with each other.

    Sample i, with the steps $d_1 = v_i - v_{i-1}$ and $d_2 = v_{i+1} - v_i$, is one where the two
    have opposite signs, the smaller is at least 2 % of the range and 8 times the median step, and
    $|d_1 + d_2|$ is at most a quarter of the smaller.

    Parameters
    ----------
    values : of one channel in the order of sampling, shape (n,)

    Returns
    -------
    indices, ascending; a break, a slip or a turn of the machine is none of them
    """
    none = np.empty(0, dtype=np.intp)
    if values.size < _FEWEST:
        return none
    steps = np.diff(values)
    least = _OFF * float(values.max() - values.min())
    if min(steps.max(), -steps.min()) < least:  # the usual curve, at a third of the cost
        return none
    sizes = np.abs(steps)
    least = max(least, _USUAL * float(np.median(sizes)))
    turn = np.minimum(sizes[1:], sizes[:-1])
    back = np.abs(steps[1:] + steps[:-1])
    alone = (steps[1:] * steps[:-1] < 0.0) & (turn >= least) & (back <= _AGREE * turn)
    return np.flatnonzero(alone) + 1


def without(values: FloatArray, lone: NDArray[np.intp]) -> FloatArray:
    """Put the mean of both neighbours in the place of single readings."""
    mended = values.copy()
    mended[lone] = 0.5 * (values[lone - 1] + values[lone + 1])
    return mended
