"""Comma-separated curves with units beside the labels, as the Ecoflex phantom set has them.

Usage
-----
Named `phantom`; detected by a comma-separated row of labels that carry their units and hold a
load or a stress. Written for the compression curves of Dawood et al. 2026 (Instron 5900, 50 x 30
mm cylinders); any plain export of this shape is read the same way.

Format
------
Note lines (`EF10_50T_A_sample_1`, `Cylinder Diameter: 50mm;`), the row of labels
(`Time (s),Compression (mm),Load (N),Engineering Strain [-],Engineering Stress (kPa),...`), then
rows of decimal-point numbers. In the set strain and stress are negative in compression while the
load is positive; signs are delivered as they stand, `-0.000000` included. A note that states a
unit for a column (`Load (kN);`) is held against the column.

Columns
-------
`time_s [s]`, `displacement_m [m]`, `force_N [N]`, `nominal_strain [1]`, `nominal_stress_Pa [Pa]`,
as far as the file has them. Every further column stands under its own label with its SI unit.

Uncertainties
-------------
None in the file; six decimals are printed whatever the load cell resolves.

Metadata
--------
Every note as text: `key: value` under its key, a line without a value under its line number.
"""

from __future__ import annotations

from deamat.core.recording import Recording
from deamat.formats.cells import Dialect
from deamat.formats.columns import Reader
from deamat.formats.documentation import stated_units
from deamat.formats.format import MECHANICS, Format
from deamat.formats.header import Layout, inline_layout, notes
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.table import read_table, required

_READER = Reader("phantom", Dialect(","))


def _layout(head: Head) -> Layout | None:
    return inline_layout(head, ",")


def _recognises(head: Head) -> bool:
    layout = head.once(_layout)
    return layout is not None and layout.has_load(_READER.unwritten)


def _read(file: RawFile) -> Recording:
    layout = required(file.once(_layout), file.head, _READER.name, file.path)
    header = file.head[: layout.names]
    return read_table(file, layout, _READER, notes(header), stated_units("\n".join(header)))


FORMAT = Format(
    _READER.name,
    "curves with units beside the labels",
    _recognises,
    _read,
    _READER.dialect.delimiter,
    MECHANICS,
    tabular=True,
    looks="comma, below a header of `label: value;` lines",
    seen="Dawood et al. 2026, phantoms of Ecoflex, CC BY 4.0",
)
