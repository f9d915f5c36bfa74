"""Workbooks (.xlsx, .ods): the one sheet that holds a table with what a technique needs.

Usage
-----
Named `workbook`; detected by the bytes with which such an archive starts, and by what is in it.

Format
------
Each sheet is read as a plain table (`plain`): a title, notes and results above, a row of labels,
perhaps a row of units, then rows of numbers. The values that are stored count, not how they are
shown: durations are in seconds, and cells shown in percent are fractions whatever stands above
them. Of several sheets exactly one may hold such a table, or the register names it
(`file.xlsx#Sheet`); where specimens stand side by side it names their columns
(`file.xlsx#Sheet!A:C`). Refused by name: a formula without its stored value, a column of which
some cells are shown in percent, dates where a number belongs. Rows that are hidden or filtered out
are read, and a flag says so.

Columns
-------
As of `plain`.

Uncertainties
-------------
None in the file.

Metadata
--------
`sheet`; every row above the labels; `columns not used`. The source names sheet and cells
(`Data!A3:C202`).
"""

from __future__ import annotations

import io
import math
import zipfile
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from datetime import datetime, time, timedelta
from functools import partial

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.core.records import Flag
from deamat.core.sheets import AGAIN as _AGAIN
from deamat.core.sheets import DAMAGED as _DAMAGED
from deamat.core.sheets import LARGEST as _LARGEST
from deamat.core.sheets import Cell
from deamat.formats.cells import OVER_RANGE
from deamat.formats.choice import Choice
from deamat.formats.durations import as_clock
from deamat.formats.format import Format
from deamat.formats.header import notes
from deamat.formats.plain_rows import Rows, recording_from, recording_of
from deamat.formats.plain_tables import FEW_ROWS, Text, complete_among, refused
from deamat.formats.rawfile import RawFile, column_letters
from deamat.formats.structure import Heading, headings
from deamat.formats.workbook_audit import Marks, marks_of

_HEAD = 1000  # rows in which labels are looked for at most
_ROWS = 40  # of numbers in a row are the table

Cells = Sequence[Sequence[Cell]]
Found = tuple[str, Cells, Marks, Choice]


def _read(file: RawFile) -> Recording:
    sheets = _sheets(file)
    if file.sheet and file.sheet not in [name for name, _, _ in sheets]:
        raise RawFileError(
            file.path, f"an Excel workbook without a sheet {file.sheet!r}; it has "
            f"{', '.join(name for name, _, _ in sheets)}",
            hint="name one of them behind the # in the register",
        )  # fmt: skip
    found, nearest = _tables(file, sheets)
    if not found:
        raise _refused(file, nearest)
    if len(found) > 1:
        names = ", ".join(name for name, *_ in found)
        raise RawFileError(
            file.path, f"an Excel workbook with several tables: sheets {names}",
            hint=f"name the sheet in the register: `{file.path.rpartition('/')[2]}#{found[0][0]}`",
        )  # fmt: skip
    return _recording(file, *found[0])


def _tables(
    file: RawFile, sheets: Iterable[tuple[str, Cells, Marks]]
) -> tuple[list[Found], tuple[str, Choice] | None]:
    """Find the sheets that hold a table with what is needed, and the nearest one of the others."""
    found: list[Found] = []
    nearest: tuple[str, Choice] | None = None
    for name, rows, marks in sheets:
        if file.sheet in ("", name):
            choice, near = _choice(file, _head(rows), marks)
            if choice is not None:
                found.append((name, rows, marks, choice))
            if near is not None and (nearest is None or near.labelled > nearest[1].labelled):
                nearest = name, near
    for better in (_is_shown, _is_long, _is_by_label):  # than a summary, a sheet put aside
        found = list(filter(better, found)) or found
    return found, nearest


def sheets_with_a_table(file: RawFile) -> list[str]:
    """Name the sheets that hold a table with what the technique needs.

    Raises
    ------
    RawFileError : a workbook that cannot be read
    """
    return [name for name, *_ in _tables(file, _sheets(file))[0]]


def _is_shown(found: Found) -> bool:
    return not found[2].sheet_hidden


def _is_long(found: Found) -> bool:
    return len(found[1]) - found[3].heading.first > FEW_ROWS


def _is_by_label(found: Found) -> bool:
    return found[3].by_label


def lines_of_sheets(file: RawFile) -> dict[str, list[str]]:
    """Write every sheet as lines of fields parted by tabs.

    Raises
    ------
    RawFileError : a workbook that cannot be read
    """
    return {name: [_line(row) for row in rows] for name, rows, _ in _sheets(file)}


