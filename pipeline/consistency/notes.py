"""Puts what was noticed about specimens onto every value that rests on them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TypeVar

from deamat.consistency.dates import day_of
from deamat.core.flags import Flag, merged
from deamat.core.recording import Specimen
from deamat.core.records import Law, Origin, PropertyRecord, Summary

E = TypeVar("E", PropertyRecord, Law)


def noted(summary: Summary, flags: Mapping[str, Sequence[Flag]]) -> Summary:
    """Add the flags of specimens to the records and laws that have them among their origins.

    Parameters
    ----------
    flags : by specimen
    """
    if not any(flags.values()):
        return summary
    return replace(
        summary,
        records=tuple(_with(record, flags) for record in summary.records),
        laws=tuple(_with(law, flags) for law in summary.laws),
    )


def with_circumstances(
    summary: Summary,
    specimens: Mapping[str, Specimen],
    calibrations: Mapping[str, tuple[str, ...]],
) -> Summary:
    """Say at each origin who tested it with what, when, how warm and how humid, as recorded.

    Parameters
    ----------
    specimens : rows by specimen
    calibrations : ids of those that held, by specimen
    """

    def told(entry: E) -> E:
        origins = [
            _circumstances(o, specimens[o.specimen], calibrations.get(o.specimen, ()))
            if o.specimen in specimens
            else o
            for o in entry.origins
        ]
        return replace(entry, origins=tuple(origins))

    return replace(
        summary,
        records=tuple(told(record) for record in summary.records),
        laws=tuple(told(law) for law in summary.laws),
    )


def _circumstances(origin: Origin, row: Specimen, calibrations: tuple[str, ...]) -> Origin:
    tested = day_of(row, "tested_on")
    temperature, humidity = (row.numbers.get(name) for name in ("temperature_K", "humidity"))
    return replace(
        origin,
        instrument=row.notes.get("instrument"),
        operator=row.notes.get("operator"),
        tested_on=None if tested is None else tested.isoformat(),
        temperature_K=None if temperature is None else temperature.value,
        humidity=None if humidity is None else humidity.value,
        calibrations=calibrations,
    )


def _with(entry: E, flags: Mapping[str, Sequence[Flag]]) -> E:
    return replace(entry, flags=_all(entry.flags, entry.origins, flags))


def _all(
    own: tuple[Flag, ...], origins: Sequence[Origin], flags: Mapping[str, Sequence[Flag]]
) -> tuple[Flag, ...]:
    specimens = list(dict.fromkeys(origin.specimen for origin in origins))
    noticed = [(s, flag) for s in specimens for flag in flags.get(s, ())]
    return tuple(dict.fromkeys((*own, *merged(noticed, len(specimens)))))
