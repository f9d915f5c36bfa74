"""Rows of numbers to an array: fast where every byte is certain, slow with a reason elsewhere.

The fast path takes a block of rows only if deleting the characters of numbers leaves exactly the
separators that `columns` fields a row must leave, and if JSON's strict number grammar accepts
every field. All the rest goes to `cells`, which reads what is unambiguous and refuses the rest
by line and column. Both give the double nearest to the text, as Python's `float` does.
"""

from __future__ import annotations

import numpy as np
import simdjson

from pipeline.core.errors import RawFileError
from pipeline.core.records import FloatArray
from pipeline.formats.cells import OVER_RANGE, Dialect, read_cells
from pipeline.formats.quoted import unquote
from pipeline.formats.rawfile import RawFile

_DIGITS = b"0123456789+-eE "
_CHUNK = 1 << 20  # bytes parsed at a time: the parser's workspace is some ten times its text


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
    if b"\r" in block:
        block = block.replace(b"\r\n", b"\n")
    ended = file.ends_open or block.endswith(b"\n")
    block = block.rstrip(b" \n")
    if not block:
        raise RawFileError(
            file.path,
            "no data rows: the file ends with its header",
            line=first,
            mend="export the file again",
        )
    table = parse(block, columns, dialect) if ended else None
    if table is None:
        table = read_cells(file, block.decode(), first + 1, columns, dialect, ended=ended)
    return table


def parse(block: bytes, columns: int, dialect: Dialect) -> FloatArray | None:
    """Parse rows without their last line end, or return None where they are not certain."""
    if dialect.quoted and b'"' in block:
        plain = unquote(block)
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
        part = _parse(block[start:end], columns, dialect)
        if part is None:
            return None
        table[row : row + len(part)] = part
        row += len(part)
        start = end + 1
    return table


def _parse(block: bytes, columns: int, dialect: Dialect) -> FloatArray | None:
    delimiter, decimal = dialect.delimiter.encode(), dialect.decimal.encode()
    separators = block.translate(None, _DIGITS + decimal) + b"\n"
    rows = len(separators) // columns
    if separators != (delimiter * (columns - 1) + b"\n") * rows:
        return None
    if delimiter == b",":
        text = b"[" + block.replace(b"\n", b",") + b"]"
    else:
        commas = bytes.maketrans(decimal + delimiter + b"\n", b".,,")
        text = b"[" + block.translate(commas) + b"]"
    if b"+" in text and not (b"+-" in text or b"+ " in text):  # JSON knows no leading plus
        text = text.replace(b",+", b",").replace(b"[+", b"[")
    try:
        parsed = simdjson.Parser().parse(text)
    except (ValueError, RuntimeError):
        return None
    if not isinstance(parsed, simdjson.Array):
        return None
    values: FloatArray = np.frombuffer(parsed.as_buffer(of_type="d"))
    if values.size != rows * columns:  # one empty field leaves no number and no separator
        return None
    if values.max() >= OVER_RANGE or values.min() <= -OVER_RANGE:
        return None
    if not values.all() and _has_integer_minus_zero(text):
        return None
    return values.reshape(rows, columns)


def _has_integer_minus_zero(text: bytes) -> bool:
    """Look for a field `-0`, which JSON reads as an integer, without its sign."""
    characters = np.frombuffer(text, dtype=np.uint8)
    minus = np.flatnonzero(characters == ord("-"))
    behind = characters[minus[characters[minus + 1] == ord("0")] + 2]
    return bool(((behind == ord(",")) | (behind == ord("]")) | (behind == ord(" "))).any())