def read_chosen(file: RawFile, chosen: Callable[[Sequence[str]], Choice | None]) -> Recording:
    """Read the one sheet in which a table is chosen.

    Parameters
    ----------
    chosen : lines of a sheet, fields parted by tabs, to what is meant by its columns

    Raises
    ------
    RawFileError : in no sheet or in several, a percentage that is stored as a fraction, values that
        are not stored
    """
    found = []
    for name, rows, marks in _sheets(file):
        lines = [_line(row) for row in rows]
        choice = chosen(lines) if file.sheet in ("", name) else None
        if choice is not None:
            found.append((name, lines, marks, choice))
    if len(found) != 1:
        names = ", ".join(name for name, *_ in found) or "none"
        raise RawFileError(
            file.path, f"one sheet must hold the table, and {names} do",
            hint="name the sheet in the register: `book.xlsx#Sheet`",
        )  # fmt: skip
    name, lines, marks, choice = found[0]
    for taken in choice.used:
        if taken.unit in ("%", "percent") and (choice.heading.first, taken.column) in marks.percent:
            raise RawFileError(
                file.path, f"{taken.label} is shown in percent and stored as a fraction",
                choice.heading.first + 1, taken.column + 1, hint="declare its unit as 1",
            )  # fmt: skip
    recording = recording_of(file, lines, "utf-8", choice, ended=True)
    return _audited(file, name, marks, choice, recording)


def _refused(file: RawFile, nearest: tuple[str, Choice] | None) -> RawFileError:
    error = refused(file, nearest[1] if nearest else None)
    hint = error.hint or "one sheet must hold a row of labels with their units, and numbers below"
    if nearest and not file.sheet:
        hint = hint.replace("#", f"#{nearest[0]}!")
    return RawFileError(file.path, f"an Excel workbook: {error.reason}", error.line, hint=hint)


def _sheets(file: RawFile) -> list[tuple[str, Cells, Marks]]:
    """Read every sheet of numbers and texts, from its first row and column on."""
    from python_calamine import (
        CalamineError,
        CalamineWorkbook,
        SheetTypeEnum,
        SheetVisibleEnum,
        ZipError,
    )

    try:
        with zipfile.ZipFile(io.BytesIO(file.data)) as archive:
            if math.fsum(part.file_size for part in archive.infolist()) > _LARGEST:
                raise RawFileError(file.path, "a workbook too large to unpack")
            book = CalamineWorkbook.from_filelike(io.BytesIO(file.data))
            found = []
            for about in book.sheets_metadata:
                if about.typ != SheetTypeEnum.WorkSheet:
                    continue  # a chart
                marks = marks_of(archive, about.name)
                sheet = book.get_sheet_by_name(about.name)
                rows = _unmerged(sheet.to_python(skip_empty_area=False), sheet.merged_cell_ranges)
                shown = about.visible == SheetVisibleEnum.Visible
                found.append((about.name, rows, replace(marks, sheet_hidden=not shown)))
            return found
    except (CalamineError, ZipError, *_DAMAGED) as error:
        raise RawFileError(
            file.path, f"a workbook that cannot be read: {error}", hint=_AGAIN
        ) from error


def _unmerged(
    rows: list[list[Cell]], merged: Sequence[tuple[tuple[int, int], tuple[int, int]]] | None
) -> Cells:
    """Let a label that stands over several rows of a header stand in each of them."""
    for (first, column), (last, _) in merged or ():
        for at in range(first + 1, min(last + 1, len(rows))):
            if column < len(rows[at]) and isinstance(rows[first][column], str):
                rows[at][column] = rows[first][column]
    return rows


def _head(rows: Cells) -> list[str]:
    """Write the rows down to the first of a table as lines of fields parted by tabs."""
    lines, numbers = [], 0
    for row in rows[:_HEAD]:
        lines.append(_line(row))
        plain = [cell for cell in row if cell != ""]
        numbers = numbers + 1 if len(plain) > 1 and set(map(type, plain)) <= _NUMBER else 0
        if numbers > _ROWS:
            break
    return lines


_NUMBER = {float, int}


def _line(row: Sequence[Cell]) -> str:
    return "\t".join(map(_field, row))


def _field(cell: Cell) -> str:
    if isinstance(cell, str):
        return " ".join(cell.replace('"', "''").split())
    if isinstance(cell, bool):
        return str(cell).upper()
    if isinstance(cell, datetime | time | timedelta):
        return as_clock(cell)
    if isinstance(cell, float) and cell.is_integer() and abs(cell) < 1e15:
        return str(int(cell))
    return str(cell)


