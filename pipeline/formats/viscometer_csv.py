"""Plain CSV of viscosity against time, as laboratories keep it.

Usage
-----
Named `viscometer_csv`; detected by a comma-separated row of labels out of the closed list below,
with one time and one viscosity among them.

Format
------
Remarks start with `#`. Labels: one of `time_s`, `time_min`, `time_h`, `elapsed_s`, `elapsed_min`,
`elapsed_h` (elapsed time since mixing) or `timestamp` (stamps as in `ndj8s`), or both where the
stamp is that of the start and stands in every line while the time elapses since then; one of
`viscosity_mPas`, `viscosity_Pas`; and, as far as there are any, `rotor`, `speed_rpm`,
`torque_percent`, `temperature_C`. Decimal points. `EEEE` and `----` in the viscosity or torque are
over-range and below zero; an empty cell or `-.-` of the others is not recorded, nor is a
temperature below absolute zero (-327.67). An elapsed time below zero is refused.

Columns
-------
`viscosity_Pas [Pa.s]`, `line [1]` (of the file), the time as the stamps are written: `utc_s [s]`
(with an offset) or `local_clock_s [s]` (without), both since 1970, or `time_of_day_s [s]` since
midnight (these also where a start is stamped), or `time_s [s]` since mixing; and `rotor [1]`,
`speed_rpm [rpm]`, `torque [1]` (of full scale) where every reading has them, and
`temperature_K [K]` where at least half of the readings have it, between them for the others.

Uncertainties
-------------
None in the file.

Metadata
--------
Every remark under its line number.
"""

from __future__ import annotations

import difflib
from collections.abc import Sequence

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.core.units import to_si
from deamat.formats.format import Format
from deamat.formats.rawfile import RawFile
from deamat.formats.viscometer import (
    BELOW_ZERO,
    NO_PROBE,
    OVER_RANGE,
    Reading,
    clock_column,
    number,
    recording,
    temperature_K,
)

_NAME = "viscometer_csv"
_ELAPSED = {f"{stem}_{unit}": unit for stem in ("time", "elapsed") for unit in ("s", "min", "h")}
_VISCOSITY = {"viscosity_mPas": "mPa.s", "viscosity_Pas": "Pa.s"}
_OTHERS = {
    "rotor": ("rotor", "1"),
    "speed_rpm": ("speed_rpm", "rpm"),
    "torque_percent": ("torque", "percent"),
    "temperature_C": ("temperature_K", "C"),
}
_SINCE_START = "since_start_s"
_KNOWN = {*_ELAPSED, "timestamp", *_VISCOSITY, *_OTHERS}


def _labels(head: list[str]) -> tuple[int, list[str]] | None:
    """Line of the labels, counted from 0, and the labels."""
    for at, line in enumerate(head):
        if not line.strip() or line.startswith("#"):
            continue
        labels = [cell.strip() for cell in line.split(",")]
        times = [label for label in labels if label in _ELAPSED or label == "timestamp"]
        viscosities = [label for label in labels if label in _VISCOSITY]
        return (at, labels) if times and viscosities else None
    return None


def _recognises(head: list[str]) -> bool:
    return _labels(head) is not None


def _read(file: RawFile) -> Recording:
    found = _labels(file.head)
    if found is None:
        raise RawFileError(
            file.path, "no row of labels with a time and a viscosity", value=file.head[0],
            hint="leave the register's `format` empty to have the form detected",
        )  # fmt: skip
    first, labels = found
    _check(file, first + 1, labels)
    lines = file.body.decode().split("\n")
    if lines[-1] and not file.ends_open:
        raise RawFileError(
            file.path, "no line end after the last row, so its last number may be cut",
            len(lines), value=lines[-1], hint="export the file again",
        )  # fmt: skip
    while lines and not lines[-1].strip():
        lines.pop()
    remarks = {
        f"line {at}": line.strip("# \r") for at, line in enumerate(lines[:first], 1) if line.strip()
    }
    readings = [
        _reading(file, at, line.rstrip("\r"), labels)
        for at, line in enumerate(lines[first + 1 :], start=first + 2)
    ]
    if "timestamp" in labels and any(label in _ELAPSED for label in labels):
        clock, times = _since_start(file, readings, labels)
    elif "timestamp" in labels:
        clock, times = clock_column(file, [(r.line, r.clock) for r in readings])
    else:
        clock, times = "time_s", _elapsed(file, readings, labels)
    units = {"viscosity": _VISCOSITY[next(label for label in labels if label in _VISCOSITY)]}
    rest = ", ".join(label for label in labels if label and label not in _KNOWN)
    remarks |= {"columns not used": rest} if rest else {}
    return recording(file, readings, clock, times, _NAME, remarks, units)


