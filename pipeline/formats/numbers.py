"""Rows of numbers to an array: fast where every byte is certain, slow with a reason elsewhere.

The fast path takes a block of rows only if deleting the characters of numbers leaves exactly the
separators that `columns` fields a row must leave, and if JSON's strict number grammar accepts
every field. All the rest goes to `cells`, which reads what is unambiguous and refuses the rest
by line and column. Both give the double nearest to the text, as Python's `float` does.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import simdjson

from deamat.core.arrays import FloatArray
from deamat.core.errors import RawFileError
from deamat.formats.cells import OVER_RANGE, Dialect, read_cells
from deamat.formats.quoted import unquote
from deamat.formats.rawfile import RawFile

_DIGITS = b"0123456789+-eE "
_BLANK_LINES = re.compile(rb"\n(?:[ \t]*\r?\n)+")
_CHUNK = 1 << 20  # bytes parsed at a time: the parser's workspace is some ten times its text
# One parser for all files: the fresh pages of a new one cost as much as the parsing. It refuses to
# parse while something that it parsed is still referred to.
_PARSER = simdjson.Parser()
_RETURN, _LINE = b"\r\n"
_MINUS, _ZERO = b"-0"
_FIELD_END = np.zeros(256, dtype=np.bool_)
_FIELD_END[list(b",] \r")] = True
_TAIL = 64  # bytes that are searched for blank lines at the end; more of them go the slow way


def read_block(file: RawFile, first: int, columns: int, dialect: Dialect) -> FloatArray:
    """Read the rows of a file from line `first` (counted from 0) to its end.

    Parameters
    ----------
    columns : fields of every row
    dialect : how the format writes them

    Returns
    -------
    array, shape (rows, columns), every value finite

    Raises
    ------
    RawFileError : no rows, or anything in them that is not a number for certain
    """
    rows = rows_from(file, first)
    if rows is not None and dialect.segmented:
        rows = _BLANK_LINES.sub(b"\n", rows)
    table = parse(rows, columns, dialect) if rows else None
    if table is not None:
        return table
    text = file.body[file.offset(first) :].replace(b"\r\n", b"\n").rstrip(b" \n").decode()
    if not text:
        raise RawFileError(
            file.path,
            "no data rows: the file ends with its header",
            line=first,
            hint="export the file again",
        )
    ended = file.ends_open or file.body.endswith(b"\n")
    return read_cells(file, text, first + 1, columns, dialect, ended=ended)


def rows_from(file: RawFile, first: int) -> bytes | None:
    """Return the bytes from line `first` on, without their last line end, or None if it is odd."""
    start, end = file.offset(first), len(file.body)
    tail = file.body[max(start, end - _TAIL) :]
    ending = tail[len(tail.rstrip(b" \r\n")) :]
    ended = file.ends_open or ending.endswith(b"\n")
    if not ended or b"\r" in ending.replace(b"\r\n", b"\n"):
        return None
    return file.body[start : end - len(ending)]


def read_some(
    file: RawFile, first: int, kept: Sequence[int], columns: int, dialect: Dialect
) -> FloatArray:
    """Read some of the columns of a block whose others may hold anything.

    Parameters
    ----------
    kept : columns that are read, counted from 0
    columns : fields of every row

    Raises
    ------
    RawFileError : as `read_block`, by line and column of the file, or a row of another length
    """
    start = file.offset(first)
    mark = dialect.delimiter.encode()
    lines = []
    for line in file.body[start:].split(b"\n"):
        fields = line.rstrip(b"\r").split(mark)
        whole = len(fields) == columns
        lines.append(mark.join(fields[column] for column in kept) if whole else line)
    part = replace(file, data=file.body[:start] + b"\n".join(lines), declared="utf-8")
    try:
        return read_block(part, first, len(kept), dialect)
    except RawFileError as error:
        column = error.column and kept[min(error.column, len(kept)) - 1] + 1
        raise RawFileError(
            file.path, error.reason, error.line, column, error.value, error.hint
        ) from error


def row_lines(file: RawFile, first: int, rows: int, dialect: Dialect) -> Sequence[int]:
    """Return the line of every row that `read_block` read, counted from 1."""
    if not dialect.segmented:
        return range(first + 1, first + 1 + rows)
    lines = file.body[file.offset(first) :].split(b"\n")
    return [at for at, line in enumerate(lines, start=first + 1) if line.strip()]


def parse(block: bytes, columns: int, dialect: Dialect) -> FloatArray | None:
    """Parse rows without their last line end, or return None where they are not certain."""
    if dialect.quoted and b'"' in block:
        plain = unquote(block.replace(b"\r\n", b"\n"))
        return None if plain is None else parse(plain, columns, Dialect("\t"))
    if len(block) <= _CHUNK:
        return _parse(block, columns, dialect)
    table = np.empty((block.count(b"\n") + 1, columns))
    row = start = 0
    while start < len(block):
        end = len(block)
        if end - start > _CHUNK:
            end = block.rfind(b"\n", start, start + _CHUNK)
            if end < 0:
                return None
        part = _parse(block[start:end].removesuffix(b"\r"), columns, dialect)
        if part is None:
            return None
        table[row : row + len(part)] = part
        row += len(part)
        start = end + 1
    return table


def _parse(block: bytes, columns: int, dialect: Dialect) -> FloatArray | None:
    delimiter, decimal = dialect.delimiter.encode(), dialect.decimal.encode()
    line_end = b"\r\n" if b"\r" in block else b"\n"
    marks = block.translate(None, _DIGITS) + line_end  # decimal marks and separators
    first = marks[: marks.index(b"\n") + 1]
    one_row = delimiter * (columns - 1) + line_end
    rows = len(marks) // len(first)
    if marks != first * rows or first.translate(None, decimal) != one_row:  # rows unlike the first
        separators = marks.translate(None, decimal)
        rows = len(separators) // len(one_row)
        if separators != one_row * rows:
            return None
        first = b""
    text = _json_list(block, line_end, delimiter, decimal)
    values = None if text is None else _json_numbers(text)
    if text is None or values is None or values.size != rows * columns:
        return None  # one empty field leaves no number and no separator
    if not _within_range(values):
        return None
    fractions = len(first) == len(one_row) + columns  # one decimal mark in every field
    if not fractions and not values.all() and _has_integer_minus_zero(text):
        return None
    return values.reshape(rows, columns)


def _json_list(block: bytes, line_end: bytes, delimiter: bytes, decimal: bytes) -> bytes | None:
    """Write rows as one JSON list, or None where a line does not end as the others do."""
    if line_end == b"\r\n" and b" " in block and not _together(block):
        return None
    # The return of a line end becomes the comma. Its line feed stays, white space to JSON, so that
    # digits between the two would be a field too many or two numbers with no comma between them.
    text = np.frombuffer(block, dtype=np.uint8)
    for mark, wanted in ((decimal, b"."), (delimiter, b","), (line_end[:1], b",")):
        if mark != wanted:  # passes of numpy over bytes cost less than `translate` or `replace`
            text = text ^ (text == ord(mark)).view(np.uint8) * np.uint8(ord(mark) ^ ord(wanted))
    listed = b"".join((b"[", text.data, b"]"))
    if b"+" in listed and not (b"+-" in listed or b"+ " in listed):  # JSON knows no leading plus
        return re.sub(rb"([\[,]\n?)\+", rb"\1", listed)
    return listed


def _together(block: bytes) -> bool:
    """Say whether carriage return and line feed only stand together, in this order."""
    characters = np.frombuffer(block, dtype=np.uint8)
    return bool(((characters[:-1] == _RETURN) == (characters[1:] == _LINE)).all())


def _json_numbers(text: bytes) -> FloatArray | None:
    try:
        parsed = _PARSER.parse(text)
    except (ValueError, RuntimeError):
        return None
    if not isinstance(parsed, simdjson.Array):
        return None
    return np.frombuffer(parsed.as_buffer(of_type="d"))  # a copy: nothing refers to `parsed` now


def _within_range(values: FloatArray) -> bool:
    with np.errstate(over="ignore"):
        if values.dot(values) < OVER_RANGE**2:  # no square is greater than the sum of all
            return True
    return bool(np.abs(values).max() < OVER_RANGE)


def _has_integer_minus_zero(text: bytes) -> bool:
    """Look for a field `-0`, which JSON reads as an integer, without its sign."""
    if b"-" not in text:
        return False
    characters = np.frombuffer(text, dtype=np.uint8)
    minus = np.flatnonzero(characters[:-2] == _MINUS)
    zero = minus[characters[minus + 1] == _ZERO]
    return bool(_FIELD_END[characters[zero + 2]].any())
