"""The tables of `materials.sqlite`, and how cards become their rows and come back. SI throughout.

The rows are made from the card's document, so that file and database cannot differ. Conditions,
diagnostics, coefficients and covariances are JSON text, for `json_extract`; NULL in an interval
means that it is open there. The ids of `properties` and `laws` are unique over both, so that
`origins` and `flags` serve either.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import astuple
from typing import Any

from deamat.core.ledger import FileEntry, Provenance
from deamat.materials.document import Document, canonical_json

VERSION = 1  # raise it with every change of the tables; kept as PRAGMA user_version
APPLICATION_ID = 0x6465614D  # "deaM": tells our files from other SQLite databases

TABLES = """
CREATE TABLE release (
    id INTEGER PRIMARY KEY CHECK (id = 1),
    version TEXT NOT NULL, code TEXT NOT NULL,
    stages TEXT NOT NULL, config TEXT NOT NULL
) STRICT;
CREATE TABLE files (
    path TEXT PRIMARY KEY, sha256 TEXT NOT NULL, size INTEGER NOT NULL, role TEXT NOT NULL,
    status TEXT NOT NULL, manifest TEXT NOT NULL, reason TEXT NOT NULL,
    line INTEGER, "column" INTEGER
) STRICT, WITHOUT ROWID;
CREATE TABLE materials (
    material TEXT PRIMARY KEY, name TEXT NOT NULL, synthetic INTEGER NOT NULL,
    release TEXT NOT NULL
) STRICT, WITHOUT ROWID;
CREATE TABLE campaigns (
    material TEXT REFERENCES materials, campaign TEXT, title TEXT NOT NULL,
    laboratory TEXT NOT NULL, licence TEXT NOT NULL, source TEXT NOT NULL,
    synthetic INTEGER NOT NULL,
    PRIMARY KEY (material, campaign)
) STRICT, WITHOUT ROWID;
CREATE TABLE properties (
    id INTEGER PRIMARY KEY, material TEXT NOT NULL REFERENCES materials, key TEXT NOT NULL,
    campaign TEXT NOT NULL, value REAL NOT NULL, unit TEXT NOT NULL,
    standard_uncertainty REAL NOT NULL, u_independent REAL NOT NULL, u_shared REAL NOT NULL,
    sd REAL, ci95_low REAL, ci95_high REAL, bound TEXT NOT NULL, n INTEGER NOT NULL,
    conditions TEXT NOT NULL, method TEXT NOT NULL, diagnostics TEXT NOT NULL
) STRICT;
CREATE TABLE laws (
    id INTEGER PRIMARY KEY, material TEXT NOT NULL REFERENCES materials, key TEXT NOT NULL,
    campaign TEXT NOT NULL, kind TEXT NOT NULL, unit TEXT NOT NULL, argument TEXT NOT NULL,
    argument_unit TEXT NOT NULL, coefficients TEXT NOT NULL, covariance TEXT NOT NULL,
    valid_low REAL NOT NULL, valid_high REAL NOT NULL, parts TEXT NOT NULL,
    rates_low REAL, rates_high REAL, degrees_of_freedom REAL,
    conditions TEXT NOT NULL, method TEXT NOT NULL, diagnostics TEXT NOT NULL
) STRICT;
CREATE TABLE refusals (
    id INTEGER PRIMARY KEY, material TEXT NOT NULL REFERENCES materials, key TEXT NOT NULL,
    reason TEXT NOT NULL, campaign TEXT NOT NULL, specimen TEXT,
    conditions TEXT NOT NULL, diagnostics TEXT NOT NULL
) STRICT;
CREATE TABLE budgets (
    id INTEGER REFERENCES properties, position INTEGER,
    source TEXT NOT NULL, u REAL NOT NULL, shared INTEGER NOT NULL,
    PRIMARY KEY (id, position)
) STRICT, WITHOUT ROWID;
CREATE TABLE origins (
    id INTEGER, position INTEGER, specimen TEXT NOT NULL,
    value REAL NOT NULL, u_independent REAL NOT NULL, u_shared REAL NOT NULL,
    register TEXT NOT NULL, register_line INTEGER NOT NULL, path TEXT, sha256 TEXT,
    first_line INTEGER, last_line INTEGER, reader TEXT, technique TEXT NOT NULL,
    diagnostics TEXT NOT NULL,
    PRIMARY KEY (id, position)
) STRICT, WITHOUT ROWID;
CREATE TABLE flags (
    id INTEGER, position INTEGER, name TEXT NOT NULL, detail TEXT NOT NULL,
    PRIMARY KEY (id, position)
) STRICT, WITHOUT ROWID;
CREATE INDEX properties_of_material ON properties (material, key);
CREATE INDEX laws_of_material ON laws (material, key);
CREATE INDEX refusals_of_material ON refusals (material, key);
"""

# Fields of a card's entries, in the order of the columns behind `material`.
_PROPERTY_CELLS = (
    *("key", "campaign", "value", "unit", "standard_uncertainty", "u_independent", "u_shared"),
    *("sd", "ci95", "bound", "n", "conditions", "method", "diagnostics"),
)
_LAW_CELLS = (
    *("key", "campaign", "kind", "unit", "argument", "argument_unit", "coefficients"),
    *("covariance", "valid", "parts", "rates", "degrees_of_freedom"),
    *("conditions", "method", "diagnostics"),
)
_REFUSAL_CELLS = ("key", "reason", "campaign", "specimen", "conditions", "diagnostics")
_INTERVALS = frozenset({"ci95", "valid", "rates"})

Cell = str | float | int | None
Row = tuple[Cell, ...]


def provenance_rows(provenance: Provenance) -> list[Row]:
    """Give the one row of `release`."""
    stages, config = dict(provenance.stages), dict(provenance.config)
    return [
        (1, provenance.version, provenance.code, canonical_json(stages), canonical_json(config))
    ]


def file_rows(files: Iterable[FileEntry]) -> list[Row]:
    """Give the rows of `files`, by path."""
    return [astuple(entry) for entry in sorted(files, key=lambda entry: entry.path)]


def card_rows(card: Document, ids: Iterator[int]) -> Iterator[tuple[str, Row]]:
    """Give every row of one card with its table, in the order of the card's document.

    Parameters
    ----------
    card : as `MaterialCard.to_document` writes it
    ids : numbers for properties, laws and refusals, not used before
    """
    material = card["material"]
    yield "materials", (material, card["name"], card["synthetic"], card["release"])
    for credit in card["campaigns"]:
        yield "campaigns", (material, *credit.values())
    for record in card["properties"]:
        number = next(ids)
        yield "properties", (number, material, *_cells(record, _PROPERTY_CELLS))
        for position, line in enumerate(record["budget"]):
            yield "budgets", (number, position, *line.values())
        yield from _owned_rows(record, number)
    for law in card["laws"]:
        number = next(ids)
        yield "laws", (number, material, *_cells(law, _LAW_CELLS))
        yield from _owned_rows(law, number)
    for refusal in card["refused"]:
        yield "refusals", (next(ids), material, *_cells(refusal, _REFUSAL_CELLS))


def _owned_rows(entry: Document, number: int) -> Iterator[tuple[str, Row]]:
    for position, origin in enumerate(entry["origins"]):
        yield "origins", (number, position, *map(_cell, origin.values()))
    for position, flag in enumerate(entry["flags"]):
        name, _, detail = flag.partition(": ")
        yield "flags", (number, position, name, detail)


def _cells(entry: Document, names: Iterable[str]) -> Iterator[Cell]:
    """Flatten an entry: an interval gives two cells, what is nested becomes JSON text."""
    for name in names:
        if name in _INTERVALS:
            yield from entry[name] or (None, None)
        else:
            yield _cell(entry[name])


def _cell(value: Any) -> Cell:
    return canonical_json(value) if isinstance(value, dict | list) else value
