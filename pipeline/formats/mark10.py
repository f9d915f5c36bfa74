"""Logs of Mark-10 and Chatillon force gauges on a motorised stand (MESUR gauge).

Usage
-----
Named `mark10`; detected by a line `Units:` above a tab-separated row that starts with `Reading`.

Format
------
A time stamp, `Units: N`, `Readings: Continuous`, `X-Axis: Travel`, `Travel Unit: mm`, the row of
labels (`Reading`, `Load`, `Travel`, `Time`, parted by tabs), then rows of decimal-point numbers;
CRLF. The unit of the load and of the travel stand in the header; the time is in seconds and the
reading is a running number, which the exporter does not write: the metadata say so.

Columns
-------
`reading [1]`, `force_N [N]`, `displacement_m [m]`, `time_s [s]`.

Uncertainties
-------------
None in the file. The load is printed with the gauge's resolution, so its last digit bounds it.

Metadata
--------
`timestamp` and every `key: value` line as text.
"""

from __future__ import annotations

from deamat.core.recording import Recording
from deamat.formats.cells import Dialect
from deamat.formats.columns import Reader
from deamat.formats.format import Format
from deamat.formats.header import Layout, notes, split, split_label
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.table import read_table, required

_READER = Reader("mark10", Dialect("\t"), {"reading": "1", "time": "s"})
_HEADER_UNITS = {"Load": "Units", "Travel": "Travel Unit"}
_SPELLINGS = {"lbF": "lbf", "ozF": "ozf", "kgF": "kgf", "gF": "gf"}


def _layout(head: Head) -> Layout | None:
    for at in head.texts:
        line = head[at]
        if line.startswith("Reading\t"):
            labels, units = zip(*map(split_label, split(line, "\t")), strict=True)
            return Layout(at, at, labels, units)
    return None


def _recognises(head: Head) -> bool:
    layout = head.once(_layout)
    return layout is not None and any(line.startswith("Units:") for line in head[: layout.names])


def _read(file: RawFile) -> Recording:
    layout = required(file.once(_layout), file.head, _READER.name, file.path)
    header = file.head[: layout.names]
    metadata = notes(header)
    if header and header[0][:1].isdigit():
        metadata = {"timestamp": header[0].strip(), **notes(header[1:])}
    header_units = {
        label: _SPELLINGS.get(metadata[key], metadata[key])
        for label, key in _HEADER_UNITS.items()
        if key in metadata
    }
    return read_table(file, layout, _READER, metadata, header_units)


FORMAT = Format(
    _READER.name,
    "Mark-10 or Chatillon log",
    _recognises,
    _read,
    _READER.dialect.delimiter,
    looks="tab, `Units: N`, `Travel Unit: mm`",
)
