"""The header of a register: which columns are numbers, words or notes, and near misses of them.

A column that is nearly a known one (`Age`, `bed_temperatureC`, `temprature_C`) would be kept as a
note, and what it says would be ignored; so it is an error that names the column that was meant.
"""

from __future__ import annotations

import difflib
import re
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from deamat.core.errors import RawFileError
from deamat.core.unit_spellings import unit_as_written
from deamat.core.units import UNITS, UnknownUnit, known, si_factor

CONDITION_COLUMNS = ("age", "cure", "electrode")
# Text columns of any technique that something reads.
TEXT_COLUMNS = (
    *("specimen", "material", "file", "format", "encoding", "instrument", "operator"),
    *("cured_on", "tested_on"),
)

# How each number is usually written. The stem of the first ones always carries a unit:
# `diameter_furlong` and a bare `diameter` are slips. `mass_flow` may be a note.
_USUAL = (
    "diameter_mm", "height_mm", "width_mm", "thickness_um", "gauge_length_mm", "speed_mm_per_min",
    "temperature_C", "humidity_percent", "micrometer_force_N", "anvil_diameter_mm",
    "plate_length_mm", "plate_width_mm", "electrode_area_mm2", "rate_V_per_s",
    "breakdown_voltage_kV", "breakdown_field_V_per_um", "tip_radius_um", "peak_load_uN",
    "bed_temperature_C", "time_h",
)  # fmt: skip
_USUAL_BESIDE = ("mass_g",)
_ALSO = {"speed": ("rpm",), "rate": ("1/s",)}  # SI units beside that of the usual column
_NOTES_ONE_LETTER_AWAY = frozenset({"film", "curve", "core"})
_BRACKETED = re.compile(r"(.*?)\s*(?:\[([^\[\]]+)\]|\(([^()]+)\)|\s/\s*(\S+))")
_AGE_IN_NUMBERS = re.compile(r"age_(h|d|w|y|hours?|days?|weeks?|months?|years?)")


@dataclass(frozen=True, slots=True)
class Column:
    """A numeric column: where it stands, its SI name, and how to convert it."""

    index: int
    header: str
    name: str
    unit: str
    factor: float
    offset: float

    @property
    def positive(self) -> bool:
        """Say whether a zero is a slip: a length, an area or a mass of a known name."""
        return self.unit in ("m", "m2", "kg") and self.name.rpartition("_")[0] in _STEMS


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


def _stem_units(usual: str) -> tuple[str, tuple[str, ...]]:
    stem, unit = split_unit(usual)
    return stem, (si_factor(unit or "1")[0], *_ALSO.get(stem, ()))


_STEMS = dict(map(_stem_units, (*_USUAL, *_USUAL_BESIDE)))
_USUAL_OF = {split_unit(usual)[0]: usual for usual in (*_USUAL, *_USUAL_BESIDE)}
_USUAL_BY_NAME = {si_name(stem, units[0]): _USUAL_OF[stem] for stem, units in _STEMS.items()}
_ALWAYS_WITH_UNIT = tuple(split_unit(usual)[0] for usual in _USUAL)


def usual_column(name: str) -> str:
    """Return how a register usually heads a number: `diameter_mm` for `diameter_m`."""
    return _USUAL_BY_NAME.get(name, name)


def columns_of(name: str) -> tuple[str, ...]:
    """Return every way to write the column of an SI name, a unit each, the usual one first."""
    if name not in _USUAL_BY_NAME:
        return (name,)
    usual = usual_column(name)
    stem, _ = split_unit(usual)
    others = (
        f"{stem}_{unit}"
        for unit, (si, _, _) in UNITS.items()
        if si == _STEMS[stem][0] and unit != "m" and unit.replace("_", "").isalnum()
    )
    return tuple(dict.fromkeys((usual, *others)))


def numeric_columns(
    header: Sequence[str],
    path: str,
    required: Sequence[str],
    text: Sequence[str],
    notes: Iterable[str],
) -> dict[str, Column]:
    """Find the numeric columns of a register, by SI name.

    Parameters
    ----------
    header : names of the columns, stripped
    path : of the register, for messages
    required : SI names of the columns that every row must fill
    text : text columns that every row must fill
    notes : text columns that the technique reads where they are there

    Raises
    ------
    RawFileError : a duplicate column, a column that must be there and is not, a quantity without a
        known unit, an uncertainty without its column, a near miss of a known column
    """
    first: dict[str, int] = {}
    for at, label in enumerate(header, start=1):
        if first.setdefault(label, at) != at:
            reason = f"duplicate column: column {first[label]} has the same name"
            raise RawFileError(path, reason, 1, at, label)
    words = dict.fromkeys((*text, *TEXT_COLUMNS, *CONDITION_COLUMNS, *notes))
    columns: dict[str, Column] = {}
    for at, label in enumerate(header):
        if label in words:
            continue
        column = _number(at, label, path, words)
        if column is None:
            continue
        if column.name in columns:
            other = columns[column.name].index + 1
            reason = f"duplicate column: column {other} is the same quantity"
            raise RawFileError(path, reason, 1, at + 1, label)
        columns[column.name] = column
    _complete(header, columns, path, required, text)
    return columns


def _number(at: int, label: str, path: str, words: Iterable[str]) -> Column | None:
    """Read one label as a numeric column; None if it is a note."""
    stem, unit = _bracketed(label) or split_unit(label)
    units = _STEMS.get(stem.removeprefix("u_"))
    if unit is not None and units is not None:
        _fits(at, label, stem, unit, units, path)
    elif (meant := _meant(label, words)) is not None:
        raise RawFileError(
            path, "not a known column, but nearly one", 1, at + 1, label,
            f"write {meant}, or name a note so that it cannot be taken for it",
        )  # fmt: skip
    if unit is None:
        _carries_unit(at, label, path)
        return None
    si, factor, offset = si_factor(unit)
    return Column(at, label, si_name(stem, si), si, factor, offset)


