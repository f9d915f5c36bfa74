"""Traces of Keysight (Agilent) E4990A and E4991 impedance analysers, saved as CSV.

Usage
-----
Named `e4990a`; detected by a first line `!Agilent` or `!Keysight` and a line `BEGIN CH1_DATA`.

Format
------
Lines that start with `!`, `BEGIN CH1_DATA`, labels with their unit and the word data
(`Frequency(Hz), R(Ohm)-data, X(Ohm)-data`), rows of decimal-point numbers with signs and
exponents, `END`. A file without its `END` is cut. One channel to a file.

Columns
-------
`frequency_Hz [Hz]` and the pair that was traced, by the names of a plain sweep.

Uncertainties
-------------
None in the file.

Metadata
--------
Every line above the labels.
"""

from __future__ import annotations

from deamat.core.errors import RawFileError
from deamat.core.records import Recording
from deamat.formats.format import Format
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.rewritten import CUT, lines_of, read_rewritten

_NAME = "e4990a"
_MAKERS = ("!agilent", "!keysight")


def _recognises(head: Head) -> bool:
    return bool(head) and head[0].casefold().startswith(_MAKERS) and any(
        line.startswith("BEGIN") for line in head
    )  # fmt: skip


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


FORMAT = Format(_NAME, "Keysight E4990A trace", _recognises, _read, ",", ("permittivity",))
