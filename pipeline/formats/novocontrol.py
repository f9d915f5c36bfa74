"""Text of Novocontrol's WinDETA: permittivities that the spectrometer's software computed.

Usage
-----
Named `novocontrol`; detected by a line that starts with `Diameter[mm]` and holds `Thickness[mm]`,
above a row of labels that starts with `Freq. [Hz]`. A text without that line is a plain table.

Format
------
`name, day, time`; `Diameter[mm] 4.0e+01  Thickness[mm] 1.0e+00  Spacer Capacity[pF] ...`, perhaps
with `Edge Correction On`; `Fixed value(s) :  AC Volt  [Vrms]=1.0e+00`; labels parted by tabs
(`Freq. [Hz]`, `Eps'`, `Eps''`, `Sig' [S/cm]`, `Tan(Delta)`, `Modulus'`, `Cp' [F]`), rows of
decimal-point numbers. A set point of the temperature is a column; the sweeps follow one another.

Columns
-------
`frequency_Hz [Hz]` and a pair: `relative_permittivity [1]` with `relative_loss_index [1]`,
`loss_tangent [1]` or `conductivity_S_per_m [S/m]`; `electric_modulus [1]` with
`electric_modulus_loss [1]`; or a pair of a plain sweep (`Cp' [F]` with `Tan(Delta)`).

Uncertainties
-------------
None in the file.

Metadata
--------
`Sample`, `Date`, `level_V`; `cell_diameter_m` and `cell_thickness_m`, with which the software
computed, and `edge_field` = `corrected` where it says so; every pair of the cell's line.
"""

from __future__ import annotations

import re
from dataclasses import replace

from deamat.core.errors import RawFileError
from deamat.core.number_grammar import NUMBER
from deamat.core.recording import Recording
from deamat.core.units import to_si
from deamat.formats.format import Format
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.rewritten import lines_of, read_rewritten

_NAME = "novocontrol"
_CELL, _TABLE = "diameter[mm]", "freq."
_PAIR = re.compile(rf"([A-Za-z][A-Za-z ]*?)\s*\[([^\]]+)\]\s+({NUMBER.pattern})")
_LEVEL = re.compile(rf"AC Volt\s*\[Vrms\]\s*=\s*({NUMBER.pattern})")
_LENGTHS = {"Diameter": "cell_diameter_m", "Thickness": "cell_thickness_m"}


def _is_cell(line: str) -> bool:
    plain = line.strip().casefold()
    return plain.startswith(_CELL) and "thickness[mm]" in plain


def _recognises(head: Head) -> bool:
    return any(map(_is_cell, head)) and any(
        line.strip().casefold().startswith(_TABLE) for line in head
    )


def _read(file: RawFile) -> Recording:
    lines = lines_of(file)
    at = next((number for number, line in enumerate(lines) if _is_cell(line)), None)
    if at is None:
        raise RawFileError(
            file.path, "no line with Diameter[mm] and Thickness[mm]", 1, value=lines[0][:60],
            hint="export the header too",
        )  # fmt: skip
    said = _cell(file, lines[at], at + 1)
    sample, _, when = lines[0].partition(",") if at else ("", "", "")
    said |= {"Sample": sample.strip()} if sample.strip() else {}
    said |= {"Date": when.split(",")[0].strip()} if when.strip() else {}
    if level := next(filter(None, map(_LEVEL.search, lines[: at + 3])), None):
        said["level_V"] = repr(float(level[1]))
    recording = read_rewritten(file, lines, _NAME)
    return replace(recording, metadata={**recording.metadata, **said})


def _cell(file: RawFile, line: str, number: int) -> dict[str, str]:
    """Read the line of the cell.

    Raises
    ------
    RawFileError : a diameter or a thickness of zero: then the permittivities mean nothing
    """
    said = {}
    for label, unit, written in _PAIR.findall(line):
        said[f"{label} [{unit}]"] = written
        if label not in _LENGTHS:
            continue
        if not float(written) > 0.0:
            raise RawFileError(
                file.path, f"permittivities computed with a {label.casefold()} of zero", number,
                value=written,
                hint="enter the dimensions of the sample in WinDETA and export again",
            )  # fmt: skip
        said[_LENGTHS[label]] = repr(to_si(float(written), unit))
    if "edge correction on" in line.casefold():
        said["edge_field"] = "corrected"
    return said


FORMAT = Format(
    _NAME,
    "Novocontrol WinDETA text",
    _recognises,
    _read,
    "\t",
    ("permittivity",),
    looks="a line `Diameter[mm] ... Thickness[mm] ...`, then `Freq. [Hz]`, `Eps'`, `Eps''`",
    seen="files of the public repository quirin053/novocontrol_toolbox",
)
