"""High-voltage ramps: the log of a DAQ on an amplifier's monitors, or a plain table in volts.

Usage
-----
Named `hv_ramp`; detected by a row of labels that holds a time and either a voltage or the channels
of a DAQ in volts (`time_s,ch1_V,ch2_V`).

Format
------
Perhaps lines that start with `#`, then one row of labels that carry their units (`time_s`,
`voltage_kV`), then rows of numbers, parted by commas, semicolons or tabs; decimal commas where no
comma parts the fields. A DAQ log holds the amplifier's monitors in volts and says above them what
each channel is: `# channel 1: voltage monitor, 2000 V/V`, `# channel 2: current monitor,
2e-3 A/V`. Both are multiplied out; a channel that nothing is said of is an error, never a guess.
A plain table names `voltage_V` or `voltage_kV` and, if there was one, `current_uA`.

Columns
-------
`time_s [s]`, `voltage_V [V]`, and `current_A [A]` if it was logged; monitors are multiplied out.
Every further column stands under its own label with its SI unit.

Uncertainties
-------------
None in the file. What the voltage monitor is good for stands in `config/instruments.toml`.

Metadata
--------
Lines of the form `# key: value` under their key, other remarks under their line number.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from deamat.core.arrays import FloatArray
from deamat.core.errors import RawFileError
from deamat.core.number_grammar import is_number
from deamat.core.recording import Recording
from deamat.core.register_columns import split_unit
from deamat.core.units import known, si_factor
from deamat.formats.cells import Dialect
from deamat.formats.columns import Reader
from deamat.formats.format import Format
from deamat.formats.header import Layout, notes, split
from deamat.formats.rawfile import RawFile
from deamat.formats.table import read_table, required

_NAME = "hv_ramp"
_CHANNEL_LABEL = re.compile(r"ch(\d+)")
_CHANNEL_LINE = re.compile(r"#\s*channel\s+(\d+)\s*:\s*(.*?)\s*", re.IGNORECASE)
_MONITOR = re.compile(r"(voltage|current) monitor\s*,\s*(\S+)\s+([a-z]+)\s*/\s*V", re.IGNORECASE)
_MEND = "declare it above the labels: `# channel 1: voltage monitor, 2000 V/V`"
_SI = {"voltage": "V", "current": "A"}


@dataclass(frozen=True, slots=True)
class _Monitor:
    """What one channel of the DAQ shows: `voltage_V` or `current_A` per volt."""

    name: str
    factor: float


def _names_line(head: Sequence[str]) -> int:
    """Line of the labels, counted from 0: the first that is neither blank nor a remark."""
    for at, line in enumerate(head):
        if line.strip() and not line.startswith("#"):
            return at
    return len(head) - 1


def _delimiter(line: str) -> str:
    return max((",", ";", "\t"), key=line.count)


def _layout(head: Sequence[str]) -> Layout | None:
    """Take the labels apart, if they are those of a ramp."""
    at = _names_line(head)
    pairs = [split_unit(cell) for cell in split(head[at], _delimiter(head[at]))]
    labels = tuple(label for label, _ in pairs)
    declared = any(map(_CHANNEL_LINE.fullmatch, head[:at]))
    if "time" not in labels or not any(
        label == "voltage" or (_CHANNEL_LABEL.fullmatch(label) and (declared or unit == "V"))
        for label, unit in pairs
    ):
        return None
    return Layout(at, at, labels, tuple(unit or "" for _, unit in pairs))


def _recognises(head: list[str]) -> bool:
    return _layout(head) is not None


def _read(file: RawFile) -> Recording:
    layout = required(_layout(file.head), file.head, _NAME, file.path)
    delimiter = _delimiter(file.head[layout.names])
    decimal = "." if delimiter == "," else file.decimal_mark(layout.rows)
    reader = Reader(_NAME, Dialect(delimiter, decimal))
    monitors = _monitors(file, layout)
    remarks = [line.lstrip("# ") for line in file.head[: layout.names]]
    table = read_table(file, layout, reader, notes(remarks))
    return replace(table, columns=_named(file, layout, monitors, table))


def _monitors(file: RawFile, layout: Layout) -> dict[str, _Monitor]:
    """Find what the header says of each channel that has a column, by its label."""
    said: dict[str, tuple[int, str]] = {}
    for at, line in enumerate(file.head[: layout.names], start=1):
        found = _CHANNEL_LINE.fullmatch(line)
        if found is None:
            continue
        label = f"ch{int(found[1])}"
        if label in said:
            raise RawFileError(
                file.path, f"channel {found[1]} is declared in line {said[label][0]} already",
                line=at, value=line, hint="declare each channel once",
            )  # fmt: skip
        said[label] = at, found[2]
    monitors = {}
    for column, label in enumerate(layout.labels, start=1):
        channel = _CHANNEL_LABEL.fullmatch(label)
        if channel is None:
            continue
        key = f"ch{int(channel[1])}"
        if key not in said:
            raise RawFileError(
                file.path, "a channel for which the file does not say what it measures",
                line=layout.names + 1, column=column, value=label, hint=_MEND,
            )  # fmt: skip
        monitors[label] = _monitor(file, *said[key])
    return monitors


def _monitor(file: RawFile, line: int, text: str) -> _Monitor:
    """Read `voltage monitor, 2000 V/V`."""
    found = _MONITOR.fullmatch(text)
    if found is None or not is_number(found[2]) or float(found[2]) == 0.0:
        raise RawFileError(
            file.path, "not the declaration of a voltage or current monitor", line=line,
            value=text, hint=_MEND,
        )  # fmt: skip
    quantity = found[1].casefold()
    si_unit, factor, _ = si_factor(found[3]) if known(found[3]) else ("", 1.0, 0.0)
    if si_unit != _SI[quantity]:
        raise RawFileError(
            file.path, f"a {quantity} monitor in {found[3]} per volt", line=line, value=text,
            hint=f"declare it in {_SI[quantity]}/V",
        )  # fmt: skip
    return _Monitor(f"{quantity}_{si_unit}", factor * float(found[2]))


def _named(
    file: RawFile, layout: Layout, monitors: dict[str, _Monitor], table: Recording
) -> dict[str, FloatArray]:
    """Multiply the monitors out, and insist on one time, one voltage and at most one current."""
    columns: dict[str, FloatArray] = {}
    for label, (name, values) in zip(table.column_units, table.columns.items(), strict=True):
        column = layout.labels.index(label) + 1
        wanted = {"time": "time_s", **{q: f"{q}_{unit}" for q, unit in _SI.items()}}
        if label in monitors:
            if name != f"{label}_V":
                raise RawFileError(
                    file.path, "a channel that is not in volts", line=layout.names + 1,
                    column=column, value=f"{label} [{layout.units[column - 1]}]",
                    hint="log the monitor outputs in V",
                )  # fmt: skip
            name, values = monitors[label].name, monitors[label].factor * values
        elif label in wanted and name != wanted[label]:
            raise RawFileError(
                file.path, f"a {label} in {layout.units[column - 1]}", line=layout.names + 1,
                column=column, value=label, hint=f"name the column {wanted[label]}",
            )  # fmt: skip
        if name in columns:
            raise RawFileError(
                file.path, f"two columns hold the {name.partition('_')[0]}",
                line=layout.names + 1, column=column, value=label,
                hint="log each quantity once",
            )  # fmt: skip
        columns[name] = values
    if "voltage_V" not in columns:
        raise RawFileError(
            file.path, "no channel is a voltage monitor", line=layout.names + 1, hint=_MEND
        )
    return columns


FORMAT = Format(
    _NAME,
    "high-voltage ramp, DAQ log or plain table",
    _recognises,
    _read,
    looks="channel lines with their ratios, or `time_s` with `voltage_kV`",
)
