"""Which techniques a file belongs to, by its content: those in whose register it could be read."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.rawfile import RawFile
from deamat.formats.vocabulary import ASKED


def recordings_of(
    file: RawFile,
    techniques: Iterable[str],
    read: Callable[[RawFile], Recording],
    *,
    named: bool = False,
) -> tuple[dict[str, Recording], list[RawFileError]]:
    """Read a file as one of each technique; keep those that find in it what they look at.

    Those that know its columns by their labels leave no room for those that know a unit alone.

    Parameters
    ----------
    read : how the file is read, once for each technique
    named : somebody says that it belongs to them: what they find in it does not matter

    Returns
    -------
    recordings by technique, and why it could not be read for others
    """
    found: dict[str, Recording] = {}
    faults: list[RawFileError] = []
    for key in techniques:
        try:
            recording = read(replace(file, technique=key))
        except RawFileError as error:
            faults.append(error)
            continue
        if named or holds_what(key, recording):
            found[key] = recording
    by_label = {key: one for key, one in found.items() if not _by_unit(one)}
    return by_label or found, faults


def holds_what(technique: str, recording: Recording) -> bool:
    """Say whether a recording holds what a technique looks at."""
    columns = recording.columns
    if technique == "viscosity":
        return "viscosity_Pas" in columns
    return any(all(name in columns for name in need) for need in ASKED[technique].needs)


def _by_unit(recording: Recording) -> bool:
    return any(flag.name == "label-by-unit" for flag in recording.flags)
