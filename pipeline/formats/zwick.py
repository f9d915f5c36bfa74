"""Text exports (`.tra`) of Zwick testXpert.

Usage
-----
Named `zwick`; detected by lines of quoted cells from the first line on, the last two of which are
labels and bare units.

Format
------
Summary lines `"label",value,"unit"` of varying number (`"Yield strain","Unknown"` without unit),
the row of labels (`"Standard travel","Standard force"`), the row of units (`"mm","N"`), then rows
of unquoted decimal-point numbers with exponents of three digits (`1.46e-007`). After the break a
lost sensor writes exact zeros to the end: flagged, never dropped. An aborted export ends in a cut
line, which is refused by its line.

Columns
-------
`displacement_m [m]`, `force_N [N]`, and what else was exported under its own label, such as
`specimen_width_m [m]`.

Uncertainties
-------------
None in the file; six significant digits are printed.

Metadata
--------
Every summary line under its label, value and unit joined by a space. `Force maximum` may be a
stress: go by its unit.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from deamat.core.recording import Recording
from deamat.core.records import Flag
from deamat.formats.cells import Dialect
from deamat.formats.columns import Reader
from deamat.formats.format import Format
from deamat.formats.header import Layout, two_row_layout
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.table import read_plain

_READER = Reader("zwick", Dialect(","))


def _layout(head: Head) -> Layout | None:
    rows = 0
    for at, line in enumerate(head):
        if line.startswith('"'):
            rows = at + 1
        elif line.strip():
            break
    layout = two_row_layout(head, ",", rows - 2)
    if layout is None or any('"(' in line for line in head[layout.names : layout.rows]):
        return None  # bracketed units are Bluehill's
    return layout


def _recognises(head: Head) -> bool:
    layout = head.once(_layout)
    return layout is not None and layout.has("force_N", "nominal_stress_Pa")


def _read(file: RawFile) -> Recording:
    recording = read_plain(file, _layout, _READER)
    return replace(recording, flags=recording.flags + _trailing_zeros(recording))


def _trailing_zeros(recording: Recording) -> tuple[Flag, ...]:
    """Notice columns that end in exact zeros after values that are not."""
    flags = []
    for name, values in recording.columns.items():
        if values[-1] == 0.0 and values.any():
            zeros = int(np.argmax(values[::-1] != 0.0))
            flags.append(
                Flag(
                    "trailing-zeros",
                    f"{name} is exactly 0 in the last {zeros} rows, from line "
                    f"{recording.source.last_line - zeros + 1}: the sensor lost the specimen",
                )
            )
    return tuple(flags)


FORMAT = Format(
    _READER.name,
    "Zwick testXpert text",
    _recognises,
    _read,
    _READER.dialect.delimiter,
    tabular=True,
    looks="quoted summary lines, then a table with three-digit exponents",
)
