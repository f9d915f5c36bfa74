"""Flow curves of several samples side by side, in a text table with `%` before its header.

Usage
-----
Named `schmid`; detected by `%ID` and `%Shear rate` at the start of header lines. Written for the
analogue materials of T. Schmid's doctoral thesis.

Format
------
`%ID` with one name above each pair of columns, further `%` lines (material, density), `%Shear
rate<TAB>Shear stress<TAB>Viscosity...` and its units, then rows with decimal points: one rate, and
stress and viscosity of every sample.

Columns
-------
`shear_rate_per_s [1/s]`, `shear_stress_Pa [Pa]`, `viscosity_Pas [Pa.s]`, `sample [1]` (index into
the samples), `line [1]` (of the file); the samples below each other.

Uncertainties
-------------
None in the file; three significant digits.

Metadata
--------
`samples`: the names in order; the other `%` lines under their first word.
"""

from __future__ import annotations

import numpy as np

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.core.units import UnknownUnit, si_factor
from deamat.formats.cells import Dialect
from deamat.formats.flow_samples import SEPARATOR, long_recording
from deamat.formats.format import Format
from deamat.formats.numbers import read_block
from deamat.formats.rawfile import RawFile

_NAME = "schmid"
_SI = ("1/s", "Pa", "Pa.s")


def _label_line(head: list[str]) -> int | None:
    found = [at for at, line in enumerate(head) if line.startswith("%Shear rate\t")]
    return found[0] if found and head[0].startswith("%ID\t") else None


def _recognises(head: list[str]) -> bool:
    return _label_line(head) is not None


def _read(file: RawFile) -> Recording:
    at = _label_line(file.head)
    if at is None or at + 1 >= len(file.head):
        raise RawFileError(
            file.path, "no `%ID` and `%Shear rate` lines", 1, value=file.head[0],
            hint="leave the register's `format` empty to have the form detected",
        )  # fmt: skip
    names = [cell.strip() for cell in file.head[0].split("\t")[1:] if cell.strip()]
    labels = file.head[at].lstrip("%").rstrip("\t").split("\t")
    if labels[1:] != ["Shear stress", "Viscosity"] * len(names) or len(set(names)) < len(names):
        raise RawFileError(
            file.path, f"{len(names)} different samples need as many pairs of columns", at + 1,
            value=file.head[at], hint="name every pair of columns once in the `%ID` line",
        )  # fmt: skip
    factors = _factors(file, at + 1, len(labels))
    table = read_block(file, at + 2, len(labels), Dialect("\t")) * factors
    rows = len(table)
    if not np.all(table[:, 0] > 0):
        raise RawFileError(file.path, "a shear rate that is not positive", at + 3, 1)
    columns = {
        "shear_rate_per_s": np.tile(table[:, 0], len(names)),
        "shear_stress_Pa": table[:, 1::2].T.ravel(),
        "viscosity_Pas": table[:, 2::2].T.ravel(),
    }
    lines = np.tile(np.arange(at + 3.0, at + 3.0 + rows), len(names))
    samples = [name for name in names for _ in range(rows)]
    units = {"Shear stress": file.head[at + 1].split("\t")[1], "Shear rate": file.head[at + 1][1:5]}
    return long_recording(file, columns, samples, lines, _NAME, _notes(file.head[1:at]), units)


def _factors(file: RawFile, at: int, columns: int) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Factors to SI of every column, from the line of units."""
    units = file.head[at].lstrip("%").rstrip("\t").split("\t")
    if len(units) != columns:
        raise RawFileError(file.path, f"{len(units)} units for {columns} columns", at + 1)
    factors = []
    for column, unit in enumerate(units):
        wanted = _SI[0] if column == 0 else _SI[2 - column % 2]
        try:
            found, factor, _ = si_factor(unit)
        except UnknownUnit as error:
            raise RawFileError(file.path, str(error), at + 1, column + 1, unit) from error
        if found != wanted:
            raise RawFileError(
                file.path, f"a unit that does not stand for {wanted}", at + 1, column + 1, unit
            )
        factors.append(factor)
    return np.array(factors)


def _notes(lines: list[str]) -> dict[str, str]:
    kept = {}
    for line in lines:
        key, *cells = line.lstrip("%").split("\t")
        if key.strip():
            kept[key.strip()] = SEPARATOR.join(cell for cell in cells if cell.strip())
    return kept


FORMAT = Format(
    _NAME,
    "flow curves side by side, % header",
    _recognises,
    _read,
    "\t",
    tabular=True,
    looks="names of the samples above, rate and stress or viscosity for each",
    seen="TimothySchmid/Additional_data_PhD_thesis",
)
