"""Puts what was noticed about specimens onto every value that rests on them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TypeVar

from deamat.core.flags import Flag, merged
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


def _with(entry: E, flags: Mapping[str, Sequence[Flag]]) -> E:
    return replace(entry, flags=_all(entry.flags, entry.origins, flags))


def _all(
    own: tuple[Flag, ...], origins: Sequence[Origin], flags: Mapping[str, Sequence[Flag]]
) -> tuple[Flag, ...]:
    specimens = list(dict.fromkeys(origin.specimen for origin in origins))
    noticed = [(s, flag) for s in specimens for flag in flags.get(s, ())]
    return tuple(dict.fromkeys((*own, *merged(noticed, len(specimens)))))
