"""Registers with slips of the hand; the first row is the one that goes wrong."""

from __future__ import annotations

from dataclasses import replace

from numpy.random import Generator

from benchmarks.fuzz.sheet import Register
from deamat.core.register_columns import split_unit

_OTHER_UNITS = {
    "mm": ("um", "cm", "m", "in"), "um": ("mm", "nm"), "mm2": ("cm2",), "mm_per_min": ("mm_per_s",),
    "N": ("kN", "mN"), "uN": ("mN",), "kV": ("V",), "h": ("s", "min"), "C": ("K",), "g": ("kg",),
    "V_per_s": ("kV_per_s",),
}  # fmt: skip
_TEXTS = ("", "", "n/a", "?", "12,5", "1 000", "-", "ca. 12", "0", "nan", "1e99")
_FACTORS = (2.0, 0.5, 10.0, 0.1, 1000.0, 0.001, 25.4, -1.0)


def _number(register: Register, rng: Generator) -> int:
    return int(rng.choice(register.numeric()))


def bad_cell(register: Register, rng: Generator) -> Register:
    """Leave a number out, or write something else."""
    return register.with_cell(0, _number(register, rng), str(rng.choice(_TEXTS)))


def no_text(register: Register, rng: Generator) -> Register:
    """Leave any cell of the row empty."""
    return register.with_cell(0, int(rng.integers(len(register.header))), "")


def other_unit(register: Register, rng: Generator) -> Register:
    """Write a number in another unit, as its radius, or with another sign."""
    at = _number(register, rng)
    value = float(register.rows[0][at]) * float(rng.choice(_FACTORS))
    return register.with_cell(0, at, f"{value:.6g}")


def digits_moved(register: Register, rng: Generator) -> Register:
    """Exchange two digits that stand side by side."""
    at = _number(register, rng)
    cell = register.rows[0][at]
    places = [
        i for i in range(len(cell) - 1)
        if cell[i].isdigit() and cell[i + 1].isdigit() and cell[i] != cell[i + 1]
    ]  # fmt: skip
    if not places:
        return register
    i = int(rng.choice(places))
    return register.with_cell(0, at, cell[:i] + cell[i + 1] + cell[i] + cell[i + 2 :])


def unit_in_header(register: Register, rng: Generator) -> Register:
    """Name another unit over the numbers as they are."""
    places = [i for i, name in enumerate(register.header) if split_unit(name)[1] in _OTHER_UNITS]
    if not places:
        return register
    at = int(rng.choice(places))
    stem, unit = split_unit(register.header[at])
    return register.with_label(at, f"{stem}_{rng.choice(_OTHER_UNITS[str(unit)])}")


def numbers_swapped(register: Register, rng: Generator) -> Register:
    """Exchange two numbers of the row."""
    places = register.numeric()
    if len(places) < 2:
        return register
    a, b = rng.choice(places, 2, replace=False).tolist()
    first = register.rows[0][a], register.rows[0][b]
    return register.with_cell(0, a, first[1]).with_cell(0, b, first[0])


def labels_swapped(register: Register, rng: Generator) -> Register:
    """Exchange two column names."""
    a, b = rng.choice(len(register.header), 2, replace=False).tolist()
    names = register.header
    return register.with_label(a, names[b]).with_label(b, names[a])


def misspelt_column(register: Register, rng: Generator) -> Register:
    """Spell a column name in another way."""
    at = int(rng.integers(len(register.header)))
    name = register.header[at]
    cut = int(rng.integers(len(name)))
    spellings = [
        name[:cut] + name[cut + 1 :], name.upper(), name.capitalize(), name.replace("_", " "),
        split_unit(name)[0], f"{name} ", name.replace("_", ""),
    ]  # fmt: skip
    return register.with_label(at, str(rng.choice(spellings)))


def no_column(register: Register, rng: Generator) -> Register:
    """Leave a column out."""
    at = int(rng.integers(len(register.header)))
    rows = tuple((*row[:at], *row[at + 1 :]) for row in register.rows)
    return Register((*register.header[:at], *register.header[at + 1 :]), rows)


def doubled_row(register: Register, rng: Generator) -> Register:
    """List a row twice, as it is or under another name."""
    row = register.rows[0]
    if rng.random() < 0.5:
        row = (row[0] + "-again", *row[1:])
    return replace(register, rows=(*register.rows, row))


def no_row(register: Register, _: Generator) -> Register:
    """Forget the row."""
    return replace(register, rows=register.rows[1:])


def field_too_many(register: Register, rng: Generator) -> Register:
    """Write a field too many or too few."""
    row = register.rows[0]
    at = int(rng.integers(len(row)))
    row = (*row[:at], *row[at + 1 :]) if rng.random() < 0.5 else (*row[:at], "", *row[at:])
    return replace(register, rows=(row, *register.rows[1:]))


def other_file(register: Register, rng: Generator) -> Register:
    """Name another file: one that is not there, a sibling's, one in another case."""
    if "file" not in register.header:
        return register
    at = register.at("file")
    mine = register.rows[0][at]
    others = [row[at] for row in register.rows[1:]]
    names = ["nothing.csv", mine.upper(), f"./{mine}", mine.rpartition("/")[2], *others[:2]]
    return register.with_cell(0, at, str(rng.choice(names)))


def files_exchanged(register: Register, _: Generator) -> Register:
    """Exchange the files of two specimens."""
    if "file" not in register.header or len(register.rows) < 2:
        return register
    at = register.at("file")
    mine, other = register.rows[0][at], register.rows[1][at]
    return register.with_cell(0, at, other).with_cell(1, at, mine)


def numbers_of_two_rows(register: Register, rng: Generator) -> Register:
    """Exchange a number between two specimens."""
    if len(register.rows) < 2:
        return register
    at = _number(register, rng)
    mine, other = register.rows[0][at], register.rows[1][at]
    return register.with_cell(0, at, other).with_cell(1, at, mine)


def near_name(register: Register, rng: Generator) -> Register:
    """Name a material nearly as it is called."""
    at = register.at("material")
    name = register.rows[0][at]
    names = [name.upper(), name.replace("-", "_"), f"{name}x", name[:-1], name.replace("-", " ")]
    return register.with_cell(0, at, str(rng.choice(names)))


REGISTER = (
    bad_cell, no_text, other_unit, digits_moved, unit_in_header, numbers_swapped, labels_swapped,
    misspelt_column, no_column, doubled_row, no_row, field_too_many, other_file, files_exchanged,
    numbers_of_two_rows, near_name,
)  # fmt: skip
