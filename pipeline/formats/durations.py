"""Times written as a clock shows them (`1:02:03.5`), in seconds."""

from __future__ import annotations

import re
from datetime import datetime, time, timedelta

CLOCK = "h:mm:ss"  # the unit of a column of such times
MINUTES = "mm:ss"
_HOURS = re.compile(r"([0-9]{1,4}):([0-5][0-9]):([0-5][0-9](?:[.,][0-9]+)?)")
_MINUTES = re.compile(r"([0-9]{1,5}):([0-5]?[0-9](?:[.,][0-9]+)?)")
_DATE = re.compile(r"[12][0-9]{3}[-/.][01]?[0-9][-/.][0-3]?[0-9](?:[ T]|$)")
_WRITTEN = {
    "h:mm:ss": CLOCK, "hh:mm:ss": CLOCK, "h:m:s": CLOCK, "h:min:s": CLOCK, "hms": CLOCK,
    "std:min:s": CLOCK, "hh:mm:ss.000": CLOCK, "hh:mm:ss.0": CLOCK, "hh:mm:ss,000": CLOCK,
    "mm:ss": MINUTES, "m:ss": MINUTES, "m:s": MINUTES, "min:s": MINUTES, "mm:ss.0": MINUTES,
    "mm:ss.000": MINUTES, "min:sec": MINUTES,
}  # fmt: skip
_SPREADSHEET_DAY_0 = datetime.fromisoformat("1899-12-31")


def clock_unit(text: str) -> str:
    """Return which of the two clocks a unit names, or nothing."""
    return _WRITTEN.get(text.casefold().strip(), "")


def is_clock(cell: str) -> bool:
    """Say whether a cell is hours, minutes and seconds for certain."""
    return _HOURS.fullmatch(cell) is not None


def is_date(cell: str) -> bool:
    """Say whether a cell begins with a date, written from the year on."""
    return _DATE.match(cell) is not None


def seconds_text(cell: str, unit: str) -> str:
    """Return a time as a number of seconds, or the cell as it is where it is no such time."""
    found = (_HOURS if unit == CLOCK else _MINUTES).fullmatch(cell)
    if found is None:
        return cell
    *larger, seconds = found.groups()
    whole = 0
    for part in larger:
        whole = 60 * whole + int(part)
    return repr(60 * whole + float(seconds.replace(",", ".")))


def as_clock(cell: datetime | time | timedelta) -> str:
    """Write a cell of a workbook as a time, or as a date where it is one."""
    if isinstance(cell, time):
        since = timedelta(0, cell.second, cell.microsecond, 0, cell.minute, cell.hour)
    elif isinstance(cell, timedelta):
        since = cell
    elif cell.year <= 1900 and cell.month in (1, 12):
        since = cell - _SPREADSHEET_DAY_0  # beyond 24 h such a cell counts as a day of 1900
    else:
        return cell.isoformat(" ")
    minutes, seconds = divmod(since.seconds, 60)
    hours, minutes = divmod(minutes, 60)
    sign = "-" if since.days < 0 else ""
    fraction = f".{since.microseconds:06d}".rstrip("0") if since.microseconds else ""
    return f"{sign}{24 * since.days + hours}:{minutes:02d}:{seconds:02d}{fraction}"
