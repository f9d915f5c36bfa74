"""Readings of a rotary viscometer, line by line: stamps, over-range text, and what is left out."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import pairwise

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import RawFileError
from deamat.core.number_grammar import is_number
from deamat.core.recording import Recording, Source
from deamat.core.records import Flag
from deamat.core.units import to_si
from deamat.formats.rawfile import RawFile

DAY_S = 86400.0
# A clock that shows less than before has gone past midnight if it fell by more than half a day, and
# has perhaps been set back for winter if by up to two hours.
_PAST_MIDNIGHT_S = 43200.0
_SET_BACK_S = 7200.0

OVER_RANGE = re.compile(r"E{2,}(?:\.E+)?|OVER|OL", re.IGNORECASE)
BELOW_ZERO = re.compile(r"-{2,}(?:\.-+)?")
NO_PROBE = re.compile(r"-+\.-+|-{2,}|")
_TEMPERATURE = "temperature_K"
_TIME_OF_DAY = re.compile(r"([01][0-9]|2[0-3]):([0-5][0-9]):([0-5][0-9](?:\.[0-9]+)?)")


@dataclass(frozen=True, slots=True)
class Reading:
    """One line: what it says, or why it holds no reading.

    Parameters
    ----------
    line : in the file, counted from 1
    clock : the stamp as text, or the elapsed time
    numbers : quantity by SI name (`viscosity_Pas`, `speed_rpm`, `rotor`, `torque`)
    missing : why there is no viscosity (`over-range`, `below-zero`), else empty
    """

    line: int
    clock: str
    numbers: Mapping[str, float]
    missing: str = ""


def recording(
    file: RawFile,
    readings: Sequence[Reading],
    clock: str,
    times: FloatArray,
    reader: str,
    metadata: Mapping[str, str],
    units: Mapping[str, str],
) -> Recording:
    """Keep the readings that are numbers; name the lines of the others in a flag.

    Parameters
    ----------
    clock, times : name of the column of time, and its values, shape (readings,)
    reader : name of the format

    Raises
    ------
    RawFileError : no line at all, or none with a number
    """
    if not readings:
        raise RawFileError(
            file.path, "no readings: the file ends with its header", hint="export the file again"
        )
    kept = [i for i, r in enumerate(readings) if not r.missing]
    if not kept:
        raise RawFileError(
            file.path,
            f"none of the {len(readings)} readings is a number",
            line=readings[0].line,
            value=readings[0].missing,
            hint="measure with a rotor and speed that keep the torque between 10 and 100 %",
        )
    names = [n for n in readings[kept[0]].numbers if all(n in readings[i].numbers for i in kept)]
    columns = {clock: times[kept]}
    for name in names:
        columns[name] = np.array([readings[i].numbers[name] for i in kept])
    columns["line"] = np.array([float(readings[i].line) for i in kept])
    partly = {n for i in kept for n in readings[i].numbers} - set(names)
    if _TEMPERATURE in partly and (probe := _between(readings, kept, columns["line"])) is not None:
        columns[_TEMPERATURE] = probe
        partly.remove(_TEMPERATURE)
    flags = [*_left_out(readings), *_partly(partly)]
    source = Source(
        file.path, file.sha256, readings[0].line, readings[-1].line, file.encoding, reader
    )
    return Recording(columns, metadata, units, source, tuple(flags))


def _between(
    readings: Sequence[Reading], kept: Sequence[int], lines: FloatArray
) -> FloatArray | None:
    """Temperature at every reading where at least half of them have it: it moves slowly."""
    has = [i for i, at in enumerate(kept) if _TEMPERATURE in readings[at].numbers]
    if 2 * len(has) < len(kept):
        return None
    known = np.array([readings[kept[i]].numbers[_TEMPERATURE] for i in has])
    return np.asarray(np.interp(lines, lines[has], known))


def lines_text(lines: Iterable[float]) -> str:
    """Name lines in short: `3, 5-7`."""
    runs: list[list[int]] = []
    for line in map(int, lines):
        if runs and line == runs[-1][1] + 1:
            runs[-1][1] = line
        else:
            runs.append([line, line])
    return ", ".join(f"{a}" if a == b else f"{a}-{b}" for a, b in runs)


def _left_out(readings: Sequence[Reading]) -> list[Flag]:
    flags = []
    for missing in dict.fromkeys(r.missing for r in readings if r.missing):
        lines = [r.line for r in readings if r.missing == missing]
        flags.append(Flag(missing, f"{len(lines)} readings left out: lines {lines_text(lines)}"))
    return flags


def _partly(names: set[str]) -> list[Flag]:
    return [
        Flag("not-in-every-reading", f"{name} is missing in some lines and was not used")
        for name in sorted(names)
    ]


def number(file: RawFile, line: int, column: int, text: str, what: str) -> float:
    """Read a number for certain.

    Raises
    ------
    RawFileError : anything else
    """
    if not is_number(text) or not np.isfinite(value := float(text)):
        raise RawFileError(
            file.path, f"not a number for the {what}", line, column, text, "export the file again"
        )
    return value


def temperature_K(file: RawFile, line: int, column: int, text: str) -> float | None:
    """Read a temperature in degrees Celsius `[K]`; None without a probe.

    An open probe also shows as a number below absolute zero, such as -327.67.

    Raises
    ------
    RawFileError : neither a number nor a sign that there is no probe
    """
    if NO_PROBE.fullmatch(text):
        return None
    kelvin = to_si(number(file, line, column, text, "temperature"), "C")
    return kelvin if kelvin > 0.0 else None


def clock_column(file: RawFile, stamps: Sequence[tuple[int, str]]) -> tuple[str, FloatArray]:
    """Turn stamps into seconds that rise.

    Parameters
    ----------
    stamps : line and text of each

    Returns
    -------
    column, values : `utc_s` (stamps with an offset) or `local_clock_s` (without), both since 1970;
        or `time_of_day_s` (no date), since the midnight before the first, going on past midnight

    Raises
    ------
    RawFileError : a text that is no stamp, stamps of several kinds, one stamp repeated in every
        line, or a clock that steps back
    """
    kinds: dict[str, Callable[[str], float | None]] = {
        "time_of_day_s": _of_day,
        "local_clock_s": lambda text: _of_date(text, aware=False),
        "utc_s": lambda text: _of_date(text, aware=True),
    }
    if not stamps:
        return "local_clock_s", np.zeros(0)
    line, first = stamps[0]
    if len(stamps) > 1 and all(text == first for _, text in stamps):
        raise RawFileError(
            file.path, f"all {len(stamps)} readings have one time stamp: the start of the log, "
            "not when each was taken", line, 1, first,
            "stamp every reading, or log the elapsed time as time_s",
        )  # fmt: skip
    kind = next((k for k, read in kinds.items() if read(first) is not None), None)
    if kind is None:
        raise _no_stamp(file, line, first)
    values = []
    for line, text in stamps:
        value = kinds[kind](text)
        if value is None:
            if any(read(text) is not None for read in kinds.values()):
                raise RawFileError(
                    file.path, f"a stamp of another kind than the first, {first!r}", line, 1, text,
                    "one file holds one run, stamped in one way",
                )  # fmt: skip
            raise _no_stamp(file, line, text)
        values.append(value)
    return kind, _rising(file, kind, stamps, np.array(values))


def _no_stamp(file: RawFile, line: int, text: str) -> RawFileError:
    return RawFileError(
        file.path, "not a time stamp", line, 1, text,
        "stamp with ISO 8601 (2022-03-01T20:30:00) or with the time of day (20:30:00)",
    )  # fmt: skip


def _of_day(text: str) -> float | None:
    found = _TIME_OF_DAY.fullmatch(text)
    if found is None:
        return None
    hours, minutes, seconds = found.groups()
    return 3600.0 * int(hours) + 60.0 * int(minutes) + float(seconds)


def _of_date(text: str, *, aware: bool) -> float | None:
    try:
        stamp = datetime.fromisoformat(text)
    except ValueError:
        return None
    if len(text) < len("2022-03-01T20:30") or (stamp.tzinfo is not None) != aware:
        return None
    return (stamp if aware else stamp.replace(tzinfo=UTC)).timestamp()


def _rising(
    file: RawFile, kind: str, stamps: Sequence[tuple[int, str]], values: FloatArray
) -> FloatArray:
    """Carry times of day past midnight; refuse a clock that steps back."""
    steps = np.diff(values)
    if kind == "time_of_day_s":
        over = steps < -_PAST_MIDNIGHT_S
        values = values + DAY_S * np.concatenate([[0.0], np.cumsum(over)])
        steps = np.diff(values)
    allowed = -_SET_BACK_S if kind == "local_clock_s" else 0.0
    for step, (_, (line, text)) in zip(steps, pairwise(stamps), strict=True):
        if step < allowed:
            raise RawFileError(
                file.path,
                f"the clock steps back by {-step:g} s",
                line,
                1,
                text,
                "one file holds one run, in the order of time",
            )
    return values
