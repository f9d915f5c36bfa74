"""The tables of `materials.sqlite`, and how a card becomes their rows. SI throughout; `rows` reads.

Columns come from `core.schema`, rows from the card's document, so that file and database cannot
differ. What is nested is JSON text, for `json_extract`; NULL in an interval means that it is open
there. The ids of `properties` and `laws` are unique over both, so that `origins` and `flags` serve
either.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from dataclasses import astuple
from functools import cache
from typing import Any

from deamat.core.ledger import Failure, FileEntry, Provenance
from deamat.core.schema import Field, Mark, document_of, entry_of, fields_of
from deamat.materials.card import MaterialCard
from deamat.materials.document import Document, canonical_json

APPLICATION_ID = 0x6465614D  # "deaM": tells our files from other SQLite databases

_LEDGER = """
CREATE TABLE release (
    id INTEGER PRIMARY KEY CHECK (id = 1),
    version TEXT NOT NULL, code TEXT NOT NULL,
    stages TEXT NOT NULL, environment TEXT NOT NULL, config TEXT NOT NULL
) STRICT;
CREATE TABLE failures (
    stage TEXT, subject TEXT, error TEXT NOT NULL, traceback TEXT NOT NULL, files TEXT NOT NULL,
    PRIMARY KEY (stage, subject)
) STRICT, WITHOUT ROWID;
"""

Cell = str | float | int | None
Row = tuple[Cell, ...]


def listed_in(cls: Any) -> tuple[Field, ...]:
    """Return the fields of a class that have rows in a table of their own."""
    return tuple(field for field in fields_of(cls) if field.kind.rows_of is not None)


@cache
def stored_fields(cls: Any) -> tuple[Field, ...]:
    """Return the fields of a class that have columns, in the order of these."""
    listed = [field for field in fields_of(cls) if field.columns]
    return tuple(sorted(listed, key=lambda field: Mark.IN_FRONT not in field.marks))


def _columns(cls: Any) -> list[str]:
    made = []
    for field in stored_fields(cls):
        null = field.kind.nullable or field.kind.open_ended
        kind = f"{field.kind.sql}{'' if null else ' NOT NULL'}"
        made += [f"{column} {kind}" for column in field.columns]
    return made


def _table(cls: Any, *before: str) -> str:
    entry, columns = entry_of(cls), [*before, *_columns(cls)]
    if entry.identity:
        columns.append(f"PRIMARY KEY ({', '.join(entry.identity)})")
    rowid = ", WITHOUT ROWID" if entry.identity else ""
    return f"CREATE TABLE {entry.table} (\n    {', '.join(columns)}\n) STRICT{rowid};\n"


def _entry_table(cls: Any) -> str:
    material = "material TEXT NOT NULL REFERENCES materials"
    if entry_of(cls).identity:
        return _table(cls, material)
    index = "CREATE INDEX {0}_of_material ON {0} (material, key);\n"
    return _table(cls, "id INTEGER PRIMARY KEY", material) + index.format(entry_of(cls).table)


def _owned_table(cls: Any) -> str:
    columns = ["id INTEGER", "position INTEGER", *_columns(cls), "PRIMARY KEY (id, position)"]
    table = entry_of(cls).table
    return f"CREATE TABLE {table} (\n    {', '.join(columns)}\n) STRICT, WITHOUT ROWID;\n"


ENTRIES = tuple(field.kind.rows_of for field in listed_in(MaterialCard))
OWNED = tuple(dict.fromkeys(field.kind.rows_of for cls in ENTRIES for field in listed_in(cls)))
TABLES = "".join(
    [
        _LEDGER,
        _table(FileEntry),
        _table(MaterialCard),
        *map(_entry_table, ENTRIES),
        *map(_owned_table, OWNED),
    ]
)

# Kept as PRAGMA user_version: it changes with the tables, and nobody has to think of it.
VERSION = int.from_bytes(hashlib.sha256(TABLES.encode()).digest()[:4]) >> 1


# --- rows


def provenance_rows(provenance: Provenance) -> list[Row]:
    """Return the one row of `release`."""
    told = (provenance.stages, provenance.environment, provenance.config)
    return [(1, provenance.version, provenance.code, *(canonical_json(dict(t)) for t in told))]


def file_rows(files: Iterable[FileEntry]) -> list[Row]:
    """Return the rows of `files`, by path."""
    return [astuple(entry) for entry in sorted(files, key=lambda entry: entry.path)]


def failure_rows(failures: Iterable[Failure]) -> list[Row]:
    """Return the rows of `failures`, by stage and subject."""
    return sorted(
        (f.stage, f.subject, f.error, f.traceback, canonical_json(list(f.files))) for f in failures
    )


def card_rows(card: Document, ids: Iterator[int]) -> Iterator[tuple[str, Row]]:
    """Return every row of one card with its table, in the order of the card's document.

    Parameters
    ----------
    card : as `MaterialCard.to_document` writes it
    ids : numbers for properties, laws and refusals, not used before
    """
    yield entry_of(MaterialCard).table, tuple(_cells(card, MaterialCard))
    for field in listed_in(MaterialCard):
        cls = field.kind.rows_of
        for entry in card.get(field.name, ()):
            number = () if entry_of(cls).identity else (next(ids),)
            yield entry_of(cls).table, (*number, card["material"], *_cells(entry, cls))
            for owned in listed_in(cls):
                yield from _owned_rows(owned.kind.rows_of, entry.get(owned.name, ()), *number)


def _owned_rows(cls: Any, entries: Iterable[Any], number: int) -> Iterator[tuple[str, Row]]:
    entry = entry_of(cls)
    for position, told in enumerate(entries):
        document = document_of(cls.from_text(told)) if entry.as_text else told
        yield entry.table, (number, position, *_cells(document, cls))


def _cells(document: Document, cls: Any) -> Iterator[Cell]:
    """Flatten an object: an interval gives two cells, what is nested becomes JSON text."""
    for field in stored_fields(cls):
        value = document.get(field.name, field.default)
        if len(field.columns) > 1:
            yield from value or (None,) * len(field.columns)
        else:
            yield canonical_json(value) if isinstance(value, dict | list | tuple) else value
