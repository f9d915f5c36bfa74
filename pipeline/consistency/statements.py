"""What a file says of itself against what its row says: header, stamp, speed, lost rows."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from datetime import date

import numpy as np

from deamat.consistency.dates import day_of
from deamat.core.arrays import FloatArray
from deamat.core.dates import read_date
from deamat.core.flags import Flag
from deamat.core.recording import Recording, Specimen
from deamat.core.units import known, si_factor

_OFF = 0.1  # relative: an exporter may have been given the nominal length
_SPEED_OFF = 0.15
_FEWEST = 10  # samples that tell a speed
_STEPS = 60  # into which a loading is cut, so that the resolution of the travel plays no part
_EVEN = 0.9  # of the intervals alike: then a longer one is a hole
_LIKE, _HOLE = 0.15, 2.5
# With a tenth of the steps at the greatest, the mean of an even log is 1.3 times the usual step.
_SURELY_EVEN = 1.9

_LABEL = re.compile(
    r"(?:.*: ?)?(?:specimen|sample|probe|probenbezeichnung|test ?piece)"
    r"(?: ?(?:label|name|id|identification|no\.?|nr\.?|number|code))?"
)
_STAMP = re.compile(
    r"(?:.*: ?)?(?:timestamp|(?:test|start|measurement) ?(?:date|time)|date(?: ?(?:and|/) ?time)?|"
    r"tested(?: on)?|datum|pr(?:ü|ue)fdatum)"
)
_OPERATOR = re.compile(
    r"(?:.*: ?)?(?:operator(?: ?name)?|tested by|user ?name|technician|bediener|pr(?:ü|ue)fer)"
)
_SPEED = "speed_m_per_s"
_LENGTHS = {
    "diameter": "diameter_m", "durchmesser": "diameter_m", "height": "height_m", "höhe": "height_m",
    "width": "width_m", "breite": "width_m", "thickness": "thickness_m", "dicke": "thickness_m",
    "gauge length": "gauge_length_m", "length": "gauge_length_m", "speed": _SPEED,
    "test speed": _SPEED, "crosshead speed": _SPEED,
}  # fmt: skip
_LENGTH = re.compile(
    rf"(?:.*: ?)?(?:(?:specimen|sample|cylinder|probe(?:n)?|test ?piece) ?)?"
    rf"({'|'.join(_LENGTHS)})(?: [a-z]0)?(?: ?[(\[](.+)[)\]])?"
)
_DURATION = re.compile(
    r"(?:.*: ?)?(?:(?:test|run|total|measurement|measuring) ?)?(?:duration|dauer|laufzeit)"
    r"(?: ?[(\[](.+)[)\]])?"
)
_STATED = re.compile(r"(.+?) ?[:=] ?(\d\S* ?\S*)")  # of a remark that is a line of its own
_DURATION_OFF = 2.0  # times, either way: a log may have been stopped, or begun, some time apart
_VALUE = re.compile(r"([-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?) ?(\S+)?")
_THOUSANDS = re.compile(r"[1-9]\d{0,2},\d{3}")  # or a decimal comma: left open
_SLASHED = re.compile(r"(\d{1,2})/(\d{1,2})/(\d{4})\b.*")
_MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")
_C_CLOCK = re.compile(rf"\w{{3}} ({'|'.join(_MONTHS)}) +(\d{{1,2}}) \d\d:\d\d:\d\d (\d{{4}})")


def label_of(recording: Recording) -> str:
    """Return the specimen's name as the export writes it; empty where it writes none."""
    for key, value in recording.metadata.items():
        if _LABEL.fullmatch(key.casefold()):
            return value
    return ""


def against_row(recording: Recording, specimen: Specimen) -> tuple[Flag, ...]:
    """Flag every statement of a file that its row contradicts."""
    return (
        *_lengths(recording.metadata, specimen),
        *_stamp(recording.metadata, specimen),
        *_speed(recording.columns, specimen),
        *_holes(recording.columns),
        *_duration(recording),
    )


@dataclass(frozen=True, slots=True)
class Stated:
    """A length or a speed that a file states of its specimen.

    Parameters
    ----------
    key, text : as written
    word : of the key, without what stands around it
    name : of the register's number by its SI name (`diameter_m`)
    value : in SI
    """

    key: str
    text: str
    word: str
    name: str
    value: float


def stated_lengths(metadata: Mapping[str, str]) -> Iterator[Stated]:
    """Return every length and speed that a file states with its unit."""
    for key, text in metadata.items():
        if not text[:1].isdigit():
            continue
        found, value = _LENGTH.fullmatch(key.casefold()), _VALUE.fullmatch(text)
        if found is None or value is None or _THOUSANDS.fullmatch(value[1]):
            continue
        name = _LENGTHS[found[1]]
        unit = key[found.start(2) : found.end(2)] if found[2] else (value[2] or "")
        number = float(value[1].replace(",", "."))
        if known(unit) and si_factor(unit)[0] == ("m/s" if name == _SPEED else "m"):
            yield Stated(key, text, found[1], name, number * si_factor(unit)[1])


def stated_days(metadata: Mapping[str, str]) -> Iterator[tuple[str, list[date]]]:
    """Return every stamp of a test with the days that it may mean."""
    for key, text in metadata.items():
        if _STAMP.fullmatch(key.casefold()) and (days := _possible_days(text)):
            yield key, days


def operator_of(recording: Recording) -> str:
    """Return who tested it as the export writes it; empty where it does not."""
    for key, value in recording.metadata.items():
        if _OPERATOR.fullmatch(key.casefold()):
            return value
    return ""


