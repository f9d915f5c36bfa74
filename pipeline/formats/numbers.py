"""Rows of numbers to an array: fast where every byte is certain, slow with a reason elsewhere.

The fast path takes a block of rows only if deleting the characters of numbers leaves exactly the
separators that `columns` fields a row must leave, and if JSON's strict number grammar accepts
every field. All the rest goes to `cells`, which reads what is unambiguous and refuses the rest
by line and column. Both give the double nearest to the text, as Python's `float` does.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache

import numpy as np
import simdjson
from numpy.typing import NDArray

from pipeline.core.errors import RawFileError
from pipeline.core.records import FloatArray
from pipeline.formats.cells import OVER_RANGE, Dialect, read_cells
from pipeline.formats.quoted import unquote
from pipeline.formats.rawfile import RawFile

_DIGITS = b"0123456789+-eE "
_BLANK_LINES = re.compile(rb"\n(?:[ \t]*\r?\n)+")
_CHUNK = 1 << 20  # bytes parsed at a time: the parser's workspace is some ten times its text
# One parser for all files: the fresh pages of a new one cost as much as the parsing. It refuses to
# parse while something that it parsed is still referred to.
_PARSER = simdjson.Parser()
_RETURN, _LINE = b"\r\n"
_LINE_TO_COMMA = np.uint8(_LINE ^ ord(","))  # by exclusive or, the cheapest way over many bytes


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
    block = file.body[file.offset(first) :]
    ended = file.ends_open or block.endswith(b"\n")
    rows = block.rstrip(b" \r\n")
    lone_return = b"\r" in block[len(rows) :].replace(b"\r\n", b"\n")
    if dialect.segmented:
        rows = _BLANK_LINES.sub(b"\n", rows)
    table = parse(rows, columns, dialect) if rows and ended and not lone_return else None
    if table is not None:
        return table
    text = block.replace(b"\r\n", b"\n").rstrip(b" \n").decode()
    if not text:
        raise RawFileError(
            file.path,
            "no data rows: the file ends with its header",
            line=first,
            mend="export the file again",
        )
    return read_cells(file, text, first + 1, columns, dialect, ended=ended)


def row_lines(file: RawFile, first: int, rows: int, dialect: Dialect) -> Sequence[int]:
    """Give the line of every row that `read_block` read, counted from 1."""
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
    one_row = delimiter * (columns - 1) + line_end
    separators = block.translate(None, _DIGITS + decimal) + line_end
    rows = len(separators) // len(one_row)
    if separators != one_row * rows:
        return None
    characters = np.frombuffer(block, dtype=np.uint8)
    line_feeds = characters == _LINE
    if line_end != b"\n" and not _only_before(characters == _RETURN, line_feeds):
        return None
    # A carriage return may stay: it is white space to JSON.
    if delimiter == b",":
        listed = (characters ^ line_feeds.view(np.uint8) * _LINE_TO_COMMA).tobytes()
    else:
        listed = block.translate(_to_commas(decimal + delimiter))
    text = b"".join((b"[", listed, b"]"))
    if b"+" in text and not (b"+-" in text or b"+ " in text):  # JSON knows no leading plus
        text = text.replace(b",+", b",").replace(b"[+", b"[")
    values = _json_numbers(text)
    if values is None or values.size != rows * columns:
        return None  # one empty field leaves no number and no separator
    if np.maximum.reduce(values) >= OVER_RANGE or np.minimum.reduce(values) <= -OVER_RANGE:
        return None
    if b"-" in text and not values.all() and _has_integer_minus_zero(text, values.size):
        return None
    return values.reshape(rows, columns)


@cache
def _to_commas(decimal_and_delimiter: bytes) -> bytes:
    return bytes.maketrans(decimal_and_delimiter + b"\n", b".,,")


def _only_before(returns: NDArray[np.bool_], line_feeds: NDArray[np.bool_]) -> bool:
    """Say whether carriage return and line feed only stand together, in this order."""
    return bool((returns[:-1] == line_feeds[1:]).all()) and not returns[-1]


def _json_numbers(text: bytes) -> FloatArray | None:
    try:
        parsed = _PARSER.parse(text)
    except (ValueError, RuntimeError):
        return None
    if not isinstance(parsed, simdjson.Array):
        return None
    return np.frombuffer(parsed.as_buffer(of_type="d"))  # a copy: nothing refers to `parsed` now


def _has_integer_minus_zero(text: bytes, numbers: int) -> bool:
    """Look for a field `-0`, which JSON reads as an integer, without its sign."""
    characters = np.frombuffer(text, dtype=np.uint8)
    if np.count_nonzero(characters == ord(".")) == numbers:
        return False  # every number has its point, so none is an integer
    minus = np.flatnonzero(characters == ord("-"))
    behind = characters[minus[characters[minus + 1] == ord("0")] + 2]
    return any((behind == end).any() for end in b",] \r")
