"""PC-logged replies of a GW Instek LCR-6000 meter (LCR-6020 and its sisters).

Usage
-----
Named `lcr6000`; detected by header lines `# key => reply`, or by rows that end in one of the
meter's statuses.

Format
------
Header lines `# key => reply` (the mark may be missing) with the replies as the meter sent them,
among them `FUNC?`, which alone says what the numbers are: `Cp-D`, `Cp-Rp`, `Cs-D`, `Cs-Rs`, `R-X`,
`Z-theta-deg` (the meter's own `Z-thd` and `Z-thr` are known). Without it a file is refused, for a
capacitance in series is not one in parallel. Then, perhaps under a line with these names, rows
`frequency,primary,secondary,status` in Hz and SI. Status `OK` is a measurement; `OUT`, `OVER` and
readings of 9.9E37 or beyond are not: they are kept as written and marked in the column
`over_range`.

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
Every reply under its key; `mode`; `level_V` and `speed` where the meter was asked; `model`,
`firmware`, `serial` and `vendor` from `*IDN?` (the vendor's name has a comma in it).
"""

from __future__ import annotations

import re

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

_NAME = "lcr6000"
_REPLY = re.compile(r"#?\s*(\S.*?)\s*=>\s*(.*?)\s*")
_STATUSES = {"ok": True, "out": False, "over": False}
_ROW = re.compile(rf"[^#,]+,[^,]+,[^,]+,\s*(?:{'|'.join(_STATUSES)})\s*", re.IGNORECASE)
_MODES = {mode.casefold(): mode for mode in PAIRS} | {
    "z-thd": "Z-theta-deg",
    "z-thr": "Z-theta-rad",
}
_NAMES = re.compile(r"frequency\w*,", re.IGNORECASE)
_IDENTITY = ("model", "firmware", "serial", "vendor")


def _recognises(head: Head) -> bool:
    replies = any(_REPLY.fullmatch(head[at]) for at in head.texts)
    return replies or bool(_ROW.fullmatch(head[0]))


def _read(file: RawFile) -> Recording:
    header = []
    for line in file.head:
        if line.strip() and not (line.startswith("#") or _REPLY.fullmatch(line)):
            if _NAMES.match(line):
                header.append(line)
            break
        header.append(line)
    replies = [
        (at, found[1], found[2])
        for at, line in enumerate(header, start=1)
        if (found := _REPLY.fullmatch(line))
    ]
    mode = mode_of(
        file,
        [(at, reply) for at, key, reply in replies if key.casefold() == "func?"],
        _MODES,
        "add the meter's own reply as a line such as `# FUNC? => Cp-D`",
    )
    metadata: dict[str, str] = {key: reply for _, key, reply in replies}
    metadata["mode"] = mode
    remarks = [
        line.lstrip("# ").rstrip()
        for line in header
        if line.startswith("#") and not _REPLY.fullmatch(line)
    ]
    if remarks:
        metadata["remark"] = "; ".join(remarks)
    for at, key, reply in replies:
        if key.casefold() == "lev:volt?":
            metadata["level_V"] = level_of(file, at, reply)
        elif key.casefold() == "aper?":
            metadata["speed"] = reply.partition(",")[0].casefold()
        elif key.casefold() == "*idn?":
            metadata.update(zip(_IDENTITY, map(str.strip, reply.split(",", 3)), strict=False))
    sweep = Sweep(len(header), function_columns(mode), Dialect(","), _STATUSES)
    return read_sweep(file, sweep, metadata, _NAME)


FORMAT = Format(
    _NAME,
    "GW Instek LCR-6000, PC-logged replies",
    _recognises,
    _read,
    ",",
    looks="`# FUNC? => Cp-D`, then frequency, primary, secondary, status",
)
