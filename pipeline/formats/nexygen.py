"""Tab-separated text as Lloyd Instruments' Nexygen exports it.

Usage
-----
Named `nexygen`; detected by a tab-separated row of labels with units, one of them `Machine
Extension`.

Format
------
UTF-16 text with its byte order mark (UTF-8 is read too), perhaps some `key: value` lines, the row
of labels (`Load (N)`, `Machine Extension (mm)`), then rows of decimal-point numbers.

Columns
-------
`time_s [s]`, `force_N [N]`, `displacement_m [m]`, as far as the file has them. Every further column
stands under its own label with its SI unit.

Uncertainties
-------------
None in the file. The machine extension holds the compliance of frame and load cell.

Metadata
--------
Every `key: value` line above the table as text.
"""

from __future__ import annotations

from deamat.core.recording import Recording
from deamat.formats.cells import Dialect
from deamat.formats.columns import Reader
from deamat.formats.format import Format
from deamat.formats.header import Layout, inline_layout
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.table import read_plain

_READER = Reader("nexygen", Dialect("\t"))


def _layout(head: Head) -> Layout | None:
    return head.once(inline_layout, "\t")


def _recognises(head: Head) -> bool:
    layout = head.once(_layout)
    return layout is not None and "machine extension" in map(str.casefold, layout.labels)


def _read(file: RawFile) -> Recording:
    return read_plain(file, _layout, _READER)


FORMAT = Format(
    _READER.name,
    "Lloyd Nexygen text",
    _recognises,
    _read,
    _READER.dialect.delimiter,
    tabular=True,
    looks="UTF-16, tab, `Machine Extension (mm)`",
)
