"""One file after the other: read as every technique that it may belong to, never registered."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from pydantic import BaseModel

from deamat.core.campaign import CAMPAIGN_FILE, MANIFEST_FILE
from deamat.core.channels import CHANNEL_COLUMNS, channels_of
from deamat.core.config import Config, Exclusions, load_config
from deamat.core.errors import ConfigError, RawFileError
from deamat.core.instruments import Instruments
from deamat.core.ledger import Failure
from deamat.core.recording import Recording
from deamat.core.register import ENCODING, REGISTER_FILES, SHEET, split_sheet
from deamat.core.sheets import is_workbook
from deamat.formats.detect import KNOWN_FORMS, by_name, detect, insist_on_channels, is_binary
from deamat.formats.exports import load_exports
from deamat.formats.format import Format
from deamat.formats.rawfile import RawFile, read_raw
from deamat.formats.vocabulary import ASKED
from deamat.formats.workbook import sheets_with_a_table
from deamat.run.boundary import attempt
from deamat.run.check.found import Checked, Column
from deamat.run.check.nearest import nearest_form, table_found
from deamat.run.check.reading import Asked, reading_of
from deamat.run.check.row import Place, of_options, place_of, registered
from deamat.run.recognise import recordings_of
from deamat.techniques import TECHNIQUES

_ROWS = 3
_NOT_DATA = (CAMPAIGN_FILE, MANIFEST_FILE, *REGISTER_FILES)


def check_files(paths: Sequence[Path], asked: Asked) -> Iterator[Checked]:
    """Look at files, and at every data file in folders.

    Raises
    ------
    ConfigError : the configuration does not hold, or there is no such technique or format
    """
    config = _config(asked.config)
    asked = replace(asked, exports=load_exports(asked.config, KNOWN_FORMS))
    if asked.technique and asked.technique not in TECHNIQUES:
        raise ConfigError(
            f"no technique is called {asked.technique!r}; there are {', '.join(TECHNIQUES)}"
        )
    if asked.format:
        by_name(asked.format, asked.exports)
    for path in paths:
        for one in [place for file in _below(path) for place in _places(file, asked, config)]:
            checked = attempt("check", str(one), (str(one),), partial(_check, one, asked, config))
            if isinstance(checked, Failure):
                said = f"the program failed over it: {checked.error}; please report it"
                checked = Checked(str(one), read=False, failed=True, faults=(said,))
            yield checked


def _config(folder: Path) -> Config:
    sections: dict[str, type[BaseModel]] = {key: t.config for key, t in TECHNIQUES.items()}
    if folder.is_dir():
        return load_config(folder, sections)
    methods = {key: section() for key, section in sections.items()}
    return Config({}, Instruments(), Exclusions(), methods, {})


def _below(path: Path) -> Iterator[Path]:
    """A file itself; of a folder every file that may hold data."""
    if not path.is_dir():
        yield path
        return
    for one in sorted(path.rglob("*")):
        hidden = any(part.startswith(".") for part in one.relative_to(path).parts)
        if one.is_file() and not hidden and one.name not in _NOT_DATA:
            yield one


def _places(path: Path, asked: Asked, config: Config) -> list[Path]:
    """A file, or each sheet or group of columns in it that is a specimen of its own."""
    name, within = split_sheet(str(path))
    if within or not Path(name).is_file():
        return [path]
    try:
        place = place_of(Path(name), TECHNIQUES)
        technique = asked.technique or place.technique
        rows = registered(place, TECHNIQUES[technique], config) if place.technique else ()
        found = [row.notes[SHEET] for row in rows if SHEET in row.notes]
        data = read_raw(Path(name).parent, Path(name).name)
        if not found and is_workbook(data):
            found = sheets_with_a_table(RawFile(name, data, technique=technique))
    except RawFileError:
        return [path]  # said when it is looked at
    return [Path(f"{path}#{one}") for one in found] if len(found) > 1 else [path]


def _check(path: Path, asked: Asked, config: Config) -> Checked:
    name, within = split_sheet(str(path))
    if Path(name).name in _NOT_DATA:
        said = "it describes a campaign and holds no curve; give the data files"
        return Checked(str(path), read=False, faults=(said,))
    try:
        place = replace(place_of(Path(name), TECHNIQUES), within=within)
        data = read_raw(Path(name).parent, Path(name).name)
    except RawFileError as error:
        reason = "there is no such file" if not Path(name).exists() else error.reason
        return Checked(str(path), read=False, faults=(reason,))
    file = RawFile(str(path), data, place.info.ends_open, place=within)
    technique = asked.technique or place.technique
    tried = [key for key in ([technique] if technique else ASKED) if key in ASKED]
    found, faults = recordings_of(
        file, tried, lambda one: _read(one, asked, place, config), named=bool(technique)
    )
    if not found:
        return _unread(file, technique, faults, asked)
    return _read_well(file, found, asked, place, config)


def _read(file: RawFile, asked: Asked, place: Place, config: Config) -> Recording:
    rows = registered(place, TECHNIQUES[file.technique], config) if place.technique else ()
    named = asked.format or next((row.format for row in rows if row.format), None)
    if rows:
        notes = rows[0].notes
        within = file.place or notes.get(SHEET, "")
        file = replace(file, place=within, declared=notes.get(ENCODING, ""))
    said = {name: cell for name, cell in asked.columns.items() if name in CHANNEL_COLUMNS}
    row = of_options(said, TECHNIQUES[file.technique], config) if said else next(iter(rows), None)
    if row is not None:
        file = replace(file, channels=channels_of(row))
    recording = _form_of(file, named, asked).read(file)
    insist_on_channels(file, recording)
    return recording


def _form_of(file: RawFile, named: str | None, asked: Asked) -> Format:
    return by_name(named, asked.exports) if named else detect(file, asked.exports)


def _unread(file: RawFile, technique: str, errors: Sequence[RawFileError], asked: Asked) -> Checked:
    """Say all that is wrong with a file, and which form it comes nearest to."""
    nearest = ""
    try:
        form = _form_of(replace(file, technique=technique), asked.format or None, asked)
        nearest = f"{form.name} ({form.title})"
        form.read(replace(file, technique=technique))
        error = RawFileError(file.path, "it holds nothing that a technique looks at")
    except RawFileError as fault:
        error = fault
    hint = error.hint
    if not nearest and not error.column and not is_binary(file):
        nearest = nearest_form(file) or table_found(file)
        hint += f"; or declare its form: deamat learn {shlex.quote(file.path)}"
    every = [error, *error.others, *(errors if technique else ())]
    faults = dict.fromkeys(map(_said, every))
    return Checked(
        file.path, read=False, faults=tuple(faults), hint=hint, nearest=nearest,
        encoding=_encoding(file),
    )  # fmt: skip


def _encoding(file: RawFile) -> str:
    try:
        return file.encoding
    except RawFileError:
        return ""


def _said(error: RawFileError) -> str:
    """A fault with its place in the file, without the file's name."""
    return f"{error.within}: {error.reason}{error.found}".removeprefix(": ")


