"""A labelled table of numbers to a Recording in SI: what every reader here has in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from pipeline.core.errors import RawFileError
from pipeline.core.records import Flag, FloatArray, Recording, Source
from pipeline.formats.cells import looks_numeric
from pipeline.formats.columns import Reader, columns_of
from pipeline.formats.header import Layout
from pipeline.formats.numbers import read_block, row_lines
from pipeline.formats.rawfile import RawFile


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
    told = columns_of(file.path, layout, reader, header_units or {})
    if told.documented:
        metadata = {**metadata, "units not written in the file": ", ".join(told.documented)}
    first = _first_row(file, layout)
    rows = read_block(file, first, len(told.names), reader.dialect)
    lines = row_lines(file, first, len(rows), reader.dialect)
    columns = {
        name: _to_si(rows[:, column], factor, offset)
        for column, (name, (factor, offset)) in enumerate(
            zip(told.names, told.conversions, strict=True)
        )
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
    flags = (*told.flags, *row_flags(rows, told.names, lines))
    return Recording(columns, metadata, told.written, source, flags)


def _first_row(file: RawFile, layout: Layout) -> int:
    """Skip blank lines between the labels and the rows."""
    for at in range(layout.rows, len(file.head)):
        if file.head[at].strip():
            return at
    return layout.rows


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


def _to_si(values: FloatArray, factor: float, offset: float) -> FloatArray:
    """Convert a column of the table as an array of its own: `SI = factor * written + offset`."""
    if factor == 1.0 and offset == 0.0:
        return values.copy()
    scaled = values * factor
    return scaled + offset if offset else scaled
