"""Holds the specimens of a technique against each other: flags, and files that are copies."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from deamat.consistency.calibrations import flags_of_calibrations
from deamat.consistency.names import near_names
from deamat.consistency.rows import materials_by_id
from deamat.consistency.seen import holds_noise
from deamat.consistency.together import Member, equal_elsewhere, together
from deamat.core.errors import RawFileError
from deamat.core.flags import Flag
from deamat.core.register import ENCODING, split_sheet
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile, read_raw
from deamat.run.build_cache import key_of
from deamat.run.measure import Measured, RunContext
from deamat.run.work import Reduced
from deamat.techniques import TECHNIQUES


def compare(measured: Sequence[Measured], run: RunContext) -> list[Measured]:
    """Flag specimens that contradict others or themselves; reject files that are copies.

    Parameters
    ----------
    measured : of one technique
    """
    if not measured:
        return []
    specimens = [s for survey in run.surveys for s in survey.specimens]
    materials = materials_by_id(specimens)
    names = near_names((s.material for s in specimens), run.config.materials)
    elsewhere = equal_elsewhere([_member(one) for one in measured])
    campaigns: dict[str, list[Measured]] = defaultdict(list)
    for one in measured:
        campaigns[one.specimen.campaign].append(one)
    compared: dict[tuple[str, str], Measured] = {}
    for campaign, members in campaigns.items():
        noticed = together(
            [_member(one) for one in members],
            materials,
            partial(_noisy, run.folders.raw, members[0].specimen.technique, _encodings(members)),
        )
        for one in members:
            place = (campaign, one.specimen.id)
            flags = [*noticed.flags.get(one.specimen.id, ())]
            measures = TECHNIQUES[one.specimen.technique].measures
            flags += flags_of_calibrations(one.specimen, run.config.instruments, measures)
            if place in elsewhere:
                flags.append(elsewhere[place])
            if one.specimen.material in names:
                flags.append(names[one.specimen.material])
            compared[place] = _with(one, flags, noticed.copies.get(one.specimen.id))
    return [compared[one.specimen.campaign, one.specimen.id] for one in measured]


def _member(one: Measured) -> Member:
    if one.reduced is None:
        return Member(one.specimen, None, None)
    return Member(one.specimen, one.reduced.measurement, one.reduced.seen)


def _encodings(members: Sequence[Measured]) -> dict[str, str]:
    rows = [one.specimen for one in members]
    return {row.file: row.notes[ENCODING] for row in rows if row.file and ENCODING in row.notes}


def _noisy(raw: Path, technique: str, encodings: Mapping[str, str], place: str) -> bool:
    path, within = split_sheet(place)
    declared = encodings.get(path, "")
    file = RawFile(path, read_raw(raw, path), False, technique, within, declared)
    return holds_noise(detect(file).read(file))


def _with(one: Measured, flags: Sequence[Flag], copied: RawFileError | None) -> Measured:
    """Put onto a specimen what was noticed; its key changes with it."""
    if copied is not None and one.reduced is not None:
        rejected = Reduced(None, copied, one.reduced.reader)
        return replace(one, key=key_of({"key": one.key, "copy": str(copied)}), reduced=rejected)
    return one.noticed(*flags)
