"""Serial lines of an NDJ-8S rotary viscometer, stamped by the PC that logged them.

Usage
-----
Named `ndj8s`; detected by a stamp, a tab and `3#30 RPM` in the first line that is no remark.

Format
------
Remarks start with `#`. Then one line per reading: stamp, TAB, `rotor#rpm RPM`, viscosity in mPa.s,
torque in percent, temperature in degrees Celsius. Stamps are ISO 8601 with or without an offset, or
the time of day alone, which goes on past midnight. `EEEE` in place of the viscosity is over-range,
`----` below zero: such readings are left out and their lines named. `-.-` means no probe, and so
does a temperature below absolute zero (-327.67).

Columns
-------
`viscosity_Pas [Pa.s]`, `line [1]` (of the file), the time as the stamps are written: `utc_s [s]`
(with an offset) or `local_clock_s [s]` (without), both since 1970, or `time_of_day_s [s]` since
midnight, and `rotor [1]`, `speed_rpm [rpm]`, `torque [1]` (of full scale), `temperature_K [K]`; the
last where at least half of the readings have it, between them for the others.

Uncertainties
-------------
None in the file. Viscosity is printed to 1 mPa.s, torque to 0.1 %.

Metadata
--------
Every remark under its line number.
"""

from __future__ import annotations

import re

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.core.units import to_si
from deamat.formats.format import Format
from deamat.formats.rawfile import RawFile
from deamat.formats.viscometer import (
    BELOW_ZERO,
    OVER_RANGE,
    Reading,
    clock_column,
    number,
    recording,
    temperature_K,
)

_NAME = "ndj8s"
_SETTING = re.compile(r"([0-9]+)#([0-9]+(?:\.[0-9]+)?) ?RPM")
_START = re.compile(r"[^\t#]+\t *[0-9]+#[0-9.]+ ?RPM\b")


def _recognises(head: list[str]) -> bool:
    first = next((line for line in head if line.strip() and not line.startswith("#")), "")
    return _START.match(first) is not None


def _read(file: RawFile) -> Recording:
    lines = file.body.decode().split("\n")
    if lines[-1] and not file.ends_open:
        raise RawFileError(
            file.path, "no line end after the last reading, so its last number may be cut",
            len(lines), value=lines[-1],
            hint="log the run again, or end the line if it is whole",
        )  # fmt: skip
    remarks: dict[str, str] = {}
    readings = []
    for at, raw in enumerate(lines, start=1):
        line = raw.rstrip("\r")
        if line.startswith("#"):
            remarks[f"line {at}"] = line.lstrip("# ")
        elif line.strip():
            readings.append(_reading(file, at, line))
    clock, times = clock_column(file, [(r.line, r.clock) for r in readings])
    return recording(file, readings, clock, times, _NAME, remarks, {"viscosity": "mPa.s"})


def _reading(file: RawFile, at: int, line: str) -> Reading:
    stamp, tab, rest = line.partition("\t")
    setting = _SETTING.match(rest.strip())
    if not tab or setting is None:
        raise RawFileError(
            file.path, "not a line of an NDJ-8S: stamp, TAB, rotor#rpm RPM, viscosity, torque, "
            "temperature", at, value=line.strip(), hint="log the run again, or make it a # remark",
        )  # fmt: skip
    fields = rest.strip()[setting.end() :].split()
    if not 1 <= len(fields) <= 3:
        raise RawFileError(
            file.path, f"{len(fields)} fields behind the setting where a reading has viscosity, "
            "torque and temperature", at, value=line.strip(), hint="log the run again",
        )  # fmt: skip
    numbers = {"rotor": float(setting[1]), "speed_rpm": float(setting[2])}
    for pattern, why in ((OVER_RANGE, "over-range"), (BELOW_ZERO, "below-zero")):
        if any(pattern.fullmatch(field) for field in fields[:2]):
            return Reading(at, stamp.strip(), numbers, why)
    if len(fields) < 2:
        raise RawFileError(
            file.path, "a reading without its torque; the line seems cut", at, value=line.strip(),
            hint="log the run again",
        )  # fmt: skip
    numbers["viscosity_Pas"] = to_si(number(file, at, 3, fields[0], "viscosity"), "mPa.s")
    numbers["torque"] = to_si(number(file, at, 4, fields[1], "torque"), "percent")
    if len(fields) == 3 and (kelvin := temperature_K(file, at, 5, fields[2])) is not None:
        numbers["temperature_K"] = kelvin
    return Reading(at, stamp.strip(), numbers)


FORMAT = Format(
    _NAME,
    "NDJ-8S serial lines, PC-stamped",
    _recognises,
    _read,
    looks="stamp, tab, `3#30 RPM  1925 48.1  22.0`",
)
