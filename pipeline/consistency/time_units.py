"""Runs of one liquid against each other: the same rise sixty times as fast is another unit."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from deamat.core.flags import Flag
from deamat.core.records import Measurement, Result

_UNITS = (
    (60.0, "minutes for seconds, or hours for minutes"),
    (3600.0, "hours for seconds"),
    (1e3, "milliseconds for seconds"),
)
_NEAR = 0.15  # logs of one protocol end within so much of each other
_LEAST_RISE = 1.2  # a liquid that does not thicken looks the same at any speed
_ALIKE = 1.3  # times, at start and end
_END = 3


@dataclass(frozen=True, slots=True)
class _Span:
    """How long a log is `[s]`, and where viscosity starts and ends `[Pa.s]`."""

    specimen: str
    length_s: float
    start_Pas: float
    end_Pas: float


def time_units(measurements: Sequence[Measurement[Result]]) -> dict[str, list[Flag]]:
    """Find runs whose siblings rise as far in 60, 1000 or 3600 times as long, or as short.

    The smaller side is flagged; of two runs nobody knows which one is wrong, and both are.

    Parameters
    ----------
    measurements : of one register

    Returns
    -------
    flags by specimen
    """
    groups: dict[tuple[object, ...], list[_Span]] = defaultdict(list)
    for m in measurements:
        span = _span(m)
        if span is not None:
            groups[m.specimen.material, *sorted(m.specimen.conditions.items())].append(span)
    flags: dict[str, list[Flag]] = {}
    for spans in groups.values():
        for one, other in combinations(spans, 2):
            unit = _unit(one, other)
            if unit is None:
                continue
            for side, rest in ((one, other), (other, one)):
                if _alike(side, spans) <= _alike(rest, spans):
                    said = f"its {side.length_s:.4g} s are {side.length_s / rest.length_s:.4g} "
                    said += f"times those of {rest.specimen}, and viscosity rises as far: {unit}?"
                    flags.setdefault(side.specimen, [Flag("time-unit", said)])
    return flags


def _span(measurement: Measurement[Result]) -> _Span | None:
    columns = measurement.curve
    if "time_s" not in columns or "viscosity_Pas" not in columns:
        return None
    time_s, viscosity = columns["time_s"], columns["viscosity_Pas"]
    if len(time_s) < 2 * _END or not np.ptp(time_s) > 0:
        return None
    start, end = (float(np.median(part)) for part in (viscosity[:_END], viscosity[-_END:]))
    if not 0 < _LEAST_RISE * start < end:
        return None
    return _Span(measurement.specimen.id, float(np.ptp(time_s)), start, end)


def _unit(one: _Span, other: _Span) -> str | None:
    """Name the slip that makes two runs one; None where there is none."""
    ratio = max(one.length_s, other.length_s) / min(one.length_s, other.length_s)
    for start, end in ((one.start_Pas, other.start_Pas), (one.end_Pas, other.end_Pas)):
        if not 1.0 / _ALIKE < start / end < _ALIKE:
            return None
    return next((told for factor, told in _UNITS if abs(ratio / factor - 1.0) < _NEAR), None)


def _alike(one: _Span, spans: Sequence[_Span]) -> int:
    """Count the runs that are as long, this one among them."""
    return len([s for s in spans if abs(one.length_s / s.length_s - 1.0) < _NEAR])