def _lengths(metadata: Mapping[str, str], specimen: Specimen) -> Iterator[Flag]:
    for stated in stated_lengths(metadata):
        row = specimen.numbers.get(stated.name)
        if row is None or not row.value:
            continue
        ratio = stated.value / row.value
        if abs(ratio - 1.0) > _OFF:
            yield Flag(
                "header-disagrees",
                f"the file says {stated.key} {stated.text}, which is {ratio:.4g} times the "
                f"{stated.word} of its row",
            )


def _duration(recording: Recording) -> Iterator[Flag]:
    """Hold how long a run took, as its file says, against its column of time."""
    if "time_s" not in recording.columns or "viscosity_Pas" not in recording.columns:
        return
    span = float(np.ptp(recording.columns["time_s"])) if recording.columns["time_s"].size else 0.0
    for key, text in recording.metadata.items():
        remark = _STATED.fullmatch(text) if _DURATION.fullmatch(key.casefold()) is None else None
        name, told = (remark[1], remark[2]) if remark else (key, text)
        found, value = _DURATION.fullmatch(name.casefold()), _VALUE.fullmatch(told)
        if found is None or value is None:
            continue
        unit = name[found.start(1) : found.end(1)] if found[1] else (value[2] or "")
        if not known(unit) or si_factor(unit)[0] != "s":
            continue
        stated_s = float(value[1]) * si_factor(unit)[1]
        if stated_s > 0 and not 1 / _DURATION_OFF < span / stated_s < _DURATION_OFF:
            yield Flag(
                "time-unit",
                f"the file says {name} {told}, and its column of time spans {span:.4g} s, "
                f"{span / stated_s:.4g} times that: another unit of time?",
            )


def _stamp(metadata: Mapping[str, str], specimen: Specimen) -> Iterator[Flag]:
    tested, cured = day_of(specimen, "tested_on"), day_of(specimen, "cured_on")
    if tested is None and cured is None:
        return
    for _, days in stated_days(metadata):
        if tested is not None and min(abs((day - tested).days) for day in days) > 1:
            said = f"the file was written on {days[0]}, its row says tested on {tested}"
            yield Flag("tested-on-disagrees", said)
        elif tested is None and cured is not None and max(days) < cured:
            said = f"the file was written on {days[0]}, before the cure on {cured}"
            yield Flag("dates-disagree", said)


def _possible_days(text: str) -> list[date]:
    """Read a stamp; one with slashes may mean two days."""
    if found := _SLASHED.fullmatch(text):
        first, second, year = found.groups()
        written = [f"{year}-{first:0>2}-{second:0>2}", f"{year}-{second:0>2}-{first:0>2}"]
    elif found := _C_CLOCK.fullmatch(text):
        month, day, year = found.groups()
        written = [f"{year}-{_MONTHS.index(month) + 1:02}-{day:0>2}"]
    else:
        written = [text]
    days = []
    for one in written:
        with suppress(ValueError):
            days.append(read_date(one))
    return days


def _speed(columns: Mapping[str, FloatArray], specimen: Specimen) -> Iterator[Flag]:
    declared = specimen.numbers.get("speed_m_per_s")
    if declared is None or "time_s" not in columns or not declared.value:
        return
    if "displacement_m" in columns:
        travel, what = columns["displacement_m"], "travel"
    else:
        length = specimen.numbers.get("gauge_length_m", specimen.numbers.get("height_m"))
        if length is None or "nominal_strain" not in columns:
            return
        travel, what = columns["nominal_strain"] * length.value, "strain times length"
    measured = _loading_speed(columns["time_s"], travel)
    if measured is None:
        return
    ratio = measured / abs(declared.value)
    if abs(ratio - 1.0) > _SPEED_OFF:
        yield Flag(
            "speed-disagrees",
            f"{what} over time is {6e4 * measured:.4g} mm/min, {ratio:.4g} times the speed of the "
            "row: units, swapped columns or another file?",
        )


def _loading_speed(time_s: FloatArray, travel_m: FloatArray) -> float | None:
    """Return the usual speed of the loading `[m/s]`; None where too little moves."""
    end = int(np.abs(travel_m - travel_m[0]).argmax()) + 1
    if end < _FEWEST:
        return None
    stride = max(1, end // _STEPS)
    steps = np.diff(travel_m[:end:stride])
    seconds = np.diff(time_s[:end:stride])
    sign = np.sign(travel_m[end - 1] - travel_m[0])
    moving = (seconds > 0.0) & (sign * steps > 0.0)
    if moving.sum() < _FEWEST // 2:
        return None
    speeds = np.abs(steps[moving] / seconds[moving])
    return float(np.median(speeds[speeds > 0.1 * speeds.max()]))


def _holes(columns: Mapping[str, FloatArray]) -> Iterator[Flag]:
    """Find rows that were dropped from an even log: in time, or in travel of an even speed."""
    if "displacement_m" not in columns:
        return
    travel = columns["displacement_m"]
    end = int(np.abs(travel - travel[0]).argmax()) + 1
    if end < 2 * _FEWEST:
        return
    for name, column in (("time_s", columns.get("time_s")), ("displacement_m", travel)):
        if column is None:
            continue
        steps = np.abs(np.diff(column[:end]))
        if steps.max() <= _SURELY_EVEN * steps.mean():
            continue  # no step of an even log can be a hole then: spares the median
        usual = float(np.median(steps))
        if usual <= 0.0 or (np.abs(steps - usual) < _LIKE * usual).mean() < _EVEN:
            continue
        holes = np.flatnonzero(steps > _HOLE * usual)
        if holes.size:
            lost = round(float(steps[holes].sum()) / usual) - holes.size
            yield Flag(
                "missing-rows",
                f"{name.rpartition('_')[0]} steps evenly but for {holes.size} gaps, the first "
                f"behind sample {int(holes[0]) + 1}: about {lost} rows are missing",
            )
            return
