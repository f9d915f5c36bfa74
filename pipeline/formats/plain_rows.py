"""The rows of a plain table to a Recording in SI; what is not asked for is left out and named."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import RawFileError
from deamat.core.number_grammar import is_number
from deamat.core.recording import Recording, Source
from deamat.core.records import Flag
from deamat.formats.cells import OVER_RANGE, Dialect, looks_numeric, text_row, why_not
from deamat.formats.choice import Choice, Taken
from deamat.formats.decimals import Ambiguous, decimal_mark, normal, number_text
from deamat.formats.header import notes
from deamat.formats.numbers import parse
from deamat.formats.rawfile import RawFile
from deamat.formats.structure import fields
from deamat.formats.table import row_flags

# what no comma between thousands can be: behind a leading zero, or before one or two digits
_FRACTION = re.compile(r"(?<![0-9])0[0-9]*,|,[0-9]{1,2}(?![0-9])|,[0-9]{4}")
_ONE_RATE = 1.05  # rates that differ by less are one setting


def recording_of(
    file: RawFile, lines: Sequence[str], encoding: str, choice: Choice, *, ended: bool
) -> Recording:
    """Read the rows below a heading.

    Parameters
    ----------
    lines : of the file, without their ends
    ended : does the last row end with a line end (or may it go without)?

    Raises
    ------
    RawFileError : no rows, rows of another length, or a cell of a needed column that is no number
    """
    first, last = choice.heading.first, len(lines)
    empty = choice.heading.separator + " \t"
    while last > first and not lines[last - 1].strip(empty):
        last -= 1
    if last <= first:
        raise RawFileError(
            file.path, "no data rows: the file ends with its header", len(lines) - (not lines[-1]),
            hint="export the file again",
        )  # fmt: skip
    values, dropped = _values(file, lines[:last], choice)
    if not ended:
        raise RawFileError(
            file.path, "no line end after the last row, so its last number may be cut", last,
            value=lines[last - 1].split(choice.heading.separator)[-1],
            hint="export the file again; if this exporter never writes a final line end, "
            "set `ends_open = true` in campaign.toml",
        )  # fmt: skip
    used = [taken for taken in (*choice.needed, *choice.further) if taken.name in values]
    table = np.column_stack([values[taken.name] for taken in used])
    names = tuple(taken.name for taken in used)
    columns = {t.name: t.factor * values[t.name] + t.offset for t in used}
    _insist_on_frequencies(file, columns, choice)
    flags = (*_flags(used, dropped), *row_flags(table, names, range(first + 1, last + 1)))
    rest = [
        label
        for at, label in enumerate(choice.heading.labels)
        if label and at not in {taken.column for taken in used}
    ]
    metadata = notes(lines[: choice.heading.names], choice.heading.separator)
    if rest:
        metadata = {**metadata, "columns not used": ", ".join(rest)}
    return Recording(
        _for_viscosity(columns) if choice.technique == "viscosity" else columns,
        metadata,
        {taken.label: taken.unit for taken in used},
        Source(file.path, file.sha256, first + 1, last, encoding, "plain"),
        tuple(flags),
    )


def _insist_on_frequencies(file: RawFile, columns: dict[str, FloatArray], choice: Choice) -> None:
    if "frequency_Hz" not in columns:
        return
    wrong = np.flatnonzero(columns["frequency_Hz"] <= 0.0)
    if wrong.size:
        raise RawFileError(
            file.path, "a frequency must be above zero", choice.heading.first + 1 + int(wrong[0]),
            hint="export the points of the sweep alone",
        )  # fmt: skip


def _values(
    file: RawFile, lines: Sequence[str], choice: Choice
) -> tuple[dict[str, FloatArray], dict[str, str]]:
    """Read the columns that are used; of those that may be dropped, say why they were."""
    used = [*choice.needed, *choice.further]
    rows = lines[choice.heading.first :]
    fast = _fast(rows, choice)
    if fast is not None:
        return {taken.name: fast[:, taken.column] for taken in used}, {}
    split = _split(file, rows, choice, lines[: choice.heading.first])
    cells = {t.name: [normal(row[t.column]) for row in split] for t in used}
    try:
        decimal = decimal_mark(cell for t in choice.needed for cell in cells[t.name])
    except Ambiguous as error:
        cell = str(error)
        raise RawFileError(
            file.path, f"two readings fit: {cell} is {cell.replace(',', '.')} with a decimal "
            f"comma and {cell.replace(',', '')} with a comma between thousands",
            choice.heading.first + 1, value=cell,
            hint="export with decimal points and without thousands separators",
        ) from error  # fmt: skip
    values, dropped = {}, {}
    for taken in used:
        column, fault = _column(cells[taken.name], decimal)
        if column is not None:
            values[taken.name] = column
            continue
        at, cell, reason, hint = fault
        if taken in choice.needed:
            raise RawFileError(
                file.path, reason, choice.heading.first + 1 + at, taken.column + 1, cell, hint
            )
        dropped[taken.label] = f"line {choice.heading.first + 1 + at}: {reason}"
    return values, dropped


def _fast(rows: Sequence[str], choice: Choice) -> FloatArray | None:
    """Read rows of nothing but plain numbers, or None where that is not certain."""
    block = "\n".join(rows)
    separator = choice.heading.separator
    width = rows[0].count(separator) + 1
    if not block.isascii() or width != len(choice.heading.labels) or separator == "|":
        return None
    decimal = "."
    if separator != "," and "," in block:
        if "." in block or not _FRACTION.search(block):
            return None
        decimal = ","
    return parse(block.encode(), width, Dialect(separator, decimal))


def _split(
    file: RawFile, rows: Sequence[str], choice: Choice, above: Sequence[str]
) -> list[list[str]]:
    """Split rows into fields, insisting on one length."""
    width = 0
    split: list[list[str]] = []
    for at, row in enumerate(rows, start=choice.heading.first + 1):
        cells = fields(row, choice.heading.separator)
        if not any(cells):
            raise RawFileError(
                file.path, "a blank line between the rows", at,
                hint="export the file again; one file holds one run",
            )  # fmt: skip
        width = width or len(cells)
        if len(cells) != width:
            if not any(map(looks_numeric, cells)):
                raise text_row(file.path, row, at, above)
            few = len(cells) < width
            last = "; the file seems cut" if few and at == choice.heading.first + len(rows) else ""
            raise RawFileError(
                file.path, f"too {'few' if few else 'many'} fields: {len(cells)} where the first "
                f"row has {width}{last}", at, min(len(cells), width + 1),
                cells[-1] if few else cells[width], "export the file again",
            )  # fmt: skip
        if not any(looks_numeric(cells[taken.column]) for taken in choice.needed) and not any(
            map(looks_numeric, cells)
        ):
            raise text_row(file.path, row, at, above)
        split.append(cells)
    return split


def _column(
    cells: Sequence[str], decimal: str
) -> tuple[FloatArray | None, tuple[int, str, str, str]]:
    """Read the cells of one column, or say which one is no number and why."""
    values = np.empty(len(cells))
    for at, cell in enumerate(cells):
        text = number_text(cell, decimal)
        if not is_number(text) or not abs(float(text)) < OVER_RANGE:
            reason, hint = why_not(cell, Dialect("\t", decimal)) or (
                "not a number", "export the file again, or correct the export settings"
            )  # fmt: skip
            return None, (at, cell, reason, hint)
        values[at] = float(text)
    return values, (0, "", "", "")


def _flags(used: Sequence[Taken], dropped: dict[str, str]) -> list[Flag]:
    flags = [
        Flag(
            "label-by-unit",
            f"{taken.label} was taken for {taken.name}: its label is unknown, and it is the only "
            f"column in {taken.unit}",
        )
        for taken in used
        if taken.by_unit
    ]
    if dropped:
        said = "; ".join(f"{label} ({why})" for label, why in dropped.items())
        flags.append(Flag("columns-not-used", f"cells that are no numbers: {said}"))
    return flags


def _for_viscosity(columns: dict[str, FloatArray]) -> dict[str, FloatArray]:
    """Add the viscosity that stress over rate is; a run at one rate is one over time."""
    rate = columns.get("shear_rate_per_s")
    if rate is None:
        return columns
    if "viscosity_Pas" not in columns:
        stress = columns["shear_stress_Pa"]
        safe = np.where(rate > 0.0, rate, 1.0)
        columns = {**columns, "viscosity_Pas": np.where(rate > 0.0, stress / safe, 0.0)}
    one = rate.min() > 0.0 and rate.max() <= _ONE_RATE * rate.min()
    if one and rate.size > 1 and "time_s" in columns:
        return {name: values for name, values in columns.items() if name != "shear_rate_per_s"}
    return columns
