"""The day of a test against the calibrations of the machine and the gauges that were used."""

from __future__ import annotations

import datetime as dt
from collections.abc import Iterable

from deamat.consistency.dates import day_of
from deamat.core.calibration import Calibration, Covered
from deamat.core.flags import Flag
from deamat.core.instruments import Instrument, Instruments
from deamat.core.recording import Specimen


def instrument_of(specimen: Specimen, instruments: Instruments) -> Instrument:
    """Find the machine of a specimen, with the calibrations that held on the day of its test."""
    stated = specimen.notes.get("instrument", "")
    return instruments.machine(stated, day_of(specimen, "tested_on"))


def calibrations_of(
    specimen: Specimen, instruments: Instruments, measures: Iterable[Covered]
) -> tuple[str, ...]:
    """Return the ids of the calibrations that a specimen's values rest on.

    Parameters
    ----------
    measures : what of the machine its technique reads
    """
    held = instrument_of(specimen, instruments).held
    found = [held[covered] for covered in measures if covered in held]
    found += [n.calibration for n in specimen.numbers.values() if n.calibration is not None]
    return tuple(dict.fromkeys(found))


def flags_of_calibrations(
    specimen: Specimen, instruments: Instruments, measures: Iterable[Covered]
) -> tuple[Flag, ...]:
    """Flag a test outside the validity of what it rests on, or on a day that nobody recorded."""
    tested = day_of(specimen, "tested_on")
    known = instruments.calibrations
    found = calibrations_of(specimen, instruments, measures)
    return tuple(flag for name in found for flag in _flags(specimen, tested, name, known[name]))


def _flags(
    specimen: Specimen, tested: dt.date | None, name: str, calibration: Calibration
) -> tuple[Flag, ...]:
    said = f"calibration {name} ({calibration.certificate}) is valid from {calibration.validity}"
    if tested is None:
        detail = f"{said}; the register states no tested_on of {specimen.id}"
        return (Flag("calibration-not-dated", detail),)
    if tested > calibration.last_day:
        days = (tested - calibration.last_day).days
        return (Flag("calibration-expired", f"{said}; tested on {tested}, {days} days later"),)
    if tested < calibration.date:
        days = (calibration.date - tested).days
        detail = f"{said}; tested on {tested}, {days} days before it was made"
        return (Flag("calibration-after-test", detail),)
    return ()
