"""A sweep logged from a Keysight E4980A: its settings as header lines, its status as an integer.

Usage
-----
Named `e4980a`; detected by a comma-separated row of labels `Frequency...,Primary,Secondary,Status`
(or `Data A`, `Data B` for the pair).

Format
------
Header lines `key,value` or `key: value`, perhaps behind `#`, one of which names the function
(`Function`, `Mode`, `Measurement function` or `FUNC:IMP`: CPD, CPRP, CSD, CSRS, RX, ZTD, ZTR, or
`Cp-D` and so on), then the row of labels, then rows of frequency in Hz, primary, secondary in SI
and the meter's status. Status 0 is a measurement; -1 (no data), 1 (overload), 3 (signal source
overloaded) and 4 (level not held) are not: such points are kept as written (9.9E37) and marked in
the column `over_range`. The meter itself saves no frequency with its data, so this is a log made
on a PC.

Columns
-------
`frequency_Hz [Hz]`, `over_range [1]` (1 where the meter calls a point no measurement, else 0), and
two columns that the function decides: `parallel_capacitance_F [F]` or `series_capacitance_F [F]`
with `loss_tangent [1]`, `parallel_resistance_ohm [ohm]` or `series_resistance_ohm [ohm]`;
`series_resistance_ohm [ohm]` with `reactance_ohm [ohm]`; `impedance_ohm [ohm]` with
`phase_rad [rad]`.

Uncertainties
-------------
None in the file. The meter's limits of error stand in `config/instruments.toml`.

Metadata
--------
Every header line under its key; `mode`; `level_V` from a line `Level` or `Voltage level`; `speed`
from `Speed`, `Aperture` or `Integration`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.cells import Dialect
from deamat.formats.format import Format
from deamat.formats.lcr_sweep import (
    PAIRS,
    Sweep,
    function_columns,
    level_of,
    mode_of,
    read_sweep,
)
from deamat.formats.rawfile import Head, RawFile

_NAME = "e4980a"
_FREQUENCY = re.compile(r"freq(?:uency)?\s*(?:[(\[_ ]\s*hz\s*[)\]]?)?", re.IGNORECASE)
_PAIR_LABELS = (("primary", "secondary"), ("data a", "data b"), ("a", "b"))
_STATUSES = {
    **dict.fromkeys(("0", "+0"), True),
    **dict.fromkeys(("-1", "1", "+1", "3", "+3", "4", "+4"), False),
}
_MODES = {mode.casefold(): mode for mode in PAIRS} | {
    "cpd": "Cp-D", "cprp": "Cp-Rp", "csd": "Cs-D", "csrs": "Cs-Rs", "rx": "R-X",
    "ztd": "Z-theta-deg", "ztr": "Z-theta-rad",
}  # fmt: skip
_FUNCTION = ("function", "mode", "measurement function", "meas function", "func", "func:imp")
_LEVEL = ("level", "voltage level", "test level")
_SPEED = ("speed", "aperture", "integration")
_SHORT = "shor"


def _labels(head: Head) -> int | None:
    """Line of the labels, counted from 0."""
    for at in head.texts:
        cells = [cell.strip(' "').casefold() for cell in head[at].split(",")]
        if (
            len(cells) == 4
            and _FREQUENCY.fullmatch(cells[0])
            and tuple(cells[1:3]) in _PAIR_LABELS
            and cells[3] == "status"
        ):
            return at
    return None


def _recognises(head: Head) -> bool:
    return head.once(_labels) is not None


def _read(file: RawFile) -> Recording:
    at = file.head.once(_labels)
    if at is None:
        raise RawFileError(
            file.path, "no row of labels as the e4980a form has it", value=file.head[0],
            hint="leave the register's `format` empty to have the form detected",
        )  # fmt: skip
    said = _settings(file.head[:at])
    mode = mode_of(
        file,
        [(line, value) for line, key, value in said if key.casefold() in _FUNCTION],
        _MODES,
        "add a header line such as `Function,CPD`",
    )
    metadata = {key: value for _, key, value in said}
    metadata["mode"] = mode
    for line, key, value in said:
        if key.casefold() in _LEVEL:
            metadata["level_V"] = level_of(file, line, value)
        elif key.casefold() in _SPEED:
            short = value.casefold().startswith(_SHORT)
            metadata["speed"] = "fast" if short else value.casefold()
    sweep = Sweep(at + 1, function_columns(mode), Dialect(","), _STATUSES)
    return read_sweep(file, sweep, metadata, _NAME)


def _settings(lines: Sequence[str]) -> list[tuple[int, str, str]]:
    """Line (from 1), key and value of every header line that has both."""
    found = []
    for line, text in enumerate(lines, start=1):
        plain = text.lstrip("# ").strip()
        key, _, value = plain.partition("," if "," in plain else ":")
        if key and value.strip(' ,"'):
            found.append((line, key.strip(' "'), value.strip(' ,"')))
    return found


FORMAT = Format(
    _NAME,
    "Keysight E4980A sweep, logged on a PC",
    _recognises,
    _read,
    ",",
    looks="`Frequency,Primary,Secondary,Status`",
)
