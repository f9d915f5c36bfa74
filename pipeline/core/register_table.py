"""The table of a register: text or workbook, as spreadsheet programs of any country save it.

Text is UTF-8, UTF-16 with its mark, or ANSI (cp1252); fields are parted by commas, semicolons or
tabs. Empty columns at the end do not count. With semicolons or tabs, numbers may have decimal
commas, unless that leaves open what they mean.
"""

from __future__ import annotations

import codecs
import csv
import io
import re
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace

from deamat.core.errors import RawFileError
from deamat.core.sheets import ARCHIVE, read_sheets

_SEPARATORS = (",", ";", "\t")
_ANSI = "cp1252"
_MULTIBYTE = re.compile(rb"[\xc2-\xf4][\x80-\xbf]")  # a letter of UTF-8
_SIGNS = frozenset("°±²³µ·×–—‘’“”„…€%§")
_COMMA = re.compile(r"[+-]?[0-9]+,[0-9]+")
_THOUSANDS = re.compile(r"[+-]?[1-9][0-9]{0,2},[0-9]{3}")


@dataclass(frozen=True, slots=True)
class RegisterTable:
    """Header and rows of a register, each row with the line that it ends in.

    Parameters
    ----------
    separator : of its fields, empty for a workbook
    encoding : of its text, empty for a workbook
    """

    header: tuple[str, ...]
    rows: tuple[tuple[int, list[str]], ...]
    separator: str
    encoding: str = ""


def read_table(
    data: bytes, path: str, names: Sequence[str], words: Iterable[str] = ()
) -> RegisterTable:
    """Read a register's bytes.

    Parameters
    ----------
    path : relative to `raw/`, for messages
    names : columns that tell the header under the right separator, and the sheet of a workbook
    words : further names of text columns; all of them may be written in capitals or with blanks

    Raises
    ------
    RawFileError : neither text nor a workbook, or no CSV, or several sheets with such a header
    """
    known = frozenset((*names, *words))
    if data.startswith(ARCHIVE):
        return _of_workbook(data, path, names, known)
    text, encoding = _decoded(data, path)
    told = re.match(r"sep=([,;\t])\r?\n", text)  # a line by which Excel tells the separator
    tables = [
        _of_text(text, path, separator, encoding, known)
        for separator in (_SEPARATORS if told is None else told[1])
        if separator == "," or separator in text
    ]
    fitting = [table for table in tables if set(names) <= set(table.header)]
    return max(fitting or tables, key=lambda table: len(set(names) & set(table.header)))


def decimal_comma(cells: Iterable[str]) -> bool:
    """Say whether numbers are written with a comma; `1,234` alone leaves that open: it is not.

    Parameters
    ----------
    cells : of the columns that hold numbers, in a table whose fields no comma parts
    """
    told = [cell for cell in cells if cell]
    commas = [cell for cell in told if _COMMA.fullmatch(cell)]
    return (
        bool(commas)
        and not any("." in cell for cell in told)
        and not all(map(_THOUSANDS.fullmatch, commas))
    )


def _decoded(data: bytes, path: str) -> tuple[str, str]:
    try:
        if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            return data.decode("utf-16"), "utf-16"
        return data.decode("utf-8-sig"), "utf-8"
    except UnicodeDecodeError as error:
        hint = "save it as UTF-8 CSV"
        fault = RawFileError(path, "neither UTF-8 nor ANSI (cp1252)", None, None, None, hint)
        if _MULTIBYTE.search(data):  # some of it is UTF-8: a damaged file, or two encodings
            raise fault from error
        try:
            text = data.decode(_ANSI)
        except UnicodeDecodeError:
            raise fault from error
        if not all(c.isascii() or c.isalpha() or c in _SIGNS for c in text):
            raise fault from error
        return text, _ANSI


def _of_text(
    text: str, path: str, separator: str, encoding: str, known: Collection[str]
) -> RegisterTable:
    rows = csv.reader(io.StringIO(text, newline=""), delimiter=separator)
    read: list[tuple[int, list[str]]] = []
    try:
        read.extend((rows.line_num, row) for row in rows)
    except csv.Error as error:
        raise RawFileError(path, f"not CSV: {error}", rows.line_num) from error
    if read and read[0][1] in (["sep=" + separator], ["sep=", ""]):
        read = read[1:]
    return replace(_table(read, separator, known), encoding=encoding)


def _table(
    rows: Sequence[tuple[int, list[str]]], separator: str, known: Collection[str]
) -> RegisterTable:
    """Take the first row as the header; fields beyond it must be empty, and are dropped."""
    header = _header(rows[0][1], known) if rows else []
    while header and not header[-1]:
        header.pop()
    good = [
        (line, _shortened(row, len(header))) for line, row in rows[1:] if any(map(str.strip, row))
    ]
    return RegisterTable(tuple(header), tuple(good), separator)


def _header(cells: Sequence[str], known: Collection[str]) -> list[str]:
    """Write `Specimen` and `Tested on` as the known names that they are."""
    bare = [cell.strip() for cell in cells]
    plain = [re.sub(r"[ -]+", "_", cell).casefold() for cell in bare]
    return [
        word if word in known and word not in bare else cell
        for word, cell in zip(plain, bare, strict=True)
    ]


def _shortened(row: list[str], columns: int) -> list[str]:
    while len(row) > columns and not row[-1].strip():
        row = row[:-1]
    return row


def _of_workbook(
    data: bytes, path: str, names: Sequence[str], known: Collection[str]
) -> RegisterTable:
    """Take the one sheet with such a header, below blank rows or a title."""
    found = []
    for sheet, cells in read_sheets(data, path):
        rows = [(at, row) for at, row in enumerate(cells, start=1) if any(map(str.strip, row))]
        starts = [at for at, (_, row) in enumerate(rows) if set(names) <= {*_header(row, known)}]
        if starts:
            found.append((sheet, _table(rows[starts[0] :], "", known)))
    if len(found) > 1:
        sheets = ", ".join(sheet for sheet, _ in found)
        raise RawFileError(path, f"several sheets are registers: {sheets}", hint="keep one of them")
    if not found:
        reason = f"no sheet has the columns {' and '.join(names)}"
        raise RawFileError(path, reason, hint="write them in one row, and a specimen a row below")
    return found[0][1]
