"""Semicolon-separated tensile curves of the Soft Robotics Materials Database.

Usage
-----
Named `soro`; detected by a semicolon-separated row of labels, some with units, that hold a stress
or a load. Written for the files of Marechal et al. 2021 (10.1089/soro.2019.0115; ASTM D412,
Instron 5569 and 68SC-2, 33 x 6 x 3 mm).

Format
------
Some 18 header lines `label;value;url;;` whose labels differ between files, a line of semicolons,
the row of labels (`Time (s);True Strain;True Stress (MPa);Engineering Strain;Engineering Stress
(MPa)`), then rows of decimal-point numbers; CRLF or LF. The strain columns carry no unit: they
are pure numbers, true = ln(1 + engineering); the metadata name each one read without a unit.

Columns
-------
`time_s [s]`, `nominal_strain [1]`, `nominal_stress_Pa [Pa]`, `true_strain [1]`,
`true_stress_Pa [Pa]`, as far as the file has them. Every further column stands under its own label
with its SI unit.

Uncertainties
-------------
None in the file. Strain is crosshead displacement over the gauge length, not an extensometer's.

Metadata
--------
Every header line under its label, value and further cells joined by a space.
"""

from __future__ import annotations

from deamat.core.recording import Recording
from deamat.formats.cells import Dialect
from deamat.formats.columns import Reader
from deamat.formats.format import MECHANICS, Format
from deamat.formats.header import Layout, inline_layout
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.table import read_plain

_READER = Reader("soro", Dialect(";"), {"true strain": "1", "engineering strain": "1"})


def _layout(head: Head) -> Layout | None:
    return inline_layout(head, ";")


def _recognises(head: Head) -> bool:
    layout = head.once(_layout)
    return layout is not None and layout.has_load(_READER.unwritten)


def _read(file: RawFile) -> Recording:
    return read_plain(file, _layout, _READER)


FORMAT = Format(
    _READER.name,
    "Soft Robotics Materials Database",
    _recognises,
    _read,
    _READER.dialect.delimiter,
    MECHANICS,
    tabular=True,
    looks="semicolon, below a `PARAMETER;INFO;URL` header",
    seen="doi 10.1089/soro.2019.0115",
)