def _bracketed(label: str) -> tuple[str, str] | None:
    """Split `Diameter [mm]`, `Gauge length (mm)` or `Speed / mm/min`; None for other labels."""
    found = _BRACKETED.fullmatch(label)
    if found is None:
        return None
    stem = re.sub(r"[\s_-]+", "_", found[1].strip()).casefold()
    if stem.removeprefix("u_") not in _STEMS:
        return None
    try:
        unit = unit_as_written(next(part for part in found.groups()[1:] if part))
    except UnknownUnit:
        return None
    return None if unit is None else (stem, unit)


def _fits(at: int, label: str, stem: str, unit: str, units: Sequence[str], path: str) -> None:
    """Refuse a unit of something else, and metres: nobody measures a specimen in them."""
    base = stem.removeprefix("u_")
    usual = stem[: len(stem) - len(base)] + _USUAL_OF[base]
    if si_factor(unit)[0] not in units:
        reason = f"{unit} is not a unit of {base}"
    elif unit == "m":
        reason = "a specimen measured in metres"
    else:
        return
    raise RawFileError(path, reason, 1, at + 1, label, f"write {usual}")


def _carries_unit(at: int, label: str, path: str) -> None:
    base = re.sub(r"\s*[\[(]", "_", label.casefold()).removeprefix("u_")
    for stem in _ALWAYS_WITH_UNIT:
        if base == stem or base.startswith(stem + "_"):
            near = difflib.get_close_matches(base.rpartition("_")[2], UNITS, n=3)
            hint = f"write {_USUAL_OF[stem]}"
            hint += f"; known units near it: {', '.join(near)}" if near else ""
            reason = "a quantity without a known unit in its column name"
            raise RawFileError(path, reason, 1, at + 1, label, hint)


def _complete(
    header: Sequence[str],
    columns: Mapping[str, Column],
    path: str,
    required: Sequence[str],
    text: Sequence[str],
) -> None:
    for name in text:
        if name not in header:
            hint = f"every row of this register says {' and '.join(text)}"
            raise RawFileError(path, f"no column {name!r}", 1, None, None, hint)
    for name in required:
        if name not in columns:
            stem = name.rpartition("_")[0]
            usual = _USUAL_OF.get(stem, f"{stem}_<unit>")
            raise RawFileError(path, f"no column for {stem}", 1, None, None, f"add {usual}")
    for name, column in columns.items():
        if name.startswith("u_") and name[2:] not in columns:
            raise RawFileError(
                path, "an uncertainty without its column", 1, column.index + 1, column.header
            )


def _meant(label: str, words: Iterable[str]) -> str | None:
    """Name the known column that a label nearly is; None for a note or another number."""
    plain = re.sub(r"[\s()\[\]._-]+", "_", unicodedata.normalize("NFKC", label)).strip("_")
    folded = plain.casefold()
    if folded in _NOTES_ONE_LETTER_AWAY:
        return None
    for word in words:
        if folded == word or _near(folded, word):
            return word
    if _AGE_IN_NUMBERS.fullmatch(folded) or split_unit(folded)[0] in CONDITION_COLUMNS:
        return f"{folded.partition('_')[0]} with the unit in each cell (2 months, 2 h at 90 C)"
    u = "u_" if folded.startswith("u_") else ""
    plain, folded = plain[len(u) :], folded[len(u) :]
    for stem in sorted(_STEMS, key=len, reverse=True):
        if folded.startswith(stem):
            unit = _unit_like(plain[len(stem) :].removeprefix("_"), _STEMS[stem])
            if unit is not None:
                return f"{u}{stem}_{unit}"
    stem, found = split_unit(plain)
    for known_stem, units in _STEMS.items():
        if found is None and len(known_stem) >= _LONG and _near(folded, known_stem):
            return u + _USUAL_OF[known_stem]
        if (
            found is not None
            and si_factor(found)[0] in units
            and _near(stem.casefold(), known_stem)
        ):
            return f"{u}{known_stem}_{found}"
    return None


def _unit_like(text: str, units: Sequence[str]) -> str | None:
    """Find a unit of these quantities in a text whose letters may have the wrong case."""
    if known(text) and si_factor(text)[0] in units:
        return text
    for unit, (si, _, _) in UNITS.items():
        if si in units and unit.casefold() == text.casefold():
            return unit
    return None


_LONG = 8  # letters from which a name may differ in two of them


def _near(label: str, name: str) -> bool:
    """Say whether a label is a known name with a letter wrong, missing, too many or swapped."""
    if label == name or abs(len(label) - len(name)) > 2:
        return False
    allowed = 2 if len(name) >= _LONG and "_" not in name else 1
    if len(name) < 5 and label[:1] != name[:1]:  # `page` is not `age`
        return False
    return _distance(label, name) <= allowed


def _distance(a: str, b: str) -> int:
    """Count the letters to change, add, drop or swap with their neighbour (Damerau)."""
    before: list[int] = []
    last = list(range(len(b) + 1))
    for i, x in enumerate(a, start=1):
        row = [i]
        for j, y in enumerate(b, start=1):
            cost = min(last[j] + 1, row[j - 1] + 1, last[j - 1] + (x != y))
            if i > 1 and j > 1 and x == b[j - 2] and a[i - 2] == y:
                cost = min(cost, before[j - 2] + 1)
            row.append(cost)
        before, last = last, row
    return last[-1]
