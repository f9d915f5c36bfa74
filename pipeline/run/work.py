"""What a worker does: one specimen's bytes to a Measurement, or to the reason why not."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from deamat.consistency.seen import Seen, look
from deamat.core.channels import channels_of
from deamat.core.errors import ConfigError, RawFileError
from deamat.core.ledger import Failure
from deamat.core.recording import Recording, Specimen
from deamat.core.records import Flag, Measurement
from deamat.core.register import ENCODING, SHEET
from deamat.core.technique import Context
from deamat.formats.detect import by_name, detect, insist_on_channels
from deamat.formats.documentation import contradictions
from deamat.formats.exports import Export
from deamat.formats.format import Format
from deamat.formats.rawfile import RawFile, read_raw
from deamat.run.boundary import attempt, killed
from deamat.techniques import TECHNIQUES

FILES_PER_TASK = 25
_TINIEST, _LARGEST = 1e-60, 1e60  # meters write 9.9e37 for a reading out of range


@dataclass(frozen=True, slots=True)
class Task:
    """One specimen to be measured.

    Parameters
    ----------
    sha256 : of its file as planned; a file that changed since is an error, not a surprise
    changed : file content differs from the manifest
    exports : forms that the laboratory declared for the technique
    """

    raw: Path
    specimen: Specimen
    context: Context
    sha256: str | None
    changed: bool
    registered: bool
    ends_open: bool
    stated_units: Mapping[str, str]
    exports: tuple[Export, ...] = ()

    @property
    def subject(self) -> str:
        """How the account of the run calls it."""
        return self.specimen.place

    @property
    def files(self) -> tuple[str, ...]:
        """What it rests on."""
        return (source_of(self.specimen),)


@dataclass(frozen=True, slots=True)
class Reduced:
    """What came of a task: a measurement or an error, and the reader that was used.

    Parameters
    ----------
    seen : what of its file is held against its row and other files; None without a measured file
    """

    measurement: Measurement | None
    error: RawFileError | None
    reader: str
    seen: Seen | None = None


def attempt_one(task: Task) -> Reduced | Failure:
    """Read and reduce one specimen; anything that nobody foresaw is a failure of it alone."""
    return attempt("measurement", task.subject, task.files, partial(reduce_one, task))


def lost(task: Task) -> Failure:
    """Say that a specimen's worker process ended over it."""
    return killed("measurement", task.subject, task.files)


def reduce_one(task: Task) -> Reduced:
    """Read and reduce one specimen; a bad file is an answer here, not an exception."""
    technique = TECHNIQUES[task.specimen.technique]
    reader = "none"
    try:
        recording = None
        if task.specimen.file is not None:
            recording = _read(task, task.specimen.file)
            reader = recording.source.reader
        measurement = technique.reduce(task.specimen, recording, task.context)
    except RawFileError as error:
        return Reduced(None, error, reader)
    seen = None if recording is None else look(recording, task.specimen)
    return Reduced(_flagged(measurement, recording, task), None, reader, seen)


def source_of(specimen: Specimen) -> str:
    """Name the file that a specimen's values come from: its own, else the register."""
    return specimen.file or specimen.register


def _read(task: Task, path: str) -> Recording:
    data, notes = read_raw(task.raw, path), task.specimen.notes
    file = RawFile(
        path, data, task.ends_open, task.specimen.technique, notes.get(SHEET, ""),
        notes.get(ENCODING, ""), channels_of(task.specimen),
    )  # fmt: skip
    if file.sha256 != task.sha256:
        raise RawFileError(path, "the file changed while it was being read", hint="run again")
    recording = _format(task.specimen, file, task.exports).read(file)
    insist_on_channels(file, recording)
    _insist_on_scale(recording)
    if task.changed:
        campaign = task.specimen.campaign
        raise RawFileError(
            path,
            "file content differs from the manifest",
            hint=f"restore it, or look at `deamat register {campaign}` and accept this change",
        )
    return recording


def _insist_on_scale(recording: Recording) -> None:
    """Refuse numbers that nothing measures: their squares and ratios cannot be computed.

    Raises
    ------
    RawFileError : a number above zero that is far smaller or larger than any measured one in SI
    """
    source = recording.source
    for name, column in recording.columns.items():
        size = np.abs(column)
        wrong = np.flatnonzero(
            (size > _LARGEST) & np.isfinite(size) | (size < _TINIEST) & (size > 0)
        )
        if wrong.size:
            at = int(wrong[0])
            by_line = source.last_line - source.first_line + 1 == column.size
            line = source.first_line + at if by_line else None
            reason = f"{name} is {column[at]:g} in row {at + 1}, which nothing measures"
            raise RawFileError(source.path, reason, line, hint="restore the file or exclude it")


def _format(specimen: Specimen, file: RawFile, exports: Sequence[Export]) -> Format:
    """The format that the register names, or the one that the file shows."""
    if specimen.format is None:
        return detect(file, exports)
    try:
        return by_name(specimen.format, exports)
    except ConfigError as error:
        raise RawFileError(
            specimen.register, str(error), specimen.line, value=specimen.format
        ) from error


def _flagged(measurement: Measurement, recording: Recording | None, task: Task) -> Measurement:
    """Hand what was noticed about the file on to every value that rests on it."""
    if recording is None:
        return measurement
    flags = [*recording.flags, *contradictions(task.stated_units, recording.column_units)]
    if not task.registered:
        flags.append(Flag("unregistered", "the file is not in its campaign's manifest"))
    values = tuple(
        replace(v, flags=tuple(dict.fromkeys([*v.flags, *flags]))) for v in measurement.values
    )
    return replace(measurement, values=values)
