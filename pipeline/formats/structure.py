"""Where a table may stand in a text: separator, row of labels, row of units, first row of numbers.

Structure only proposes; what the labels mean decides (`plain`). A proposal is a row of labels with
a row of as many fields below it, at least two of them numbers.
"""

from __future__ import annotations

import contextlib
import csv
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from deamat.core.register_columns import split_unit
from deamat.core.unit_spellings import unit_as_written
from deamat.core.units import UnknownUnit
from deamat.formats.cells import looks_numeric
from deamat.formats.durations import CLOCK, clock_unit, is_clock, is_date

SEPARATORS = ("\t", ";", ",", "|")
_HEADER_LINES = 1000  # no results block above a table is longer
_ROWS = 32  # of numbers in a row are the table, and no further heading is looked for
_TEXT = re.compile(r"[^0-9+\-.,;\t|\" eE]")  # what no row of plain numbers holds
# two fields that begin as numbers do
_NUMBERS = {
    mark: re.compile(rf'(?:^|{re.escape(mark)})[ "+-]*[0-9].*?{re.escape(mark)}[ "+-]*[0-9]')
    for mark in SEPARATORS
}
_BRACKETED = re.compile(r"\((.*)\)|\[(.*)\]|<(.*)>")
_ENDING = re.compile(r"(.*\S)\s*(?:\(([^()]*)\)|\[([^\[\]]*)\]|<([^<>]*)>)")
_SLASH = re.compile(r"(.*\S)(?:\s+(?:/|in\b|,)\s*|,\s+)(\S+(?: s)?)")
_TIGHT = re.compile(r"(.*[^\s0-9])/(\S+(?: s)?)")
_GROUPED = re.compile(r"[+\-\u2212]?[0-9][0-9.,'\u00a0\u202f ]*")
_WITHOUT = frozenset(("", "#", "-", "[]", "()", "n/a", "none"))


@dataclass(frozen=True, slots=True)
class Heading:
    """Where a table may start and what stands over its columns.

    Parameters
    ----------
    separator : of its fields
    names : line of the labels, counted from 0
    first : line of the first row, counted from 0
    labels : per column, without the unit
    units : per column as written, empty where none is
    """

    separator: str
    names: int
    first: int
    labels: tuple[str, ...]
    units: tuple[str, ...]

    def only(self, columns: range | None) -> Heading:
        """Leave out what stands over the columns that the register does not name."""
        if columns is None:
            return self
        labels, units = (
            tuple(text if at in columns else "" for at, text in enumerate(texts))
            for texts in (self.labels, self.units)
        )
        return replace(self, labels=labels, units=units)


def fields(line: str, separator: str) -> list[str]:
    """Split a line into fields without blanks around them and without their quotes."""
    if '"' in line:
        with contextlib.suppress(csv.Error):  # a quote that does not close is no quote
            row = next(csv.reader([line], delimiter=separator, skipinitialspace=True, strict=True))
            return [field.strip() for field in row]
    return [field.strip() for field in line.split(separator)]


def headings(lines: Sequence[str]) -> Iterator[Heading]:
    """Propose every place where a table may start, for every separator."""
    head = "\n".join(lines[:_HEADER_LINES])
    for separator in SEPARATORS:
        if separator not in head:
            continue
        begins = _NUMBERS[separator].search
        rows = alike = marks = 0
        for at, line in enumerate(lines[:_HEADER_LINES]):
            last, marks = marks, line.count(separator)
            alike = alike + 1 if marks == last > 0 and begins(line) else 0
            rows = 0 if alike > _ROWS or _TEXT.search(line) else rows + 1
            if rows > _ROWS:
                break
            if rows or alike > _ROWS or not marks:
                continue
            names = _trimmed(fields(line, separator))
            if len([name for name in names if name]) < 2:
                continue
            numbers = len([name for name in names if looks_numeric(name)])
            yield from _headings_at(lines, at, separator, names, numbers)


def _headings_at(
    lines: Sequence[str], at: int, separator: str, names: list[str], numbers: int
) -> Iterator[Heading]:
    for below in (at + 1, at + 2):
        units = _unit_row(lines, below, separator, len(names))
        if units is not None and numbers < len(names):
            first = _first_row(lines, below + 1, separator, len(names))
            if first is not None:
                yield _clocked(lines, Heading(separator, at, first, *_with_units(names, units)))
    if numbers:
        return
    labels, written = zip(*map(split_label, names), strict=True)
    if all(names) or sum(map(bool, written)) > 1:  # a running number may have no label
        first = _first_row(lines, at + 1, separator, len(names))
        if first is not None:
            yield _clocked(lines, Heading(separator, at, first, labels, written))


