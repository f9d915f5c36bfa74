"""Workbooks (.xlsx, .ods): the one sheet that holds a table with what a technique needs.

Usage
-----
Named `workbook`; detected by the bytes with which such an archive starts, and by what is in it.

Format
------
Each sheet is read as a plain table (`plain`): a title and notes above, a row of labels, perhaps a
row of units, then rows of numbers. The values that are stored count, not how they are shown. Of
several sheets exactly one may hold such a table. Refused by name: a formula without its stored
value, cells shown in percent (stored as fractions), dates and durations where a number belongs.

Columns
-------
As of `plain`.

Uncertainties
-------------
None in the file.

Metadata
--------
`sheet`; every row above the labels; `columns not used`.
"""

from __future__ import annotations

import io
import math
import re
import struct
import zipfile
import zlib
from collections.abc import Sequence
from dataclasses import replace
from datetime import date, datetime, time, timedelta

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.core.records import Flag
from deamat.formats.choice import Choice
from deamat.formats.format import Format
from deamat.formats.plain import Text, complete_in, refused
from deamat.formats.plain_rows import recording_of
from deamat.formats.rawfile import RawFile

ARCHIVE = b"PK\x03\x04"
_SHEETS = re.compile(rb"<sheet\b[^>]*?/>|<sheet\b[^>]*>")
_CELL = re.compile(
    rb'<c r="([A-Z]+[0-9]+)"[^>]*>\s*<f\b(?:[^>]*/>|.*?</f>)\s*(?:</c>|<v\s*/>|<v></v>)'
)
_HIDDEN = re.compile(rb'<row\b[^>]*\bhidden="(?:1|true)"')
_STYLED = re.compile(rb'<c r="([A-Z]+[0-9]+)" s="([0-9]+)"')
_PERCENT = re.compile(rb'<numFmt\b[^>]*numFmtId="([0-9]+)"[^>]*formatCode="[^"]*%[^"]*"')
_FORMATS = re.compile(rb'<xf\b[^>]*?numFmtId="([0-9]+)"')
_LARGEST = 1 << 29  # bytes of an archive unpacked
_AGAIN = "open it in the spreadsheet program, save it, and register the saved file"

# What zipfile raises on a damaged archive: NotImplementedError for a compression method that a
# flipped byte names, RuntimeError for a part that it marks as encrypted.
_DAMAGED = (
    zipfile.BadZipFile, zlib.error, struct.error, NotImplementedError, RuntimeError, OSError,
    EOFError, ValueError,
)  # fmt: skip

Cell = str | float | int | bool | date | datetime | time | timedelta


def is_workbook(data: bytes) -> bool:
    """Say whether bytes are an archive with the parts of an .xlsx or .ods workbook."""
    if not data.startswith(ARCHIVE):
        return False
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            names = archive.namelist()
            return "xl/workbook.xml" in names or "content.xml" in names
    except _DAMAGED:
        return False


def _read(file: RawFile) -> Recording:
    found: list[tuple[str, Text, Choice]] = []
    nearest: Choice | None = None
    sheets = dict(_sheets(file))
    if file.sheet and file.sheet not in sheets:
        raise RawFileError(
            file.path, f"an Excel workbook without a sheet {file.sheet!r}; it has "
            f"{', '.join(sheets)}", hint="name one of them behind the # in the register",
        )  # fmt: skip
    for name, rows in sheets.items():
        if file.sheet not in ("", name):
            continue
        text = Text([_line(row) for row in rows], "utf-8", ended=True)
        choice, near = complete_in(file, text)
        if choice is not None:
            found.append((name, text, choice))
        if near is not None and (nearest is None or near.labelled > nearest.labelled):
            nearest = near
    if not found:
        error = refused(file, nearest)
        raise RawFileError(
            file.path, f"an Excel workbook: {error.reason}", error.line,
            hint="one sheet must hold a row of labels with their units, and numbers below",
        )  # fmt: skip
    if len(found) > 1:
        names = ", ".join(name for name, _, _ in found)
        raise RawFileError(
            file.path, f"an Excel workbook with several tables: sheets {names}",
            hint=f"name the sheet in the register: `{file.path.rpartition('/')[2]}#{found[0][0]}`",
        )  # fmt: skip
    name, text, choice = found[0]
    recording = recording_of(file, text.lines, text.encoding, choice, ended=True)
    hidden = _audit(file, name)
    flags = recording.flags
    if hidden:
        flags += (Flag("hidden-rows", f"{hidden} rows of sheet {name} are hidden; all were read"),)
    source = replace(recording.source, reader=f"workbook, sheet {name}")
    return replace(
        recording, metadata={"sheet": name, **recording.metadata}, flags=flags, source=source
    )


