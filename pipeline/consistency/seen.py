"""What reading a file leaves behind, to hold it against its row and against other files."""

from __future__ import annotations

from dataclasses import dataclass

from deamat.consistency.statements import against_row, label_of
from deamat.core.flags import Flag
from deamat.core.recording import Recording, Specimen
from deamat.estimators.rows import Sketch, has_noise, sketch

_SET = frozenset(("time_s", "frequency_Hz", "shear_rate_per_s"))  # by the instrument


@dataclass(frozen=True, slots=True)
class Seen:
    """One file, once it was read.

    Parameters
    ----------
    sketch : of its rows
    label : the specimen's name as the export writes it, empty where it writes none
    flags : where its row contradicts it
    """

    sketch: Sketch
    label: str
    flags: tuple[Flag, ...]


def look(recording: Recording, specimen: Specimen) -> Seen:
    """Hold a recording against its row, and keep what comparing it with others takes."""
    return Seen(
        sketch([column for name, column in recording.columns.items() if name != "time_s"]),
        label_of(recording),
        against_row(recording, specimen),
    )


def holds_noise(recording: Recording) -> bool:
    """Say whether any column but what is set scatters: no two tests then write the same rows."""
    return any(has_noise(column) for name, column in recording.columns.items() if name not in _SET)