def _clocked(lines: Sequence[str], heading: Heading) -> Heading:
    """Times of a clock say their own unit where none stands over them."""
    row = lines[heading.first] if heading.first < len(lines) else ""
    if ":" not in row:
        return heading
    cells = fields(row, heading.separator)
    units = tuple(
        CLOCK if not unit and is_clock(cell) else unit
        for cell, unit in zip(cells, heading.units, strict=False)
    )
    return replace(heading, units=units + heading.units[len(units) :])


def _trimmed(cells: list[str]) -> list[str]:
    """Leave out empty fields at the end, as spreadsheet programs write them."""
    while cells and not cells[-1]:
        cells = cells[:-1]
    return cells


def _unit_row(
    lines: Sequence[str], at: int, separator: str, columns: int
) -> tuple[str, ...] | None:
    """Read a line as units alone, bracketed or bare, some of them left out."""
    if at >= len(lines) or separator not in lines[at]:
        return None
    cells = fields(lines[at], separator)
    if len(_trimmed(cells)) > columns or any(map(looks_numeric, cells[:1])):
        return None
    cells = (cells + [""] * columns)[:columns]
    units = [_inside(cell) for cell in cells]
    told = [unit for cell, unit in zip(cells, units, strict=True) if cell]
    brackets = all(_BRACKETED.fullmatch(cell) for cell in cells if cell)
    good = [unit for unit in told if unit in _WITHOUT or _is_unit(unit)]
    if not any(map(_is_unit, told)) or (len(good) < len(told) and not brackets):
        return None
    return tuple("" if unit in _WITHOUT else unit for unit in units)


@lru_cache(maxsize=1024)
def _is_unit(text: str) -> bool:
    if text != "1" and looks_numeric(text):
        return False
    try:
        known = unit_as_written(text) is not None or text.casefold() == "s"
        return known or bool(clock_unit(text))
    except UnknownUnit:
        return True  # of which there are several: refused later, with the choices


def _inside(cell: str) -> str:
    found = _BRACKETED.fullmatch(cell)
    return (
        next((part for part in found.groups() if part is not None), "").strip() if found else cell
    )


def _with_units(
    names: Sequence[str], units: Sequence[str]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Labels above a row of units; a column without one there may carry it in its label."""
    pairs = [
        (name, unit) if unit else split_label(name)
        for name, unit in zip(names, units, strict=True)
    ]  # fmt: skip
    labels, written = zip(*pairs, strict=True)
    return labels, written


def _first_row(lines: Sequence[str], at: int, separator: str, columns: int) -> int | None:
    """Find the first row below a heading, past blank lines, if it has as many fields."""
    while at < len(lines) and not lines[at].strip(" \t;,"):
        at += 1
    if at >= len(lines):
        return at or None  # a header alone is said so when it is read
    cells = fields(lines[at], separator)
    numbers = len([cell for cell in cells if looks_numeric_grouped(cell)])
    return at if len(_trimmed(cells)) <= columns <= len(cells) and numbers >= 2 else None


def looks_numeric_grouped(cell: str) -> bool:
    """Say whether a cell may be a number, perhaps with thousands separators, or a time or date."""
    return bool(looks_numeric(cell) or _GROUPED.fullmatch(cell) or is_clock(cell) or is_date(cell))


def split_label(label: str) -> tuple[str, str]:
    """Part a label from its unit: `Load (N)`, `Load [N]`, `load_N`, `Load / N`, `F in N`."""
    found = _ENDING.fullmatch(label)
    if found is not None:
        unit = next((part for part in found.groups()[1:] if part is not None), "").strip()
        return (found[1], unit) if unit not in _WITHOUT else (found[1], "")
    found = _SLASH.fullmatch(label)
    if found is not None and _is_unit(found[2]):
        return found[1].rstrip(" ,"), found[2]
    stem, unit_ = split_unit(label)
    if unit_ is not None:
        return stem, unit_
    stem, _, ending = label.rpartition("_")
    if stem and ending and _is_unit(ending):
        return stem, ending
    found = _TIGHT.fullmatch(label)
    return (found[1], found[2]) if found is not None and _is_unit(found[2]) else (label, "")
