"""Takes a filled-in row over: its file goes into place, its row behind those of the register."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import count
from pathlib import Path

from deamat.core.atomic import write_atomically
from deamat.core.config import Config
from deamat.core.csv_cells import csv_text
from deamat.core.errors import RawFileError
from deamat.core.number_grammar import is_number
from deamat.core.register import ENDINGS, read_register, register_table, split_sheet
from deamat.core.register_columns import Column, numeric_columns, si_name, split_unit
from deamat.core.register_table import RegisterTable, decimal_comma
from deamat.core.slug import nearest_slug, slug_fault
from deamat.core.technique import AnyTechnique
from deamat.core.units import si_factor
from deamat.run.add.rows import FOUND_IN
from deamat.run.register_schemas import header_of


@dataclass(frozen=True, slots=True)
class Place:
    """A technique's folder in a campaign."""

    raw: Path
    campaign: str
    technique: AnyTechnique

    @property
    def folder(self) -> Path:
        """Where its register and files stand."""
        return self.raw / self.campaign / self.technique.key

    @property
    def register(self) -> Path:
        """Its register."""
        return self.folder / self.technique.register.file

    @property
    def name(self) -> str:
        """The register relative to `raw/`, for messages."""
        return f"{self.campaign}/{self.technique.key}/{self.technique.register.file}"


def take(place: Place, row: Mapping[str, str], data: bytes, source: Path, config: Config) -> str:
    """Put a file and its row into place; returns the file's name below the register's folder.

    Parameters
    ----------
    data : bytes of the file
    source : where it stands now; one that stands in the folder already stays there

    Raises
    ------
    RawFileError : the row does not hold, with the reason; nothing was written then
    """
    material = row.get("material", "")
    if fault := slug_fault(material):
        hint = f"nearest valid: {nearest_slug(material)!r}" if material else "fill in the material"
        raise RawFileError(place.name, fault, value=material, hint=hint)
    name = _free_name(place, row, data, source)
    sheet = split_sheet(row["file"])[1]
    cells = {c: cell for c, cell in row.items() if c != FOUND_IN and cell}
    cells["file"] = f"{name}#{sheet}" if sheet else name
    register = _appended(place, cells, config)
    target = place.folder / name
    if not target.resolve().is_relative_to(place.raw.resolve()):
        raise RawFileError(place.name, f"{target} leads out of {place.raw}")
    if not target.is_file():
        write_atomically(target, data)
    write_atomically(place.register, register)
    return name


def _free_name(place: Place, row: Mapping[str, str], data: bytes, source: Path) -> str:
    """Choose `<material>/<file>`, with a number where another file has that name."""
    whole, folder = source.resolve(), place.folder.resolve()
    if whole.is_relative_to(folder):
        return whole.relative_to(folder).as_posix()
    stem = nearest_slug(source.stem)
    ending = re.sub(r"[^a-z0-9_]", "", source.suffix.casefold())[:8]
    digest = hashlib.sha256(data).digest()
    for number in count(1):
        more = "" if number == 1 else f"-{number}"
        name = f"{row['material']}/{stem}{more}" + (f".{ending}" if ending else "")
        taken = place.folder / name
        if not taken.exists() or hashlib.sha256(taken.read_bytes()).digest() == digest:
            break
    return name


def _appended(place: Place, cells: Mapping[str, str], config: Config) -> bytes:
    """Return the register with a row more, in its own separator, encoding and units.

    Raises
    ------
    RawFileError : the register does not take the row
    """
    form = place.technique.register
    old = csv_text([header_of(place.technique)]).encode()
    if place.register.is_file():
        old = place.register.read_bytes()
    elif any(place.register.with_suffix(ending).is_file() for ending in ENDINGS):
        reason = "its register is a workbook, which this program does not write"
        raise RawFileError(place.name, reason, hint="save it as CSV, or write the row there")
    table = register_table(old, place.name, form)
    if table.encoding == "utf-16":
        raise RawFileError(place.name, "its register is in UTF-16", hint="save it as UTF-8 CSV")
    end = b"\r\n" if b"\r\n" in old else b"\n"
    line = csv_text([_cells_of(place, table, cells)], table.separator, end.decode())
    try:
        added = line.encode(table.encoding)
    except UnicodeEncodeError as error:
        reason = f"the register is in {table.encoding}, which has no {line[error.start]!r}"
        raise RawFileError(place.name, reason, hint="save it as UTF-8 CSV") from error
    new = old + (b"" if old.endswith(b"\n") else end) + added
    read = read_register(
        new, place.name, place.campaign, place.technique.key, place.technique.required,
        config.instruments.gauges, form,
    )  # fmt: skip
    last = max((line for line, _ in register_table(new, place.name, form).rows), default=0)
    for _, fault in read.errors:
        if fault.line == last:
            raise fault
    return new


def _cells_of(place: Place, table: RegisterTable, cells: Mapping[str, str]) -> list[str]:
    """Put cells in the order and the units of a register's header.

    Raises
    ------
    RawFileError : the register has no column for one of them
    """
    form = place.technique.register
    numbers = numeric_columns(
        table.header, place.name, place.technique.required, form.text, form.notes
    )
    by_header = {column.header: column for column in numbers.values()}
    told = [row[c.index] for _, row in table.rows for c in numbers.values() if len(row) > c.index]
    commas = table.separator != "," and decimal_comma(told)
    found = dict.fromkeys(table.header, "")
    for label, cell in cells.items():
        column = label
        if label not in found:
            column, cell = _converted(label, cell, numbers, place)
        found[column] = cell.replace(".", ",", 1) if commas and column in by_header else cell
    return list(found.values())


def _converted(
    label: str, cell: str, numbers: Mapping[str, Column], place: Place
) -> tuple[str, str]:
    """Write a number in the column that holds its quantity in another unit.

    Raises
    ------
    RawFileError : there is no such column, or the cell is no number
    """
    stem, unit = split_unit(label)
    if unit is not None:
        si, factor, offset = si_factor(unit)
        column = numbers.get(si_name(stem, si))
        if column is not None and is_number(cell):
            value = factor * float(cell) + offset
            return column.header, f"{(value - column.offset) / column.factor:.10g}"
    raise RawFileError(
        place.name, f"the register has no column {label!r}", value=cell,
        hint="add the column to its header, or empty the cell",
    )  # fmt: skip
