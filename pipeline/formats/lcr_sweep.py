"""What the readers of LCR meters have in common: the pairs a meter shows, and rows with a status.

Points that the meter itself calls no measurement (over-range, overload) stay in the recording as
they were written, so that rows and lines keep step, and are marked in the column `over_range`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import RawFileError
from deamat.core.number_grammar import NUMBER, is_number
from deamat.core.recording import Recording, Source
from deamat.core.records import Flag
from deamat.core.units import UnknownUnit, si_factor
from deamat.formats.cells import OVER_RANGE, Dialect, read_cells
from deamat.formats.rawfile import RawFile
from deamat.formats.table import row_flags

# what a meter calls its setting -> the two columns that it then writes, each with its unit
PAIRS: dict[str, tuple[tuple[str, str], tuple[str, str]]] = {
    "Cp-D": (("parallel_capacitance_F", "F"), ("loss_tangent", "1")),
    "Cp-Rp": (("parallel_capacitance_F", "F"), ("parallel_resistance_ohm", "ohm")),
    "Cs-D": (("series_capacitance_F", "F"), ("loss_tangent", "1")),
    "Cs-Rs": (("series_capacitance_F", "F"), ("series_resistance_ohm", "ohm")),
    "R-X": (("series_resistance_ohm", "ohm"), ("reactance_ohm", "ohm")),
    "Z-theta-deg": (("impedance_ohm", "ohm"), ("phase_rad", "deg")),
    "Z-theta-rad": (("impedance_ohm", "ohm"), ("phase_rad", "rad")),
}
_MOST_LINES_NAMED = 5
_VOLTAGE = re.compile(rf"({NUMBER.pattern})\s*(m?V)?")


@dataclass(frozen=True, slots=True)
class Column:
    """One column of numbers: its name in SI, its label, and the unit it is written in."""

    name: str
    label: str
    unit: str


@dataclass(frozen=True, slots=True)
class Sweep:
    """How the rows of one file are written.

    Parameters
    ----------
    first : line of the first row, counted from 0
    columns : of numbers, in their order
    dialect : how the rows are parted
    statuses : what may stand in a last column behind them (in lower case), and whether it means a
        measurement; None where there is no such column
    """

    first: int
    columns: tuple[Column, ...]
    dialect: Dialect
    statuses: Mapping[str, bool] | None = None


def function_columns(mode: str) -> tuple[Column, ...]:
    """Columns of a log whose rows are frequency, primary and secondary of a mode in SI."""
    first, second = PAIRS[mode]
    return (
        Column("frequency_Hz", "frequency", "Hz"),
        Column(first[0], "primary", first[1]),
        Column(second[0], "secondary", second[1]),
    )


def mode_of(
    file: RawFile, said: Sequence[tuple[int, str]], modes: Mapping[str, str], hint: str
) -> str:
    """Tell which pair a log holds from what its header says of it.

    Parameters
    ----------
    said : line (from 1) and text of each statement in the header
    modes : text in lower case to a key of `PAIRS`

    Raises
    ------
    RawFileError : nothing is said, two statements differ, or the pair gives no permittivity
    """
    if not said:
        raise RawFileError(
            file.path,
            "the file does not say which function the meter measured, so its first number may be "
            "a capacitance in parallel or in series, or no capacitance at all",
            line=1,
            hint=hint,
        )
    for line, text in said:
        if text.casefold() not in modes:
            raise RawFileError(
                file.path,
                "a function that gives no permittivity",
                line=line,
                value=text,
                hint=f"measure one of {', '.join(dict.fromkeys(modes.values()))}",
            )
        if modes[text.casefold()] != modes[said[0][1].casefold()]:
            raise RawFileError(
                file.path,
                f"the function changes from {said[0][1]} (line {said[0][0]})",
                line=line,
                value=text,
                hint="log one sweep with one function to one file",
            )
    return modes[said[0][1].casefold()]


def level_of(file: RawFile, line: int, text: str) -> str:
    """Read the test level (`1.000e-01V`, `500 mV`) and give it in volts, as text of a number.

    Raises
    ------
    RawFileError : anything else
    """
    found = _VOLTAGE.fullmatch(text.strip())
    if found is None or not float(found[1]) > 0.0:
        raise RawFileError(
            file.path, "not a test level in V or mV", line=line, value=text,
            hint="log the reply of LEV:VOLT? as it is",
        )  # fmt: skip
    return repr(si_factor(found[2] or "V")[1] * float(found[1]))


def read_sweep(file: RawFile, sweep: Sweep, metadata: Mapping[str, str], reader: str) -> Recording:
    """Read the rows of a sweep into SI, marking what the meter calls over-range.

    Raises
    ------
    RawFileError : no rows, a row that is not as the header says, a status or a unit that is not
        known, a frequency that is not above zero
    """
    text, ended = _block(file, sweep.first)
    lines = text.split("\n")
    marks = [""] * len(lines)
    if sweep.statuses is not None:
        lines, marks = _split_status(file, lines, sweep)
    rows = read_cells(
        file,
        "\n".join(_without_sentinels(line, sweep.dialect) for line in lines),
        sweep.first + 1,
        len(sweep.columns),
        sweep.dialect,
        ended=ended,
    )
    over = _over_range(lines, marks, sweep, rows)
    flags = row_flags(
        rows,
        tuple(c.name for c in sweep.columns),
        range(sweep.first + 1, sweep.first + 1 + len(rows)),
    )
    columns = {c.name: _factor(file, c, sweep) * rows[:, i] for i, c in enumerate(sweep.columns)}
    _positive(file, columns["frequency_Hz"], sweep.first + 1)
    if over.any():
        flags += (_over_range_flag(over, columns["frequency_Hz"], sweep.first + 1),)
    source = Source(
        file.path, file.sha256, sweep.first + 1, sweep.first + len(lines), file.encoding,
        reader,
    )  # fmt: skip
    return Recording(
        {**columns, "over_range": over.astype(np.float64)},
        metadata,
        {c.label: c.unit for c in sweep.columns},
        source,
        tuple(flags),
    )


def _block(file: RawFile, first: int) -> tuple[str, bool]:
    """Return the rows as text without trailing blank lines, and whether the last one is ended."""
    block = file.body[file.offset(first) :].replace(b"\r\n", b"\n")
    ended = file.ends_open or block.endswith(b"\n")
    block = block.rstrip(b" \n")
    if not block:
        raise RawFileError(
            file.path, "no data rows: the file ends with its header",
            line=file.body.rstrip().count(b"\n") + 1, hint="log the sweep again",
        )  # fmt: skip
    return block.decode(), ended


def _split_status(file: RawFile, lines: Sequence[str], sweep: Sweep) -> tuple[list[str], list[str]]:
    """Part each row into its numbers and its status."""
    statuses = sweep.statuses or {}
    numbers, marks = [], []
    for at, line in enumerate(lines, start=sweep.first + 1):
        cells = line.split(sweep.dialect.delimiter)
        wanted = len(sweep.columns) + 1
        if line.lstrip().startswith("#"):
            raise RawFileError(
                file.path, "a header line between the rows", line=at, value=line.strip()[:60],
                hint="log one sweep to one file",
            )  # fmt: skip
        if len(cells) != wanted:
            raise RawFileError(
                file.path,
                f"{len(cells)} fields where {', '.join(c.label for c in sweep.columns)} and a "
                "status belong",
                line=at,
                column=min(len(cells), wanted),
                value=line.strip()[:60],
                hint="log the sweep again",
            )
        mark = cells[-1].strip()
        if mark.casefold() not in statuses:
            raise RawFileError(
                file.path, "an unknown status", line=at, column=wanted, value=mark,
                hint=f"known: {', '.join(statuses)}",
            )  # fmt: skip
        numbers.append(sweep.dialect.delimiter.join(cells[:-1]))
        marks.append(mark)
    return numbers, marks


def _sentinel(cell: str, dialect: Dialect) -> float | None:
    """Return the number that stands for over-range (9.9E37), or None for any other cell."""
    plain = cell.strip(" \t")
    if dialect.decimal == ",":
        plain = plain.replace(",", ".", 1)
    if not is_number(plain):
        return None
    value = float(plain)
    return value if OVER_RANGE <= abs(value) < np.inf else None


def _without_sentinels(line: str, dialect: Dialect) -> str:
    """Put a zero where the meter wrote 9.9E37, except for the frequency."""
    first, *rest = line.split(dialect.delimiter)
    return dialect.delimiter.join(
        [first, *("0" if _sentinel(cell, dialect) is not None else cell for cell in rest)]
    )


def _over_range(
    lines: Sequence[str], marks: Sequence[str], sweep: Sweep, rows: FloatArray
) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Tell which points are no measurements, and put what stood there back into the rows."""
    over = np.zeros(len(lines), dtype=np.bool_)
    for i, (line, mark) in enumerate(zip(lines, marks, strict=True)):
        over[i] = sweep.statuses is not None and not sweep.statuses[mark.casefold()]
        for column, cell in enumerate(line.split(sweep.dialect.delimiter)):
            value = _sentinel(cell, sweep.dialect) if column else None
            if value is not None:
                rows[i, column] = value
                over[i] = True
    return over


