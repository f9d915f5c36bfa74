"""Traces of Keysight (Agilent) E4990A and E4991 impedance analysers, saved as CSV.

Usage
-----
Named `e4990a`; detected by a line `!Agilent` or `!Keysight` at the top, perhaps below `!CSV`, and a
line `BEGIN CH1_DATA`.

Format
------
Lines that start with `!`, `BEGIN CH1_DATA`, labels with their unit and the word data
(`Frequency(Hz), R(Ohm)-data, X(Ohm)-data`), rows of decimal-point numbers with signs and
exponents, `END`. A file without its `END` is cut. One channel to a file.

Columns
-------
`frequency_Hz [Hz]`, `series_resistance_ohm [ohm]`, `reactance_ohm [ohm]`; another pair that was
traced has the names of a plain table.

Uncertainties
-------------
None in the file.

Metadata
--------
Every line above the labels.
"""

from __future__ import annotations

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.format import Format
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.rewritten import CUT, lines_of, read_rewritten

_NAME = "e4990a"
_MAKERS = ("!agilent", "!keysight")
_TOP = 4  # lines


def _recognises(head: Head) -> bool:
    made = any(line.casefold().startswith(_MAKERS) for line in head[:_TOP])
    return made and any(line.startswith("BEGIN") for line in head)


def _read(file: RawFile) -> Recording:
    lines = lines_of(file)
    begins = [at for at, line in enumerate(lines) if line.startswith("BEGIN")]
    ends = [at for at, line in enumerate(lines) if line.strip() == "END"]
    if len(begins) != 1:
        raise RawFileError(
            file.path, f"{len(begins)} channels where one belongs", value=lines[0],
            hint="save one channel to a file",
        )  # fmt: skip
    if not ends:
        raise RawFileError(file.path, f"no line END; {CUT}", len(lines), hint="save it again")
    for at in (begins[0], ends[0]):
        lines[at] = ""
    if begins[0] + 1 < len(lines):
        lines[begins[0] + 1] = lines[begins[0] + 1].replace("-data", "")
    return read_rewritten(file, lines, _NAME)


FORMAT = Format(
    _NAME,
    "Keysight E4990A trace",
    _recognises,
    _read,
    ",",
    ("permittivity",),
    looks="`!Agilent`, `BEGIN CH1_DATA`, `R(Ohm)-data`, `END`",
    seen="its `!`, `BEGIN`, `END` frame: public scripts that read Keysight analysers",
)
