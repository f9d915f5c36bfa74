"""Files that read without a complaint and do not say what was measured."""

from __future__ import annotations

import re
from decimal import Decimal

from numpy.random import Generator

from benchmarks.fuzz.sheet import Sheet

# Units that are taken for one another, in a header.
_MISTAKEN = {
    "N": ("kN", "mN", "kg"), "kN": ("N",), "mm": ("m", "cm", "um", "in"), "kPa": ("MPa", "Pa"),
    "MPa": ("kPa", "Pa"), "Pa": ("kPa", "mPa"), "s": ("min", "ms", "h"), "h": ("s", "min"),
    "nm": ("um",), "µN": ("mN", "nN"), "uN": ("mN",), "kV": ("V",), "V": ("kV", "mV"),
    "uA": ("mA", "A"), "Hz": ("kHz",), "F": ("pF", "nF"), "Pas": ("mPas",), "mPa·s": ("Pa·s",),
    "Pa·s": ("mPa·s",), "1/s": ("1/min",), "Pa s": ("mPa s",), "V/V": ("kV/V",), "A/V": ("mA/V",),
}  # fmt: skip
_FACTORS = ("1000", "0.001", "1e6", "1e-6", "25.4", "4.448", "9.81", "60", "0.1", "10")
_BESIDE = 5  # lines of a header that stands beside the rows
_GAINS = ("2", "0.5", "10", "0.1", "1.1", "0.9")


def unit_of_label(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Name another unit over the numbers as they are."""
    lines = range(sheet.first or _BESIDE)
    places = [
        (at, found.span(1), found[1])
        for at in lines
        for found in re.finditer(r"(?:[\[(_\"\t; ]|^)([A-Za-zµ/·]+(?: s)?)(?=[\])\",;\t]|$)",
                                 sheet.lines[at])
        if found[1] in _MISTAKEN
    ]  # fmt: skip
    if not places:
        return sheet.data
    at, (start, end), unit = places[int(rng.integers(len(places)))]
    line = sheet.lines[at]
    other = str(rng.choice(_MISTAKEN[unit]))
    return sheet.with_line(at, line[:start] + other + line[end:]).data


def values_in_other_unit(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Write the numbers of a column in another unit under the label as it is."""
    factor = Decimal(str(rng.choice(_FACTORS)))
    return sheet.with_column(int(rng.choice(sheet.numeric)), lambda _i, v: v * factor).data


def gain(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Measure one channel with an amplifier set to another gain."""
    factor = Decimal(str(rng.choice(_GAINS)))
    return sheet.with_column(int(rng.choice(sheet.numeric)), lambda _i, v: v * factor).data


def columns_swapped(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Exchange the numbers of two columns under labels that stay."""
    a, b = rng.choice(sheet.numeric, 2, replace=False).tolist()
    table = [list(row) for row in sheet.table]
    for row in table:
        if max(a, b) < len(row):
            row[a], row[b] = row[b], row[a]
    return sheet.with_table(table).data


def clipping(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Let a channel end at the limit of its range, as one number again and again."""
    at = int(rng.choice(sheet.numeric))
    column = sheet.column(at)
    low, high = min(column), max(column)
    limit = low + (high - low) * Decimal(round(float(rng.uniform(0.3, 0.95)), 3))
    limit = limit.quantize(column[-1]) if not column[-1].is_zero() else limit
    return sheet.with_column(at, lambda _i, v: min(v, limit)).data


def offset(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Add a constant to a channel: a cell without tare, an absolute position, a late clock."""
    at = int(rng.choice(sheet.numeric))
    column = sheet.column(at)
    share = Decimal(round(float(rng.choice([-1.0, 1.0]) * rng.uniform(0.01, 0.5)), 3))
    added = (max(column) - min(column)) * share
    return sheet.with_column(at, lambda _i, v: v + added).data


def other_sign(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Count a channel the other way."""
    return sheet.with_column(int(rng.choice(sheet.numeric)), lambda _i, v: -v).data


def stuck(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Let a channel keep its value from some row on."""
    at = int(rng.choice(sheet.numeric))
    column = sheet.column(at)
    start = int(rng.integers(len(column)))
    return sheet.with_column(at, lambda i, v: column[start] if i > start else v).data


def lost_rows(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Lose rows: a block at the start, in the middle or at the end, or every second one."""
    n = len(sheet.rows)
    size = max(1, int(n * rng.uniform(0.03, 0.4)))
    start = int(rng.choice([0, n - size, int(rng.integers(n - size + 1))]))
    if rng.random() < 0.25:
        return sheet.with_rows(sheet.rows[::2]).data
    return sheet.with_rows((*sheet.rows[:start], *sheet.rows[start + size :])).data


def doubled_rows(sheet: Sheet, rng: Generator, _: Sheet) -> bytes:
    """Write a block of rows twice, or every row."""
    n = len(sheet.rows)
    if rng.random() < 0.25:
        return sheet.with_rows([row for row in sheet.rows for _ in range(2)]).data
    size = max(2, int(n * rng.uniform(0.03, 0.4)))
    start = int(rng.integers(n - size + 1))
    return sheet.with_rows((*sheet.rows[: start + size], *sheet.rows[start:])).data


def two_exports(sheet: Sheet, rng: Generator, sibling: Sheet) -> bytes:
    """Append the export of another specimen, with its header or without; or mix the two."""
    how = int(rng.integers(3))
    if how == 0:
        return sheet.with_rows((*sheet.rows, *sibling.lines)).data
    if how == 1:
        return sheet.with_rows((*sheet.rows, *sibling.rows)).data
    half = len(sheet.rows) // 2
    return sheet.with_rows((*sheet.rows[:half], *sibling.rows[half:])).data


WRONG = (
    unit_of_label, values_in_other_unit, gain, columns_swapped, clipping, offset, other_sign, stuck,
    lost_rows, doubled_rows, two_exports,
)  # fmt: skip
