"""A form that a laboratory declared in `config/exports.toml`, read as a plain table.

Usage
-----
Named as its section; detected by the declared labels in one row (and by `starts_with`). A form
whose columns have numbers instead of labels and no `starts_with` is only taken where the register's
`format` names it.

Format
------
As declared: separator, decimal mark, encoding, lines of the labels and of the first row. A decimal
mark that is declared is not guessed at.

Columns
-------
The declared quantities; `time_s` from a sampling interval.

Uncertainties
-------------
None in the file.

Metadata
--------
Every line above the rows; `declared in`; `level_V` where it is declared.
"""

from __future__ import annotations

import codecs
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.core.sheets import is_workbook
from deamat.core.unit_spellings import unit_as_written
from deamat.core.units import si_factor
from deamat.formats.blocks import split
from deamat.formats.cells import looks_numeric
from deamat.formats.choice import HERTZ_PER_RADIAN, Choice, Taken
from deamat.formats.exports import EXPORTS_FILE, SEPARATORS, Export, ExportColumn
from deamat.formats.format import Format
from deamat.formats.plain_rows import recording_of
from deamat.formats.rawfile import RawFile
from deamat.formats.structure import Heading
from deamat.formats.vocabulary import ASKED, vocabulary
from deamat.formats.workbook import lines_of_sheets, read_chosen

WORKBOOK = "workbook"  # in place of a separator
_LOOKED_AT = 1000  # lines in which the labels stand
_START = 1 << 16  # bytes in which a form is detected
_BELOW = 8  # lines between labels and rows


def format_of(export: Export) -> Format:
    """Return a declared form as one of the forms."""

    def read(file: RawFile) -> Recording:
        return _read(file, export)

    form = export.form
    return Format(
        export.name, form.title or f"declared in config/{EXPORTS_FILE}", lambda _: False, read,
        SEPARATORS[form.separator], form.techniques,
    )  # fmt: skip


def is_declared(file: RawFile, export: Export) -> bool:
    """Say whether a file is of a declared form, by its labels and its first line."""
    form = export.form
    if file.technique and file.technique not in form.techniques:
        return False
    labelled = any(column.label for column in form.columns)
    if not (labelled or form.starts_with):
        return False
    if form.separator == WORKBOOK:
        return _is_declared_workbook(file, export)
    lines = _head(file, export)
    return (
        bool(lines)
        and lines[0].startswith(form.starts_with)
        and (not labelled or _labels(lines, export) is not None)
    )


def _is_declared_workbook(file: RawFile, export: Export) -> bool:
    if not is_workbook(file.data):
        return False
    try:
        sheets = lines_of_sheets(file)
    except RawFileError:
        return False
    wanted = [lines for name, lines in sheets.items() if file.sheet in ("", name)]
    return any(
        lines and lines[0].startswith(export.form.starts_with) and _labels(lines, export)
        for lines in wanted
    )


def _head(file: RawFile, export: Export) -> list[str]:
    """Decode the start of a file as declared; nothing where it is in another encoding."""
    decoder = codecs.getincrementaldecoder(_codec(export))()
    try:
        text = decoder.decode(file.data[:_START])  # the last character may be cut
    except UnicodeDecodeError:
        return []
    return text.replace("\r\n", "\n").split("\n")


def _codec(export: Export) -> str:
    return "utf-8-sig" if export.form.encoding == "utf-8" else export.form.encoding


def _lines(file: RawFile, export: Export) -> list[str]:
    """Decode a file as declared.

    Raises
    ------
    RawFileError : it is in another encoding
    """
    encoding = export.form.encoding
    try:
        text = file.data.decode(_codec(export))
    except UnicodeDecodeError as error:
        raise RawFileError(
            file.path, f"not in {encoding}, which {export.name} of config/{EXPORTS_FILE} declares",
            file.data.count(b"\n", 0, error.start) + 1, hint="correct its `encoding`",
        ) from error  # fmt: skip
    return text.replace("\r\n", "\n").split("\n")


def _labels(lines: Sequence[str], export: Export) -> tuple[int, list[str]] | None:
    """Find the row of labels, counted from 0."""
    form, separator = export.form, SEPARATORS[export.form.separator]
    wanted = {column.label for column in form.columns if column.label}
    within = range(min(_LOOKED_AT, len(lines)))
    if form.labels_line:
        within = range(form.labels_line - 1, min(form.labels_line, len(lines)))
    for at in within:
        cells = [cell.strip() for cell in split(lines[at], separator)]
        if wanted.issubset(cells):
            return at, cells
    return None


def _read(file: RawFile, export: Export) -> Recording:
    form = export.form
    if form.separator == WORKBOOK:
        return _completed(read_chosen(file, lambda lines: _in_sheet(file, lines, export)), export)
    lines = _lines(file, export)
    where = f"{export.name} of config/{EXPORTS_FILE}"
    if not lines[0].startswith(form.starts_with):
        raise RawFileError(
            file.path, f"the first line does not start with {form.starts_with!r}, as {where} "
            "declares", 1, value=lines[0][:60],
        )  # fmt: skip
    if _labels(lines, export) is None:
        raise RawFileError(
            file.path, f"no row holds the labels {_wanted(export)}, which {where} declares",
            form.labels_line or 1, hint="correct the labels there, or name another `format`",
        )  # fmt: skip
    choice, rows, end = _chosen(file, lines, export)
    ended = file.ends_open or form.ends_open or any(rows[end:]) or not rows[-1].strip()
    recording = recording_of(file, [*rows[:end], ""], form.encoding, choice, ended=ended)
    return _completed(recording, export)


