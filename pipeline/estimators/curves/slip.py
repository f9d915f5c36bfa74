"""Slip in the grips and partial tears: load that is lost while the crosshead goes on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.estimators.curves.noise import noise_sd

_SLIP = 0.03  # of the load: a sudden loss of more than this is no property of a rubber
_SLIPPABLE = 0.1  # of the greatest load: below it a loss is noise or a toe
_RECOVERED = 0.3  # of the load lost that must come back for the loss to be a slip
_CERTAIN = 8.0  # standard deviations of the load's noise
_STEPS = 2.5  # of the load's resolution, likewise
_TURN = 0.05  # of the greatest strain: a return by more begins another loading
_BLOCKS = 40  # of equal strain, into which a loading is divided
_PER_BLOCK = 4  # samples, on average
_FEWEST_BLOCKS = 8
_FLAT = 0.2  # of the rise on both sides of a stretch: no rubber bends so sharply twice
_SHORTEST = 0.95  # of the most that is lost over any stretch


@dataclass(frozen=True, slots=True)
class Slip:
    """A loss of load that came back: the specimen slid in its grips or tore a little.

    Parameters
    ----------
    at, until : index of the last sample before the loss, and of the first behind it
    loss : fraction of the load that was lost
    count : how many such losses there are; the others are those of the first
    """

    at: int
    until: int
    loss: float
    count: int

    @property
    def sudden(self) -> bool:
        """Say whether the load was lost between two samples."""
        return self.until == self.at + 1


def find_slip(strain: FloatArray, stress: FloatArray, last: int) -> Slip | None:
    """Find losses of load while the crosshead goes on, sudden ones first, then gradual ones.

    Parameters
    ----------
    strain, stress : loading positive, shape (n,)
    last : index of the last sample that carries load
    """
    x, y = strain[: last + 1], stress[: last + 1]
    if y.size < 4:
        return None
    steps = np.abs(np.diff(y))
    if not steps.any():
        return None
    noise, step = _CERTAIN * noise_sd(y), _STEPS * float(steps[steps > 0.0].min())
    return _sudden(x, y, max(noise, step)) or _gradual(x, y, noise, step)


def _sudden(x: FloatArray, y: FloatArray, least: float) -> Slip | None:
    """Find losses between two samples, after which the load rises again."""
    fall = y[:-1] - y[1:]
    greatest = float(y.max())
    if fall.max() <= _SLIP * _SLIPPABLE * greatest:  # the usual test, at a tenth of the cost
        return None
    then = np.append(x[2:], x[-1])
    further = (then >= x[1:]) | (then > np.append(x[0], x[:-2]))  # not where the machine turns
    forward = (np.diff(x) >= 0.0) & further
    lost = np.maximum.accumulate(y)[:-1] - y[1:]
    sudden = (fall > np.maximum(_SLIP * np.abs(y[:-1]), least)) & forward
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
    return Slip(first, first + 1, float(1.0 - y[first + 1] / y[first]), len(found))


def _gradual(x: FloatArray, y: FloatArray, noise: float, step: float) -> Slip | None:
    """Find the stretch of the last loading over which the load stays behind both its sides most.

    The loading is divided into blocks of equal strain; over the stretch the load rises by less
    than a fifth of what it does in the two blocks in front of it and in the two behind it, one
    block on either side left out. A rubber bends so sharply at most once, where it yields.
    """
    x, y, first = _last_loading(x, y)
    blocks = min(_BLOCKS, y.size // _PER_BLOCK)
    if blocks < _FEWEST_BLOCKS:
        return None
    way = np.maximum.accumulate(x)
    edges = np.searchsorted(way, np.linspace(way[0], way[-1], blocks + 1)[:-1])
    if (np.diff(edges, append=y.size) < 2).any():
        return None
    size = np.diff(edges, append=y.size)
    level = np.add.reduceat(_without_spikes(y), edges) / size
    rise = np.diff(level)
    told = max(noise / float(np.sqrt(size.min())), step)  # counts of a coarse cell do not average
    total = np.concatenate([[0.0], np.cumsum(rise)])
    least = np.minimum(rise[:-1], rise[1:])  # of two neighbours
    best, loss = None, 0.0
    for start in range(3, rise.size - 3):
        ends = np.arange(start + 1, rise.size - 2)
        usual = np.minimum(least[start - 3], least[ends + 1])
        gained = total[ends] - total[start]
        behind = (ends - start) * usual - gained
        slid = (
            (gained < _FLAT * (ends - start) * usual) & (usual > told) & (behind > max(noise, step))
        )
        slid &= behind > _SLIP * level[start]
        if slid.any() and level[start] > _SLIPPABLE * level.max():
            most = float(behind[slid].max())
            if most > loss:  # the shortest stretch that shows it
                best = start, int(ends[slid & (behind >= _SHORTEST * most)][0])
                loss = most
    if best is None:
        return None
    at, until = int(edges[best[0]]), int(edges[best[1]])
    return Slip(first + at, first + until, loss / float(level[best[0]]), 1)


def _last_loading(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray, int]:
    """Cut off what came before the loading that ends the record, and say where it begins."""
    back = np.flatnonzero(np.maximum.accumulate(x) - x > _TURN * float(np.ptp(x)))
    if back.size == 0:
        return x, y, 0
    begun = int(back[-1])
    while begun > 0 and x[begun - 1] <= x[begun]:
        begun -= 1
    return x[begun:], y[begun:], begun


def _without_spikes(y: FloatArray) -> FloatArray:
    """Median of each sample and its two neighbours, shape (n,)."""
    left, right = np.concatenate([y[:1], y[:-1]]), np.concatenate([y[1:], y[-1:]])
    low, high = np.minimum(left, right), np.maximum(left, right)
    result: FloatArray = np.clip(y, low, high)
    return result