def _factor(file: RawFile, column: Column, sweep: Sweep) -> float:
    try:
        return si_factor(column.unit)[1]
    except UnknownUnit as error:
        raise RawFileError(file.path, f"{column.label!r}: {error}", line=sweep.first) from error


def _positive(file: RawFile, frequency_Hz: FloatArray, first_line: int) -> None:
    wrong = np.flatnonzero(frequency_Hz <= 0.0)
    if wrong.size:
        at = int(wrong[0])
        raise RawFileError(
            file.path, "a frequency must be above zero", line=first_line + at, column=1,
            value=f"{frequency_Hz[at]:g}", hint="log the sweep again",
        )  # fmt: skip


def _over_range_flag(over: Iterable[np.bool_], frequency_Hz: FloatArray, first_line: int) -> Flag:
    """Name the points that the meter calls no measurements, by line and frequency."""
    found = np.flatnonzero(np.asarray(over))
    named = ", ".join(
        f"line {first_line + i} ({frequency_Hz[i]:g} Hz)" for i in found[:_MOST_LINES_NAMED]
    )
    more = f" and {found.size - _MOST_LINES_NAMED} more" if found.size > _MOST_LINES_NAMED else ""
    return Flag(
        "over-range",
        f"{found.size} of {frequency_Hz.size} points are marked as invalid by the meter "
        f"and are not used: {named}{more}",
    )
