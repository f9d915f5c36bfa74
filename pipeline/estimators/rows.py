"""Rows of recordings compared by what they hold: copies are found without keeping the rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray

_RUN = 5  # neighbouring rows that are hashed together
_KEPT = 192  # smallest hashes of a recording: shared fractions of 5 % still show
_ODD = np.uint64(0x9E3779B97F4A7C15)
_SHIFT = np.uint64(29)
_WRITTEN = 0.1  # of a converter's step: what writing its multiples rounds them by
_SET_STEPS = 4  # different ones: none, up, down, and the last one
_ROUNDED = 4.2  # quanta: rounding alone moves a third difference by at most four


@dataclass(frozen=True, slots=True)
class Sketch:
    """What is kept of a recording to find copies of its rows.

    Parameters
    ----------
    runs : the smallest hashes of runs of five rows, little-endian 64-bit integers, ascending
    count : different runs in the recording
    """

    runs: bytes
    count: int


def sketch(columns: Sequence[FloatArray]) -> Sketch:
    """Sketch the rows of a recording: bottom-k hashes of runs of neighbouring rows.

    Hashes are of single-precision values, so that a copy written in other units shows as well.

    Parameters
    ----------
    columns : shape (n,) each, without time (a copy may start at another time)

    Source: A. Z. Broder, Compression and Complexity of Sequences (1997) 21, for bottom-k sketches.
    """
    # a constant column is hashed with the others: it may not be constant in a sibling
    telling = [column for column in columns if column.size >= _RUN and not _counts(column)]
    if not any(np.ptp(column) > 0.0 for column in telling):
        telling = []
    if not telling:
        return Sketch(b"", 0)
    rows = np.zeros(telling[0].size, dtype=np.uint64)
    for column in telling:
        bits = column.astype(np.float32).view(np.uint32)
        rows = _mixed(rows * _ODD + bits)
    count = rows.size - _RUN + 1
    runs = rows[:count]
    moving = np.ones(count, dtype=bool)  # a channel at rest repeats itself from test to test
    for offset in range(1, _RUN):
        runs = _mixed(runs * _ODD + rows[offset : offset + count])
        moving &= rows[offset : offset + count] != rows[offset - 1 : offset - 1 + count]
    told = _different(runs[moving])
    return Sketch(told[:_KEPT].astype("<u8").tobytes(), int(told.size))


def holders_of(sketches: Sequence[Sketch]) -> list[list[int]]:
    """List which sketches hold each hash that several of them hold, by their places."""
    hashes = np.concatenate([np.zeros(0, np.uint64), *map(_hashes, sketches)])
    owner = np.repeat(np.arange(len(sketches)), [len(one.runs) // 8 for one in sketches])
    order = np.argsort(hashes, kind="stable")
    hashes, owner = hashes[order], owner[order]
    starts = np.flatnonzero(np.append(True, hashes[1:] != hashes[:-1]))
    ends = np.append(starts[1:], hashes.size)
    several = ends - starts > 1
    pairs = zip(starts[several].tolist(), ends[several].tolist(), strict=True)
    return [owner[start:end].tolist() for start, end in pairs]


def shared_fraction(one: Sketch, other: Sketch) -> float:
    """Estimate which fraction of the shorter recording's rows the other one holds too."""
    a, b = _hashes(one), _hashes(other)
    if not (a.size and b.size):
        return 0.0
    common = float(np.intersect1d(a, b, assume_unique=True).size)
    fewer = min(one.count, other.count)
    if max(one.count, other.count) <= _KEPT:
        return common / fewer
    end = min(a[-1] if one.count > _KEPT else b[-1], b[-1] if other.count > _KEPT else a[-1])
    seen = float((a <= end).sum() + (b <= end).sum()) - common  # a fair sample of the union
    union = (one.count + other.count) / (1.0 + common / seen)
    return min(1.0, common / seen * union / fewer)


def has_noise(column: FloatArray) -> bool:
    """Say whether neighbouring values scatter by more than their last written digit explains.

    Two tests never share the noise of one; a curve without noise may come from a simulation.
    """
    if column.size < 2 * _RUN:
        return False
    quantum = max(_quantum(column), _converter_step(column))
    if quantum and np.unique(np.rint(np.diff(column) / quantum)).size <= _SET_STEPS:
        return False  # a voltage that is set in steps
    bends = np.abs(np.diff(column, n=3))
    return float(np.median(bends)) > _ROUNDED * quantum


def _counts(column: FloatArray) -> bool:
    """Say whether a column steps evenly, as a running number does: it tells no tests apart."""
    steps = column[1:] - column[:-1]
    if steps[0] == 0.0:
        return False
    return bool((np.abs(steps - steps[0]) <= 1e-6 * abs(steps[0])).all())


def _quantum(column: FloatArray) -> float:
    """Find the largest power of ten of which all values are multiples."""
    greatest = float(np.abs(column).max())
    if greatest == 0.0:
        return 0.0
    top = int(np.floor(np.log10(greatest)))
    for digits in range(12):
        quantum = 10.0 ** (top - digits)
        units = column / quantum
        if np.abs(units - np.rint(units)).max() < 1e-6 * 10.0 ** max(digits - 6, 0):
            return quantum
    return 0.0


def _converter_step(column: FloatArray) -> float:
    """Find the step of the converter of which all values are multiples, zero if there is none."""
    values = np.unique(column)
    if values.size < 2:
        return 0.0
    step = float(np.diff(values).min())
    span = float(values[-1] - values[0])
    step = span / round(span / step)
    off = (values - values[0]) / step
    return step if np.abs(off - np.rint(off)).max() < _WRITTEN else 0.0


def _different(values: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Sort and drop repeats; quicker than `np.unique`, which hashes first."""
    values = np.sort(values)
    kept: NDArray[np.uint64] = values[np.append(True, values[1:] != values[:-1])[: values.size]]
    return kept


def _hashes(of: Sketch) -> NDArray[np.uint64]:
    return np.frombuffer(of.runs, dtype="<u8").astype(np.uint64)


def _mixed(values: NDArray[np.uint64]) -> NDArray[np.uint64]:
    return (values ^ (values >> _SHIFT)) * _ODD
