"""How a pull ended: a break, a reversal or a stop; and slips and cycles on the way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.estimators.curves.noise import noise_sd

End = Literal["broke", "reversed", "stopped"]

_BACK = 0.02  # of the greatest strain: a return by more is a reversal, by less the crosshead's stop
_ON_CURVE = 0.5  # of the load that loading needed there: an unbroken specimen still carries it
_SLIP = 0.03  # of the load: a sudden loss of more than this is no property of a rubber
_SLIPPABLE = 0.1  # of the greatest load: below it a loss is noise or a toe
_RECOVERED = 0.3  # of the load lost that must come back for the loss to be a slip


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
    of its greatest value while the crosshead goes on, or falls to where a specimen unloaded to
    that strain would still carry twice as much. Exports that fill up with zeros after the break
    jump to zero strain and zero load in one sample.

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
    if gone_back <= _BACK * float(strain.max()):
        return Rupture("broke", last, int(stress[:after].argmax()), after)
    if _carries_on_return(strain, stress, after, drop):
        return _unbroken(stress, "reversed")
    return Rupture("broke", last, int(stress[:after].argmax()), after)


def _carries_on_return(strain: FloatArray, stress: FloatArray, after: int, drop: float) -> bool:
    """Say whether the way back lies near the way there: nothing broke."""
    top = int(strain[:after].argmax())
    tail = np.flatnonzero(strain[after:] > 0.1 * strain[top]) + after
    if tail.size == 0:
        return False
    highest = np.maximum.accumulate(strain[: top + 1])
    there = np.interp(strain[tail], highest, stress[: top + 1])
    return bool(np.median(stress[tail] / np.maximum(there, 1e-300)) > _ON_CURVE * (1.0 - drop))


def _unbroken(stress: FloatArray, end: End) -> Rupture:
    top = int(stress.argmax())
    return Rupture(end, top, top, None)


@dataclass(frozen=True, slots=True)
class Slip:
    """A sudden loss of load that came back: the specimen slid in its grips or tore a little.

    Parameters
    ----------
    at : index of the last sample before the loss
    loss : fraction of the load that was lost
    count : how many such losses there are; `at` and `loss` are those of the first
    """

    at: int
    loss: float
    count: int


def find_slip(strain: FloatArray, stress: FloatArray, last: int) -> Slip | None:
    """Find sudden losses of load while the crosshead goes on, after which the load rises again.

    Parameters
    ----------
    strain, stress : loading positive, shape (n,)
    last : index of the last sample that carries load
    """
    x, y = strain[: last + 1], stress[: last + 1]
    if y.size < 4:
        return None
    fall = y[:-1] - y[1:]
    greatest = float(y.max())
    if fall.max() <= _SLIP * _SLIPPABLE * greatest:  # the usual test, at a tenth of the cost
        return None
    noise = noise_sd(y)
    forward = np.diff(x) >= 0.0
    lost = np.maximum.accumulate(y)[:-1] - y[1:]
    sudden = (fall > np.maximum(_SLIP * np.abs(y[:-1]), 8.0 * noise)) & forward
    sudden &= y[:-1] > _SLIPPABLE * greatest
    found = []
    for i in np.flatnonzero(sudden).tolist():
        drop = float(y[i] - y[i + 1])
        wild = i > 0 and y[i - 1] - y[i + 1] < 0.5 * drop  # one sample too high
        lost_sample = i + 2 < y.size and y[i] - y[i + 2] < 0.5 * drop  # or one too low
        risen = float(y[i + 1 :].max() - y[i + 1])
        if not wild and not lost_sample and risen > _RECOVERED * float(lost[i]):
            found.append(i)
    if not found:
        return None
    first = found[0]
    return Slip(first, float(1.0 - y[first + 1] / y[first]), len(found))


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
