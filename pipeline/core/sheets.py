"""Sheets of workbooks as cells: read for registers, written for people to fill in."""

from __future__ import annotations

import io
import math
import struct
import zipfile
import zlib
from collections.abc import Mapping, Sequence
from datetime import date, datetime, time, timedelta
from xml.etree.ElementTree import ParseError
from xml.sax.saxutils import escape

from deamat.core.errors import RawFileError

ARCHIVE = b"PK\x03\x04"
AGAIN = "open it in the spreadsheet program, save it, and register the saved file"
LARGEST = 1 << 29  # bytes of an archive unpacked
# What zipfile and the XML parser raise on a damaged archive: NotImplementedError for a compression
# method that a flipped byte names, RuntimeError for a part that it marks as encrypted, ParseError
# and KeyError for its parts.
DAMAGED = (
    zipfile.BadZipFile, zlib.error, struct.error, NotImplementedError, RuntimeError, OSError,
    EOFError, ValueError, ParseError, KeyError,
)  # fmt: skip
_MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
_OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_PACKAGE = "http://schemas.openxmlformats.org/package/2006"
_KIND = "application/vnd.openxmlformats-officedocument.spreadsheetml"
_EPOCH = (1980, 1, 1, 0, 0, 0)  # of every part: same rows, same bytes

Cell = str | float | int | bool | date | datetime | time | timedelta


def is_workbook(data: bytes) -> bool:
    """Say whether bytes are an archive with the parts of an .xlsx or .ods workbook."""
    if not data.startswith(ARCHIVE):
        return False
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            names = archive.namelist()
            return "xl/workbook.xml" in names or "content.xml" in names
    except DAMAGED:
        return False


def read_cells(data: bytes, path: str) -> list[tuple[str, list[list[Cell]]]]:
    """Read every sheet of a workbook, from its first row and column on.

    Raises
    ------
    RawFileError : no workbook, a damaged or a huge one
    """
    from python_calamine import CalamineError, CalamineWorkbook, ZipError

    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            if math.fsum(part.file_size for part in archive.infolist()) > LARGEST:
                raise RawFileError(path, "a workbook too large to unpack")
        book = CalamineWorkbook.from_filelike(io.BytesIO(data))
        return [
            (name, book.get_sheet_by_name(name).to_python(skip_empty_area=False))
            for name in book.sheet_names
        ]
    except (CalamineError, ZipError, *DAMAGED) as error:
        raise RawFileError(path, f"a workbook that cannot be read: {error}", hint=AGAIN) from error


def read_sheets(data: bytes, path: str) -> list[tuple[str, list[list[str]]]]:
    """Read every sheet of a workbook as rows of text.

    Raises
    ------
    RawFileError : no workbook, a damaged or a huge one
    """
    return [
        (name, [list(map(as_text, row)) for row in rows]) for name, rows in read_cells(data, path)
    ]


def as_text(cell: Cell) -> str:
    """Write a cell as a register does: numbers with a point, days as 2022-01-31."""
    if isinstance(cell, bool):
        return str(cell).upper()
    if isinstance(cell, float):
        return str(int(cell)) if cell.is_integer() and abs(cell) < 1e15 else repr(cell)
    if isinstance(cell, datetime):
        whole_day = (cell.hour, cell.minute, cell.second) == (0, 0, 0)
        return cell.date().isoformat() if whole_day else cell.isoformat(timespec="seconds")
    return " ".join(str(cell).split())


def write_workbook(sheets: Mapping[str, Sequence[Sequence[str | float]]]) -> bytes:
    """Return an .xlsx workbook; texts are inline, so that none is ever a formula."""
    names = list(enumerate(sheets, start=1))
    listed = "".join(
        f'<sheet name="{escape(name, _QUOTE)}" sheetId="{at}" r:id="rId{at}"/>'
        for at, name in names
    )
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{_PACKAGE}/content-types">'
        '<Default Extension="rels" '
        'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        f'<Override PartName="/xl/workbook.xml" ContentType="{_KIND}.sheet.main+xml"/>'
        + "".join(
            f'<Override PartName="/xl/worksheets/sheet{at}.xml" '
            f'ContentType="{_KIND}.worksheet+xml"/>'
            for at, _ in names
        )
        + "</Types>",
        "_rels/.rels": _relations([("rId1", "officeDocument", "xl/workbook.xml")]),
        "xl/_rels/workbook.xml.rels": _relations(
            [(f"rId{at}", "worksheet", f"worksheets/sheet{at}.xml") for at, _ in names]
        ),
        "xl/workbook.xml": f'<workbook xmlns="{_MAIN}" xmlns:r="{_OFFICE}"><sheets>{listed}'
        "</sheets></workbook>",
        **{
            f"xl/worksheets/sheet{at}.xml": f'<worksheet xmlns="{_MAIN}"><sheetData>'
            f"{_rows_xml(sheets[name])}</sheetData></worksheet>"
            for at, name in names
        },
    }
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for part, xml in parts.items():
            head = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'
            archive.writestr(zipfile.ZipInfo(part, _EPOCH), head + xml, zipfile.ZIP_DEFLATED)
    return out.getvalue()


def _relations(targets: Sequence[tuple[str, str, str]]) -> str:
    listed = "".join(
        f'<Relationship Id="{name}" Type="{_OFFICE}/{kind}" Target="{target}"/>'
        for name, kind, target in targets
    )
    return f'<Relationships xmlns="{_PACKAGE}/relationships">{listed}</Relationships>'


def _rows_xml(rows: Sequence[Sequence[str | float]]) -> str:
    return "".join(
        f'<row r="{at}">' + "".join(map(_cell_xml, row)) + "</row>"
        for at, row in enumerate(rows, start=1)
    )


_QUOTE = {'"': "&quot;"}


def _cell_xml(cell: str | float) -> str:
    if isinstance(cell, str):
        kept = "".join(c for c in cell if c.isprintable())
        return f'<c t="inlineStr"><is><t xml:space="preserve">{escape(kept)}</t></is></c>'
    return f"<c><v>{cell!r}</v></c>"
