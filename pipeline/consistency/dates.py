"""The dates of a row against each other and against its age."""

from __future__ import annotations

from datetime import date

from deamat.core.dates import read_date, stated_age
from deamat.core.flags import Flag
from deamat.core.properties import REFERENCE_AGE
from deamat.core.recording import Specimen

_DAYS_OFF, _PART_OFF = 3.0, 0.35  # an age is rounded; months differ
_USUAL_STATE_DAYS = 45.0  # up to which a specimen is tested `after cure`


def day_of(specimen: Specimen, column: str) -> date | None:
    """Read a date column of a row, which the register has checked; None where it is empty."""
    text = specimen.notes.get(column, "")
    return read_date(text) if text else None


def dates_of_row(specimen: Specimen) -> tuple[Flag, ...]:
    """Flag a test before the cure, and an age that the dates contradict."""
    cured, tested = day_of(specimen, "cured_on"), day_of(specimen, "tested_on")
    if cured is None or tested is None:
        return ()
    days = (tested - cured).days
    if days < 0:
        said = f"tested on {tested}, {-days} days before it was cured on {cured}"
        return (Flag("dates-disagree", said),)
    age = str(specimen.conditions.get("age", ""))
    stated = stated_age(age)
    if stated is not None:
        expected = stated.total_seconds() / 86400.0
        allowed = max(_DAYS_OFF, _PART_OFF * max(days, expected))
        wrong = abs(days - expected) > allowed
    else:
        wrong = age == REFERENCE_AGE and days > _USUAL_STATE_DAYS
    if not wrong:
        return ()
    said = f"age is {age!r}, but {days} days lie between cure ({cured}) and test ({tested})"
    return (Flag("dates-disagree", said),)