def _check(file: RawFile, line: int, labels: Sequence[str]) -> None:
    """Refuse labels that are nearly known ones, and two that mean the same."""
    for column, label in enumerate(labels, start=1):
        if label not in _KNOWN and _nearly_known(label):
            raise RawFileError(
                file.path, "an unknown label", line, column, label,
                f"known labels: {', '.join(sorted(_KNOWN))}",
            )  # fmt: skip
    for known in ({*_ELAPSED}, {"timestamp"}, set(_VISCOSITY), *({label} for label in _OTHERS)):
        same = [label for label in labels if label in known]
        if len(same) > 1:
            raise RawFileError(
                file.path, "two columns of the same quantity", line,
                len(labels) - labels[::-1].index(same[-1]), same[-1],
                "export each quantity once",
            )  # fmt: skip


def _nearly_known(label: str) -> bool:
    """Say whether a label may be one of the list, written otherwise; the others are notes."""
    plain = label.casefold()
    stems = {known.partition("_")[0] for known in _KNOWN} | {"spindle", "rpm", "temp"}
    return plain.startswith(tuple(stems)) or bool(
        difflib.get_close_matches(plain, [known.casefold() for known in _KNOWN], 1, 0.75)
    )


def _reading(file: RawFile, at: int, line: str, labels: Sequence[str]) -> Reading:
    cells = [cell.strip() for cell in line.split(",")]
    if len(cells) != len(labels):
        raise RawFileError(
            file.path, f"{len(cells)} fields where the header names {len(labels)}", at,
            min(len(cells), len(labels)), line.strip(),
            "export with decimal points, every reading in every row",
        )  # fmt: skip
    clock, missing = "", ""
    numbers: dict[str, float] = {}
    for column, (label, cell) in enumerate(zip(labels, cells, strict=True), start=1):
        if label == "timestamp" or (label in _ELAPSED and "timestamp" not in labels):
            clock = cell
        elif label in _ELAPSED:
            numbers[_SINCE_START] = to_si(number(file, at, column, cell, label), _ELAPSED[label])
        elif label in _VISCOSITY or label == "torque_percent":
            name, unit = _OTHERS.get(label) or ("viscosity_Pas", _VISCOSITY[label])
            if OVER_RANGE.fullmatch(cell):
                missing = "over-range"
            elif BELOW_ZERO.fullmatch(cell):
                missing = "below-zero"
            elif cell or label in _VISCOSITY:
                numbers[name] = to_si(number(file, at, column, cell, label), unit)
        elif label == "temperature_C":
            if (kelvin := temperature_K(file, at, column, cell)) is not None:
                numbers["temperature_K"] = kelvin
        elif label in _OTHERS and not NO_PROBE.fullmatch(cell):
            name, unit = _OTHERS[label]
            numbers[name] = to_si(number(file, at, column, cell, label), unit)
    return Reading(at, clock, numbers, missing)


def _since_start(
    file: RawFile, readings: Sequence[Reading], labels: Sequence[str]
) -> tuple[str, FloatArray]:
    """Add the time elapsed to the one stamp that every line repeats."""
    column = labels.index("timestamp") + 1
    for r in readings:
        if r.clock != readings[0].clock:
            raise RawFileError(
                file.path, "two clocks: a stamp that changes beside an elapsed time", r.line,
                column, r.clock, "export one of the two",
            )  # fmt: skip
    clock, start = clock_column(file, [(r.line, r.clock) for r in readings[:1]])
    times = np.array([r.numbers[_SINCE_START] for r in readings])
    back = np.flatnonzero(np.diff(times) < 0)
    if back.size:
        raise RawFileError(
            file.path, "the elapsed time steps back", readings[back[0] + 1].line,
            hint="one file holds one run, in the order of time",
        )  # fmt: skip
    return clock, np.asarray(start.sum() + times)


def _elapsed(file: RawFile, readings: Sequence[Reading], labels: Sequence[str]) -> FloatArray:
    label = next(known for known in labels if known in _ELAPSED)
    column = labels.index(label) + 1
    times = np.array(
        [to_si(number(file, r.line, column, r.clock, label), _ELAPSED[label]) for r in readings]
    )
    if times.size and times[0] < 0:
        first = readings[0]
        raise RawFileError(
            file.path, "a time before mixing", first.line, column, first.clock,
            "log the time since mixing; -1 often stands for a time that is not known",
        )  # fmt: skip
    for before, r, step in zip(readings[:-1], readings[1:], np.diff(times), strict=True):
        if step < 0:
            raise RawFileError(
                file.path, f"the time steps back from {before.clock}", r.line, column, r.clock,
                "one file holds one run, in the order of time",
            )  # fmt: skip
    return times


FORMAT = Format(
    _NAME,
    "plain CSV of viscosity against time",
    _recognises,
    _read,
    looks="`time_h,rotor,speed_rpm,viscosity_mPas,torque_percent`",
)
