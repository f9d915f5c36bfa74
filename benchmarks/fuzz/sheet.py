"""A good file taken apart into lines, cells and columns, and a register into header and rows."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from decimal import Context, Decimal, InvalidOperation
from functools import cached_property

_QUOTED = r',(?=")'
# What parts the cells of a row, by reader.
_SEPARATOR = {
    "antonpaar": ";", "bluehill": _QUOTED, "flow_tab": "\t", "hysitron": "\t", "mark10": "\t",
    "lvm": "\t", "mts": "\t", "ndj8s": r"[\t#]|\s+", "nexygen": "\t", "plain": r"[;|\t]",
    "rheocompass": "\t", "schmid": "\t", "soro": ";",
}  # fmt: skip
_DECIMAL_COMMA = ("antonpaar", "mts", "rheocompass")
_UNITS_BELOW_LABELS = {
    "antonpaar": 1,
    "bluehill": 1,
    "rheocompass": 2,
    "rigol": 1,
    "schmid": 1,
    "zwick": 1,
}
_TEN_DIGITS = Context(prec=10)
_NO_LABELS = ("lcr6000", "ndj8s", "tektronix")


@dataclass(frozen=True)
class Sheet:
    """Lines of a text file, of which those from `first` to `end` are rows of a table.

    Parameters
    ----------
    lines : without their ends
    first, end : the first row, and the line after the last one, counted from 0
    """

    reader: str
    lines: tuple[str, ...]
    first: int
    end: int
    encoding: str
    newline: str

    @classmethod
    def of(cls, data: bytes, reader: str, encoding: str, rows: tuple[int, int]) -> Sheet:
        """Take a file apart; `rows` are the line of its first row and the one after its last."""
        text = data.decode(encoding)
        newline = "\r\n" if "\r\n" in text else "\n"
        lines = tuple(text.split(newline)[:-1])
        return cls(reader, lines, *rows, encoding, newline)

    @property
    def data(self) -> bytes:
        """The file's bytes."""
        return "".join(line + self.newline for line in self.lines).encode(self.encoding, "replace")

    @cached_property
    def decimal(self) -> str:
        """Decimal mark of its numbers."""
        comma = self.reader in _DECIMAL_COMMA or "." not in "".join(self.rows)
        return "," if comma else "."

    @property
    def units(self) -> int | None:
        """Line of the units; that of the labels where they carry them."""
        return None if self.reader in _NO_LABELS else self.first - 1

    @property
    def labels(self) -> int | None:
        """Line of the labels."""
        below = _UNITS_BELOW_LABELS.get(self.reader, 0)
        return None if self.reader in _NO_LABELS else self.first - 1 - below

    @property
    def header(self) -> tuple[str, ...]:
        """The lines above the table."""
        return self.lines[: self.first]

    @property
    def rows(self) -> tuple[str, ...]:
        """The lines of the table."""
        return self.lines[self.first : self.end]

    @cached_property
    def table(self) -> list[list[str]]:
        """Cells (at even places) and what parts them (at odd ones) of every row."""
        return [self.split(row) for row in self.rows]

    @cached_property
    def numeric(self) -> list[int]:
        """Places of the cells that are numbers, in a row that has most of them."""
        numbers = [
            [i for i in range(0, len(row), 2) if self.number(row[i]) is not None]
            for row in self.table
        ]
        return max(numbers, key=len)

    def split(self, line: str) -> list[str]:
        """Take one line apart into cells and what parts them."""
        parting = _SEPARATOR.get(self.reader, ",")
        if parting == _QUOTED and not line.startswith('"'):
            parting = ","  # labels and units are not quoted
        return re.split(f"({parting})", line)

    def number(self, cell: str) -> Decimal | None:
        """Read a cell as a number; None if it is none."""
        plain = cell.strip(' "')
        plain = plain.replace(",", ".") if self.decimal == "," else plain.replace(",", "")
        try:
            found = Decimal(plain)
        except InvalidOperation:
            return None
        return found if found.is_finite() else None

    def written(self, value: Decimal, like: str) -> str:
        """Write a number as another cell is written: quotes, decimal mark, exponent."""
        value = _TEN_DIGITS.plus(value)
        small = value != 0 and not -12 < value.adjusted() < 12
        text = f"{value:.6e}" if "e" in like.lower() or small else f"{value:f}"
        text = text.replace(".", self.decimal)
        return f'"{text}"' if like.startswith('"') else text

    def with_rows(self, rows: Sequence[str]) -> Sheet:
        """Return the file with other rows."""
        lines = (*self.header, *rows, *self.lines[self.end :])
        return replace(self, lines=lines, end=self.first + len(rows))

    def with_table(self, table: Sequence[Sequence[str]]) -> Sheet:
        """Return the file with other cells."""
        return self.with_rows(["".join(row) for row in table])

    def with_line(self, at: int, line: str) -> Sheet:
        """Return the file with another line."""
        return replace(self, lines=(*self.lines[:at], line, *self.lines[at + 1 :]))

    def with_column(self, at: int, change: Callable[[int, Decimal], Decimal]) -> Sheet:
        """Return the file with other numbers in one column; `change` gets row and number."""
        table = [list(row) for row in self.table]
        for i, row in enumerate(table):
            value = self.number(row[at]) if at < len(row) else None
            if value is not None:
                row[at] = self.written(change(i, value), row[at])
        return self.with_table(table)

    def column(self, at: int) -> list[Decimal]:
        """The numbers of one column."""
        cells = [self.number(row[at]) for row in self.table if at < len(row)]
        return [cell for cell in cells if cell is not None]


@dataclass(frozen=True)
class Register:
    """A register as header and rows of cells; the first row is the one that is spoilt."""

    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    @classmethod
    def of(cls, text: str) -> Register:
        """Take a register apart."""
        header, *rows = csv.reader(io.StringIO(text, newline=""))
        return cls(tuple(header), tuple(map(tuple, rows)))

    @property
    def data(self) -> bytes:
        """The register's bytes."""
        text = io.StringIO(newline="")
        csv.writer(text, lineterminator="\n").writerows([self.header, *self.rows])
        return text.getvalue().encode()

    def at(self, name: str) -> int:
        """Place of a column."""
        return self.header.index(name)

    def numeric(self) -> list[int]:
        """Places of the cells of the first row that are numbers."""
        return [i for i, cell in enumerate(self.rows[0]) if _is_number(cell)]

    def with_cell(self, row: int, at: int, cell: str) -> Register:
        """Return the register with another cell."""
        cells = (*self.rows[row][:at], cell, *self.rows[row][at + 1 :])
        return replace(self, rows=(*self.rows[:row], cells, *self.rows[row + 1 :]))

    def with_label(self, at: int, label: str) -> Register:
        """Return the register with another column name."""
        return replace(self, header=(*self.header[:at], label, *self.header[at + 1 :]))


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True
