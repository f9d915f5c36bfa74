"""Registers: `specimens.csv` (or `.xlsx`, `.ods`), one row per specimen, units in the header.

A technique whose register holds one row per observation declares another `RegisterForm`.

A column whose name ends in a known unit is a number (`diameter_mm` becomes `diameter_m`), and its
`u_` twin is its standard uncertainty; the closed list of text columns is kept as text; any other
column is a note. A column that starts like a quantity but ends in no known unit is an error, and so
is one that is nearly a known column. Every bad row is an error of its own; the others are read.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

from deamat.core.dates import read_date
from deamat.core.errors import RawFileError
from deamat.core.instruments import Gauge
from deamat.core.number_grammar import is_number
from deamat.core.quantity import Quantity
from deamat.core.recording import Specimen
from deamat.core.records import Condition
from deamat.core.register_bounds import possible
from deamat.core.register_columns import (
    CONDITION_COLUMNS,
    TEXT_COLUMNS,
    Column,
    numeric_columns,
)
from deamat.core.register_table import RegisterTable, decimal_comma, read_table
from deamat.core.slug import Spellings, label_fault, nearest_label, nearest_slug, slug_fault

REGISTER_FILE = "specimens.csv"
ENDINGS = (".csv", ".xlsx", ".ods")  # of a register, as text or as a workbook
REGISTER_FILES = tuple(
    stem + ending for stem in ("specimens", "observations") for ending in ENDINGS
)

DATE_COLUMNS = ("cured_on", "tested_on")
_TINIEST, _LARGEST = 1e-30, 1e30  # in SI: no measured number is smaller or larger
_SHORTEST_m, _LONGEST_m = 1e-9, 1e3
_LONGEST_SPECIMEN = 120
_SHOWN = 80  # characters of a bad cell


SHEET = "sheet"  # the note that keeps the place in a file: `file.xlsx#Sheet`, `file.csv#D:F`
ENCODING = "encoding"  # the note that keeps the encoding of a file where its bytes leave it open
_PLACE_OF = re.compile(r"(.+\.(?:xlsx|xlsm|ods))#(.+)|(.+)#([A-Z]{1,3}:[A-Z]{1,3})", re.IGNORECASE)


def split_sheet(file: str) -> tuple[str, str]:
    """Part `book.xlsx#Specimen 1` into the file and the place in it, empty where none is named.

    A place is a sheet of a workbook (`#Data`), columns (`#D:F`), or both (`#Data!D:F`).
    """
    found = _PLACE_OF.fullmatch(file)
    if found is None:
        return file, ""
    return (found[1], found[2].strip()) if found[1] else (found[3], found[4].upper())


@dataclass(frozen=True, slots=True)
class RegisterForm:
    """Which register a technique reads, and what its rows are.

    Parameters
    ----------
    file : its name in the technique's folder; it may be a workbook of that name (`REGISTER_FILES`)
    text : text columns that every row must fill
    identity : columns (a text column, or a number by its SI name) whose cells name a row
    conditions : number by its SI name (`bed_temperature_K`) to the condition key that it gives
    whole : the rows hang together, so that one bad row spoils all of them
    notes : further text columns that the technique reads where they are there
    asked : columns beside the required ones that most files need: numbers by SI name, or texts
    """

    file: str = REGISTER_FILE
    text: tuple[str, ...] = ("specimen", "material")
    identity: tuple[str, ...] = ("specimen",)
    conditions: Mapping[str, str] = field(default_factory=dict)
    whole: bool = False
    notes: tuple[str, ...] = ()
    asked: tuple[str, ...] = ()


SPECIMENS = RegisterForm()


@dataclass(frozen=True, slots=True)
class Register:
    """What a register gave: good rows, and bad rows each with its error.

    A register whose rows hang together gives no good row as soon as there is a bad one.
    """

    specimens: tuple[Specimen, ...]
    errors: tuple[tuple[str | None, RawFileError], ...]  # (file the bad row names, why)
    left_out: tuple[Specimen, ...] = ()  # bad rows whose faults do not matter


def read_register(
    data: bytes,
    path: str,
    campaign: str,
    technique: str,
    required: Sequence[str],
    gauges: Mapping[str, Gauge],
    form: RegisterForm = SPECIMENS,
    spellings: Spellings | None = None,
    left_out: Collection[str] = (),
) -> Register:
    """Read a register's bytes into specimens.

    Parameters
    ----------
    path : relative to `raw/`: `<campaign>/<technique>/<form.file>`
    required : SI names of the columns that every row must fill (`diameter_m`)
    gauges : SI name without unit (`diameter`) to the gauge that read it
    form : what the technique declares of its register
    spellings : of the names in the registers read before
    left_out : ids of rows whose faults do not matter

    Raises
    ------
    RawFileError : the header itself is unusable (no `specimen` column, unknown unit, ...)
    """
    table = register_table(data, path, form)
    header = table.header
    if not header:
        raise RawFileError(path, "an empty register")
    columns = numeric_columns(header, path, required, form.text, form.notes)
    commas = table.separator != "," and decimal_comma(
        row[column.index].strip()
        for _, row in table.rows
        for column in columns.values()
        if len(row) > column.index
    )
    reader = _Rows(path, campaign, technique, header, columns, required, gauges, form, commas)
    spellings = Spellings() if spellings is None else spellings
    specimens: list[Specimen] = []
    errors: list[tuple[str | None, RawFileError]] = []
    faulty: list[Specimen] = []
    seen: dict[str, int] = {}
    for line, row in table.rows:
        try:
            specimen = reader.specimen(row, line)
            reader.spelt_once(specimen, seen, spellings)
        except RawFileError as error:
            named = reader.named(row, line)
            if named.id in left_out:
                faulty.append(named)
            else:
                errors.append((named.file, error))
            continue
        specimens.append(specimen)
    sound = () if form.whole and errors else tuple(specimens)
    return Register(sound, tuple(errors), tuple(faulty))


def register_table(data: bytes, path: str, form: RegisterForm) -> RegisterTable:
    """Read the table of a register of this form.

    Raises
    ------
    RawFileError : neither text nor a workbook, or no CSV, or several sheets with such a header
    """
    words = (*TEXT_COLUMNS, *CONDITION_COLUMNS, *form.notes)
    return read_table(data, path, form.text, words)


@dataclass
class _Rows:
    """Reads the rows under one header; what many rows have in common is read once.

    Parameters
    ----------
    decimal_comma : numbers have one
    quantities : by column and cells
    sound : names that passed, by column
    """

    path: str
    campaign: str
    technique: str
    header: Sequence[str]
    columns: Mapping[str, Column]
    required: Sequence[str]
    gauges: Mapping[str, Gauge]
    form: RegisterForm
    decimal_comma: bool = False
    quantities: dict[tuple[str, str, str], Quantity] = field(default_factory=dict)
    sound: set[tuple[str, str]] = field(default_factory=set)

    def __post_init__(self) -> None:
        """Find once which columns are numbers, make the id, and are notes."""
        self.numbers = {n: c for n, c in self.columns.items() if not n.startswith("u_")}
        self.twins = {n: self.columns.get(f"u_{n}") for n in self.numbers}
        written = {name: column.header for name, column in self.columns.items()}
        self.identity = [written.get(name, name) for name in self.form.identity]
        taken = {"specimen", "material", "file", "format", *CONDITION_COLUMNS, *written.values()}
        self.notes = [name for name in self.header if name not in taken]

    def specimen(self, row: list[str], line: int) -> Specimen:
        """Read one row.

        Raises
        ------
        RawFileError : a field too many or too few, a cell that is not what its column says
        """
        if len(row) != len(self.header):
            reason = f"{len(row)} fields where the header has {len(self.header)}"
            raise RawFileError(self.path, reason, line, len(row))
        cells = {name: cell.strip() for name, cell in zip(self.header, row, strict=True)}
        numbers: dict[str, Quantity] = {}
        for name, column in self.numbers.items():
            if cells[column.header]:
                numbers[name] = self._quantity(name, column, cells, line)
            elif name in self.required:
                raise RawFileError(self.path, "must not be empty", line, column.index + 1, "")
        self._check_names(cells, line)
        conditions: dict[str, Condition] = {k: cells[k] for k in CONDITION_COLUMNS if cells.get(k)}
        for name, key in self.form.conditions.items():
            if name in numbers:
                conditions[key] = numbers[name].value
        file, sheet = split_sheet(cells.get("file", ""))
        notes = {name: cells[name] for name in self.notes if cells[name]}
        if sheet:
            notes[SHEET] = sheet
        return Specimen(
            id=self._id(cells),
            material=cells["material"],
            campaign=self.campaign,
            technique=self.technique,
            file=self._below(file) if file else None,
            format=cells.get("format") or None,
            numbers=numbers,
            conditions=conditions,
            notes=notes,
            register=self.path,
            line=line,
        )

    def _check_names(self, cells: Mapping[str, str], line: int) -> None:
        for name in self.form.text:
            if not cells[name]:
                raise self._slip(name, cells, line, f"no {name}")
        for name in ("material", *CONDITION_COLUMNS):
            text = cells.get(name, "")
            if (name, text) in self.sound or not text:
                continue
            if name == "material":
                fault, near = slug_fault(text), nearest_slug(text)
            else:
                fault, near = label_fault(text), nearest_label(text)
            if fault:
                raise self._slip(name, cells, line, fault, near)
        if fault := _specimen_fault(cells.get("specimen", "")):
            near = nearest_label(re.sub(r"[/\\]", "-", cells["specimen"]), _LONGEST_SPECIMEN)
            raise self._slip("specimen", cells, line, fault, near.lstrip(".-"))
        for name in DATE_COLUMNS:
            if cells.get(name):
                try:
                    read_date(cells[name])
                except ValueError as error:
                    at = self.header.index(name) + 1
                    hint = "write it as 2022-01-31, or leave the cell empty"
                    raise RawFileError(
                        self.path, str(error), line, at, cells[name], hint
                    ) from error
        file = cells.get("file", "")
        if file.startswith("/") or ".." in file.split("/") or "\\" in file:
            raise self._slip(
                "file", cells, line, "a file is named relative to its register's folder"
            )

    def _slip(
        self, name: str, cells: Mapping[str, str], line: int, reason: str, near: str = ""
    ) -> RawFileError:
        value = cells[name] if len(cells[name]) <= _SHOWN else cells[name][:_SHOWN] + "..."
        hint = f"nearest valid: {near!r}" if near else ""
        return RawFileError(self.path, reason, line, self.header.index(name) + 1, value, hint)

    def spelt_once(self, specimen: Specimen, seen: dict[str, int], spellings: Spellings) -> None:
        """Refuse a row that is listed twice, and a name that differs from another only in its case.

        Parameters
        ----------
        seen : ids of the rows before, folded, to their lines
        """
        line = specimen.line
        first = seen.setdefault(specimen.id.casefold(), line)
        if first != line:
            reason = f"duplicate specimen: it is already in line {first}"
            raise RawFileError(self.path, reason, line, 1, specimen.id)
        for name in ("material", *CONDITION_COLUMNS):
            text = specimen.material if name == "material" else specimen.conditions.get(name)
            if not isinstance(text, str) or (name, text) in self.sound:
                continue
            kind = name if name == "material" else f"{self.campaign} {name}"
            if other := spellings.other(kind, text, f"{self.path}, line {line}"):
                hint = "write it as there: names that differ only in case or spaces are one name"
                at = self.header.index(name) + 1
                reason = f"{name} is spelled differently: {other}"
                raise RawFileError(self.path, reason, line, at, text, hint)
            self.sound.add((name, text))

    def named(self, row: list[str], line: int) -> Specimen:
        """What a bad row names, as far as it can be told, without a number or a condition."""
        cells = {name: cell.strip() for name, cell in zip(self.header, row, strict=False)}
        file, _ = split_sheet(cells.get("file", ""))
        return Specimen(
            self._id(cells), cells.get("material", ""), self.campaign, self.technique,
            self._below(file) if file else None, None, {}, {}, {}, self.path, line,
        )  # fmt: skip

    def _id(self, cells: Mapping[str, str]) -> str:
        return " ".join(cells[column] for column in self.identity if cells.get(column))

    def _below(self, file: str) -> str:
        return f"{self.path.rpartition('/')[0]}/{file}"

    def _quantity(self, name: str, column: Column, cells: Mapping[str, str], line: int) -> Quantity:
        cell, twin = cells[column.header], self.twins[name]
        u_cell = cells[twin.header] if twin else ""
        found = self.quantities.get((name, cell, u_cell))
        if found is not None:
            return found
        value = column.factor * self._number(cell, line, column) + column.offset
        needed = name in self.required
        # a time counts from an event, so zero is one; a length of zero is a slip
        if (value < 0 and (needed or column.positive)) or (
            value == 0 and (column.positive or (needed and column.unit != "s"))
        ):
            raise RawFileError(self.path, "must be positive", line, column.index + 1, cell)
        if column.unit == "m" and value != 0 and not _SHORTEST_m <= abs(value) <= _LONGEST_m:
            raise RawFileError(
                self.path, "no length of a specimen or a gauge", line, column.index + 1, cell,
                f"check the unit in the header, {column.header!r}",
            )  # fmt: skip
        if column.unit == "K" and value < 0:
            raise RawFileError(
                self.path, "a temperature below absolute zero", line, column.index + 1, cell,
                "leave the cell empty where it was not recorded",
            )  # fmt: skip
        limits = possible(name)
        if limits is not None and not limits[0] <= value <= limits[1]:
            reason = (
                f"{name} of {value:.4g} cannot be: it is between {limits[0]:g} and {limits[1]:g}"
            )
            hint = "check the unit and the decimal point"
            raise RawFileError(self.path, reason, line, column.index + 1, cell, hint)
        stem = name.rpartition("_")[0]
        of_length = Gauge() if column.unit == "m" else None
        gauge = self.gauges.get(stem, of_length)
        u_own = gauge.u_reading_m if gauge else 0.0
        if twin and u_cell:
            u_own = twin.factor * self._number(u_cell, line, twin)
            if u_own < 0:
                reason = "an uncertainty below zero"
                raise RawFileError(self.path, reason, line, twin.index + 1, u_cell)
        found = Quantity(
            *(value, column.unit, u_own, gauge.u_calibration_m if gauge else 0.0),
            calibration=gauge.calibration if gauge else None,
        )
        self.quantities[name, cell, u_cell] = found
        return found

    def _number(self, cell: str, line: int, column: Column) -> float:
        cell = cell.replace(",", ".", 1) if self.decimal_comma else cell
        if not is_number(cell):
            hint = "write it with a decimal point"
            raise RawFileError(self.path, "not a number", line, column.index + 1, cell, hint)
        value = float(cell)
        if not math.isfinite(value) or abs(column.factor * value) > _LARGEST:
            raise RawFileError(self.path, "too large for a number", line, column.index + 1, cell)
        if value != 0 and abs(column.factor * value) < _TINIEST:
            raise RawFileError(self.path, "too small for a number", line, column.index + 1, cell)
        return value


def _specimen_fault(text: str) -> str | None:
    """Say what keeps a text from naming a specimen; it may stand in addresses and exports."""
    if text.startswith(".") or "/" in text or "\\" in text:
        return "a specimen's name must not be a path"
    return label_fault(text, _LONGEST_SPECIMEN)
