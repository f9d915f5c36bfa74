"""Text exports of Bruker Hysitron nanoindenters (TriboScan).

Usage
-----
Named `hysitron`; detected by a line `Number of Points = ` above a tab-separated row of labels that
begins with `Depth (nm)`.

Format
------
A date (`Mon Apr 29 10:41:06 2019`), a blank line, `Number of Points = 5304`, the row of labels
(`Depth (nm)`, `Load (µN)`, `Time (s)`, `Depth (V)`, `Load (V)`), then rows of decimal-point
numbers parted by tabs; ISO-8859-1, for the sake of the µ. A blank line parts the segments of the
load function (approach, loading, hold, unloading). The signals in volts stand under the same
labels as the quantities: they become `depth_signal_V` and `load_signal_V`. Depths before contact
are negative where the software took the surface for zero, and are delivered as they stand. The
stated number of points is held against the rows: a cut between two lines would not show otherwise.

Columns
-------
`depth_m [m]`, `force_N [N]`, `time_s [s]`, and the raw signals `depth_signal_V [V]` and
`load_signal_V [V]`.

Uncertainties
-------------
None in the file; six decimals are printed whatever the transducer resolves.

Metadata
--------
`timestamp`, `Number of Points` and any other line above the labels as text.
"""

from __future__ import annotations

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.cells import Dialect
from deamat.formats.columns import Reader
from deamat.formats.format import Format
from deamat.formats.header import Layout, split, split_label
from deamat.formats.rawfile import RawFile
from deamat.formats.table import read_table, required

_READER = Reader("hysitron", Dialect("\t", segmented=True))
_POINTS = "Number of Points"


def _layout(head: list[str]) -> Layout | None:
    for at, line in enumerate(head):
        if line.startswith("Depth (nm)\t"):
            labels, units = zip(*map(split_label, split(line, "\t")), strict=True)
            told_apart = (
                f"{n} signal" if u == "V" else n for n, u in zip(labels, units, strict=True)
            )
            return Layout(at, at, tuple(told_apart), units)
    return None


def _stated_points(head: list[str]) -> tuple[int, str] | None:
    """Find the line (counted from 0) that states the number of points, and what it states."""
    for at, line in enumerate(head):
        name, sign, value = line.partition("=")
        if name.strip() == _POINTS and sign:
            return at, value.strip()
    return None


def _recognises(head: list[str]) -> bool:
    layout, points = _layout(head), _stated_points(head)
    return layout is not None and points is not None and points[0] < layout.names


def _read(file: RawFile) -> Recording:
    layout = required(_layout(file.head), file.head, _READER.name, file.path)
    stated = _stated_points(file.head[: layout.names])
    if stated is None:
        raise RawFileError(
            file.path,
            f"no line `{_POINTS} = ` above the labels, so a cut file would not show",
            line=layout.names + 1,
            hint="export the file again",
        )
    at, points = stated
    if not (points.isascii() and points.isdigit()):
        raise RawFileError(
            file.path,
            f"{_POINTS} is not a count",
            line=at + 1,
            value=points,
            hint="export the file again",
        )
    metadata = {
        {0: "timestamp", at: _POINTS}.get(i, f"line {i + 1}"): points if i == at else line.strip()
        for i, line in enumerate(file.head[: layout.names])
        if line.strip()
    }
    recording = read_table(file, layout, _READER, metadata)
    rows = len(next(iter(recording.columns.values())))
    if rows != int(points):
        raise RawFileError(
            file.path,
            f"{rows} rows where line {at + 1} states {points} points"
            + ("; the file seems cut" if rows < int(points) else ""),
            line=recording.source.last_line,
            hint="export the file again",
        )
    return recording


FORMAT = Format(
    _READER.name,
    "Hysitron TriboScan text",
    _recognises,
    _read,
    "\t",
    looks="`Number of Points = `, `Depth (nm)`, blank lines between segments",
    seen="micromechanics/main",
)
