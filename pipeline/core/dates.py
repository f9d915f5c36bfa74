"""Dates as laboratories write them, read without a guess."""

from __future__ import annotations

import re
from datetime import date, timedelta

_ISO = re.compile(r"(\d{4})-(\d{2})-(\d{2})(?:[T ].*)?")
_DOTTED = re.compile(r"(\d{1,2})\.(\d{1,2})\.(\d{4})(?:[ ,].*)?")
_FIRST, _LAST = 1950, 2100  # years in which an elastomer may have been tested

_AGE = re.compile(r"(\d+(?:\.\d+)?)\s*(minutes?|min|hours?|h|days?|d|weeks?|w|months?|years?|y)\b")
_DAYS = {"m": 1 / 1440, "h": 1 / 24, "d": 1.0, "w": 7.0, "mo": 30.44, "y": 365.25}


def read_date(text: str) -> date:
    """Read a day written as `2022-01-31` or `31.01.2022`; a time of day behind it is ignored.

    Raises
    ------
    ValueError : not such a day, or one in no calendar, or before 1950 or after 2100
    """
    if found := _ISO.fullmatch(text):
        year, month, day = map(int, found.groups())
    elif found := _DOTTED.fullmatch(text):
        day, month, year = map(int, found.groups())
    else:
        raise ValueError("not a date")
    try:
        read = date(year, month, day)
    except ValueError as error:
        raise ValueError("a day that is in no calendar") from error
    if not _FIRST <= year <= _LAST:
        raise ValueError(f"a year that is not between {_FIRST} and {_LAST}")
    return read


def stated_age(text: str) -> timedelta | None:
    """Read an age such as `2 months` or `24 h`; None for words (`after cure`)."""
    found = _AGE.match(text.strip().casefold())
    if found is None:
        return None
    unit = found[2]
    days = _DAYS["mo" if unit.startswith("mo") else unit[0]]
    return timedelta(days=float(found[1]) * days)
