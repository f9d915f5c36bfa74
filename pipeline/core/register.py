"""Registers: `specimens.csv`, one row per specimen, units in the header.

A technique whose register holds one row per observation declares another `RegisterForm`.

A column whose name ends in a known unit is a number (`diameter_mm` becomes `diameter_m`), and its
`u_` twin is its standard uncertainty; the closed list of text columns is kept as text; any other
column is a note. A column that starts like a quantity but ends in no known unit is an error.
"""

from __future__ import annotations

import csv
import difflib
import io
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from deamat.core.errors import RawFileError
from deamat.core.instruments import Gauge
from deamat.core.quantity import Quantity
from deamat.core.records import Condition, Specimen
from deamat.core.units import UNITS, known, si_factor

REGISTER_FILE = "specimens.csv"
REGISTER_FILES = (REGISTER_FILE, "observations.csv")

_CONDITIONS = ("age", "cure", "electrode")
# Stems that always carry a unit: `diameter_furlong` is a slip, `curing_temperature` a note.
_STEMS = (
    "diameter", "height", "width", "thickness", "gauge_length", "speed", "temperature", "humidity",
    "micrometer_force", "anvil_diameter", "plate_length", "plate_width", "electrode_area", "rate",
    "breakdown_voltage", "breakdown_field", "tip_radius", "peak_load", "bed_temperature",
    "time",
)  # fmt: skip
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


@dataclass(frozen=True, slots=True)
class RegisterForm:
    """Which register a technique reads, and what its rows are.

    Parameters
    ----------
    file : its name in the technique's folder, one of `REGISTER_FILES`
    text : text columns that every row must fill
    identity : columns (a text column, or a number by its SI name) whose cells name a row
    conditions : number by its SI name (`bed_temperature_K`) to the condition key that it gives
    whole : the rows hang together, so that one bad row spoils all of them
    """

    file: str = REGISTER_FILE
    text: tuple[str, ...] = ("specimen", "material")
    identity: tuple[str, ...] = ("specimen",)
    conditions: Mapping[str, str] = field(default_factory=dict)
    whole: bool = False


SPECIMENS = RegisterForm()


@dataclass(frozen=True, slots=True)
class _Column:
    """A numeric column: where it stands, its SI name, and how to convert it."""

    index: int
    header: str
    name: str
    unit: str
    factor: float
    offset: float


@dataclass(frozen=True, slots=True)
class Register:
    """What a register gave: good rows, and bad rows each with its error."""

    specimens: tuple[Specimen, ...]
    errors: tuple[tuple[str | None, RawFileError], ...]  # (file the bad row names, why)


def read_register(
    data: bytes,
    path: str,
    campaign: str,
    technique: str,
    required: Sequence[str],
    gauges: Mapping[str, Gauge],
    form: RegisterForm = SPECIMENS,
) -> Register:
    """Read a register's bytes into specimens.

    Parameters
    ----------
    path : relative to `raw/`: `<campaign>/<technique>/<form.file>`
    required : SI names of the columns that every row must fill (`diameter_m`)
    gauges : SI name without unit (`diameter`) to the gauge that read it
    form : what the technique declares of its register

    Raises
    ------
    RawFileError : the header itself is unusable (no `specimen` column, unknown unit, ...), or a
        row is bad in a register whose rows hang together
    """
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise RawFileError(path, "a register must be UTF-8", mend="save it as UTF-8 CSV") from error
    rows = csv.reader(io.StringIO(text, newline=""))
    header = [h.strip() for h in next(rows, [])]
    if not header:
        raise RawFileError(path, "an empty register")
    columns = _columns(header, path, required, form)
    specimens: list[Specimen] = []
    errors: list[tuple[str | None, RawFileError]] = []
    seen: dict[str, int] = {}
    for row in rows:
        line = rows.line_num
        if not any(cell.strip() for cell in row):
            continue
        try:
            specimen = _specimen(
                row, line, header, columns, path, campaign, technique, required, gauges, form
            )
            if specimen.id in seen:
                reason = f"the specimen stands in line {seen[specimen.id]} already"
                raise RawFileError(path, reason, line, 1, specimen.id)
        except RawFileError as error:
            if form.whole:
                raise
            errors.append((_named_file(row, header, path), error))
            continue
        seen[specimen.id] = line
        specimens.append(specimen)
    return Register(tuple(specimens), tuple(errors))


def _columns(
    header: list[str], path: str, required: Sequence[str], form: RegisterForm
) -> dict[str, _Column]:
    for name in form.text:
        if name not in header:
            mend = f"every row of this register says {' and '.join(form.text)}"
            raise RawFileError(path, f"no column {name!r}", line=1, mend=mend)
    for name in header:
        if header.count(name) > 1:
            raise RawFileError(path, "a column stands twice", 1, header.index(name) + 1, name)
    columns: dict[str, _Column] = {}
    for i, label in enumerate(header):
        stem, unit = split_unit(label)
        base = stem.removeprefix("u_")
        if unit is None:
            if any(base == s or base.startswith(s + "_") for s in _STEMS):
                near = difflib.get_close_matches(base.rpartition("_")[2], UNITS, n=3)
                raise RawFileError(
                    path, "a quantity without a known unit in its column name", 1, i + 1, label,
                    f"known units near it: {', '.join(near) or 'see docs/formats.md'}",
                )  # fmt: skip
            continue
        si, factor, offset = si_factor(unit)
        name = si_name(stem, si)
        if name in columns:
            raise RawFileError(path, f"{name} is given twice", 1, i + 1, label)
        columns[name] = _Column(i, label, name, si, factor, offset)
    for name in required:
        if name not in columns:
            stem = name.rpartition("_")[0]
            raise RawFileError(path, f"no column for {stem}", 1, mend=f"add {stem}_<unit>")
    for name in columns:
        if name.startswith("u_") and name[2:] not in columns:
            raise RawFileError(
                path, "an uncertainty without its column", 1, columns[name].index + 1, name
            )
    return columns


