"""Intervals exported by Anton Paar RheoCompass: UTF-16, tabs, three header rows, any language.

Usage
-----
Named `rheocompass`; detected by a tab-separated row of labels that starts with `Abschnittsdaten:`
or `Interval data:` and names a shear rate.

Format
------
`key:<TAB>value` lines, the row of labels, a row of remarks (`Konstanter Anteil`), a row of
bracketed units, then rows that start with a tab; decimal commas or points as the language has it.
Columns of text with empty units (date of the start) are kept as metadata. The number of points that
the header states must be there.

Columns
-------
`shear_rate_per_s [1/s]`, `shear_stress_Pa [Pa]`, `time_s [s]`, `viscosity_Pas [Pa.s]` (stress over
rate where the file has none, 0 at rest), and the rest under its own label, such as `punkt_nr [1]`.

Uncertainties
-------------
None in the file.

Metadata
--------
The header lines under their keys; the first cell of every column of text.
"""

from __future__ import annotations

import re

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording, Source
from deamat.core.units import UnknownUnit, si_factor
from deamat.formats.cells import Dialect, looks_numeric, read_cells
from deamat.formats.format import Format
from deamat.formats.header import Layout, bare_unit
from deamat.formats.quantities import assign, meaning
from deamat.formats.rawfile import RawFile

_NAME = "rheocompass"
_LABELS = re.compile(r"(?:Abschnittsdaten|Interval data):\t")
_POINTS = re.compile(r"(?:Abschnitt und Datenpunkte|Interval and data points):\t[0-9]+\t([0-9]+)")


def _layout(head: list[str]) -> Layout | None:
    at = next((i for i, line in enumerate(head) if _LABELS.match(line)), None)
    if at is None or at + 3 >= len(head):
        return None
    labels = tuple(head[at].split("\t")[1:])
    units = head[at + 2].split("\t")[1:]
    if len(units) != len(labels):
        return None
    layout = Layout(at, at + 2, labels, tuple(map(bare_unit, units)))
    return layout if layout.has("shear_rate_per_s") else None


def _recognises(head: list[str]) -> bool:
    return _layout(head) is not None


def _read(file: RawFile) -> Recording:
    layout = _layout(file.head)
    if layout is None:
        raise RawFileError(
            file.path, "no interval with labels and units as RheoCompass writes them", 1,
            value=file.head[0],
            hint="leave the register's `format` empty to have the form detected",
        )  # fmt: skip
    text = file.body.decode().replace("\r\n", "\n")
    rows = [row.split("\t") for row in text.rstrip("\n").split("\n")[layout.rows :]]
    _check(file, layout, rows)
    width = len(layout.labels)
    numeric = [c for c in range(width) if layout.units[c] or looks_numeric(rows[0][c + 1])]
    decimal = "," if any("," in rows[0][c + 1] for c in numeric) else "."
    block = "\n".join("\t".join(row[c + 1] for c in numeric) for row in rows)
    ended = text.endswith("\n") or file.ends_open
    table = read_cells(
        file, block, layout.rows + 1, len(numeric), Dialect("\t", decimal), ended=ended
    )
    labels = tuple(layout.labels[c] for c in numeric)
    factors = [_factor(file, layout, c) for c in numeric]
    names = assign(labels, tuple(unit for unit, _, _ in factors))
    columns = {
        name: table[:, i] * factor + offset
        for i, (name, (_, factor, offset)) in enumerate(zip(names, factors, strict=True))
    }
    if "viscosity_Pas" not in columns and "shear_stress_Pa" in columns:
        rates = columns["shear_rate_per_s"]
        turning = rates != 0
        viscosity = columns["shear_stress_Pa"].copy()
        viscosity[turning] /= rates[turning]
        viscosity[~turning] = 0.0  # no rate, no viscosity: the technique leaves such rows out
        columns["viscosity_Pas"] = viscosity
    said = {layout.labels[c]: rows[0][c + 1] for c in range(width) if c not in numeric}
    source = Source(
        file.path, file.sha256, layout.rows + 1, layout.rows + len(rows), file.encoding,
        _NAME,
    )  # fmt: skip
    units = {label: layout.units[c] for label, c in zip(labels, numeric, strict=True)}
    return Recording(columns, {**_notes(file.head[: layout.names]), **said}, units, source)


def _check(file: RawFile, layout: Layout, rows: list[list[str]]) -> None:
    """Refuse rows of another width, a second interval, and points that are not there."""
    for at, row in enumerate(rows, start=layout.rows + 1):
        if len(row) != len(layout.labels) + 1 or row[0]:
            raise RawFileError(
                file.path, f"{len(row) - 1} fields where the header names {len(layout.labels)}", at,
                value="\t".join(row)[:60], hint="export one interval, whole, to a file of its own",
            )  # fmt: skip
    stated = next((m for line in file.head if (m := _POINTS.match(line))), None)
    if stated is not None and int(stated[1]) != len(rows):
        raise RawFileError(
            file.path, f"{len(rows)} rows where the header states {stated[1]} points",
            layout.rows + len(rows), hint="export the file again",
        )  # fmt: skip


def _factor(file: RawFile, layout: Layout, column: int) -> tuple[str, float, float]:
    unit = layout.units[column]
    label = layout.labels[column]
    if not unit:
        found = meaning(label)
        if found is not None:
            raise RawFileError(
                file.path, "a quantity without its unit", layout.units_line + 1, column + 2, label
            )
        return "1", 1.0, 0.0
    try:
        return si_factor(unit)
    except UnknownUnit as error:
        raise RawFileError(
            file.path, f"{label!r}: {error}", layout.units_line + 1, column + 2, unit
        ) from error


def _notes(lines: list[str]) -> dict[str, str]:
    kept = {}
    for line in lines:
        key, _, value = line.partition(":\t")
        if value:
            kept[key.strip()] = value.replace("\t", " ").strip()
    return kept


FORMAT = Format(
    _NAME,
    "Anton Paar RheoCompass interval",
    _recognises,
    _read,
    "\t",
    looks="UTF-16, tab, three header rows",
    seen="Mareike-99/rheocem2024_public",
)
