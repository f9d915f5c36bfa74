"""Raw data as Instron Bluehill exports it.

Usage
-----
Named `bluehill`; detected by a comma-separated row of bracketed units below the row of labels.

Format
------
Optional header lines `key,"value",unit` and a blank line, the row of labels
(`Time,Compressive extension,Load`), the row of units (`(s),(mm),(N)`), then rows of numbers with
decimal points, which may stand in double quotes and then carry THOUSANDS COMMAS
(`"242,370.29658"`). A comma outside quotes always parts fields. Compression is signed either way
and a preload is not zeroed; both are delivered as they stand. Of several extensions or loads
(`Extension`, `Compressive extension`) the plain one is `displacement_m` or `force_N`.

Columns
-------
`time_s [s]`, `displacement_m [m]`, `force_N [N]`, as far as the file has them. Every further column
stands under its own label with its SI unit.

Uncertainties
-------------
None in the file.

Metadata
--------
Every header line under its key, value and unit joined by a space.
"""

from __future__ import annotations

from deamat.core.recording import Recording
from deamat.formats.cells import Dialect
from deamat.formats.columns import Reader
from deamat.formats.format import MECHANICS, Format
from deamat.formats.header import Layout, two_row_layout, units_row
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.table import read_plain

_CURVE = ("displacement_m", "force_N", "nominal_strain", "nominal_stress_Pa")
_READER = Reader("bluehill", Dialect(",", quoted=True))


def _layout(head: Head) -> Layout | None:
    units = units_row(head, ",")
    return None if units is None else two_row_layout(head, ",", units - 1)


def _recognises(head: Head) -> bool:
    layout = head.once(_layout)
    # labels in other languages are the plain table's to read
    return layout is not None and layout.has(*_CURVE)


def _read(file: RawFile) -> Recording:
    return read_plain(file, _layout, _READER)


FORMAT = Format(
    _READER.name,
    "Instron Bluehill raw data",
    _recognises,
    _read,
    _READER.dialect.delimiter,
    MECHANICS,
    tabular=True,
    looks="units row, quoted numbers with thousands commas",
)
