"""The rows of a plain table to a Recording in SI; what is not asked for is left out and named."""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import RawFileError
from deamat.core.number_grammar import is_number
from deamat.core.recording import Recording, Source
from deamat.core.records import Flag
from deamat.formats.cells import OVER_RANGE, Dialect, looks_numeric, text_row, why_not
from deamat.formats.choice import Choice, Taken
from deamat.formats.decimals import (
    Ambiguous,
    decimal_mark,
    grouping,
    normal,
    number_text,
    sole_decimal_mark,
    thousands_by_point,
)
from deamat.formats.durations import clock_unit, is_clock, is_date, seconds_text
from deamat.formats.header import notes
from deamat.formats.numbers import parse
from deamat.formats.rawfile import RawFile
from deamat.formats.strain_columns import unknown_strain
from deamat.formats.structure import fields
from deamat.formats.table import row_flags

_MARKS = {",": "comma", ".": "point"}
_OF_THE_DAY_s = 3600.0  # an elapsed time starts earlier
_ONE_RATE = 1.05  # rates that differ by less are one setting


@dataclass(frozen=True, slots=True)
class Rows:
    """The numbers below a heading, as written.

    Parameters
    ----------
    values : by quantity, shape (rows,) each
    dropped : label of each column that may be left out and was, and why
    first, last : lines of the first and the last row, counted from 1
    """

    values: Mapping[str, FloatArray]
    dropped: Mapping[str, str]
    first: int
    last: int


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
    first, last = choice.heading.first, _end(lines, choice, file.columns)
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
    metadata = notes(lines[: choice.heading.names], choice.heading.separator)
    rows = Rows(values, dropped, first + 1, last)
    return recording_from(file, choice, rows, encoding, metadata)


def _end(lines: Sequence[str], choice: Choice, columns: range | None) -> int:
    """Count the lines down to the last row, of the columns that the register names."""
    separator, last = choice.heading.separator, len(lines)
    empty = separator + " \t"
    while last > choice.heading.first:
        line = lines[last - 1]
        if columns is not None:
            line = "".join(fields(line, separator)[columns.start : columns.stop])
        if line.strip(empty):
            break
        last -= 1
    return last


def recording_from(
    file: RawFile, choice: Choice, rows: Rows, encoding: str, metadata: Mapping[str, str]
) -> Recording:
    """Convert rows to SI, and say which columns were left out.

    Parameters
    ----------
    metadata : what stands above the labels

    Raises
    ------
    RawFileError : a frequency that is not above zero
    """
    used = [taken for taken in choice.used if taken.name in rows.values]
    columns = {t.name: _in_si(t, rows.values[t.name]) for t in used}
    _insist_on_frequencies(file, columns, choice)
    left = [*choice.heading.labels]
    for taken in used:
        left[taken.column] = ""
    rest = ", ".join(label for label in left if label)
    metadata = {**metadata, **choice.channels.said}
    return Recording(
        _for_viscosity(columns) if choice.technique == "viscosity" else columns,
        {**metadata, "columns not used": rest} if rest else metadata,
        {taken.label: taken.unit for taken in used},
        Source(file.path, file.sha256, rows.first, rows.last, encoding, "plain"),
        (
            *_flags(used, rows.dropped),
            *unknown_strain(columns, set(left) - set(rows.dropped)),
            *_row_flags(rows),
        ),
    )


def _in_si(taken: Taken, values: FloatArray) -> FloatArray:
    made = values * taken.factor
    if taken.offset:
        made += taken.offset
    return made


def _row_flags(rows: Rows) -> tuple[Flag, ...]:
    names = tuple(rows.values)
    lead = rows.values["time_s" if "time_s" in names else names[0]]
    if (lead[1:] > lead[:-1]).all():  # nearly every recording rises, so it repeats no row
        return ()
    table = np.column_stack(list(rows.values.values()))
    return row_flags(table, names, range(rows.first, rows.last + 1))


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
    rows = lines[choice.heading.first :]
    columns = _columns_of(rows, choice.heading.separator)
    quick = None if columns is None else _quick(columns, choice)
    if quick is not None:
        return quick
    split, numbers, faults = _split(file, rows, choice, lines[: choice.heading.first])
    cells = {t.name: normal([row[t.column] for row in split]) for t in choice.used}
    try:
        decimal = choice.decimal or decimal_mark(
            cell for t in choice.needed for cell in cells[t.name]
        )
        if decimal == "." and not choice.decimal:
            _insist_on_points(list(zip(*split, strict=True)), choice)
    except Ambiguous as error:
        cell, mark = error.cell, "," if "," in error.cell else "."
        raise RawFileError(
            file.path, f"two readings fit: {cell} is {cell.replace(',', '.')} with a decimal "
            f"{_MARKS[mark]} and {cell.replace(mark, '')} with a {_MARKS[mark]} between thousands",
            choice.heading.first + 1, value=cell,
            hint="export with decimal points and without thousands separators",
        ) from error  # fmt: skip
    values, dropped = {}, {}
    for taken in choice.used:
        column, wrong = _column(cells[taken.name], decimal, taken.unit)
        if taken in choice.needed:
            faults += [
                RawFileError(file.path, reason, numbers[at], taken.column + 1, cell, hint)
                for at, cell, reason, hint in wrong
            ]
        elif wrong:
            dropped[taken.label] = f"line {numbers[wrong[0][0]]}: {wrong[0][2]}"
            continue
        values[taken.name] = column
    if faults:
        faults.sort(key=lambda fault: (fault.line or 0, fault.column or 0))
        raise RawFileError.together(faults)
    return values, dropped


