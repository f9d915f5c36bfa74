"""One look at a folder: what was filled in is taken over, what is new is proposed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from deamat.core.campaign import CAMPAIGN_FILE, MANIFEST_FILE
from deamat.core.config import Config, load_config
from deamat.core.errors import ConfigError, RawFileError
from deamat.core.register import REGISTER_FILES, split_sheet
from deamat.core.slug import slug_fault
from deamat.formats.detect import KNOWN_FORMS
from deamat.formats.exports import Export, load_exports
from deamat.formats.rawfile import RawFile, read_raw
from deamat.run.add.facts import Facts, facts_of
from deamat.run.add.known import Campaign, campaign_named, look_at_campaign
from deamat.run.add.proposal import Proposal, Row, missing_in, read_proposal, write_proposal
from deamat.run.add.rows import FOUND_IN, MISSING, proposed_row
from deamat.run.add.take import Place, take
from deamat.run.folders import Folders, Stat, walk
from deamat.run.other_folders import is_picture, no_technique
from deamat.run.register import register
from deamat.run.register_schemas import header_of
from deamat.techniques import TECHNIQUES

TO_FILL_IN = "to-fill-in"  # beside `raw/`, a folder for each campaign
UNSURE = "which-technique"
_NOT_DATA = (CAMPAIGN_FILE, MANIFEST_FILE, *REGISTER_FILES)
_DOCUMENTS = (".md", ".pdf", ".rst")


@dataclass
class Added:
    """The outcome of a look at a folder, in lines of text.

    Parameters
    ----------
    taken : files that were taken over now
    there : files of the campaign that the folder holds as well
    faulty : a row that was filled in does not hold
    """

    lines: list[str] = field(default_factory=list)
    taken: set[str] = field(default_factory=set)
    there: list[str] = field(default_factory=list)
    faulty: bool = False

    def say(self, what: str, text: str) -> None:
        """Add a line."""
        self.lines.append(f"{what:<11}{text}")


@dataclass(frozen=True, slots=True)
class Wish:
    """What was asked for.

    Parameters
    ----------
    campaign, technique, material : empty where nobody says
    move : files are moved into place, not copied
    workbook : new tables to fill in are .xlsx
    """

    campaign: str = ""
    technique: str = ""
    material: str = ""
    move: bool = False
    workbook: bool = False


@dataclass(frozen=True, slots=True)
class _Look:
    """One look at a folder.

    Parameters
    ----------
    files : those of the folder, relative to it
    """

    source: Path
    files: Mapping[str, Stat]
    wish: Wish
    config: Config
    exports: Sequence[Export]
    added: Added


def add(folders: Folders, source: Path, wish: Wish) -> Added:
    """Take over the rows that were filled in, and propose rows for the other files of a folder.

    Raises
    ------
    ConfigError : no such folder, campaign or technique
    RawFileError : a register or a table to fill in cannot be read
    """
    _check(source, wish, folders)
    config = load_config(folders.config, {key: t.config for key, t in TECHNIQUES.items()})
    name = campaign_named(folders.raw, wish.campaign)
    waiting = folders.raw.parent / TO_FILL_IN / name
    files = {path.partition("/")[2]: stat for path, stat in walk(str(source), "x")}
    added = Added()
    look = _Look(source, files, wish, config, load_exports(folders.config, KNOWN_FORMS), added)
    tables = {
        key: read_proposal(waiting, key, workbook=wish.workbook) for key in (*TECHNIQUES, UNSURE)
    }
    rows = {
        key: _taken(Place(folders.raw, name, TECHNIQUES[key]), table, look)
        for key, table in tables.items()
        if key != UNSURE
    }
    campaign = look_at_campaign(folders.raw, name, config)
    _take_names(campaign, rows)
    if wish.material:
        campaign.known.materials.add(wish.material)
    listed = {row["file"].partition("#")[0] for mine in rows.values() for row in mine}
    decided = {row["file"]: row.get("technique", MISSING) for row in tables[UNSURE].rows}
    unsure: list[Row] = []
    for path in files:
        if path not in listed | added.taken and _may_be_data(path):
            said = decided.get(path, MISSING)
            for facts in _facts(path, said, campaign, look):
                if len(facts.techniques) > 1:
                    unsure.append(_undecided(facts))
                else:
                    key = facts.techniques[0]
                    rows[key].append(_proposed(facts, key, campaign, wish))
    for key, table in tables.items():
        header = ("file", "technique", "it_may_be") if key == UNSURE else _header(key)
        mine = unsure if key == UNSURE else rows[key]
        write_proposal(table, header, mine)
        _tell(table, mine, added)
    if added.there:
        added.say("there", f"{len(added.there)} of the files are in {name} already")
    added.lines += register(folders.raw, name).text.splitlines()[-1:]
    return added


def _check(source: Path, wish: Wish, folders: Folders) -> None:
    if not source.is_dir():
        raise ConfigError(f"{source} is no folder")
    if folders.raw.resolve().is_relative_to(source.resolve()):
        raise ConfigError(f"{source} holds the project itself; name the folder of the new files")
    if wish.technique and wish.technique not in TECHNIQUES:
        raise ConfigError(no_technique(wish.technique, TECHNIQUES))
    if wish.material and (fault := slug_fault(wish.material)):
        raise ConfigError(f"--material {wish.material!r}: {fault}")


def _may_be_data(path: str) -> bool:
    name = path.rpartition("/")[2]
    return name not in _NOT_DATA and not is_picture(path) and not name.lower().endswith(_DOCUMENTS)


def _header(key: str) -> tuple[str, ...]:
    columns = header_of(TECHNIQUES[key])
    return ("file", *(column for column in columns if column != "file"), FOUND_IN)


def _taken(place: Place, table: Proposal, look: _Look) -> list[Row]:
    """Take over the rows of a table that are filled in; returns those that wait."""
    waiting = []
    moved: list[Path] = []
    for row in table.rows:
        path = split_sheet(row["file"])[0]
        if missing_in(row) or path not in look.files or look.files[path].odd:
            waiting.append(row)
            continue
        source = look.source / path
        try:
            name = take(place, row, read_raw(look.source, path), source, look.config)
        except RawFileError as error:
            look.added.faulty = True
            look.added.say("NOT TAKEN", f"{row['file']}: {error}")
            waiting.append(row)
            continue
        look.added.taken.add(path)
        target = f"{place.campaign}/{place.technique.key}/{name}"
        look.added.say("moved" if look.wish.move else "copied", f"{row['file']} -> {target}")
        if not source.resolve().is_relative_to(place.folder.resolve()):
            moved.append(source)
    still = {look.source / split_sheet(row["file"])[0] for row in waiting}
    for old in set(moved) - still if look.wish.move else ():
        old.unlink(missing_ok=True)
    return waiting


def _take_names(campaign: Campaign, rows: Mapping[str, list[Row]]) -> None:
    """The names of rows that wait are taken as well."""
    for key, mine in rows.items():
        names = {row.get("specimen", MISSING).casefold() for row in mine} - {MISSING}
        campaign.known.specimens.setdefault(key, set()).update(names)
        campaign.known.materials |= {
            row["material"] for row in mine if not slug_fault(row.get("material", MISSING))
        }


def _facts(path: str, said: str, campaign: Campaign, look: _Look) -> list[Facts]:
    """Look at a file that has no row yet; say why, where nothing comes of it."""
    if odd := look.files[path].odd:
        look.added.say("not read", f"{path}: {odd}")
        return []
    technique = said
    if said in ("", MISSING):
        technique = look.wish.technique or _own_technique(look.source / path, campaign)
    if technique and technique not in TECHNIQUES:
        look.added.faulty = True
        look.added.say("NOT TAKEN", f"{path}: {no_technique(technique, TECHNIQUES)}")
        technique = ""
    try:
        data = read_raw(look.source, path)
        if there := campaign.place_of(data, ""):
            look.added.there.append(there)
            return []
        found = facts_of(RawFile(path, data), technique, look.exports, look.source.name)
    except RawFileError as error:
        reason = f"{error.within}: {error.reason}".removeprefix(": ")
        look.added.say("not read", f"{path}: {reason}; look at it with `deamat check`")
        return []
    new = []
    for facts in found:
        there = campaign.place_of(data, facts.path.removeprefix(path).removeprefix("#"))
        if there:
            look.added.there.append(there)
        else:
            new.append(facts)
    return new


def _own_technique(file: Path, campaign: Campaign) -> str:
    """Name the technique in whose folder a file stands already; empty where it stands in none."""
    place, whole = (campaign.raw / campaign.name).resolve(), file.resolve()
    parts = whole.relative_to(place).parts if whole.is_relative_to(place) else ()
    return parts[0] if len(parts) > 1 and parts[0] in TECHNIQUES else ""


def _undecided(facts: Facts) -> Row:
    return {
        "file": facts.path,
        "technique": MISSING,
        "it_may_be": " or ".join(facts.techniques),
    }


def _proposed(facts: Facts, key: str, campaign: Campaign, wish: Wish) -> Row:
    row = proposed_row(facts, TECHNIQUES[key], campaign.known)
    if wish.material:
        row["material"] = wish.material
    if not slug_fault(row["material"]):
        campaign.known.materials.add(row["material"])
    return row


def _tell(table: Proposal, rows: list[Row], added: Added) -> None:
    """Say how many rows of a table wait, and what must be filled in."""
    if not rows:
        return
    columns = list(dict.fromkeys(column for row in rows for column in missing_in(row)))
    what = f"fill in {', '.join(columns)}" if columns else "complete: look at them"
    place = "/".join(table.path.parts[-3:])
    count = "1 row" if len(rows) == 1 else f"{len(rows)} rows"
    added.say("to fill in", f"{place}: {count}; {what}, then `deamat add` again")
