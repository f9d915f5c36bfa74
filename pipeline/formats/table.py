"""A labelled table of numbers to a Recording in SI: what every reader here has in common."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import RawFileError
from deamat.core.recording import Recording, Source
from deamat.core.records import Flag
from deamat.formats.cells import looks_numeric
from deamat.formats.columns import Columns, Reader, columns_of
from deamat.formats.header import Layout, notes
from deamat.formats.numbers import read_block, read_some, row_lines
from deamat.formats.rawfile import Head, RawFile


@dataclass(frozen=True, slots=True)
class _Heading:
    """What stands above the rows of a table.

    Parameters
    ----------
    rows : line of the first row, counted from 0
    columns : what they are
    metadata : what the header says, as text
    """

    rows: int
    columns: Columns
    metadata: Mapping[str, str]


def required(layout: Layout | None, head: Head, name: str, path: str = "") -> Layout:
    """Return the layout, or refuse a file that a register sends to the wrong reader."""
    if layout is None:
        raise RawFileError(
            path,
            f"no row of labels and units as the {name} form has it",
            value=head[0],
            hint="leave the register's `format` empty to have the form detected",
        )
    return layout


def read_plain(
    file: RawFile, layout_of: Callable[[Head], Layout | None], reader: Reader
) -> Recording:
    """Read a file of some lines of notes above one table, and convert every column to SI.

    Parameters
    ----------
    layout_of : finds the table

    Raises
    ------
    RawFileError : as `read_table`, or there is no table
    """
    try:
        heading = file.once(_plain_heading, layout_of, reader)
    except RawFileError as error:
        raise RawFileError(file.path, *error.args[1:]) from error
    return _read_rows(file, heading, reader)


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
    try:
        heading = _heading(file.head, layout, reader, metadata, header_units or {})
    except RawFileError as error:
        raise RawFileError(file.path, *error.args[1:]) from error
    return _read_rows(file, heading, reader)


def _plain_heading(
    head: Head, layout_of: Callable[[Head], Layout | None], reader: Reader
) -> _Heading:
    layout = required(layout_of(head), head, reader.name)
    metadata = notes(head[: layout.names], reader.dialect.delimiter)
    return _heading(head, layout, reader, metadata, {})


def _heading(
    head: Head,
    layout: Layout,
    reader: Reader,
    metadata: Mapping[str, str],
    header_units: Mapping[str, str],
) -> _Heading:
    _refuse_rows_above(head, layout, reader.dialect.delimiter)
    columns = columns_of(layout, reader, header_units)
    if columns.documented:
        metadata = {**metadata, "units not written in the file": ", ".join(columns.documented)}
    if columns.left:
        metadata = {**metadata, "columns not used": ", ".join(filter(None, columns.left))}
    return _Heading(_first_row(head, layout), columns, metadata)


def _read_rows(file: RawFile, heading: _Heading, reader: Reader) -> Recording:
    told = heading.columns
    if told.left:
        rows = read_some(
            file, heading.rows, told.kept, len(told.kept) + len(told.left), reader.dialect
        )
    else:
        rows = read_block(file, heading.rows, len(told.names), reader.dialect)
    lines = row_lines(file, heading.rows, len(rows), reader.dialect)
    columns = _to_si(rows, told.conversions)
    source = Source(
        path=file.path,
        sha256=file.sha256,
        first_line=lines[0],
        last_line=lines[-1],
        encoding=file.encoding,
        reader=reader.name,
    )
    lead = columns[_lead(told.names)]
    flags = told.flags
    if not (lead[1:] > lead[:-1]).all():  # nearly every recording rises, so it repeats no row
        flags += row_flags(rows, told.names, lines)
    named = dict(zip(told.names, columns, strict=True))
    return Recording(named, heading.metadata, told.written, source, flags)


def _first_row(head: Head, layout: Layout) -> int:
    """Skip blank lines between the labels and the rows."""
    for at in range(layout.rows, len(head)):
        if head[at].strip():
            return at
    return layout.rows


def _refuse_rows_above(head: Head, layout: Layout, delimiter: str) -> None:
    """Refuse a second table: what stands above the labels is kept as text, so no rows may."""
    for at, line in enumerate(head[: layout.names]):
        if delimiter in line and all(map(looks_numeric, line.split(delimiter))):
            raise RawFileError(
                "",
                "a row of numbers above the labels",
                line=at + 1,
                value=line,
                hint="one file holds one run: export each run to a file of its own",
            )


def row_flags(rows: FloatArray, names: tuple[str, ...], lines: Sequence[int]) -> tuple[Flag, ...]:
    """Notice rows that repeat the row before them, and time that runs backwards.

    Parameters
    ----------
    rows : shape (rows, columns), units as written
    lines : line of each row, counted from 1
    """
    lead = _lead(names)
    flags = _repeats(rows, lead, lines)
    if "time_s" in names:
        flags += _steps_back(rows[:, lead], lines)
    return tuple(flags)


def _lead(names: tuple[str, ...]) -> int:
    """Return the column that tells most rows apart: time, or the first."""
    return names.index("time_s") if "time_s" in names else 0


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


def _to_si(rows: FloatArray, conversions: Sequence[tuple[float, float]]) -> FloatArray:
    """Convert rows as written to columns, shape (columns, n): `SI = factor * written + offset`."""
    columns = rows.T.copy()
    for column, (factor, offset) in zip(columns, conversions, strict=True):
        if factor != 1.0:
            column *= factor
        if offset:
            column += offset
    return columns