def _read_well(
    file: RawFile, found: Mapping[str, Recording], asked: Asked, place: Place, config: Config
) -> Checked:
    first = next(iter(found.values()))
    source = first.source
    readings = tuple(
        reading_of(key, recording, asked, place, config) for key, recording in found.items()
    )
    measured = tuple(reading for reading in readings if reading.measured)
    form = _form(source.reader, asked)
    return Checked(
        file.path,
        read=True,
        encoding=source.encoding,
        form=source.reader,
        title=form.title if form else "",
        first_line=source.first_line,
        last_line=source.last_line,
        rows=_rows(file, source.first_line, source.reader),
        columns=tuple(_columns(first)),
        unused=first.metadata.get("columns not used", ""),
        readings=measured or readings,
    )


def _form(reader: str, asked: Asked) -> Format | None:
    try:
        return by_name(reader.split(",")[0].split(" (")[0], asked.exports)
    except ConfigError:
        return None


def _rows(file: RawFile, first: int, reader: str) -> tuple[str, ...]:
    if reader.startswith("workbook"):
        return ()
    lines = file.body[file.offset(first - 1) :].split(b"\n", _ROWS)[:_ROWS]
    return tuple(line.decode("utf-8", "replace").rstrip("\r") for line in lines if line.strip())


def _columns(recording: Recording) -> Iterator[Column]:
    """The columns; labels stand beside them where there is one for each."""
    labels = list(recording.column_units.items())
    paired = len(labels) == len(recording.columns)
    for at, (name, values) in enumerate(recording.columns.items()):
        label, unit = labels[at] if paired else ("", "")
        least, greatest = float(np.nanmin(values)), float(np.nanmax(values))
        yield Column(name, label, unit, float(values[0]), float(values[-1]), least, greatest)