def _choice(
    file: RawFile, lines: Sequence[str], marks: Marks
) -> tuple[Choice | None, Choice | None]:
    """Choose the table; what is shown in percent is a fraction, whatever stands above it."""
    text = Text(lines, "utf-8", ended=True)
    return complete_among(file, text, map(partial(_fractions, marks), headings(lines)))


def _fractions(marks: Marks, heading: Heading) -> Heading:
    units = tuple(
        "1" if unit in ("", "%") and (heading.first, at) in marks.percent else unit
        for at, unit in enumerate(heading.units)
    )
    return replace(heading, units=units)


def _recording(file: RawFile, name: str, rows: Cells, marks: Marks, choice: Choice) -> Recording:
    recording = _quick(file, rows, choice)
    if recording is None:
        lines = [_line(row) for row in rows]
        again, near = _choice(file, lines, marks)
        if again is None:
            raise _refused(file, None if near is None else (name, near))
        choice = again
        _insist_on_values(file, name, marks, choice, len(rows))
        recording = recording_of(file, lines, "utf-8", choice, ended=True)
    return _audited(file, name, marks, choice, recording)


def _audited(
    file: RawFile, name: str, marks: Marks, choice: Choice, recording: Recording
) -> Recording:
    """Insist on stored values, and say where the table stands and which rows are hidden."""
    first, last = recording.source.first_line, recording.source.last_line
    _insist_on_values(file, name, marks, choice, last)
    used = [taken.column for taken in choice.used if taken.name in recording.columns]
    cells = f"{column_letters(min(used))}{first}:{column_letters(max(used))}{last}"
    return replace(
        recording,
        metadata={"sheet": name, **recording.metadata},
        flags=recording.flags + _hidden(name, marks, range(first - 1, last)),
        source=replace(recording.source, reader=f"workbook, {name}!{cells}"),
    )


def _quick(file: RawFile, rows: Cells, choice: Choice) -> Recording | None:
    """Read columns that hold numbers alone, or return None where that is not certain."""
    first, last = choice.heading.first, len(rows)
    within = file.columns or range(len(rows[0]) if rows else 0)
    while last > first and not any(c != "" for c in rows[last - 1][within.start : within.stop]):
        last -= 1
    values = {}
    for taken in choice.used if last > first else ():
        column = _numbers([row[taken.column] for row in rows[first:last]])
        if column is None:
            return None
        values[taken.name] = column
    if not values:
        return None
    above = notes([_line(row) for row in rows[: choice.heading.names]], "\t")
    return recording_from(file, choice, Rows(values, {}, first + 1, last), "utf-8", above)


def _numbers(cells: Sequence[Cell]) -> FloatArray | None:
    if not set(map(type, cells)) <= _NUMBER:
        return None
    values = np.array(cells, dtype=np.float64)
    return values if np.abs(values).max() < OVER_RANGE else None


def _insist_on_values(file: RawFile, name: str, marks: Marks, choice: Choice, last: int) -> None:
    """Refuse formulas without a value, and columns of which some cells are shown in percent."""
    rows = range(choice.heading.first, last)
    for taken in choice.used:
        blank = _first(marks.unsaved, rows, taken.column)
        if blank is not None:
            raise RawFileError(
                file.path, f"sheet {name}: the formula in cell "
                f"{column_letters(taken.column)}{blank + 1} has no stored value", blank + 1,
                taken.column + 1, hint=_AGAIN,
            )  # fmt: skip
        shown = _first(marks.percent, rows, taken.column)
        if shown is not None and (taken.unit != "1" or not _all(marks, rows, taken.column)):
            raise RawFileError(
                file.path, f"sheet {name}: cell {column_letters(taken.column)}{shown + 1} is shown "
                "in percent and stored as a fraction", shown + 1, taken.column + 1,
                hint="show the cells as numbers, with their unit above",
            )  # fmt: skip


def _first(places: Iterable[tuple[int, int]], rows: range, column: int) -> int | None:
    return min((row for row, at in places if at == column and row in rows), default=None)


def _all(marks: Marks, rows: range, column: int) -> bool:
    return all((row, column) in marks.percent for row in rows)


def _hidden(name: str, marks: Marks, rows: range) -> tuple[Flag, ...]:
    if marks.sheet_hidden:
        return (Flag("hidden-rows", f"sheet {name} is hidden; it was read"),)
    hidden = len(marks.hidden.intersection(rows))
    if not hidden:
        return ()
    why = "filtered out" if marks.filtered else "hidden"
    return (Flag("hidden-rows", f"{hidden} rows of sheet {name} are {why}; all were read"),)


FORMAT = Format(
    "workbook",
    "Excel or OpenDocument workbook",
    lambda _: False,
    _read,
    looks="`.xlsx` or `.ods`: the one sheet with a table",
    seen="python-calamine",
)
