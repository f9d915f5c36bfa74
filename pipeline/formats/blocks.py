"""Where rows of numbers stand in a text, whatever is above them: for files that nothing reads."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from deamat.formats.structure import SEPARATORS, fields, looks_numeric_grouped

NAMES = {"\t": "tabs", ";": "semicolons", ",": "commas", "|": "bars", " ": "blanks"}
_BLANKS = re.compile(" +")
_FEWEST = 3  # rows of a block
_LOOKED_AT = 2000  # lines


@dataclass(frozen=True, slots=True)
class Block:
    """Rows of numbers under each other.

    Parameters
    ----------
    separator : of the fields; a blank stands for any number of them
    first, last : lines of the first and of the last row, counted from 0
    columns : fields of each row
    labels : fields of the nearest line above that has words, if there are as many
    labels_line : where it stands, counted from 0; -1 where there is none
    """

    separator: str
    first: int
    last: int
    columns: int
    labels: tuple[str, ...]
    labels_line: int


def split(line: str, separator: str) -> list[str]:
    """Split a line at a separator; a blank stands for any number of them."""
    return _BLANKS.split(line.strip()) if separator == " " else fields(line, separator)


def block_in(lines: Sequence[str]) -> Block | None:
    """Find the longest run of rows with the same number of fields, all of them numbers.

    None where no separator gives three rows of at least two numbers.
    """
    found: Block | None = None
    for separator in (*SEPARATORS, " "):
        for first, last, columns in _runs(lines[:_LOOKED_AT], separator):
            longer = found is None or last - first > found.last - found.first
            if last - first + 1 >= _FEWEST and longer:
                labels, at = _labels(lines, first, separator, columns)
                found = Block(separator, first, last, columns, labels, at)
    return found


def _runs(lines: Sequence[str], separator: str) -> list[tuple[int, int, int]]:
    runs: list[tuple[int, int, int]] = []
    for at, line in enumerate(lines):
        cells = split(line, separator) if separator in line else []
        if len(cells) < 2 or not all(map(looks_numeric_grouped, filter(None, cells))):
            continue
        if runs and runs[-1][1] == at - 1 and runs[-1][2] == len(cells):
            runs[-1] = (runs[-1][0], at, len(cells))
        else:
            runs.append((at, at, len(cells)))
    return runs


def _labels(
    lines: Sequence[str], first: int, separator: str, columns: int
) -> tuple[tuple[str, ...], int]:
    above = [at for at in range(first - 1, -1, -1) if lines[at].strip()][:_FEWEST]
    for at in above:
        for by in (separator, " "):
            cells = [cell.strip() for cell in split(lines[at], by)]
            if len(cells) == columns and not any(map(looks_numeric_grouped, cells)):
                return tuple(cells), at
    return (), -1
