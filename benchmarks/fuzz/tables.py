"""Tables with columns, rows or labels amiss, and cells that hold something else than a number."""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal

from numpy.random import Generator

from benchmarks.fuzz.sheet import Sheet

_TEXTS = (
    "n/a", "-", "----", "EEEE", "OVER", "Overflow", "#DIV/0!", "#N/A", "ERROR", "x", "1.2.3", "--1",
    "1e", "0x10", "1_000", "½",
)  # fmt: skip
_NO_NUMBERS = ("NaN", "nan", "inf", "-inf", "Infinity", "1e999", "-1e999", "1e-999", "9.9E37")
_SENTINELS = ("0", "-1", "99999", "-9999", "9.99999E37", "-327.67", "32767")


def _without(cells: Sequence[str], at: int) -> list[str]:
    """Take away a cell and what parts it from its neighbour."""
    return [*cells[:at], *cells[at + 2 :]] if at + 1 < len(cells) else list(cells[: at - 1])


def _twice(cells: Sequence[str], at: int) -> list[str]:
    """Write a cell twice."""
    parting = cells[at + 1] if at + 1 < len(cells) else cells[at - 1] if at else " "
    return [*cells[: at + 1], parting, *cells[at:]]


def _with_labels(sheet: Sheet, rows: Sequence[Sequence[str]], at: int, twice: bool) -> Sheet:
    """Return the table with other rows, and the same change of the lines of labels and units."""
    found = sheet.with_table(rows)
    for line in range(sheet.labels if sheet.labels is not None else sheet.first, sheet.first):
        cells = sheet.split(sheet.lines[line])
        if at < len(cells):
            changed = _twice(cells, at) if twice else _without(cells, at)
            found = found.with_line(line, "".join(changed))
    return found


