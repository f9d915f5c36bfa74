"""Tab-separated text with decimal commas, as MTS TestSuite exports it on a European computer.

Usage
-----
Named `mts`; detected by a tab-separated table with units and a force or stress, whose rows hold
more commas than points. A table with `Machine Extension` is Nexygen's.

Format
------
UTF-8 with a byte order mark, CRLF, perhaps some `key: value` or `key<TAB>value` lines, then the
labels with their units (`Time (s)`, `Crosshead (mm)`, `Load (kN)`) or a row of labels above a row
of units, then rows of decimal-comma numbers. A decimal point is an error: it could be a thousands
separator. The load is in kN.

Columns
-------
`time_s [s]`, `displacement_m [m]`, `force_N [N]`, as far as the file has them. Every further column
stands under its own label with its SI unit.

Uncertainties
-------------
None in the file. A load in kN with four decimals resolves 0.1 N, coarse for soft specimens.

Metadata
--------
Every line above the table as text.
"""

from __future__ import annotations

from deamat.core.recording import Recording
from deamat.formats.cells import Dialect
from deamat.formats.columns import Reader
from deamat.formats.format import MECHANICS, Format
from deamat.formats.header import Layout, inline_layout, two_row_layout, units_row
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.table import read_plain

_READER = Reader("mts", Dialect("\t", decimal=","))


def _layout(head: Head) -> Layout | None:
    units = units_row(head, "\t", bare=True)
    if units is not None:
        return two_row_layout(head, "\t", units - 1)
    return head.once(inline_layout, "\t")


def _recognises(head: Head) -> bool:
    layout = head.once(_layout)
    # without rows to show a decimal comma, labels alone tell the other tab-separated forms apart
    if layout is None or {"machine extension", "depth"} & {*map(str.casefold, layout.labels)}:
        return False
    rows = "".join(head[layout.rows :])
    return rows.count(",") >= rows.count(".") and layout.has_load()


def _read(file: RawFile) -> Recording:
    return read_plain(file, _layout, _READER)


FORMAT = Format(
    _READER.name,
    "MTS text with decimal commas",
    _recognises,
    _read,
    _READER.dialect.delimiter,
    MECHANICS,
    tabular=True,
    looks="tab, byte order mark, kN",
)