def split_unit(label: str) -> tuple[str, str | None]:
    """Split `speed_mm_per_min` into `speed` and `mm_per_min`; None without a known unit."""
    parts = label.split("_")
    for i in range(1, len(parts)):
        unit = "_".join(parts[i:])
        if known(unit):  # either mu
            return "_".join(parts[:i]), unit
    return label, None


def si_name(stem: str, si_unit: str) -> str:
    """Name a column with its SI unit: `speed` in m/s is `speed_m_per_s`, a pure number is bare."""
    return stem if si_unit == "1" else f"{stem}_{si_unit.replace('/', '_per_').replace('.', '')}"


def _specimen(
    row: list[str],
    line: int,
    header: list[str],
    columns: Mapping[str, _Column],
    path: str,
    campaign: str,
    technique: str,
    required: Sequence[str],
    gauges: Mapping[str, Gauge],
    form: RegisterForm,
) -> Specimen:
    if len(row) != len(header):
        raise RawFileError(
            path, f"{len(row)} fields where the header has {len(header)}", line, len(row)
        )
    cells = {name: cell.strip() for name, cell in zip(header, row, strict=True)}
    numbers: dict[str, Quantity] = {}
    for name, column in columns.items():
        if name.startswith("u_"):
            continue
        cell = cells[column.header]
        if not cell:
            if name in required:
                raise RawFileError(path, "must not be empty", line, column.index + 1, "")
            continue
        value = column.factor * _number(cell, path, line, column) + column.offset
        # a time counts from an event, so zero is one; a length of zero is a slip
        if name in required and (value < 0 or (value == 0 and column.unit != "s")):
            raise RawFileError(path, "must be positive", line, column.index + 1, cell)
        if column.unit == "K" and value < 0:
            raise RawFileError(
                path, "a temperature below absolute zero", line, column.index + 1, cell,
                "leave the cell empty where it was not recorded",
            )  # fmt: skip
        numbers[name] = _with_uncertainty(name, value, column, columns, cells, path, line, gauges)
    numeric = {c.header for c in columns.values()}
    taken = numeric | {"specimen", "material", "file", "format", *_CONDITIONS}
    for name in form.text:
        if not cells[name]:
            raise RawFileError(path, f"no {name}", line, header.index(name) + 1, "")
    folder = path.rpartition("/")[0]
    file = cells.get("file") or None
    if file and (file.startswith("/") or ".." in file.split("/") or "\\" in file):
        raise RawFileError(
            path, "a file is named relative to its register's folder", line,
            header.index("file") + 1, file,
        )  # fmt: skip
    conditions: dict[str, Condition] = {k: cells[k] for k in _CONDITIONS if cells.get(k)}
    conditions |= {key: numbers[k].value for k, key in form.conditions.items() if k in numbers}
    written = {name: column.header for name, column in columns.items()}
    named = [written.get(name, name) for name in form.identity]
    return Specimen(
        id=" ".join(cells[column] for column in named if cells.get(column)),
        material=cells["material"],
        campaign=campaign,
        technique=technique,
        file=f"{folder}/{file}" if file else None,
        format=cells.get("format") or None,
        numbers=numbers,
        conditions=conditions,
        notes={k: v for k, v in cells.items() if v and k not in taken},
        register=path,
        line=line,
    )


def _number(cell: str, path: str, line: int, column: _Column) -> float:
    if not _NUMBER.fullmatch(cell):
        raise RawFileError(
            path, "not a number", line, column.index + 1, cell, "write it with a decimal point"
        )
    value = float(cell)
    if not math.isfinite(value):
        raise RawFileError(path, "too large for a number", line, column.index + 1, cell)
    return value


def _with_uncertainty(
    name: str,
    value: float,
    column: _Column,
    columns: Mapping[str, _Column],
    cells: Mapping[str, str],
    path: str,
    line: int,
    gauges: Mapping[str, Gauge],
) -> Quantity:
    stem = name.rpartition("_")[0]
    gauge = gauges[stem] if stem in gauges else Gauge() if column.unit == "m" else None
    u_own = gauge.u_reading_m if gauge else 0.0
    twin = columns.get(f"u_{name}")
    if twin and cells[twin.header]:
        u_own = twin.factor * _number(cells[twin.header], path, line, twin)
        if u_own < 0:
            raise RawFileError(
                path, "an uncertainty below zero", line, twin.index + 1, cells[twin.header]
            )
    return Quantity(value, column.unit, u_own, gauge.u_calibration_m if gauge else 0.0)


def _named_file(row: list[str], header: list[str], path: str) -> str | None:
    """The file that a bad row names, as far as it can be told."""
    if "file" not in header or len(row) <= header.index("file"):
        return None
    file = row[header.index("file")].strip()
    return f"{path.rpartition('/')[0]}/{file}" if file else None
