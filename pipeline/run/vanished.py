"""Values of the last release that a run has not got any more, and why."""

from __future__ import annotations

import json
import sqlite3
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from deamat.core.card_lists import Excluded
from deamat.core.ledger import FileEntry
from deamat.core.records import Condition, Law, PropertyRecord, Refusal
from deamat.materials.database import DATABASE_FILE

_QUERY = """
WITH entries AS (
    SELECT id, material, key, campaign, conditions, 0 AS is_law FROM properties
    UNION ALL SELECT id, material, key, campaign, conditions, 1 FROM laws
)
SELECT e.id, e.material, e.key, e.campaign, e.conditions, e.is_law, o.path, o.register, o.specimen
FROM entries e LEFT JOIN origins o ON o.id = e.id ORDER BY e.id, o.position
"""


@dataclass(frozen=True, slots=True)
class Value:
    """What tells a value from others from one release to the next.

    Parameters
    ----------
    words : its conditions that are words (age, cure); numbers are means, which move a little
    is_law : it is a law of the property
    """

    material: str
    key: str
    campaign: str
    words: tuple[tuple[str, str], ...]
    is_law: bool


@dataclass(frozen=True, slots=True)
class Published:
    """The values of a release: how many of each, and what they rest on.

    Parameters
    ----------
    rests_on : specimen and its raw file, or its register where it has none
    """

    counts: Mapping[Value, int]
    rests_on: Mapping[Value, tuple[tuple[str, str], ...]]


def published(release: Path | None) -> Published:
    """Read the values of a release; none where there is no database, or not one that is known."""
    counts: Counter[Value] = Counter()
    rests_on: dict[Value, list[tuple[str, str]]] = {}
    seen: set[int] = set()
    for number, material, key, campaign, conditions, is_law, path, register, specimen in _rows(
        release
    ):
        words = _words(json.loads(conditions))
        value = Value(material, key, campaign, words, bool(is_law))
        if number not in seen:
            seen.add(number)
            counts[value] += 1
        if specimen:
            rests_on.setdefault(value, []).append((specimen, path or register))
    return Published(counts, {value: tuple(mine) for value, mine in rests_on.items()})


def _rows(release: Path | None) -> list[tuple[Any, ...]]:
    if release is None or not (path := release / DATABASE_FILE).is_file():
        return []
    address = f"{path.resolve().as_uri()}?mode=ro&immutable=1"
    try:
        with closing(sqlite3.connect(address, uri=True)) as db:
            return db.execute(_QUERY).fetchall()
    except sqlite3.Error:  # tables of a version before, or a damaged file: nothing to compare with
        return []


def vanished(
    before: Published,
    entries: Iterable[PropertyRecord | Law],
    refusals: Sequence[Refusal],
    files: Iterable[FileEntry],
    excluded: Iterable[Excluded] = (),
) -> list[dict[str, Any]]:
    """Name each value that was published and is gone: material, property, campaign and why.

    Parameters
    ----------
    before : of the last release
    entries, refusals : records, laws and refusals of this run
    files : its account
    excluded : specimens that it left out
    """
    now = Counter(
        Value(e.material, e.key, e.campaign, _words(e.conditions), isinstance(e, Law))
        for e in entries
    )
    account = {entry.path: entry for entry in files}
    left_out = {(e.campaign, e.material, e.specimen): e for e in excluded}
    gone = []
    for value, count in before.counts.items():
        lost = count - now[value]
        if lost > 0:
            said = ", ".join(word for _, word in value.words)
            gone.append({
                "material": value.material,
                "key": f"law of {value.key}" if value.is_law else value.key,
                "campaign": value.campaign,
                "conditions": said,
                "lost": lost,
                "of": count,
                "why": _why(value, refusals, before.rests_on.get(value, ()), account, left_out),
            })  # fmt: skip
    return gone


def _words(conditions: Mapping[str, Condition]) -> tuple[tuple[str, str], ...]:
    return tuple(sorted((k, v) for k, v in conditions.items() if isinstance(v, str)))


def _why(
    value: Value,
    refusals: Sequence[Refusal],
    rests_on: Sequence[tuple[str, str]],
    account: Mapping[str, FileEntry],
    left_out: Mapping[tuple[str, str, str], Excluded],
) -> str:
    for refusal in refusals:
        its = (refusal.material, refusal.key, refusal.campaign)
        if its == (value.material, value.key, value.campaign):
            return f"refused: {refusal.reason}"
    for specimen, path in rests_on:
        if named := left_out.get((value.campaign, value.material, specimen)):
            return f"{named.place} is excluded: {named.reason}"
        entry = account.get(path)
        if entry is None or (entry.role == "missing" and entry.status == "rejected"):
            return f"{path} was removed"
        if entry.status != "used":
            return f"{path} is {entry.status}: {entry.reason}"
    return "its rows, or their conditions, were changed in the register" if rests_on else "unknown"