def drop_column(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Leave a column out, with its label or without."""
    at = int(rng.choice(sheet.numeric))
    rows = [_without(row, at) if at < len(row) else row for row in sheet.table]
    both = rng.random() < 0.5
    return (_with_labels(sheet, rows, at, False) if both else sheet.with_table(rows)).data


def double_column(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Write a column twice, with its label or without."""
    at = int(rng.choice(sheet.numeric))
    rows = [_twice(row, at) if at < len(row) else row for row in sheet.table]
    both = rng.random() < 0.5
    return (_with_labels(sheet, rows, at, True) if both else sheet.with_table(rows)).data


def columns_in_other_order(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Exchange two columns with their labels: another order, and nothing wrong."""
    a, b = _two(sheet, rng)
    found = sheet.with_table([_exchanged(row, a, b) for row in sheet.table])
    for line in range(sheet.labels if sheet.labels is not None else sheet.first, sheet.first):
        cells = _exchanged(sheet.split(sheet.lines[line]), a, b)
        found = found.with_line(line, "".join(cells))
    return found.data


def _two(sheet: Sheet, rng: Generator) -> tuple[int, int]:
    a, b = rng.choice(sheet.numeric, 2, replace=False).tolist()
    return a, b


def _exchanged(row: Sequence[str], a: int, b: int) -> list[str]:
    cells = list(row)
    if max(a, b) < len(cells):
        cells[a], cells[b] = cells[b], cells[a]
    return cells


def drop_row(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Leave one row out."""
    at = int(rng.integers(len(sheet.rows)))
    return sheet.with_rows((*sheet.rows[:at], *sheet.rows[at + 1 :])).data


def double_row(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Write one row twice."""
    at = int(rng.integers(len(sheet.rows)))
    return sheet.with_rows((*sheet.rows[: at + 1], *sheet.rows[at:])).data


def rows_in_other_order(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Exchange two neighbours, turn the table round, or sort it as text."""
    rows = list(sheet.rows)
    how = int(rng.integers(3))
    if how == 0:
        at = int(rng.integers(len(rows) - 1))
        rows[at], rows[at + 1] = rows[at + 1], rows[at]
    rows = rows[::-1] if how == 1 else sorted(rows) if how == 2 else rows
    return sheet.with_rows(rows).data


def other_label(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Change the spelling of one label: a letter lost, other case, a word of another language."""
    at = sheet.labels
    if at is None:
        return sheet.data
    cells = sheet.split(sheet.lines[at])
    place = 2 * int(rng.integers((len(cells) + 1) // 2))
    label = cells[place]
    cut = int(rng.integers(max(len(label), 1)))
    cells[place] = str(
        rng.choice(
            [label[:cut] + label[cut + 1 :], label.upper(), label.lower(), "Wert", "", "Column 2"]
        )
    )
    return sheet.with_line(at, "".join(cells)).data


def no_units(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Take the units away: the line of them, or one behind its label."""
    at, labels = sheet.units, sheet.labels
    if at is None:
        return sheet.data
    if at != labels:
        lines = (*sheet.lines[:at], *sheet.lines[at + 1 :])
        return "".join(line + sheet.newline for line in lines).encode(sheet.encoding)
    cells = sheet.split(sheet.lines[at])
    place = 2 * int(rng.integers((len(cells) + 1) // 2))
    for mark in (" (", " [", "_"):
        cells[place] = cells[place].rpartition(mark)[0] or cells[place]
    return sheet.with_line(at, "".join(cells)).data


def line_in_table(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Put a foreign line into the table or below it: blank, remark, labels again, a statistic."""
    foreign = str(
        rng.choice(["", "# remark", "Mean", "Maximum,1.0", sheet.lines[sheet.first - 1], "END"])
    )
    at = len(sheet.rows) if rng.random() < 0.5 else int(rng.integers(len(sheet.rows)))
    return sheet.with_rows((*sheet.rows[:at], foreign, *sheet.rows[at:])).data


def _cell(sheet: Sheet, rng: Generator, text: str) -> bytes:
    row, at = int(rng.integers(len(sheet.rows))), int(rng.choice(sheet.numeric))
    table = [list(cells) for cells in sheet.table]
    if at < len(table[row]):
        quoted = table[row][at].startswith('"')
        table[row][at] = f'"{text}"' if quoted else text
    return sheet.with_table(table).data


def blank_cell(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Leave a cell empty."""
    return _cell(sheet, rng, str(rng.choice(["", " "])))


def text_cell(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Write a word, or half a number, into a cell."""
    return _cell(sheet, rng, str(rng.choice(_TEXTS)))


def no_number_cell(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Write what a program writes for no number, or for one too large."""
    return _cell(sheet, rng, str(rng.choice(_NO_NUMBERS)))


def sentinel_cell(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Write a number that stands for none."""
    return _cell(sheet, rng, str(rng.choice(_SENTINELS)))


def _scaled_cell(sheet: Sheet, rng: Generator, factor: Decimal) -> bytes:
    row, at = int(rng.integers(len(sheet.rows))), int(rng.choice(sheet.numeric))
    return sheet.with_column(at, lambda i, value: value * factor if i == row else value).data


def sign_of_cell(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Turn the sign of one number."""
    return _scaled_cell(sheet, rng, Decimal(-1))


def exponent_of_cell(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Move the decimal point of one number."""
    return _scaled_cell(sheet, rng, Decimal(10) ** int(rng.choice([-6, -3, -2, -1, 1, 2, 3, 6])))


def wild_cell(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Make one number a multiple of itself, as a spike of the mains does."""
    return _scaled_cell(sheet, rng, Decimal(round(float(rng.uniform(1.1, 5.0)), 2)))


STRUCTURE = (
    drop_column, double_column, columns_in_other_order, drop_row, double_row, rows_in_other_order,
    other_label, no_units, line_in_table,
)  # fmt: skip
CELLS = (
    blank_cell, text_cell, no_number_cell, sentinel_cell, sign_of_cell, exponent_of_cell, wild_cell,
)  # fmt: skip
