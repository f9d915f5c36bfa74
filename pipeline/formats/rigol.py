"""Waveforms that Rigol DS1000Z and MSO1000Z oscilloscopes save as CSV.

Usage
-----
Named `rigol`; detected by a first line `X,CH1,...,Start,Increment,`.

Format
------
`X,CH1,Start,Increment,`, then `Sequence,Volt,<start>,<increment>`, then rows of a running number
and one value for each channel, with a comma at the end. The time is start + number * increment;
the number must run from 0 without gaps. The values hold the probe ratio that is set on the scope;
whether that is the ratio of the probe, the file does not say.

Columns
-------
`time_s [s]`, and `voltage_V [V]` where one channel alone was saved.

Uncertainties
-------------
None in the file; eight bits of the vertical range.

Metadata
--------
None.
"""

from __future__ import annotations

from deamat.core.errors import RawFileError
from deamat.core.number_grammar import is_number
from deamat.core.recording import Recording
from deamat.formats.format import Format
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.rewritten import lines_of, read_rewritten

_NAME = "rigol"
_UNITS = {"Volt": "V", "Amp": "A"}


def _recognises(head: Head) -> bool:
    cells = head[0].rstrip(",").split(",") if head else []
    return len(cells) >= 4 and cells[0] == "X" and cells[-2:] == ["Start", "Increment"]


def _read(file: RawFile) -> Recording:
    lines = lines_of(file)
    channels = lines[0].rstrip(",").split(",")[1:-2]
    below = lines[1].rstrip(",").split(",") if len(lines) > 1 else []
    start, increment = below[-2:] if len(below) == len(channels) + 3 else ("", "")
    if not (is_number(start) and is_number(increment) and float(increment) > 0.0):
        raise RawFileError(
            file.path, "no start and increment of time below the labels", 2,
            value=",".join(below), hint="save the waveform as CSV again",
        )  # fmt: skip
    units = [_UNITS.get(unit, unit) for unit in below[1:-2]]
    over = [f"{name} ({unit})" for name, unit in zip(channels, units, strict=True)]
    rows = [
        _row(file, at, line, at, float(start), float(increment)) if line.strip() else line
        for at, line in enumerate(lines[2:])
    ]
    return read_rewritten(file, ["", ",".join(["Time (s)", *over]), *rows], _NAME)


def _row(file: RawFile, at: int, line: str, number: int, start: float, increment: float) -> str:
    sequence, comma, rest = line.partition(",")
    if sequence.strip() != str(number):
        raise RawFileError(
            file.path, "the running number does not go on", at + 3, 1, sequence,
            "save the waveform again, whole",
        )  # fmt: skip
    return f"{start + number * increment!r}{comma}{rest.removesuffix(',')}"


FORMAT = Format(
    _NAME,
    "Rigol oscilloscope",
    _recognises,
    _read,
    looks="`X,CH1,Start,Increment,`, one channel",
    seen="public scripts that read the DS1000Z",
)
