"""Text that was damaged on its way, or written by a computer that was set to another country."""

from __future__ import annotations

import re
from dataclasses import replace

from numpy.random import Generator

from benchmarks.fuzz.sheet import Sheet

_NOISE = b'\x00\x01\t\n\r ,;"#%()-+.eE/\x7f\x80\xb5\xc3\xe9\xff' + bytes(range(97, 123))
_DIGITS = b"0123456789"
_BURST = 8


def _place(rng: Generator, data: bytes) -> int:
    return int(rng.integers(len(data)))


def flip_byte(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Replace one byte by another; not a digit by a digit, which nothing could show."""
    data = sheet.data
    at = _place(rng, data)
    return data[:at] + bytes([int(rng.choice(list(_NOISE)))]) + data[at + 1 :]


def drop_byte(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Lose one byte that is no digit."""
    data = sheet.data
    places = [at for at in rng.integers(len(data), size=20).tolist() if data[at] not in _DIGITS]
    return data[: places[0]] + data[places[0] + 1 :] if places else data


def double_byte(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Write one byte that is no digit twice."""
    data = sheet.data
    places = [at for at in rng.integers(len(data), size=20).tolist() if data[at] not in _DIGITS]
    return data[: places[0] + 1] + data[places[0] :] if places else data


def drop_digit(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Lose one digit."""
    data = sheet.data
    places = [at for at in rng.integers(len(data), size=50).tolist() if data[at] in _DIGITS]
    return data[: places[0]] + data[places[0] + 1 :] if places else data


def insert_bytes(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Insert some bytes of another file."""
    data = sheet.data
    at = _place(rng, data)
    return data[:at] + bytes(rng.choice(list(_NOISE), 3).tolist()) + data[at:]


def burst(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Overwrite a few neighbouring bytes with noise."""
    data = sheet.data
    at = _place(rng, data)
    return data[:at] + rng.bytes(_BURST) + data[at + _BURST :]


def nul(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Fill a part of the file with NUL, as a disk does that lost a block."""
    data = sheet.data
    at, size = _place(rng, data), int(rng.choice([1, 16, 512]))
    return (data[:at] + b"\0" * size + data[at + size :])[: len(data)]


def cut_anywhere(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Stop in the middle of the file."""
    data = sheet.data
    return data[: _place(rng, data)]


def cut_at_line(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Stop at the end of a row."""
    return sheet.with_rows(sheet.rows[: int(rng.integers(len(sheet.rows)))]).data


def drop_line(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Lose one line, of the header or of the table."""
    at = int(
        rng.integers(len(sheet.header or sheet.lines) if rng.random() < 0.5 else len(sheet.lines))
    )
    return replace(sheet, lines=(*sheet.lines[:at], *sheet.lines[at + 1 :])).data


def double_line(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Write one line twice, of the header or of the table."""
    at = int(
        rng.integers(len(sheet.header or sheet.lines) if rng.random() < 0.5 else len(sheet.lines))
    )
    return replace(sheet, lines=(*sheet.lines[: at + 1], *sheet.lines[at:])).data


def join_lines(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Lose one line end."""
    at = int(rng.integers(len(sheet.lines) - 1))
    joined = sheet.lines[at] + sheet.lines[at + 1]
    return replace(sheet, lines=(*sheet.lines[:at], joined, *sheet.lines[at + 2 :])).data


def other_newlines(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Change the line ends, of all lines or of half of them."""
    end = str(rng.choice(["\n", "\r\n", "\r", "\n\n"]))
    lines = [line + (end if rng.random() < 0.5 else sheet.newline) for line in sheet.lines]
    return "".join(lines).encode(sheet.encoding)


def blanks(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Put blanks, tabs or no-break spaces around the lines of the table."""
    blank = str(rng.choice([" ", "\t", "  ", "\u00a0"]))
    before = rng.random() < 0.5
    rows = [blank + row if before else row + blank for row in sheet.rows]
    return sheet.with_rows(rows).data


def other_decimal(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Write the other decimal mark, in all rows or in some."""
    new = "." if sheet.decimal == "," else ","
    share = float(rng.choice([1.0, 0.5, 0.05]))
    rows = [row.replace(sheet.decimal, new) if rng.random() < share else row for row in sheet.rows]
    return sheet.with_rows(rows).data


def other_decimal_in_column(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Write the other decimal mark in one column."""
    new = "." if sheet.decimal == "," else ","
    at = int(rng.choice(sheet.numeric))
    table = [
        [*row[:at], row[at].replace(sheet.decimal, new), *row[at + 1 :]] if at < len(row) else row
        for row in sheet.table
    ]
    return sheet.with_table(table).data


def other_separator(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Separate the cells in another way, in the table or in the whole file."""
    new = str(rng.choice([",", ";", "\t", " ", "|"]))
    whole = rng.random() < 0.5
    lines = [
        "".join(new if i % 2 else cell for i, cell in enumerate(sheet.split(line)))
        if whole or at >= sheet.first else line
        for at, line in enumerate(sheet.lines)
    ]  # fmt: skip
    return replace(sheet, lines=tuple(lines)).data


def thousands(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Group the digits before the decimal mark, or all of them, by thousands.

    No program uses its decimal mark for that: `3.810` among `22.0` would be no damage but a number.
    """
    mark = str(rng.choice([",", ".", " ", "'", "\u00a0", "\u2009"]))
    if mark == sheet.decimal:
        return sheet.data
    at = int(rng.choice(sheet.numeric))
    table = [list(row) for row in sheet.table]
    for row in table:
        if at < len(row):
            row[at] = re.sub(r"(?<=[0-9])(?=(?:[0-9]{3})+(?![0-9]))", mark, row[at])
    return sheet.with_table(table).data


def typeset_signs(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Write the minus sign, or a dash, of a word processor; or full-width digits."""
    new = str(rng.choice(["\u2212", "\u2013", "FULL"]))
    if new == "FULL":
        wide = str.maketrans({str(d): chr(0xFF10 + d) for d in range(10)})
        rows = [row.translate(wide) if rng.random() < 0.1 else row for row in sheet.rows]
    else:
        rows = [row.replace("-", new) for row in sheet.rows]
    return _encoded(sheet.with_rows(rows), sheet.encoding)


def other_encoding(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Save the text in another encoding."""
    return _encoded(
        sheet, str(rng.choice(["utf-16", "utf-16-le", "utf-8-sig", "latin-1", "cp1252", "utf-32"]))
    )


def _encoded(sheet: Sheet, encoding: str) -> bytes:
    text = "".join(line + sheet.newline for line in sheet.lines)
    if encoding == "latin-1":
        encoding = "utf-8"  # letters that Latin-1 does not have come as from another program
    return text.encode(encoding, "replace")


TEXT = (
    flip_byte, drop_byte, double_byte, drop_digit, insert_bytes, burst, nul, cut_anywhere,
    cut_at_line, drop_line, double_line, join_lines, other_newlines, blanks,
)  # fmt: skip
LOCALE = (
    other_decimal, other_decimal_in_column, other_separator, thousands, typeset_signs,
    other_encoding,
)  # fmt: skip
