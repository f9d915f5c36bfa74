"""A frequency sweep as a plain table: `frequency_Hz,Cp_F,D`.

Usage
-----
Named `lcr_csv`; detected by a row of labels that starts with a frequency and goes on with a
capacitance, a resistance or an impedance.

Format
------
Perhaps lines that start with `#`, then one row of labels and rows of numbers, parted by commas,
semicolons or tabs; decimal commas where no comma parts the fields. The labels are `frequency` and
one of the pairs `Cp,D`, `Cp,Rp`, `Cs,D`, `Cs,Rs`, `R,X`, `Z,theta`; each carries its unit
(`Cp_pF`, `theta_deg`; D has none), or all units stand in a row of their own below. A bare `C` is
refused: it may be in parallel or in series. A last column `status` may say `OK`, `OUT` or `OVER`.
Readings of 9.9E37 or beyond are kept as written and marked in the column `over_range`.

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
`mode`; lines of the form `# key => reply` or `# key: value` under their key; other remarks under
`remark`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.core.register_columns import split_unit
from deamat.core.units import known, si_factor
from deamat.formats.cells import Dialect
from deamat.formats.format import Format
from deamat.formats.header import bare_unit, split
from deamat.formats.lcr_sweep import PAIRS, Column, Sweep, read_sweep
from deamat.formats.rawfile import RawFile

_NAME = "lcr_csv"
_STATUSES = {"ok": True, "out": False, "over": False}
_FREQUENCY = ("frequency", "freq", "f")
_STATUS = "status"
# label in lower case -> what it is; `c` and its kind are known in order to be refused by name
_LABELS = {
    "cp": "Cp", "cs": "Cs", "c": "C", "capacitance": "C", "d": "D", "tan_delta": "D",
    "loss_tangent": "D", "rp": "Rp", "rs": "Rs", "r": "R", "x": "X", "z": "Z", "theta": "theta",
    "phase": "theta",
}  # fmt: skip
_PRIMARIES = ("Cp", "Cs", "C", "R", "Z")
_MODES = {("Z", "theta"): "Z-theta-rad"} | {
    tuple(mode.split("-")): mode for mode in PAIRS if "theta" not in mode
}
_SI = {"Cp": "F", "Cs": "F", "D": "1", "Rp": "ohm", "Rs": "ohm", "R": "ohm", "X": "ohm",
       "Z": "ohm", "theta": "rad"}  # fmt: skip
_REMARK = re.compile(r"#\s*([^=>:]+?)\s*(?:=>|:)\s*(.+?)\s*")


def _start(head: Sequence[str]) -> int:
    """Line of the labels, counted from 0."""
    for at, line in enumerate(head):
        if line.strip() and not line.startswith("#"):
            return at
    return len(head) - 1


def _delimiter(line: str) -> str:
    return max((";", "\t", ","), key=line.count)


def _labels(line: str) -> list[tuple[str, str | None]]:
    """Part each label into its name and its unit."""
    return [split_unit(cell) for cell in split(line, _delimiter(line))]


def _meaning(stem: str) -> str:
    return _LABELS.get(stem.casefold(), stem)


def _recognises(head: list[str]) -> bool:
    labels = [stem for stem, _ in _labels(head[_start(head)])]
    return (
        len(labels) >= 3
        and labels[0].casefold() in _FREQUENCY
        and _meaning(labels[1]) in _PRIMARIES
    )


def _read(file: RawFile) -> Recording:
    head = file.head
    at = _start(head)
    delimiter = _delimiter(head[at])
    labels = _labels(head[at])
    has_status = len(labels) > 3 and labels[-1][0].casefold() == _STATUS
    numeric: Sequence[tuple[str, str | None]] = labels[:-1] if has_status else labels
    mode = _mode(file, at, [stem for stem, _ in numeric])
    first = at + 1
    below = split(head[first], delimiter) if first < len(head) else []
    if below and all(known(bare_unit(cell)) for cell in below[: len(numeric)]):
        numeric = _with_row(file, first, numeric, [bare_unit(cell) for cell in below])
        first += 1
    columns = _columns(file, at, mode, numeric)
    decimal = "." if delimiter == "," else file.decimal_mark(first)
    sweep = Sweep(first, columns, Dialect(delimiter, decimal), _STATUSES if has_status else None)
    return read_sweep(file, sweep, {**_remarks(head[:at]), "mode": mode}, _NAME)


def _mode(file: RawFile, at: int, stems: Sequence[str]) -> str:
    """Tell the pair from the labels."""
    if len(stems) != 3:
        raise RawFileError(
            file.path, f"{len(stems)} columns of numbers", line=at + 1, value=", ".join(stems),
            hint="a sweep is frequency and one pair, such as frequency_Hz,Cp_F,D",
        )  # fmt: skip
    found = tuple(map(_meaning, stems[1:]))
    if "C" in found:
        raise RawFileError(
            file.path,
            "the label does not say whether the capacitance is in parallel or in series",
            line=at + 1,
            column=2 + found.index("C"),
            value=stems[1 + found.index("C")],
            hint="name the column Cp_F or Cs_F, as the meter was set",
        )
    if found not in _MODES:
        pairs = "; ".join(",".join(pair) for pair in _MODES)
        raise RawFileError(
            file.path, "not a pair that gives a permittivity", line=at + 1, column=2,
            value=",".join(found), hint=f"known pairs: {pairs}",
        )  # fmt: skip
    return _MODES[found]


def _with_row(
    file: RawFile,
    at: int,
    labels: Sequence[tuple[str, str | None]],
    row: Sequence[str],
) -> Sequence[tuple[str, str | None]]:
    """Take the units from the row below the labels, which must not contradict the labels."""
    result = []
    for column, ((stem, unit), below) in enumerate(zip(labels, row, strict=False), start=1):
        if unit is not None and si_factor(unit) != si_factor(below):
            raise RawFileError(
                file.path, f"the label says {unit}, the row of units below says otherwise",
                line=at + 1, column=column, value=below, hint="state each unit once",
            )  # fmt: skip
        result.append((stem, unit or below))
    return result


def _columns(
    file: RawFile, at: int, mode: str, labels: Sequence[tuple[str, str | None]]
) -> tuple[Column, ...]:
    """Name the columns, insisting on a unit of the right kind over each."""
    names = ("frequency_Hz", *(name for name, _ in PAIRS[mode]))
    wanted = ("Hz", *(_SI[_meaning(stem)] for stem, _ in labels[1:]))
    columns = []
    for column, ((stem, unit), name, si) in enumerate(
        zip(labels, names, wanted, strict=True), start=1
    ):
        used = "1" if unit is None and si == "1" else unit
        if used is None or si_factor(used)[0] != si:
            found = "without a unit" if used is None else f"in {used}"
            raise RawFileError(
                file.path, f"a column {found}, where a unit of {si} belongs", line=at + 1,
                column=column, value=stem, hint=f"name the column {stem}_{si}",
            )  # fmt: skip
        columns.append(Column(name, stem, used))
    return tuple(columns)


def _remarks(lines: Sequence[str]) -> dict[str, str]:
    kept: dict[str, str] = {}
    for line in lines:
        found = _REMARK.fullmatch(line)
        key, text = (found[1], found[2]) if found else ("remark", line.lstrip("# ").strip())
        if text:
            kept[key] = f"{kept[key]}; {text}" if key in kept else text
    return kept


FORMAT = Format(
    _NAME,
    "LCR sweep as a plain table",
    _recognises,
    _read,
    tabular=True,
    looks="`frequency_Hz,Cp_F,D` and its sisters",
)
