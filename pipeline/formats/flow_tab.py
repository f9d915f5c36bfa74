"""Flow curves in tab-separated text, labels with their units in square brackets.

Usage
-----
Named `flow_tab`; detected by a tab-separated first line with `Shear Rate` and `Viscosity`.

Format
------
`Point No.<TAB>Shear Rate [1/s]<TAB>Shear Stress [Pa]<TAB>Viscosity [mPa.s]...`, then rows with
decimal points; CRLF or LF. A rate or viscosity without its unit is refused: nothing tells Pa.s from
mPa.s. Units with a middle dot or a degree sign may be in Mac OS Roman, as some exports were.

Columns
-------
`point_no [1]`, `shear_rate_per_s [1/s]`, `viscosity_Pas [Pa.s]`, `temperature_K [K]`, as far as the
file has them. Every further column stands under its own label with its SI unit.

Uncertainties
-------------
None in the file.

Metadata
--------
None.
"""

from __future__ import annotations

from dataclasses import replace

from deamat.core.recording import Recording
from deamat.core.records import Flag
from deamat.formats.cells import Dialect, looks_numeric
from deamat.formats.columns import Reader
from deamat.formats.format import Format
from deamat.formats.header import Layout, split, split_label
from deamat.formats.quantities import meaning
from deamat.formats.rawfile import RawFile
from deamat.formats.table import read_table, required

_READER = Reader("flow_tab", Dialect("\t"), {"point no.": "1"})
# Middle dot and degree sign of Mac OS Roman, as they look when read as Latin-1.
_MAC_ROMAN = str.maketrans({"\u00e1": ".", "\u00a1": "\u00b0"})


def _layout(head: list[str]) -> Layout | None:
    cells = split(head[0], "\t")
    if len(cells) < 2 or not all(cells) or any(map(looks_numeric, cells)):
        return None
    pairs = [split_label(cell) for cell in cells]
    labels = tuple(label for label, _ in pairs)
    found = {known[1] for label in labels if (known := meaning(label)) is not None}
    if not {"shear_rate_per_s", "viscosity_Pas"} <= found:
        return None
    return Layout(0, 0, labels, tuple(unit for _, unit in pairs))


def _recognises(head: list[str]) -> bool:
    return _layout(head) is not None


def _read(file: RawFile) -> Recording:
    layout = required(_layout(file.head), file.head, _READER.name, file.path)
    if file.encoding != "latin-1":
        return read_table(file, layout, _READER, {})
    spelled = tuple(unit.translate(_MAC_ROMAN) for unit in layout.units)
    recording = read_table(file, replace(layout, units=spelled), _READER, {})
    if spelled == layout.units:
        return recording
    told = ", ".join(unit for unit in spelled if unit)
    flag = Flag("mac-roman", f"units in Mac OS Roman encoding, read as {told}")
    return replace(recording, flags=(*recording.flags, flag))


FORMAT = Format(
    _READER.name,
    "tab-separated flow curve",
    _recognises,
    _read,
    "\t",
    tabular=True,
    looks="rate and viscosity or stress, units beside the labels",
    seen="TimothySchmid/Additional_data_PhD_thesis",
)
