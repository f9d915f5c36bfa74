"""Waveforms that Tektronix TDS1000, TDS2000 and DPO oscilloscopes save as CSV, one channel a file.

Usage
-----
Named `tektronix`; detected by a first line `Record Length,` and a line `Vertical Units,`.

Format
------
The header stands beside the rows: `key,value,,time,value,` in the first 18 lines, then
`,,,time,value,`. The units are those of `Horizontal Units` and `Vertical Units`; the values hold
the `Probe Atten` that is set on the scope.

Columns
-------
`time_s [s]` and `voltage_V [V]`.

Uncertainties
-------------
None in the file; eight bits of the vertical range.

Metadata
--------
Every header line under its key.
"""

from __future__ import annotations

from dataclasses import replace

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.format import Format
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.rewritten import lines_of, read_rewritten

_NAME = "tektronix"
_FIELDS = 5  # key, value, nothing, time, value


def _recognises(head: Head) -> bool:
    return bool(head) and head[0].startswith("Record Length,") and any(
        line.startswith("Vertical Units,") for line in head
    )  # fmt: skip


def _read(file: RawFile) -> Recording:
    said: dict[str, str] = {}
    rows = []
    for at, line in enumerate(lines_of(file), start=1):
        cells = line.removesuffix(",").split(",")
        if line.strip() and len(cells) != _FIELDS:
            raise RawFileError(
                file.path, f"{len(cells)} fields where key, value, time and signal belong", at,
                value=line, hint="save the waveform as CSV again",
            )  # fmt: skip
        if line.strip() and cells[0].strip():
            said[cells[0].strip()] = cells[1].strip()
        rows.append(",".join(cells[3:]))
    for key in ("Horizontal Units", "Vertical Units"):
        if not said.get(key):
            raise RawFileError(file.path, f"no {key} in the header", 1, hint="save it again")
    source = said.get("Source", "CH")
    names = f"Time ({said['Horizontal Units']}),{source} ({said['Vertical Units']})"
    recording = read_rewritten(file, [names, *rows], _NAME, shift=1)
    return replace(recording, metadata={**recording.metadata, **said})


FORMAT = Format(
    _NAME,
    "Tektronix oscilloscope",
    _recognises,
    _read,
    ",",
    looks="header beside the rows, `Record Length,`",
    seen="TDS2000, as saved",
)