def _insist_on_points(columns: Sequence[Sequence[str]], choice: Choice) -> None:
    """Refuse points that may part thousands, where another column has decimal commas.

    Raises
    ------
    Ambiguous : with such a cell
    """
    for taken in choice.needed if columns else ():
        others = (cell for column in columns for cell in column)
        if cell := thousands_by_point(columns[taken.column], others):
            raise Ambiguous(cell)


def _columns_of(rows: Sequence[str], separator: str) -> list[Sequence[str]] | None:
    """Turn rows of one length into columns, or return None where anything is odd."""
    text = "\n".join(rows)
    if '"' not in text:
        width = rows[0].count(separator) + 1
        if any(row.count(separator) != width - 1 for row in rows):
            return None
        cells = text.replace("\n", separator).split(separator)
        return [cells[column::width] for column in range(width)]
    try:
        split = list(csv.reader(rows, delimiter=separator, skipinitialspace=True, strict=True))
        return list(zip(*split, strict=True)) if len(split) == len(rows) else None
    except (csv.Error, ValueError):
        return None


def _quick(
    columns: Sequence[Sequence[str]], choice: Choice
) -> tuple[dict[str, FloatArray], dict[str, str]] | None:
    """Read the columns that are used, if all cells of the needed ones are plain numbers."""
    blocks = {t.name: "\n".join(columns[t.column]).encode() for t in choice.used}
    decimal = sole_decimal_mark(b"\n".join(blocks[t.name] for t in choice.needed), choice.decimal)
    if not decimal:
        return None
    if decimal == "." and not choice.decimal:
        try:
            _insist_on_points(columns, choice)
        except Ambiguous:
            return None  # said by the long way
    values, dropped = {}, {}
    for taken in choice.used:
        column = parse(blocks[taken.name], 1, Dialect("\t", decimal))
        if column is not None:
            values[taken.name] = column[:, 0]
        elif taken in choice.needed:
            return None
        else:
            cells = normal([cell.strip() for cell in columns[taken.column]])
            slow, wrong = _column(cells, decimal, taken.unit)
            if wrong:
                at, _, reason, _ = wrong[0]
                dropped[taken.label] = f"line {choice.heading.first + 1 + at}: {reason}"
            else:
                values[taken.name] = slow
    return values, dropped


def _split(
    file: RawFile, rows: Sequence[str], choice: Choice, above: Sequence[str]
) -> tuple[list[list[str]], list[int], list[RawFileError]]:
    """Split rows into fields of one length; give their lines too, and what is wrong with others."""
    width = 0
    split: list[list[str]] = []
    lines: list[int] = []
    faults: list[RawFileError] = []
    for at, row in enumerate(rows, start=choice.heading.first + 1):
        cells = fields(row, choice.heading.separator)
        width = width or len(cells)
        last = at == choice.heading.first + len(rows)
        fault = _fault_of_row(file.path, cells, width, at, last=last)
        if fault is None and not any(looks_numeric(cells[t.column]) for t in choice.needed):
            fault = None if any(map(looks_numeric, cells)) else text_row(file.path, row, at, above)
        elif fault is not None and any(cells) and not any(map(looks_numeric, cells)):
            fault = text_row(file.path, row, at, above)
        if fault is not None:
            faults.append(fault)
            continue
        split.append(cells)
        lines.append(at)
    return split, lines, faults


def _fault_of_row(
    path: str, cells: Sequence[str], width: int, at: int, *, last: bool
) -> RawFileError | None:
    """Say what is wrong with the length of a row, if anything."""
    if not any(cells):
        return RawFileError(
            path, "a blank line between the rows", at,
            hint="export the file again; one file holds one run",
        )  # fmt: skip
    if len(cells) == width:
        return None
    few = len(cells) < width
    cut = "; the file seems cut" if few and last else ""
    return RawFileError(
        path, f"too {'few' if few else 'many'} fields: {len(cells)} where the first row has "
        f"{width}{cut}", at, min(len(cells), width + 1), cells[-1] if few else cells[width],
        "export the file again",
    )  # fmt: skip


def _column(
    cells: Sequence[str], decimal: str, unit: str
) -> tuple[FloatArray, list[tuple[int, str, str, str]]]:
    """Read the cells of one column, and say which ones are no numbers and why."""
    values = np.zeros(len(cells))
    wrong: list[tuple[int, str, str, str]] = []
    clock, grouped = clock_unit(unit), grouping(cells)
    for at, cell in enumerate(cells):
        text = seconds_text(cell, clock) if clock else number_text(cell, decimal, grouped=grouped)
        if not is_number(text) or not abs(float(text)) < OVER_RANGE:
            wrong.append((at, cell, *_why(cell, decimal)))
            continue
        values[at] = float(text)
    if clock and not wrong and cells and values[0] >= _OF_THE_DAY_s:
        wrong.append((0, cells[0], "it may be a time of the day or an elapsed time",
                      "export elapsed times, in seconds"))  # fmt: skip
    return values, wrong


def _why(cell: str, decimal: str) -> tuple[str, str]:
    if is_clock(cell):
        return (
            "a time as a clock shows it, under a unit",
            "write h:mm:ss over the column, or export seconds",
        )
    if is_date(cell):
        return "a date where a number belongs", "export elapsed times, in seconds"
    return why_not(cell, Dialect("\t", decimal)) or (
        "not a number", "export the file again, or correct the export settings"
    )  # fmt: skip


def _flags(used: Sequence[Taken], dropped: Mapping[str, str]) -> list[Flag]:
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
