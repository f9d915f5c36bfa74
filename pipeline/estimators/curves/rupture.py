"""How a pull ended: a break, a reversal or a stop; and the cycles on the way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from deamat.core.arrays import FloatArray

End = Literal["broke", "reversed", "stopped"]

_BACK = 0.02  # of the greatest strain: a return by more is a reversal, by less the crosshead's stop
_ON_CURVE = 0.5  # of the load that loading needed there: an unbroken specimen still carries it
_FADES = 0.1  # of the greatest load, above the drop: what a break passes in one or two samples
_FEWEST_OF_FADING = 5
_STANDS = 0.25  # of the usual step: a machine that moves by less does not pull any more
_CARRIES = 0.05  # of the greatest load: a broken specimen carries less on the way back


@dataclass(frozen=True, slots=True)
class Rupture:
    """The end of a pull.

    Parameters
    ----------
    end : the load collapsed, the machine turned before it did, or the record stops under load
    last : index of the last sample before the break; of the greatest stress without one
    maximum : index of the greatest stress up to there
    first_after : index of the first sample after the break, None without one
    """

    end: End
    last: int
    maximum: int
    first_after: int | None


def find_rupture(strain: FloatArray, stress: FloatArray, drop: float) -> Rupture:
    """Find how a pull ended, whatever cycles came before.

    A break is a loss of the load that the specimen does not carry again: the load falls by `drop`
    of its greatest value while the crosshead goes on, or at once to where a specimen unloaded to
    that strain would still carry twice as much. A load that fades over several samples while the
    machine stands (relaxation) or goes back (unloading) is none. Exports that fill up with zeros
    after the break jump to zero strain and zero load in one sample.

    Parameters
    ----------
    strain, stress : of the whole recording, loading positive, shape (n,) `[1]`, `[Pa]`
    drop : fraction of the greatest stress by which the load must fall
    """
    maximum = int(stress.argmax())
    greatest = float(stress[maximum])  # below zero where nothing was pulled
    carrying = np.flatnonzero(stress >= min(greatest, (1.0 - drop) * greatest))
    last = int(carrying[-1])
    if last + 1 == stress.size:
        turned = strain[maximum:].max() - strain[-1] > _BACK * strain.max()
        return _unbroken(stress, "reversed" if turned else "stopped")
    after = last + 1
    gone_back = float(strain[:after].max() - strain[after])
    if _fades(strain, stress, after, drop):
        return _unbroken(stress, "reversed" if gone_back > _BACK * strain.max() else "stopped")
    if gone_back >= 0.0 and _carries_on_return(strain, stress, after, drop):
        return _unbroken(stress, "reversed")
    return Rupture("broke", last, int(stress[:after].argmax()), after)


def _fades(strain: FloatArray, stress: FloatArray, after: int, drop: float) -> bool:
    """Say whether the load falls below the drop gradually while nothing pulls any more."""
    greatest = float(stress.max())
    floor = (1.0 - drop) * greatest
    above = np.flatnonzero(stress[:after] >= floor + _FADES * greatest)
    if greatest <= 0.0 or above.size == 0:
        return False
    high = int(above[-1])
    steps = after - high
    if steps < _FEWEST_OF_FADING or float(stress[high:after].min()) < 0.9 * floor:
        return False
    forward = np.diff(strain[: high + 1])
    usual = float(np.median(forward[forward > 0.0])) if (forward > 0.0).any() else 0.0
    return float(strain[after] - strain[high]) < _STANDS * steps * usual


def _carries_on_return(strain: FloatArray, stress: FloatArray, after: int, drop: float) -> bool:
    """Say whether load is carried on the way back: nothing broke.

    Either the way back lies near the way there, or, where a specimen dissipates much, most of its
    first half still carries a load, counted from that before the pull.
    """
    top = int(strain[:after].argmax())
    tail = np.flatnonzero(strain[after:] > 0.1 * strain[top]) + after
    if tail.size == 0:
        return False
    zero = min(float(stress[0]), float(stress[tail].min()))
    highest = np.maximum.accumulate(strain[: top + 1])
    there = np.interp(strain[tail], highest, stress[: top + 1]) - zero
    back = stress[tail] - zero
    if np.median(back / np.maximum(there, 1e-300)) > _ON_CURVE * (1.0 - drop):
        return True
    far = strain[tail] > 0.5 * strain[top]
    size = int(np.count_nonzero(far))
    return bool(size >= 3 and np.count_nonzero(back[far] > _CARRIES * stress.max()) > 0.5 * size)


def _unbroken(stress: FloatArray, end: End) -> Rupture:
    top = int(stress.argmax())
    return Rupture(end, top, top, None)


def count_loadings(strain: FloatArray, last: int) -> int:
    """Count the loadings up to a sample: each returns by more than 5 % of the greatest strain."""
    x = strain[: last + 1]
    if (x[1:] >= x[:-1]).all():  # the usual test, at a hundredth of the cost
        return 1
    size = 0.05 * float(np.ptp(x))
    loadings, rising = 1, True
    low = high = float(x[0])
    for value in x.tolist():
        if rising:
            high = max(high, value)
            if high - value > size:
                rising, low = False, value
        else:
            low = min(low, value)
            if value - low > size:
                loadings, rising, high = loadings + 1, True, value
    return loadings
