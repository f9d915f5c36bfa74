"""LabVIEW measurement files (`.lvm`), text form, of one block of channels over time.

Usage
-----
Named `lvm`; detected by a first line `LabVIEW Measurement`.

Format
------
Header lines of a key and its values, parted by tabs, `***End_of_Header***`, the header of the
channels (`Channels`, `Samples`, `Y_Unit_Label`, `X_Dimension`, `Delta_X`), the same mark again, the
labels `X_Value`, one for each channel and `Comment`, then rows. With `X_Columns One` the first
column is the time in seconds, with `X_Columns No` it is X0 + row * Delta_X. The unit of a channel
is that of `Y_Unit_Label`; a file without it is refused. One block to a file (`Multi_Headings No`);
fewer rows than `Samples` are a cut file.

Columns
-------
`time_s [s]`, `voltage_V [V]`, and further channels that the technique knows by label or by unit.

Uncertainties
-------------
None in the file.

Metadata
--------
Every header line under its key.
"""

from __future__ import annotations

from deamat.core.errors import RawFileError
from deamat.core.number_grammar import is_number
from deamat.core.recording import Recording
from deamat.formats.format import Format
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.rewritten import CUT, lines_of, read_rewritten

_NAME = "lvm"
_START, _END = "LabVIEW Measurement", "***End_of_Header***"
_SEPARATORS = {"Tab": "\t", "Comma": ","}


def _recognises(head: Head) -> bool:
    return bool(head) and head[0].strip(" \t,") == _START


def _read(file: RawFile) -> Recording:
    lines = lines_of(file)
    marks = [at for at, line in enumerate(lines) if line.startswith(_END)]
    if not _recognises(file.head) or len(marks) != 2:
        raise RawFileError(
            file.path, f"{max(len(marks) - 1, 0)} blocks of channels where one belongs",
            value=lines[0], hint="write one ramp to one file, without further headings",
        )  # fmt: skip
    said = {line.split("\t")[0]: line.split("\t")[1:] for line in lines[: marks[1]]}
    separator = _SEPARATORS.get("".join(said.get("Separator", ["Tab"])[:1]).strip(), "\t")
    if separator != "\t":
        said = {line.split(separator)[0]: line.split(separator)[1:] for line in lines[: marks[1]]}
    step = _step(file, said)
    _insist(file, said, "X_Dimension", "Time")
    names = marks[1] + 1
    labels = lines[names].split(separator)[1:] if names < len(lines) else []
    labels = labels[: len(labels) - (labels[-1:] == ["Comment"])]
    units = [unit.strip() for unit in said.get("Y_Unit_Label", [])]
    over = [f"{label} ({unit})" if unit else label for label, unit in zip(
        labels, [*units, *[""] * len(labels)], strict=False
    )]  # fmt: skip
    rows = [
        _row(row.split(separator)[: len(labels) + 1], at, step, separator) if row.strip() else row
        for at, row in enumerate(lines[names + 1 :])
    ]
    _insist_on_samples(file, said, len([row for row in rows if row.strip()]), len(lines))
    above = [line.replace(separator, ": ", 1).replace(separator, " ") for line in lines[:names]]
    return read_rewritten(file, [*above, separator.join(["Time (s)", *over]), *rows], _NAME)


def _step(file: RawFile, said: dict[str, list[str]]) -> tuple[float, float] | None:
    """Return start and step of the time where it has no column."""
    if "".join(said.get("X_Columns", ["One"])[:1]).strip() != "No":
        _insist(file, said, "X_Columns", "One")
        return None
    values = []
    for key in ("X0", "Delta_X"):
        texts = {text.strip().replace(",", ".") for text in said.get(key, []) if text.strip()}
        text = texts.pop() if len(texts) == 1 else ""
        if not is_number(text):
            raise RawFileError(
                file.path, f"no one {key} for all channels", hint="write it with X_Columns One"
            )
        values.append(float(text))
    return values[0], values[1]


def _row(cells: list[str], at: int, step: tuple[float, float] | None, separator: str) -> str:
    if step is not None:
        decimal = "," if any("," in cell for cell in cells) else "."
        cells = [repr(step[0] + at * step[1]).replace(".", decimal), *cells[1:]]
    return separator.join(cells)


def _insist(file: RawFile, said: dict[str, list[str]], key: str, wanted: str) -> None:
    found = "".join(said.get(key, [wanted])[:1]).strip()
    if found != wanted:
        raise RawFileError(
            file.path, f"{key} is not {wanted}", value=found,
            hint=f"write the file again with {key} {wanted}",
        )  # fmt: skip


def _insist_on_samples(file: RawFile, said: dict[str, list[str]], rows: int, line: int) -> None:
    text = "".join(said.get("Samples", [])[:1]).strip()
    if text.isascii() and text.isdigit() and rows < int(text):
        raise RawFileError(
            file.path, f"{rows} rows where the header states {text} samples; {CUT}", line,
            hint="write the file again",
        )  # fmt: skip


FORMAT = Format(
    _NAME,
    "LabVIEW measurement, text",
    _recognises,
    _read,
    looks="`***End_of_Header***`, `Y_Unit_Label`, `X_Value`",
    seen="public scripts and files of NI LabVIEW text",
)
