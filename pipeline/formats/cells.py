"""The slow reader of numbers: cell by cell, with a reason, a place and a hint for what it refuses.

`numbers` hands a block over whenever its fast path is not certain. What is read here is read by
the grammar below and by Python's correctly rounded `float`; nothing is ever turned into NaN.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import RawFileError
from deamat.core.number_grammar import is_number
from deamat.formats.rawfile import RawFile

# From here on a reading means "over range": SCPI instruments send 9.9E37 (9.91E37 for "no number").
OVER_RANGE = 9.9e37


@dataclass(frozen=True, slots=True)
class Dialect:
    """How a format writes its rows.

    Parameters
    ----------
    delimiter : one of comma, semicolon, tab
    decimal : point or comma; the other one inside a number is then an error
    quoted : numbers may stand in double quotes and then carry thousands commas
    segmented : blank lines part the rows into segments of one run
    """

    delimiter: str
    decimal: str = "."
    quoted: bool = False
    segmented: bool = False


_GROUPED = re.compile(r"[+-]?[1-9][0-9]{0,2}(?:,[0-9]{3})+(?:\.[0-9]*)?")
_GROUPED_OR_DECIMAL = re.compile(r"[+-]?[1-9][0-9]{0,2},[0-9]{3}")
_GROUPED_BY_POINTS = re.compile(r"[+-]?[1-9][0-9]{0,2}(?:\.[0-9]{3})+(?:,[0-9]*)?")
_COMMA_NUMBER = re.compile(r"[+-]?[0-9]*,[0-9]+(?:[eE][+-]?[0-9]+)?")
_FIELD = re.compile(r'("[^"]*"|[^",]*),')

_RANGE = "repeat the test within the instrument's range, or exclude the file"
_NOT_A_NUMBER = ("not a number", "export the file again, or correct the export settings")

# reason and hint by what the whole cell looks like; the first that fits is given
_REASONS = tuple(
    (re.compile(pattern, re.IGNORECASE), reason, hint)
    for pattern, reason, hint in (
        ("", "a blank cell", "export the file again with every reading in every row"),
        (
            r"OVER.*|OUT.*|OVLD|OFL|[O0]\.?L|E{2,}|[+-]?(?:-{2,}|-[.,]-)|[*]+|[#]+",
            "over-range text in place of a number",
            _RANGE,
        ),
        (
            r"#?N/?A|-?NAN.*|NULL|NONE|-?1\.#(?:IND|QNAN|NAN).*",
            "a missing value written as text",
            "export the file again with every reading in every row",
        ),
        (
            r"[+-]?(?:INF|INFINITY|∞|1\.#INF.*)",
            "an infinite value",
            _RANGE,
        ),
        (
            r"[+-]|[+-]?[0-9]+[.,]?[0-9]*E[+-]?",
            "an incomplete number",
            "export the file again",
        ),
        (
            r"[+-]?[0-9]*[.,]?[0-9]+(?:E[+-]?[0-9]+)?\s*(?!x)[^\W\d_][\w/%^²³]*|[+-]?[0-9.,]+\s*[%°]\w*",
            "a unit behind the number",
            "export numbers alone; the unit belongs over the column",
        ),
    )
)


def read_cells(
    file: RawFile, text: str, first_line: int, columns: int, dialect: Dialect, *, ended: bool
) -> FloatArray:
    """Read a block of rows cell by cell.

    Parameters
    ----------
    text : the rows, without trailing blank lines
    first_line : line of the first row in the file, counted from 1
    ended : does the last row end with a line end (or may it go without)?

    Returns
    -------
    array, shape (rows, columns)

    Raises
    ------
    RawFileError : naming line, column, value, reason and hint of the first cell that is no number,
        and the others that are none
    """
    lines = list(enumerate(text.split("\n"), start=first_line))
    if dialect.segmented:
        lines = [(at, line) for at, line in lines if line.strip()]
    table = np.empty((len(lines), columns))
    faults: list[RawFileError] = []
    for row, (at, line) in enumerate(lines):
        try:
            fields = _split(file, line, at, columns, dialect, last=row == len(lines) - 1)
        except RawFileError as error:
            faults.append(error)
            continue
        for column, field in enumerate(fields):
            value = _value(field, dialect)
            if value is None:
                faults.append(_refusal(file, line, at, fields, column, dialect))
                break
            table[row, column] = value
    if faults:
        raise RawFileError.together(faults)
    if not ended:
        raise RawFileError(
            file.path,
            "no line end after the last row, so its last number may be cut",
            line=lines[-1][0],
            column=columns,
            value=fields[-1],
            hint="export the file again; if this exporter never writes a final line end, "
            "set `ends_open = true` in campaign.toml",
        )
    return table


def looks_numeric(cell: str) -> bool:
    """Say whether a cell holds a plain number, with a decimal point or a decimal comma."""
    plain = cell.strip(' \t"')
    return bool(is_number(plain) or _COMMA_NUMBER.fullmatch(plain))


def _split(
    file: RawFile, line: str, at: int, columns: int, dialect: Dialect, *, last: bool
) -> list[str]:
    """Split a row into its fields, refusing a row that has not `columns` of them."""
    if not line.strip(" " if dialect.delimiter == "\t" else " \t"):
        raise RawFileError(
            file.path,
            "a blank line between the rows",
            line=at,
            hint="export the file again; one file holds one run",
        )
    fields = line.split(dialect.delimiter)
    if dialect.quoted and '"' in line:
        found = _FIELD.findall(line + ",")
        if "".join(f"{field}," for field in found) == line + ",":
            fields = found
    fields = [field.strip(" \t") for field in fields]
    stray = [column for column, field in enumerate(fields, 1) if '"' in field]
    if len(fields) == columns and (dialect.quoted or not stray):
        return fields
    if not any(looks_numeric(field) for field in fields):
        raise text_row(file.path, line, at, file.head[: at - 1])
    if stray and not dialect.quoted:
        raise RawFileError(
            file.path,
            "a quoted number, which this format does not use",
            line=at,
            column=stray[0],
            value=fields[stray[0] - 1],
            hint="export the numbers without quotes",
        )
    if len(fields) < columns:
        raise RawFileError(
            file.path,
            f"too few fields: {len(fields)} where the header names {columns}"
            + ("; the file seems cut" if last else ""),
            line=at,
            column=len(fields),
            value=fields[-1],
            hint="export the file again",
        )
    raise RawFileError(
        file.path,
        f"too many fields: {len(fields)} where the header names {columns}",
        line=at,
        column=columns + 1,
        value=fields[columns],
        hint="export the file again"
        + (
            ", without thousands separators and with decimal points"
            if dialect.delimiter == ","
            else ""
        ),
    )


def _value(field: str, dialect: Dialect) -> float | None:
    """Read one field, or None where it is not a number for certain."""
    if dialect.decimal == ",":
        if "." in field:
            return None
        field = field.replace(",", ".", 1)
    elif dialect.quoted and len(field) > 2 and field[0] == field[-1] == '"':
        field = field[1:-1]
        if _GROUPED.fullmatch(field):
            field = field.replace(",", "")
    if not is_number(field):
        return None
    value = float(field)
    return value if abs(value) < OVER_RANGE else None


def _refusal(
    file: RawFile, line: str, at: int, fields: list[str], column: int, dialect: Dialect
) -> RawFileError:
    """Say why a field is not a number."""
    found = why_not(fields[column], dialect)
    if found is None and not any(looks_numeric(field) for field in fields):
        return text_row(file.path, line, at, file.head[: at - 1])
    reason, hint = found or _NOT_A_NUMBER
    return RawFileError(
        file.path, reason, line=at, column=column + 1, value=fields[column], hint=hint
    )


def why_not(field: str, dialect: Dialect) -> tuple[str, str] | None:
    """Return reason and hint for a field that `_value` does not read, None if it is no number."""
    plain = field.strip('"') if dialect.quoted else field
    if dialect.decimal == "," and "." in plain and is_number(plain):
        return "a decimal point in a file with decimal commas", "export with one decimal mark"
    pointed = plain.replace(",", ".", 1) if dialect.decimal == "," else plain
    if is_number(pointed):  # a number indeed, so it was refused for its size
        if math.isinf(float(pointed)):
            return "a number too large to hold", "export the file again"
        return "a number that stands for over-range (9.9E37 or beyond)", _RANGE
    if dialect.decimal == "." and _GROUPED_OR_DECIMAL.fullmatch(plain):
        return (
            "a comma that may be a decimal comma or a thousands separator",
            "export with decimal points and without thousands separators",
        )
    if dialect.decimal == "." and _COMMA_NUMBER.fullmatch(plain):
        return "a decimal comma in a file with decimal points", "export with one decimal mark"
    if _GROUPED.fullmatch(plain) or _GROUPED_BY_POINTS.fullmatch(plain):
        return (
            "a thousands separator, which this format does not use",
            "export without thousands separators",
        )
    for pattern, reason, hint in _REASONS:
        if pattern.fullmatch(plain):
            return reason, hint
    return None


def text_row(path: str, line: str, at: int, above: Iterable[str]) -> RawFileError:
    """Refuse a row of text between the rows, perhaps the header once more."""
    header = line.strip() in (known.strip() for known in above)
    return RawFileError(
        path,
        "the header is repeated between the rows" if header else "a text row between the rows",
        line=at,
        value=line.strip(),
        hint="one file holds one run: export each run to a file of its own",
    )
