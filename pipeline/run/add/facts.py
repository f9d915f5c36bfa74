"""What one file of a folder is, and what it says of its specimen."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from deamat.consistency.statements import label_of, operator_of, stated_days, stated_lengths
from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.core.sheets import is_workbook, read_sheets
from deamat.formats.detect import detect
from deamat.formats.exports import Export
from deamat.formats.rawfile import RawFile
from deamat.formats.vocabulary import ASKED
from deamat.run.other_folders import techniques_said
from deamat.run.recognise import recordings_of

_BEYOND_COMPRESSION = 1.0  # of strain
# columns that only a clock fills: when it was mixed must then be said
_CLOCKS = frozenset(("utc_s", "local_clock_s", "time_of_day_s"))
_CELL = "cell_thickness_m"  # of a spectrometer that states its film


@dataclass(frozen=True, slots=True)
class Facts:
    """What a file, or a sheet of it, says.

    Parameters
    ----------
    path : relative to the folder, with `#Sheet` where a workbook holds several tables
    sha256 : of its bytes
    techniques : it may belong to; one where that is sure
    label, operator, day : as the file writes them, empty where it does not or leaves it open
    lengths : SI name to value that the file states
    clocked : its times are those of a clock
    whole : it states its specimen's dimensions in a way of its own
    """

    path: str
    sha256: str
    techniques: tuple[str, ...]
    label: str
    operator: str
    day: str
    lengths: Mapping[str, float]
    clocked: bool
    whole: bool


def facts_of(
    file: RawFile, technique: str, exports: Sequence[Export], folder: str = ""
) -> list[Facts]:
    """Look at a file; of a workbook with several tables at each sheet.

    Parameters
    ----------
    technique : to which somebody says that it belongs, empty where nobody does
    exports : forms that the laboratory declares
    folder : name of the folder that was given, which may say the technique

    Raises
    ------
    RawFileError : no technique finds in it what it looks at
    """
    asked = (technique,) if technique else tuple(ASKED)

    def read(one: RawFile) -> Recording:
        return detect(one, exports).read(one)

    found, faults = recordings_of(file, asked, read)
    if found:
        return [_facts(file, found, folder)]
    by_sheet = list(_of_sheets(file, asked, read, folder))
    if by_sheet:
        return by_sheet
    for fault in faults:
        raise fault
    raise RawFileError(file.path, "it holds nothing that a technique looks at")


def _of_sheets(
    file: RawFile, asked: Sequence[str], read: Callable[[RawFile], Recording], folder: str
) -> Iterator[Facts]:
    if not is_workbook(file.data):
        return
    for name, _ in read_sheets(file.data, file.path):
        found, _ = recordings_of(replace(file, place=name), asked, read)
        if found:
            yield _facts(replace(file, path=f"{file.path}#{name}"), found, folder)


def _facts(file: RawFile, found: Mapping[str, Recording], folder: str) -> Facts:
    techniques = _among(f"{folder}/{file.path}", found)
    recording = found[techniques[0]]
    days = {day for _, several in stated_days(recording.metadata) for day in several}
    return Facts(
        path=file.path,
        sha256=file.sha256,
        techniques=techniques,
        label=label_of(recording),
        operator=operator_of(recording),
        day=next(iter(days)).isoformat() if len(days) == 1 else "",
        lengths=_lengths(recording),
        clocked=bool(_CLOCKS & set(recording.columns)),
        whole=_CELL in recording.metadata,
    )


def _lengths(recording: Recording) -> dict[str, float]:
    """Take the lengths that a file states once, or the same each time."""
    told: dict[str, set[float]] = {}
    for stated in stated_lengths(recording.metadata):
        told.setdefault(stated.name, set()).add(stated.value)
    return {name: next(iter(values)) for name, values in told.items() if len(values) == 1}


def _among(path: str, found: Mapping[str, Recording]) -> tuple[str, ...]:
    """Choose among the techniques that read a file: by its name, its words, what it states."""
    if len(found) == 1:
        return tuple(found)
    recording = next(iter(found.values()))
    words = [*recording.column_units, *recording.metadata, *recording.metadata.values()]
    stated = {stated.name for stated in stated_lengths(recording.metadata)}
    strain = recording.columns.get("nominal_strain")
    hints = (
        *(techniques_said(part, found) for part in reversed(path.split("/"))),
        techniques_said(" ".join(words), found),
        ["tension"] if stated & {"width_m", "gauge_length_m"} else [],
        ["compression"] if "diameter_m" in stated else [],
        ["tension"] if strain is not None and strain.max() > _BEYOND_COMPRESSION else [],
    )
    for hint in hints:
        if len(hint) == 1 and hint[0] in found:
            return (hint[0],)
    return tuple(found)
