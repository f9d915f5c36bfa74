"""Flow curves as Anton Paar's older rheometer software exports them: semicolons, decimal commas.

Usage
-----
Named `antonpaar`; detected by a semicolon-separated row of labels with `Shear Rate`, and a row of
bracketed units below it.

Format
------
`Shear Rate;Shear Stress;Viscosity;Speed;Torque`, then `[1/s];[Pa];[Pa.s];[1/min];[uNm]` (with a
middle dot and a micro sign, in UTF-8 or Latin-1), then rows with decimal commas; CRLF or LF.

Columns
-------
`shear_rate_per_s [1/s]`, `shear_stress_Pa [Pa]`, `viscosity_Pas [Pa.s]`, `torque_Nm [N.m]`. Every
further column stands under its own label with its SI unit.

Uncertainties
-------------
None in the file.

Metadata
--------
None.
"""

from __future__ import annotations

from deamat.core.recording import Recording
from deamat.formats.cells import Dialect
from deamat.formats.columns import Reader
from deamat.formats.format import Format
from deamat.formats.header import Layout, two_row_layout, units_row
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.table import read_table, required

_READER = Reader("antonpaar", Dialect(";", ","))


def _layout(head: Head) -> Layout | None:
    units = units_row(Head([line or " " for line in head]), ";")
    return None if units is None else two_row_layout(head, ";", units - 1)


def _recognises(head: Head) -> bool:
    layout = _layout(head)
    return layout is not None and layout.has("shear_rate_per_s")


def _read(file: RawFile) -> Recording:
    layout = required(_layout(file.head), file.head, _READER.name, file.path)
    return read_table(file, layout, _READER, {})


FORMAT = Format(
    _READER.name,
    "Anton Paar flow curve",
    _recognises,
    _read,
    ";",
    tabular=True,
    looks="semicolon, decimal comma, a row of units",
    seen="imewei/rheojax, flow curves of ethylcellulose",
)
