"""LabVIEW measurements in binary form (.tdms), read with npTDMS.

Usage
-----
Named `tdms`; detected by the bytes `TDSm` at the start.

Format
------
Groups of channels; exactly one group may hold what the technique needs. A channel's name is its
label, its property `unit_string` the unit; the time is a channel, or comes from `wf_increment` and
`wf_start_offset`. Channels that are used must have one length and one time. A file that npTDMS
warns of (cut, its last segment not closed) is refused: it would be read in part. Scaling that the
file declares is applied, once.

Columns
-------
As of `plain`.

Uncertainties
-------------
None in the file.

Metadata
--------
`group`; the properties of file and group as text; `columns not used`.
"""

from __future__ import annotations

import io
import logging
import struct
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.choice import Choice, choose
from deamat.formats.format import Format
from deamat.formats.plain_rows import Rows, recording_from
from deamat.formats.plain_tables import refused
from deamat.formats.rawfile import RawFile
from deamat.formats.structure import Heading, split_label
from deamat.formats.vocabulary import ASKED

MAGIC = b"TDSm"
_AGAIN = "close the file in LabVIEW and copy it again, or export it as text"
# What npTDMS raises on damaged files (6000 were spoilt), and what other bytes may lead it into. It
# checks no types: a flipped byte makes a property or a scale of another kind, which is used only
# when a channel is read.
_DAMAGED = (
    ValueError, KeyError, IndexError, TypeError, AttributeError, struct.error, NotImplementedError,
    ArithmeticError, MemoryError, EOFError, OSError,
)  # fmt: skip
_SAID = 100  # characters of a warning: it may quote the file
_TIME, _OFFSET, _UNIT = "wf_increment", "wf_start_offset", "unit_string"


@dataclass(frozen=True, slots=True)
class Group:
    """The channels of one group as columns.

    Parameters
    ----------
    columns : label to unit and values, shape (n,) of each its own n
    """

    name: str
    columns: Mapping[str, tuple[str, FloatArray]]
    metadata: Mapping[str, str]


def _read(file: RawFile) -> Recording:
    found: list[tuple[Group, Choice]] = []
    nearest: Choice | None = None
    for group in _groups(file):
        choice = _chosen(file, group)
        if choice.faults:
            nearest = max(filter(None, (nearest, choice)), key=lambda one: one.labelled)
        else:
            found.append((group, choice))
    if not found:
        error = refused(file, nearest)
        raise RawFileError(
            file.path, f"a LabVIEW measurement (.tdms): {error.reason}", hint="name the channels "
            "after what they are, with their units, or name them in the register "
            "(voltage_channel, current_channel)",
        )  # fmt: skip
    if len(found) > 1:
        names = ", ".join(group.name for group, _ in found)
        raise RawFileError(
            file.path, f"several groups hold what is needed: {names}",
            hint="one file holds one run: write each run to a file of its own",
        )  # fmt: skip
    group, choice = found[0]
    recording = recording_from(
        file, choice, _rows(file, group, choice), "binary", {"group": group.name, **group.metadata}
    )
    return replace(recording, source=replace(recording.source, reader="tdms"))


def _chosen(file: RawFile, group: Group) -> Choice:
    """Understand the channels of a group for the technique, or for the one that they fit best."""
    parted = [split_label(label) for label in group.columns]
    units = [unit for unit, _ in group.columns.values()]
    labels = tuple(part[0] if not unit else label for label, unit, part in zip(
        group.columns, units, parted, strict=True
    ))  # fmt: skip
    said = tuple(unit or part[1] for unit, part in zip(units, parted, strict=True))
    heading = Heading("\t", 0, 0, labels, said)
    techniques = [file.technique] if file.technique in ASKED else list(ASKED)
    choices = [choose(heading, technique, file.channels) for technique in techniques]
    return next((one for one in choices if not one.faults), None) or max(
        choices, key=lambda one: one.labelled
    )


def _rows(file: RawFile, group: Group, choice: Choice) -> Rows:
    arrays = [values for _, values in group.columns.values()]
    values = {taken.name: arrays[taken.column] for taken in choice.used}
    lengths = {len(one) for one in values.values()}
    if len(lengths) > 1 or 0 in lengths:
        said = ", ".join(f"{taken.label} {len(values[taken.name])}" for taken in choice.used)
        raise RawFileError(
            file.path, f"channels of different lengths or without samples: {said}",
            hint="record them together",
        )  # fmt: skip
    for taken in choice.used:
        wrong = np.flatnonzero(~np.isfinite(values[taken.name]))
        if wrong.size:
            raise RawFileError(
                file.path, f"{taken.label} holds {wrong.size} values that are no numbers",
                int(wrong[0]) + 1, hint="record the ramp again, or exclude the file",
            )  # fmt: skip
    return Rows(values, {}, 1, lengths.pop())


def _groups(file: RawFile) -> list[Group]:
    """Read every group.

    Raises
    ------
    RawFileError : damaged, cut, or read in part only
    """
    from nptdms import TdmsFile

    with _warnings() as said:
        try:
            groups = [_group(one) for one in TdmsFile.read(io.BytesIO(file.data)).groups()]
        except _DAMAGED as error:
            raise RawFileError(
                file.path, "a damaged LabVIEW measurement (.tdms)", hint=_AGAIN
            ) from error
    if said:
        raise RawFileError(
            file.path,
            f"a LabVIEW measurement (.tdms) that is not whole: {said[0][:_SAID]}",
            hint=_AGAIN,
        )
    return groups


def _group(group: Any) -> Group:
    columns: dict[str, tuple[str, FloatArray]] = {}
    steps: set[tuple[float, float]] = set()
    count = 0
    for channel in group.channels():
        properties = channel.properties
        values = channel[:]
        if not np.issubdtype(values.dtype, np.number):
            continue  # texts and stamps are notes
        columns[channel.name] = str(properties.get(_UNIT, "")), np.asarray(values, np.float64)
        if step := float(properties.get(_TIME, 0.0)):
            steps.add((step, float(properties.get(_OFFSET, 0.0))))
            count = max(count, len(values))
    if len(steps) == 1 and not any(label.casefold() == "time" for label in columns):
        step, offset = steps.pop()
        columns["Time"] = "s", offset + step * np.arange(count, dtype=np.float64)
    notes = {str(key): str(value) for key, value in group.properties.items()}
    return Group(str(group.name), columns, notes)


@contextmanager
def _warnings() -> Iterator[list[str]]:
    """Collect what npTDMS logs, and keep it off the terminal."""
    said: list[str] = []

    class Collect(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            said.append(record.getMessage())

    manager = logging.Logger.manager
    names = [name for name in manager.loggerDict if name.partition(".")[0] == "nptdms"]
    loggers = [logging.getLogger(name) for name in names]  # each has a handler of its own
    before = [(logger.handlers, logger.propagate) for logger in loggers]
    for logger in loggers:
        logger.handlers, logger.propagate = [Collect(logging.WARNING)], False
    try:
        yield said
    finally:
        for logger, (handlers, propagate) in zip(loggers, before, strict=True):
            logger.handlers, logger.propagate = handlers, propagate


FORMAT = Format(
    "tdms",
    "LabVIEW measurement, binary",
    lambda _: False,
    _read,
    looks="groups of channels with `unit_string` and `wf_increment`",
    seen="npTDMS, its reader and writer",
)
