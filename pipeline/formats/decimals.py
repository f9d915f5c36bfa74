"""Which decimal mark the cells of a table use, and their numbers under it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from deamat.core.number_grammar import is_number

_GROUPS_BY_COMMA = re.compile(r"[+-]?[1-9][0-9]{0,2}(?:,[0-9]{3})+(?:\.[0-9]*)?")
_GROUPS_BY_POINT = re.compile(r"[+-]?[1-9][0-9]{0,2}(?:\.[0-9]{3})+,[0-9]*")
_WHOLE_BY_POINT = re.compile(r"[+-]?[1-9][0-9]{0,2}(?:\.[0-9]{3})+")
_GROUPS_BY_SPACE = re.compile(r"[+-]?[0-9]{1,3}(?:[\u00a0\u202f' ][0-9]{3})+(?:[.,][0-9]*)?")
_SPACES = re.compile(r"[\u00a0\u202f' ]")
# what no damage makes of a decimal point: a group and a fraction, two groups, a blank of print
_PROVEN = re.compile(r"[+-]?[0-9]{1,3}(?:([,' ])[0-9]{3}(?:\1[0-9]{3}|[.,][0-9])|[\u00a0\u202f]).*")
# what no comma between thousands can be: behind a leading zero, or before one or two digits
_FRACTION = re.compile(rb"(?<![0-9])0[0-9]*,|,[0-9]{1,2}(?![0-9])|,[0-9]{4}")


class Ambiguous(ValueError):
    """Both decimal marks fit, and mean different numbers.

    Parameters
    ----------
    cell : the one that shows it
    """

    def __init__(self, cell: str) -> None:
        super().__init__(cell)
        self.cell = cell


def grouping(cells: Iterable[str]) -> bool:
    """Say whether some cell proves that thousands are parted: `1,234.5`, `1 234 567`.

    A lone `1 234` or `1,234` among fractions may be a damaged `1.234`.
    """
    return any(_PROVEN.fullmatch(cell) for cell in cells)


def normal(cells: Sequence[str]) -> list[str]:
    """Write true minus signs as hyphens, and leave out blanks that are proven to part thousands."""
    plain = [cell.replace("\u2212", "-") for cell in cells]
    if not grouping(plain):
        return plain
    return [_SPACES.sub("", c) if _GROUPS_BY_SPACE.fullmatch(c) else c for c in plain]


def _has_comma(cell: str) -> bool:
    """Say whether a cell is a number with a decimal comma."""
    return "," in cell and "." not in cell and is_number(cell.replace(",", ".", 1))


def decimal_mark(cells: Iterable[str]) -> str:
    """Return the decimal mark under which all cells that are numbers at all are numbers.

    Raises
    ------
    Ambiguous : every cell with a comma may be a fraction or thousands
    """
    point = comma = True
    doubtful = ""
    for cell in cells:
        if "," not in cell and "." not in cell:
            continue
        as_point = is_number(cell) or bool(_GROUPS_BY_COMMA.fullmatch(cell))
        as_comma = _has_comma(cell) or bool(_GROUPS_BY_POINT.fullmatch(cell))
        if not (as_point or as_comma):
            continue
        if as_point and as_comma and not doubtful:
            doubtful = cell
        point, comma = point and as_point, comma and as_comma
    if point and comma and doubtful:
        raise Ambiguous(doubtful)
    return "," if comma and not point else "."


def thousands_by_point(cells: Iterable[str], others: Iterable[str]) -> str:
    """Return a cell whose point may part thousands, for other cells have decimal commas.

    Parameters
    ----------
    cells : of a column that is needed: all of them like `3.810`, whole numbers apart
    others : cells of the same table
    """
    first = ""
    for cell in cells:
        if "." in cell:
            if not _WHOLE_BY_POINT.fullmatch(cell):
                return ""
            first = first or cell
    return first if first and any(map(_has_comma, others)) else ""


def sole_decimal_mark(block: bytes, declared: str = "") -> str:
    """Return the decimal mark of plain numbers, without commas between fields; empty if unsure.

    Parameters
    ----------
    declared : the mark that is declared, empty where none is
    """
    if declared:
        other = b"." if declared == "," else b","
        return "" if other in block else declared  # the other one may part thousands
    if b"," not in block:
        return "."
    return "," if b"." not in block and _FRACTION.search(block) else ""


def number_text(cell: str, decimal: str, *, grouped: bool = True) -> str:
    """Return a cell as a number with a decimal point, or as it is where it is none."""
    if decimal == ",":
        if _GROUPS_BY_POINT.fullmatch(cell):
            cell = cell.replace(".", "")
        return cell.replace(",", ".", 1) if _has_comma(cell) else cell
    return cell.replace(",", "") if grouped and _GROUPS_BY_COMMA.fullmatch(cell) else cell
