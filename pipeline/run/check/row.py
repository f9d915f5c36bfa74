"""The row of a register that goes with a file: the one beside it, or one made of options."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from deamat.core.campaign import CAMPAIGN_FILE, CampaignInfo, load_campaign
from deamat.core.config import Config
from deamat.core.errors import RawFileError
from deamat.core.recording import Specimen
from deamat.core.register import ENDINGS, SHEET, read_register
from deamat.core.technique import AnyTechnique
from deamat.formats.rawfile import read_raw

OPTIONS = "the options"  # what messages call a row that is in no register
_UNKNOWN = CampaignInfo(title="", laboratory="", licence="", synthetic=False)


@dataclass(frozen=True, slots=True)
class Place:
    """Where a file stands among campaigns.

    Parameters
    ----------
    technique : whose folder it is in, empty where it is in none
    name : of the file as its register would write it
    register : of that folder, None where there is none yet
    info : of the campaign
    within : the sheet or the columns that are looked at, empty for all of the file
    """

    technique: str
    name: str
    register: Path | None
    info: CampaignInfo
    within: str = ""


def place_of(path: Path, techniques: Mapping[str, AnyTechnique]) -> Place:
    """Find the technique's folder and the register above a file.

    Raises
    ------
    RawFileError : the campaign's declaration does not hold
    """
    whole = path.resolve()
    for folder in whole.parents:
        if folder.name not in techniques:
            continue
        named = folder / techniques[folder.name].register.file
        register = next((r for r in map(named.with_suffix, ENDINGS) if r.is_file()), None)
        info = _UNKNOWN
        if (folder.parent / CAMPAIGN_FILE).is_file():
            data = read_raw(folder.parent, CAMPAIGN_FILE)
            info = load_campaign(folder.parent, data).info
        name = whole.relative_to(folder).as_posix()
        return Place(folder.name, name, register, info)
    return Place("", path.name, None, _UNKNOWN)


def registered(place: Place, technique: AnyTechnique, config: Config) -> tuple[Specimen, ...]:
    """Return the rows that name a file, or the place in it; none without a register.

    Raises
    ------
    RawFileError : the register cannot be read, or its row of this file does not hold
    """
    if place.register is None:
        return ()
    folder = place.register.parent
    path = f"{folder.parent.name}/{folder.name}/{place.register.name}"
    register = read_register(
        read_raw(folder, place.register.name), path, folder.parent.name, technique.key,
        technique.required, config.instruments.gauges, technique.register,
    )  # fmt: skip
    named = f"{folder.parent.name}/{folder.name}/{place.name}"
    for file, error in register.errors:
        if file == named:
            raise error
    rows = tuple(row for row in register.specimens if row.file == named)
    within = tuple(row for row in rows if row.notes.get(SHEET, "") == place.within)
    return within if place.within else rows


def of_options(said: Mapping[str, str], technique: AnyTechnique, config: Config) -> Specimen:
    """Read columns and cells as a register's row would be read.

    Raises
    ------
    RawFileError : a column without a known unit, a cell that is no number
    """
    cells = {"specimen": "check", "material": "check", **said}
    for column in technique.register.text:
        cells.setdefault(column, "check")
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([cells.keys(), cells.values()])
    form = replace(technique.register, text=("specimen", "material"), identity=("specimen",))
    register = read_register(
        text.getvalue().encode(), OPTIONS, "check", technique.key, (), config.instruments.gauges,
        form,
    )  # fmt: skip
    for _, error in register.errors:
        raise RawFileError(OPTIONS, error.reason, value=error.value, hint=error.hint)
    return register.specimens[0]
