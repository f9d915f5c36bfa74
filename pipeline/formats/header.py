"""The lines above the rows: where the table starts, what its columns are called, what else is said.

Everything here looks at structure only, on the few lines of `RawFile.head`.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

from deamat.core.units import known
from deamat.formats.cells import looks_numeric
from deamat.formats.quantities import meaning
from deamat.formats.rawfile import ROW_STARTS, Head

_LABEL_WITH_UNIT = re.compile(r"(.*\S)\s*(?:\(([^()]*)\)|\[([^\[\]]*)\])")
_CELL = {mark: re.compile(rf'(?:^|{re.escape(mark)}) *("[^"]*"|[^{mark}]*)') for mark in ",;\t|"}
_UNIT = re.compile(r"\((.*)\)|\[(.*)\]")


@dataclass(frozen=True, slots=True)
class Layout:
    """Where a table stands in its file and what is written over its columns.

    Parameters
    ----------
    names : line of the labels, counted from 0
    units_line : line of the units, counted from 0 (the same line where labels carry them)
    labels : per column, without unit
    units : per column as written, empty where none is
    """

    names: int
    units_line: int
    labels: tuple[str, ...]
    units: tuple[str, ...]

    @property
    def rows(self) -> int:
        """Line of the first row, counted from 0."""
        return max(self.names, self.units_line) + 1

    def has(self, *quantities: str) -> bool:
        """Say whether a label means one of these quantities (`force_N`)."""
        found = (meaning(label) for label in self.labels)
        return any(known is not None and known[1] in quantities for known in found)

    def has_load(self, unwritten: Collection[str] = ()) -> bool:
        """Say whether this is a machine's curve and nothing but columns of quantities.

        A counter without a unit makes it a plain table, in which such columns are notes.

        Parameters
        ----------
        unwritten : labels in lower case that need no unit
        """
        return self.has("force_N", "nominal_stress_Pa", "true_stress_Pa") and all(
            unit or meaning(label) is not None or label.casefold() in unwritten
            for label, unit in zip(self.labels, self.units, strict=True)
        )


def split(line: str, delimiter: str) -> list[str]:
    """Split a header line into cells, honouring double quotes."""
    if '"' not in line:
        return [cell.strip() for cell in line.split(delimiter)]
    return [cell.strip(' "') for cell in _CELL[delimiter].findall(line)]


def inline_layout(head: Head, delimiter: str) -> Layout | None:
    """Find a row of labels that carry their units: `Load (N)`, `True Strain [-]`.

    The row with most units wins, for a remark in the header may look like one.
    """
    best: Layout | None = None
    for at in head.texts:
        line = head[at]
        if delimiter not in line or not ("(" in line or "[" in line):
            continue
        if best and any(row[:1] in ROW_STARTS for row in head[best.rows : at + 1]):
            break  # rows of numbers have begun
        cells = split(line, delimiter)
        if not all(cells) or any(looks_numeric(cell) for cell in cells):
            continue
        pairs = [split_label(cell) for cell in cells]
        units = tuple(unit for _, unit in pairs)
        if sum(map(bool, units)) > (sum(map(bool, best.units)) if best else 0):
            best = Layout(at, at, tuple(label for label, _ in pairs), units)
    if (
        best
        and best.rows < len(head)
        and all(map(_UNIT.fullmatch, split(head[best.rows], delimiter)))
    ):
        return None  # a row of units below: the brackets above are remarks
    return best


def units_row(head: Head, delimiter: str, *, bare: bool = False) -> int | None:
    """Find the first line that holds units alone: `(s),(mm),(N)`, or `s`, `mm`, `N` if `bare`."""
    for at in head.texts:
        line = head[at]
        if delimiter not in line or line[0] in ROW_STARTS:
            continue
        cells = split(line, delimiter)
        if all(map(_UNIT.fullmatch, cells)) or (bare and all(map(known, cells))):
            return at
    return None


def two_row_layout(head: Sequence[str], delimiter: str, names: int) -> Layout | None:
    """Take line `names` as labels and the next one as units, bracketed or bare."""
    if not 0 <= names < len(head) - 1:
        return None
    labels, units = split(head[names], delimiter), split(head[names + 1], delimiter)
    if len(labels) != len(units) or len(labels) < 2 or not all(labels):
        return None
    return Layout(names, names + 1, tuple(labels), tuple(map(bare_unit, units)))


def split_label(cell: str) -> tuple[str, str]:
    """Part `Load (N)` into `Load` and `N`; the unit is empty where there is none."""
    found = _LABEL_WITH_UNIT.fullmatch(cell)
    if found is None:
        return cell, ""
    label, round_unit, square_unit = found.groups()
    return label, (round_unit if round_unit is not None else square_unit).strip()


def bare_unit(cell: str) -> str:
    """Strip the brackets of `(mm)` or `[mm]`."""
    found = _UNIT.fullmatch(cell)
    if found is None:
        return cell
    round_unit, square_unit = found.groups()
    return str(round_unit if round_unit is not None else square_unit).strip()


def notes(lines: Iterable[str], delimiter: str = "") -> dict[str, str]:
    """Keep header lines as text: `key: value`, or `key<delimiter>value<delimiter>unit`.

    A line of neither kind is kept under its number; a key said twice keeps both values.
    """
    kept: dict[str, str] = {}
    for number, line in enumerate(lines, start=1):
        text = line.strip().rstrip(";").strip()
        if delimiter and delimiter in text:
            key, *rest = split(text, delimiter)
            key, value = key.rstrip(" :"), " ".join(cell for cell in rest if cell)
        else:
            key, _, value = (part.strip() for part in text.partition(":"))
            if not value or not key[:1].isalpha():
                key, value = f"line {number}", text
        if value:
            kept[key] = f"{kept[key]}; {value}" if key in kept else value
    return kept
