"""From the numbers of an axis to places on the page, and the round numbers that stand at it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.chart import Axis

_MARGIN = 0.04  # of the span of the data, on either side
_STEPS = (1.0, 2.0, 5.0, 10.0)
_LOG_STEPS = ((1.0, 2.0, 5.0), (1.0,))
Tick = tuple[float, str]


@dataclass(frozen=True, slots=True)
class Scale:
    """An axis laid on the page: `low` lies at `start`, `high` at `end` `[px]`."""

    low: float
    high: float
    start: float
    end: float
    log: bool

    def __call__(self, values: FloatArray) -> FloatArray:
        """Return places `[px]` of values; of none above zero on a logarithmic axis, NaN."""
        low, high = self.low, self.high
        if self.log:
            with np.errstate(divide="ignore", invalid="ignore"):
                values = np.log10(np.where(values > 0, values, np.nan))
            low, high = math.log10(low), math.log10(high)
        return self.start + (self.end - self.start) / (high - low) * (values - low)

    def at(self, value: float) -> float:
        """Return the place of one value `[px]`."""
        return float(self(np.array([value]))[0])


def scale_of(axis: Axis, data: Sequence[FloatArray], start: float, end: float) -> Scale:
    """Lay an axis over its data, with a margin, between two places of the page."""
    log = axis.spacing == "log"
    if axis.limits is not None:
        return Scale(*axis.limits, start, end, log)
    low, high = _extent(data, log)
    if log:
        low, high = math.log10(low), math.log10(high)
    if high <= low:
        width = 0.1 * abs(high) or 1.0
        low, high = low - width, high + width
    margin = _MARGIN * (high - low)
    from_zero = not log and 0.0 <= low < 0.2 * high
    low, high = 0.0 if from_zero else low - margin, high + margin
    if log:
        low, high = 10.0**low, 10.0**high
    return Scale(low, high, start, end, log)


def _extent(data: Sequence[FloatArray], log: bool) -> tuple[float, float]:
    ends: list[tuple[float, float]] = []
    for values in data:
        shown = values[np.isfinite(values) & (values > 0)] if log else values[np.isfinite(values)]
        if shown.size:
            ends.append((float(shown.min()), float(shown.max())))
    if not ends:
        return (1.0, 10.0) if log else (0.0, 1.0)
    return min(low for low, _ in ends), max(high for _, high in ends)


def ticks_of(axis: Axis, scale: Scale, most: int) -> list[Tick]:
    """Return the numbers to stand at an axis, `most` at most where it may choose."""
    if axis.ticks is not None:
        return list(axis.ticks)
    low, high = scale.low, scale.high
    values = _decades(low, high, most) if scale.log else []
    if len(values) < 2:
        values = _round(low, high, most)
    return [(value, number(value)) for value in values]


def number(value: float) -> str:
    """Write a round number: `0.5`, `20`, `1e+06`."""
    return f"{value + 0.0:.6g}"


def _round(low: float, high: float, most: int) -> list[float]:
    rough = (high - low) / most
    decade = 10.0 ** math.floor(math.log10(rough))
    step = next(s * decade for s in _STEPS if s * decade >= rough * (1 - 1e-9))
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [round(i * step, 12 - math.floor(math.log10(step))) for i in range(first, last + 1)]


def _decades(low: float, high: float, most: int) -> list[float]:
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    for steps in _LOG_STEPS:
        found = [s * 10.0**d for d in range(first, last + 1) for s in steps]
        found = [value for value in found if low <= value <= high]
        if len(found) <= most:
            return found
    every = math.ceil(len(found) / most)
    return found[::every]
