"""Most plain tables: below the heading nothing but rows of numbers, read in one pass.

What stands above the rows is understood from the head of the file, once for all files that differ
from it in numbers alone. That every byte below is part of a row of numbers, of one length, proves
that there is no other table; whatever is not certain goes the long way (`plain_tables`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from deamat.core.arrays import FloatArray
from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.cells import Dialect
from deamat.formats.choice import Choice
from deamat.formats.decimals import sole_decimal_mark
from deamat.formats.header import notes
from deamat.formats.numbers import parse, rows_from
from deamat.formats.plain_rows import Rows, recording_from
from deamat.formats.plain_tables import Text, best, complete_in, decoded
from deamat.formats.rawfile import Head, RawFile

_ROWS = 4  # in the head: of fewer the heading is not certain


@dataclass(frozen=True, slots=True)
class _Heading:
    choice: Choice
    encoding: str
    metadata: Mapping[str, str]


def block_of(file: RawFile) -> Recording | None:
    """Read a file whose rows are nothing but numbers, or return None where that is not certain."""
    if file.channels:
        return None
    heading = file.once(_heading, file.technique, file.encoding, file.open_encoding)
    if heading is None:
        return None
    choice = heading.choice
    block = rows_from(file, choice.heading.first)
    if block is None:
        return None
    table = numbers_of(block, choice)
    if table is None:
        return None
    first = choice.heading.first + 1
    rows = Rows(
        {t.name: table[:, t.column] for t in choice.used}, {}, first, first + len(table) - 1
    )
    return recording_from(file, choice, rows, heading.encoding, heading.metadata)


def _heading(head: Head, technique: str, encoding: str, undecided: bool) -> _Heading | None:
    if head.rows < _ROWS or not head.size:
        return None
    file = RawFile("", b"", technique=technique)
    complete = []
    try:
        for one, written in decoded("\n".join(head).encode(), encoding, undecided=undecided):
            proposed = Text(written.split("\n"), one, ended=True)
            found, _ = complete_in(file, proposed)
            if found is not None:
                complete.append((proposed, found))
        if not complete:
            return None
        text, choice = best(file, complete)
    except RawFileError:
        return None  # said by the long way, with its place
    above = text.lines[: choice.heading.names]
    return _Heading(choice, text.encoding, notes(above, choice.heading.separator))


def numbers_of(block: bytes, choice: Choice) -> FloatArray | None:
    """Read rows of nothing but plain numbers, or return None where that is not certain.

    Parameters
    ----------
    block : the rows, without the last line end
    """
    width = len(choice.heading.labels)
    mark = choice.heading.separator.encode()
    if b'"' in block:
        block, mark = _unquoted(block, mark), b"\t"
    first = block[: block.find(b"\n") % (len(block) + 1)]  # the whole block if it is one row
    if first.count(mark) == width and first.rstrip(b"\r").endswith(mark):
        block = _without_last_field(block, mark)
    elif first.count(mark) != width - 1:
        return None
    decimal = "." if mark == b"," else sole_decimal_mark(block)
    return parse(block, width, Dialect(mark.decode(), decimal)) if block and decimal else None


def _unquoted(block: bytes, mark: bytes) -> bytes:
    """Part fields that all stand in quotes by tabs; nothing where not all of them do."""
    if block[:1] != b'"' or block[-1:] != b'"' or b"\t" in block:
        return b""
    plain = block[1:-1].replace(b"\r\n", b"\n").replace(b'"\n"', b"\n")
    plain = plain.replace(b'"' + mark + b'"', b"\t")
    return b"" if b'"' in plain else plain


def _without_last_field(block: bytes, mark: bytes) -> bytes:
    """Leave out the separator at the end of every row; nothing where not every row has one."""
    end = b"\r\n" if b"\r" in block else b"\n"
    plain = (block + end).replace(mark + end, end)
    whole = len(block) + len(end) - len(plain) == block.count(b"\n") + 1
    return plain[: -len(end)] if whole else b""
