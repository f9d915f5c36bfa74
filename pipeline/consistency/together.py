"""The specimens of one register held against each other, once they are measured."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from deamat.consistency.copies import Copy, File, find_copies
from deamat.consistency.labels import labels_against_rows
from deamat.consistency.rows import flags_of_row
from deamat.consistency.seen import Seen
from deamat.consistency.siblings import siblings_of_rows
from deamat.consistency.swaps import swapped_files
from deamat.consistency.time_units import time_units
from deamat.core.errors import RawFileError
from deamat.core.flags import Flag
from deamat.core.recording import Source, Specimen
from deamat.core.records import Measurement
from deamat.core.register import SHEET

_HINT = "exclude the wrong one in config/exclusions.toml, with the reason"


@dataclass(frozen=True, slots=True)
class Member:
    """One specimen of a register, and what came of it.

    Parameters
    ----------
    measurement, seen : None where it has no file, or its file could not be read
    """

    specimen: Specimen
    measurement: Measurement | None
    seen: Seen | None

    @property
    def source(self) -> Source | None:
        """Where its recording came from."""
        return None if self.measurement is None else self.measurement.source


@dataclass(frozen=True, slots=True)
class Noticed:
    """What was noticed about the specimens of a register, by specimen.

    Parameters
    ----------
    flags : contradictions
    copies : files that are not its own, as they hold the rows of another one
    """

    flags: Mapping[str, Sequence[Flag]]
    copies: Mapping[str, RawFileError]


def together(
    members: Sequence[Member],
    materials: Mapping[tuple[str, str], Mapping[str, str]],
    noisy: Callable[[str], bool],
) -> Noticed:
    """Hold the specimens of one register against each other, their rows and their files.

    Parameters
    ----------
    materials : see `rows.materials_by_id`
    noisy : reads a file again, by its path, and says whether it holds noise
    """
    specimens = [member.specimen for member in members]
    labels = {m.specimen.id: m.seen.label for m in members if m.seen is not None}
    measured = [m.measurement for m in members if m.measurement is not None]
    flags: dict[str, list[Flag]] = defaultdict(list)
    for member in members:
        flags[member.specimen.id] += flags_of_row(member.specimen, materials)
        if member.seen is not None:
            flags[member.specimen.id] += member.seen.flags
    copied, errors = _copies(members, noisy)
    for more in (
        siblings_of_rows(specimens),
        labels_against_rows(specimens, labels),
        swapped_files(measured),
        time_units(measured),
        copied,
    ):
        for specimen, told in more.items():
            flags[specimen] += told
    return Noticed(flags, errors)


def equal_elsewhere(members: Sequence[Member]) -> dict[tuple[str, str], Flag]:
    """Flag files whose bytes another campaign has too, by campaign and specimen."""
    holders: dict[str, list[Member]] = defaultdict(list)
    for member in members:
        if member.source is not None:
            holders[member.source.sha256].append(member)
    flags = {}
    for found in holders.values():
        for one in found:
            other = next((m for m in found if m.specimen.campaign != one.specimen.campaign), None)
            if other is not None:
                said = f"its bytes are also those of {other.specimen.file}: one measurement in two "
                said += "campaigns is no second one"
                flags[one.specimen.campaign, one.specimen.id] = Flag("equal-files", said)
    return flags


def _copies(
    members: Sequence[Member], noisy: Callable[[str], bool]
) -> tuple[dict[str, list[Flag]], dict[str, RawFileError]]:
    files = [
        File(m.specimen.id, m.source.path + _sheet(m), m.source.sha256 + _sheet(m), m.seen.sketch)
        for m in members
        if m.source is not None and m.seen is not None
    ]
    flags: dict[str, list[Flag]] = defaultdict(list)
    errors: dict[str, RawFileError] = {}
    known: dict[str, bool] = {}

    def noisy_once(file: File) -> bool:
        if file.path not in known:
            known[file.path] = noisy(file.path)
        return known[file.path]

    for copy in find_copies(files, noisy_once):
        for one, other in ((copy.one, copy.other), (copy.other, copy.one)):
            if copy.certain and copy.whole:
                errors.setdefault(one.specimen, _error(copy, one, other))
            else:
                flags[one.specimen].append(_flag(copy, other))
    return flags, errors


def _sheet(member: Member) -> str:
    """Name the sheet, `#Sheet`, where several specimens share a workbook."""
    sheet = member.specimen.notes.get(SHEET, "")
    return f"#{sheet}" if sheet else ""


def _error(copy: Copy, one: File, other: File) -> RawFileError:
    if copy.one.sha256 == copy.other.sha256:
        reason = f"equal bytes: those of {other.path} ({other.specimen})"
    else:
        reason = f"a copy: {100 * copy.fraction:.0f} % of its rows are those of {other.path} "
        reason += f"({other.specimen})"
    reason += "; no two tests agree so, and one of the two is not what its row says"
    return RawFileError(one.path, reason, hint=_HINT)


def _flag(copy: Copy, other: File) -> Flag:
    if copy.one.sha256 == copy.other.sha256:
        said = f"equal bytes: those of {other.path} ({other.specimen}); without noise nobody can "
        said += "tell a copy from a repetition"
        return Flag("equal-files", said)
    said = f"{100 * copy.fraction:.0f} % of its rows are those of {other.path} ({other.specimen}): "
    said += "copied, in one of them"
    return Flag("copied-rows", said)
