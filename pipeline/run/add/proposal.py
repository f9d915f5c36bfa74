"""The table of proposed rows: written for people to fill in, read as their spreadsheet saves it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from deamat.core.atomic import write_atomically
from deamat.core.csv_cells import csv_text, neutral, restored
from deamat.core.errors import ConfigError, RawFileError
from deamat.core.number_grammar import is_number
from deamat.core.register_columns import split_unit
from deamat.core.register_table import decimal_comma, read_table
from deamat.core.sheets import write_workbook
from deamat.run.add.rows import MISSING

Row = dict[str, str]


@dataclass(frozen=True, slots=True)
class Proposal:
    """Rows that wait to be filled in.

    Parameters
    ----------
    path : of their file, whether it is there yet or not
    separator : of its fields, empty for a workbook
    """

    path: Path
    rows: tuple[Row, ...]
    separator: str = ","


def read_proposal(folder: Path, name: str, *, workbook: bool) -> Proposal:
    """Read the proposed rows of one technique; none where there is no such file.

    Parameters
    ----------
    workbook : which form a new file shall have

    Raises
    ------
    ConfigError : there are two such files
    RawFileError : it cannot be read
    """
    there = [path for path in (folder / f"{name}.csv", folder / f"{name}.xlsx") if path.is_file()]
    if len(there) > 1:
        raise ConfigError(f"{there[0]} and {there[1]}: keep one of them")
    if not there:
        return Proposal(folder / f"{name}.{'xlsx' if workbook else 'csv'}", ())
    table = read_table(there[0].read_bytes(), str(there[0]), ["file"])
    if "file" not in table.header:
        hint = "restore the column, or remove this file and call `deamat add` again"
        raise RawFileError(str(there[0]), "no column 'file'", 1, hint=hint)
    rows = [
        {column: restored(cell.strip()) for column, cell in zip(table.header, row, strict=False)}
        for _, row in table.rows
    ]
    return Proposal(there[0], tuple(_with_points(rows, table.separator)), table.separator)


def _with_points(rows: Sequence[Row], separator: str) -> Sequence[Row]:
    """Write decimal commas as points, where they are no thousands."""
    cells = [cell for row in rows for column, cell in row.items() if _is_number_column(column)]
    if separator == "," or not decimal_comma(cells):
        return rows
    return [
        {c: cell.replace(",", ".", 1) if _is_number_column(c) else cell for c, cell in row.items()}
        for row in rows
    ]


def _is_number_column(column: str) -> bool:
    return split_unit(column)[1] is not None


def write_proposal(proposal: Proposal, columns: Sequence[str], rows: Sequence[Row]) -> None:
    """Write the rows that wait; without any the file goes."""
    if not rows:
        proposal.path.unlink(missing_ok=True)
        return
    further = dict.fromkeys(column for row in rows for column in row)
    header = list(dict.fromkeys((*columns, *further)))
    table = [header, *([row.get(column, "") for column in header] for row in rows)]
    if proposal.path.suffix == ".xlsx":
        data = write_workbook({proposal.path.stem: [list(map(_typed, row)) for row in table]})
    else:
        # With the mark spreadsheet programs read it as UTF-8.
        data = csv_text(table, proposal.separator).encode("utf-8-sig")
    if not proposal.path.is_file() or proposal.path.read_bytes() != data:
        write_atomically(proposal.path, data)


def _typed(cell: str) -> str | float:
    return float(cell) if is_number(cell) else neutral(cell)


def missing_in(row: Mapping[str, str]) -> list[str]:
    """List the columns of a row that are still marked."""
    return [column for column, cell in row.items() if cell == MISSING]