def _sheets(file: RawFile) -> list[tuple[str, Sequence[Sequence[Cell]]]]:
    """Read every sheet of numbers and texts, from its first row and column on."""
    from python_calamine import CalamineError, CalamineWorkbook, ZipError

    try:
        with zipfile.ZipFile(io.BytesIO(file.data)) as archive:
            if math.fsum(part.file_size for part in archive.infolist()) > _LARGEST:
                raise RawFileError(file.path, "a workbook too large to unpack")
            damaged = archive.testzip()
            if damaged is not None:
                raise RawFileError(file.path, f"a damaged workbook: {damaged}", hint=_AGAIN)
        book = CalamineWorkbook.from_filelike(io.BytesIO(file.data))
        return [
            (name, book.get_sheet_by_name(name).to_python(skip_empty_area=False))
            for name in book.sheet_names
        ]
    except (CalamineError, ZipError, *_DAMAGED) as error:
        raise RawFileError(
            file.path, f"a workbook that cannot be read: {error}", hint=_AGAIN
        ) from error


def _line(row: Sequence[Cell]) -> str:
    """Write a row of cells as a line of fields parted by tabs."""
    return "\t".join(map(_field, row))


def _field(cell: Cell) -> str:
    if isinstance(cell, bool):
        return str(cell).upper()
    if isinstance(cell, float) and cell.is_integer() and abs(cell) < 1e15:
        return str(int(cell))
    return " ".join(str(cell).replace('"', "''").split())


def _audit(file: RawFile, name: str) -> int:
    """Refuse formulas without a value and cells in percent; return how many rows are hidden."""
    with zipfile.ZipFile(io.BytesIO(file.data)) as archive:
        part = _part(archive, name)
        if part is None:
            return 0
        xml = archive.read(part)
        formula = _CELL.search(xml)
        if formula is not None:
            raise RawFileError(
                file.path, f"sheet {name}: the formula in cell {formula[1].decode()} has no "
                "stored value", hint=_AGAIN,
            )  # fmt: skip
        percent = _percent_styles(archive)
        for cell, style in _STYLED.findall(xml) if percent else ():
            if int(style) in percent:
                raise RawFileError(
                    file.path, f"sheet {name}: cell {cell.decode()} is shown in percent and "
                    "stored as a fraction", hint="show the cells as numbers, with their unit above",
                )  # fmt: skip
        return len(_HIDDEN.findall(xml))


def _part(archive: zipfile.ZipFile, name: str) -> str | None:
    """Name the part of an .xlsx archive that holds a sheet: they are numbered in their order."""
    names = archive.namelist()
    if "xl/workbook.xml" not in names:
        return None
    sheets = _SHEETS.findall(archive.read("xl/workbook.xml"))
    relations = archive.read("xl/_rels/workbook.xml.rels").decode("utf-8", "replace")
    for sheet in sheets:
        text = sheet.decode("utf-8", "replace")
        said = re.search(r'\bname="([^"]*)"', text)
        link = re.search(r'\br:id="([^"]*)"', text)
        if said is None or link is None or _unescaped(said[1]) != name:
            continue
        for relation in re.findall(r"<Relationship\b[^>]*>", relations):
            target = re.search(r'\bTarget="/?(?:xl/)?([^"]*)"', relation)
            if f'Id="{link[1]}"' in relation and target and f"xl/{target[1]}" in names:
                return f"xl/{target[1]}"
    return None


def _unescaped(text: str) -> str:
    for name, mark in (("&lt;", "<"), ("&gt;", ">"), ("&quot;", '"'), ("&apos;", "'")):
        text = text.replace(name, mark)
    return text.replace("&amp;", "&")


def _percent_styles(archive: zipfile.ZipFile) -> frozenset[int]:
    """Number the cell styles that show a fraction in percent."""
    if "xl/styles.xml" not in archive.namelist():
        return frozenset()
    xml = archive.read("xl/styles.xml")
    percent = {9, 10} | {int(number) for number in _PERCENT.findall(xml)}
    cells = xml.partition(b"<cellXfs")[2].partition(b"</cellXfs>")[0]
    return frozenset(
        at for at, number in enumerate(_FORMATS.findall(cells)) if int(number) in percent
    )


FORMAT = Format("workbook", "Excel or OpenDocument workbook", lambda _: False, _read)