def _in_sheet(file: RawFile, lines: Sequence[str], export: Export) -> Choice | None:
    """What a declared form means by the columns of a sheet; None where it is not of that form."""
    starts = bool(lines) and lines[0].startswith(export.form.starts_with)
    if not starts or _labels(lines, export) is None:
        return None
    return _chosen(file, lines, export)[0]


def _chosen(
    file: RawFile, lines: Sequence[str], export: Export
) -> tuple[Choice, Sequence[str], int]:
    """What is meant by the columns, the lines with their fields parted, and where the rows end.

    Raises
    ------
    RawFileError : no rows, or fewer columns than are declared
    """
    form = export.form
    where = f"{export.name} of config/{EXPORTS_FILE}"
    technique = file.technique if file.technique in form.techniques else form.techniques[0]
    found = _labels(lines, export)
    labelled = found is not None and any(column.label for column in form.columns)
    names, cells = found if found is not None and labelled else (form.first_line - 2, [])
    rows = _parted(lines, form.separator, max(names, 0))
    end = _end(rows, form.ends_before, names + 1)
    first = form.first_line - 1 if form.first_line else _first_row(rows, names, export, cells)
    if not 0 <= first < end:
        raise RawFileError(
            file.path, "no data rows where they are declared", min(first, len(rows)) + 1,
            hint=f"correct `first_line` of {where}",
        )  # fmt: skip
    width = len(split(rows[first], "|" if form.separator == "blanks" else _mark(export)))
    taken = [_taken(file, column, cells, width, where) for column in form.columns]
    return _choice(export, technique, taken, (names, first), cells, width), rows, end


def _wanted(export: Export) -> str:
    return ", ".join(column.label for column in export.form.columns if column.label)


def _mark(export: Export) -> str:
    return SEPARATORS[export.form.separator]


def _parted(lines: Sequence[str], separator: str, names: int) -> list[str]:
    """Part fields that any number of blanks separate by bars, from the labels on."""
    if separator != "blanks":
        return list(lines)
    below = ["|".join(split(line, " ")) for line in lines[names:]]
    return [*lines[:names], *below]


def _end(lines: Sequence[str], text: str, first: int) -> int:
    """Return the line below the rows, counted from 0."""
    for at in range(max(first, 0), len(lines)) if text else ():
        if lines[at].startswith(text):
            return at
    last = len(lines)
    while last > 0 and not lines[last - 1].strip():
        last -= 1
    return last


def _first_row(lines: Sequence[str], names: int, export: Export, cells: Sequence[str]) -> int:
    """Find the first line below the labels in which all columns that are used are numbers."""
    mark = "|" if export.form.separator == "blanks" else _mark(export)
    used = [_place(column, cells) for column in export.form.columns]
    for at in range(names + 1, min(names + 1 + _BELOW, len(lines))):
        row = split(lines[at], mark)
        if all(place < len(row) and looks_numeric(row[place]) for place in used):
            return at
    return names + 1


def _place(column: ExportColumn, cells: Sequence[str]) -> int:
    return column.number - 1 if column.number else cells.index(column.label)


def _taken(
    file: RawFile, column: ExportColumn, cells: Sequence[str], width: int, where: str
) -> Taken:
    at = _place(column, cells)
    if at >= width:
        raise RawFileError(
            file.path, f"the rows have {width} fields, and {where} declares column {at + 1}",
            hint="correct its `number`",
        )  # fmt: skip
    if column.label and cells.count(column.label) > 1:
        raise RawFileError(
            file.path, f"two columns are labelled {column.label!r}",
            hint=f"declare its `number` in {where}",
        )  # fmt: skip
    si = vocabulary()[column.quantity].unit
    unit = unit_as_written(column.unit, si) or "1"
    written, factor, offset = si_factor(unit)
    if column.quantity == "frequency_Hz" and written == "rad/s":
        factor *= HERTZ_PER_RADIAN
    label = column.label or f"column {column.number}"
    return Taken(column.quantity, at, label, column.unit, factor * column.factor, offset)


def _choice(
    export: Export, technique: str, taken: Sequence[Taken], lines: tuple[int, int],
    cells: Sequence[str], width: int,
) -> Choice:  # fmt: skip
    form = export.form
    need = set(form.need(technique) or ())
    takes = set(ASKED[technique].quantities)
    mark = "|" if form.separator == "blanks" else _mark(export)
    names, first = max(lines[0], 0), lines[1]
    labels = tuple((list(cells) + [""] * width)[:width])
    heading = Heading(mark, names, first, labels, ("",) * width)
    return Choice(
        heading, technique,
        tuple(one for one in taken if one.name in need),
        tuple(one for one in taken if one.name in takes - need),
        (), len(taken), decimal=form.decimal,
    )  # fmt: skip


def _completed(recording: Recording, export: Export) -> Recording:
    """Add what is declared beside the columns, and by whom the file was read."""
    form, columns = export.form, dict(recording.columns)
    if form.sampling_interval_s:
        rows = next(iter(columns.values())).size
        columns["time_s"] = form.sampling_interval_s * np.arange(rows, dtype=np.float64)
    said = {"declared in": f"config/{EXPORTS_FILE}, [{export.name}], version {export.version}"}
    if form.level_V:
        said["level_V"] = repr(form.level_V)
    within = recording.metadata.get("sheet", "")
    reader = f"{export.name} (config/{EXPORTS_FILE}, version {export.version})"
    return replace(
        recording,
        columns=columns,
        metadata={**recording.metadata, **said},
        source=replace(recording.source, reader=f"{reader}, sheet {within}" if within else reader),
    )
