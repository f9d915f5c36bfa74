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


def with_circumstances(summary: Summary, specimens: Mapping[str, Specimen]) -> Summary:
    """Say at each origin who tested it with what, when, how warm and how humid, as recorded."""
    return replace(
        summary,
        records=tuple(_told(record, specimens) for record in summary.records),
        laws=tuple(_told(law, specimens) for law in summary.laws),
    )


def _told(entry: E, specimens: Mapping[str, Specimen]) -> E:
    return replace(entry, origins=tuple(_circumstances(o, specimens) for o in entry.origins))


def _circumstances(origin: Origin, specimens: Mapping[str, Specimen]) -> Origin:
    if origin.specimen not in specimens:
        return origin
    row = specimens[origin.specimen]
    tested = day_of(row, "tested_on")
    temperature, humidity = (row.numbers.get(name) for name in ("temperature_K", "humidity"))
    return replace(
        origin,
        instrument=row.notes.get("instrument"),
        operator=row.notes.get("operator"),
        tested_on=None if tested is None else tested.isoformat(),
        temperature_K=None if temperature is None else temperature.value,
        humidity=None if humidity is None else humidity.value,
    )


def _with(entry: E, flags: Mapping[str, Sequence[Flag]]) -> E:
    return replace(entry, flags=_all(entry.flags, entry.origins, flags))


def _all(
    own: tuple[Flag, ...], origins: Sequence[Origin], flags: Mapping[str, Sequence[Flag]]
) -> tuple[Flag, ...]:
    specimens = list(dict.fromkeys(origin.specimen for origin in origins))
    noticed = [(s, flag) for s in specimens for flag in flags.get(s, ())]
    return tuple(dict.fromkeys((*own, *merged(noticed, len(specimens)))))
