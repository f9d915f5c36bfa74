"""A labelled table of numbers to a Recording in SI: what every reader here has in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from pipeline.core.errors import RawFileError
from pipeline.core.records import Flag, FloatArray, Recording, Source
from pipeline.core.units import UnknownUnit, si_factor
from pipeline.formats.cells import Dialect, looks_numeric
from pipeline.formats.documentation import contradictions
from pipeline.formats.header import Layout
from pipeline.formats.numbers import read_block, row_lines
from pipeline.formats.quantities import STANDARD, assign, meaning
from pipeline.formats.rawfile import RawFile


@dataclass(frozen=True, slots=True)
class Reader:
    """What a format adds to the common reading of its tables.

    Parameters
    ----------
    name, version : of the format
    dialect : how it writes rows
    unwritten : label in lower case to unit, for columns that the exporter documents but writes
        without a unit; each use is kept in the metadata
    """

    name: str
    version: int
    dialect: Dialect
    unwritten: Mapping[str, str] = field(default_factory=dict)


def required(layout: Layout | None, file: RawFile, name: str) -> Layout:
    """Give the layout, or refuse a file that a register sends to the wrong reader."""
    if layout is None:
        raise RawFileError(
            file.path,
            f"no row of labels and units as the {name} form has it",
            value=file.head[0],
            mend="leave the register's `format` empty to have the form detected",
        )
    return layout


def read_table(
    file: RawFile,
    layout: Layout,
    reader: Reader,
    metadata: Mapping[str, str],
    header_units: Mapping[str, str] | None = None,
) -> Recording:
    """Read the rows below a layout and convert every column to SI.

    Parameters
    ----------
    metadata : what the header says, as text
    header_units : label to the unit that the header states for it

    Raises
    ------
    RawFileError : a column without a unit, with an unknown one, or with an already used label;
        or rows that are not numbers for certain
    """
    _refuse_rows_above(file, layout, reader.dialect.delimiter)
    _refuse_twins(file, layout, tuple(label.casefold() for label in layout.labels))
    units, written, documented, flags = _units(file, layout, reader, header_units or {})
    if documented:
        metadata = {**metadata, "units not written in the file": ", ".join(documented)}
    conversions = [_conversion(file, layout, column, unit) for column, unit in enumerate(units)]
    si_units = tuple(si_unit for si_unit, _, _ in conversions)
    names = assign(layout.labels, si_units)
    _refuse_twins(file, layout, names)
    first = _first_row(file, layout)
    rows = read_block(file, first, len(names), reader.dialect)
    lines = row_lines(file, first, len(rows), reader.dialect)
    flags += _kind_flags(layout, si_units) + row_flags(rows, names, lines)
    columns = {
        name: _to_si(rows[:, column], factor, offset)
        for column, (name, (_, factor, offset)) in enumerate(zip(names, conversions, strict=True))
    }
    source = Source(
        path=file.path,
        sha256=file.sha256,
        first_line=lines[0],
        last_line=lines[-1],
        encoding=file.encoding,
        reader=reader.name,
        reader_version=reader.version,
    )
    return Recording(columns, metadata, written, source, tuple(flags))


def _first_row(file: RawFile, layout: Layout) -> int:
    """Skip blank lines between the labels and the rows."""
    below = range(layout.rows, len(file.head))
    return next((at for at in below if file.head[at].strip()), layout.rows)


def _refuse_rows_above(file: RawFile, layout: Layout, delimiter: str) -> None:
    """Refuse a second table: what stands above the labels is kept as text, so no rows may."""
    for at, line in enumerate(file.head[: layout.names]):
        if delimiter in line and all(map(looks_numeric, line.split(delimiter))):
            raise RawFileError(
                file.path,
                "a row of numbers above the labels",
                line=at + 1,
                value=line,
                mend="one file holds one run: export each run to a file of its own",
            )


def _refuse_twins(file: RawFile, layout: Layout, names: tuple[str, ...]) -> None:
    if len(set(names)) < len(names):
        twin = next(column for column, name in enumerate(names) if name in names[:column])
        raise RawFileError(
            file.path,
            "two columns have the same label",
            line=layout.names + 1,
            column=twin + 1,
            value=layout.labels[twin],
            mend="export each quantity once",
        )


def row_flags(rows: FloatArray, names: tuple[str, ...], lines: Sequence[int]) -> list[Flag]:
    """Notice rows that repeat the row before them, and time that runs backwards.

    Parameters
    ----------
    rows : shape (rows, columns), units as written
    lines : line of each row, counted from 1
    """
    lead = names.index("time_s") if "time_s" in names else 0
    if (rows[1:, lead] > rows[:-1, lead]).all():
        return []  # a column that only rises repeats no row: nearly every recording
    flags = _repeats(rows, lead, lines)
    if "time_s" in names:
        flags += _steps_back(rows[:, lead], lines)
    return flags


def _repeats(rows: FloatArray, lead: int, lines: Sequence[int]) -> list[Flag]:
    same = rows[1:, lead] == rows[:-1, lead]  # one column first: it rules out nearly all rows
    if not same.any():
        return []
    repeats = np.flatnonzero(same & (rows[1:] == rows[:-1]).all(axis=1))
    if not repeats.size:
        return []
    detail = (
        f"rows equal to the row before in every column: {repeats.size}, the first in line "
        f"{lines[repeats[0] + 1]}; none was dropped"
    )
    return [Flag("identical-rows", detail)]


def _steps_back(time: FloatArray, lines: Sequence[int]) -> list[Flag]:
    back = np.flatnonzero(time[1:] < time[:-1])
    if not back.size:
        return []
    row = int(back[0])
    detail = (
        f"steps back in time: {back.size}, the first in line {lines[row + 1]} "
        f"(from {time[row]:g} to {time[row + 1]:g} as written)"
    )
    return [Flag("time-not-increasing", detail)]


def _units(
    file: RawFile, layout: Layout, reader: Reader, header_units: Mapping[str, str]
) -> tuple[list[str], dict[str, str], list[str], list[Flag]]:
    """Give every column's unit, what the file writes of it, what it leaves out, what is odd."""
    stated = {label.casefold(): unit for label, unit in header_units.items()}
    flags = list(
        contradictions(stated, dict(zip(layout.labels, layout.units, strict=True)), "header")
    )
    units: list[str] = []
    written: dict[str, str] = {}
    documented = []
    for column, (label, unit) in enumerate(zip(layout.labels, layout.units, strict=True)):
        key = label.casefold()
        used = written[label] = unit or stated.get(key) or ""
        if not used and key in reader.unwritten:
            used = reader.unwritten[key]
            documented.append(f"{label} [{used}]")
        if not used:
            raise RawFileError(
                file.path,
                "a column without a unit, neither over the column nor in the header",
                line=layout.units_line + 1,
                column=column + 1,
                value=label,
                mend="export the column with its unit, or leave it out",
            )
        units.append(used)
    return units, written, documented, flags


def _conversion(file: RawFile, layout: Layout, column: int, unit: str) -> tuple[str, float, float]:
    try:
        return si_factor(unit)
    except UnknownUnit as error:
        raise RawFileError(
            file.path,
            f"{layout.labels[column]!r}: {error}",
            line=layout.units_line + 1,
            column=column + 1,
            value=unit,
            mend="export the column in a known unit, or leave it out",
        ) from error


def _to_si(values: FloatArray, factor: float, offset: float) -> FloatArray:
    """Convert a column of the table as an array of its own: `SI = factor * written + offset`."""
    if factor == 1.0 and offset == 0.0:
        return values.copy()
    scaled = values * factor
    return scaled + offset if offset else scaled


def _kind_flags(layout: Layout, si_units: tuple[str, ...]) -> list[Flag]:
    """Notice a column whose unit is not one of what its label means."""
    flags = []
    for label, si_unit in zip(layout.labels, si_units, strict=True):
        found = meaning(label)
        if found is not None and STANDARD[found[1]][0] != si_unit:
            flags.append(
                Flag(
                    "unit-of-another-kind",
                    f"{label} is in {si_unit}, which is not a unit of {found[1]}; it was not "
                    "taken for it",
                )
            )
    return flags
