"""Surveys `raw/`: which campaigns, which specimens, and a first account of every file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from deamat.core.campaign import CAMPAIGN_FILE, Campaign, load_campaign
from deamat.core.card_lists import Excluded
from deamat.core.config import Config
from deamat.core.errors import RawFileError
from deamat.core.ledger import Failure, FileEntry, Role
from deamat.core.recording import Specimen
from deamat.core.register import (
    SHEET,
    RegisterForm,
    read_register,
    split_sheet,
)
from deamat.core.register_table import read_table
from deamat.core.slug import Spellings
from deamat.core.technique import AnyTechnique
from deamat.formats.documentation import stated_units
from deamat.formats.rawfile import read_raw
from deamat.run.first_account import content_of, entry_of, is_register, manifest_of, role_of
from deamat.run.folders import Input
from deamat.run.other_folders import no_technique

Owners = dict[str, dict[str, Specimen]]  # whose a file is, by its path and sheet


@dataclass
class Survey:
    """What a look at one campaign gave.

    Parameters
    ----------
    specimens : rows whose file is there and not excluded, in register order
    entries : the account so far; a recording stays `used` until reading it says otherwise
    excluded : rows that `config/exclusions.toml` names, or whose file it names
    stated_units : label to unit, as the campaign's own documents say
    """

    campaign: Campaign | None
    specimens: list[Specimen] = field(default_factory=list)
    entries: dict[str, FileEntry] = field(default_factory=dict)
    stated_units: Mapping[str, str] = field(default_factory=dict)
    excluded: list[Excluded] = field(default_factory=list)


def survey(
    folder: Path,
    inputs: Mapping[str, Input],
    techniques: Mapping[str, AnyTechnique],
    config: Config,
    spellings: Spellings,
) -> Survey:
    """Account for every file of one campaign folder.

    Parameters
    ----------
    inputs : this campaign's files, by path relative to `raw/`
    spellings : of the names in the configuration and in the campaigns surveyed before
    """
    result = Survey(None)
    difference, broken = manifest_of(folder, inputs)
    for path, found in inputs.items():
        result.entries[path] = entry_of(path, found, difference, techniques)
    if broken:
        _reject(result, broken)
    for name in difference.missing:
        path = f"{folder.name}/{name}"
        if path not in result.entries:
            result.entries[path] = FileEntry(
                path, "", 0, "missing", "rejected", "missing", "in the manifest, but not there"
            )
    _exclude(result, config)
    try:
        campaign_file = f"{folder.name}/{CAMPAIGN_FILE}"
        campaign = load_campaign(folder, content_of(campaign_file, folder, inputs))
        if other := spellings.other("campaign", folder.name, "raw/"):
            reason = f"the folder of another campaign differs only in case: {other}"
            raise RawFileError(campaign_file, reason)
        result.campaign = campaign
    except RawFileError as error:
        _reject(result, error)
        for path, entry in result.entries.items():
            if entry.role not in ("campaign", "missing"):
                why = f"{folder.name}/{CAMPAIGN_FILE} cannot be read"
                result.entries[path] = replace(entry, status="rejected", reason=why)
        return result
    documents = [p for p, e in result.entries.items() if e.role == "document" and _text(p)]
    texts = [data.decode("utf-8", "replace") for _, data in _readable(documents, folder, result)]
    result.stated_units = stated_units("\n".join(texts))
    registers = sorted(p for p, e in result.entries.items() if e.role == "register")
    for path, data in _readable(registers, folder, result):
        _register(path, data, folder, result, techniques, config, spellings)
    _unnamed(result, folder, techniques)
    return result


def without_survey(
    failure: Failure, inputs: Mapping[str, Input], techniques: Mapping[str, AnyTechnique]
) -> Survey:
    """Account for the files of a campaign whose survey ended in an internal error."""
    entries = {
        path: failed(
            FileEntry(path, one.sha256, one.size, role_of(path, techniques), "used"), failure
        )
        for path, one in inputs.items()
    }
    return Survey(None, entries=entries)


def failed(entry: FileEntry, failure: Failure) -> FileEntry:
    """Say of a file that the program failed over it."""
    reason = f"internal error: {failure.error}"
    return replace(entry, status="failed", reason=reason, placed=False)


def survey_strays(raw: Mapping[str, Input], config: Config) -> Survey:
    """Account for what cannot be read directly in `raw/`, outside of every campaign."""
    result = Survey(None)
    for path, one in raw.items():
        if "/" not in path and one.odd:
            result.entries[path] = FileEntry(path, "", 0, "unnamed", "rejected", reason=one.odd)
    _exclude(result, config)
    return result


def _readable(paths: Sequence[str], folder: Path, result: Survey) -> Iterator[tuple[str, bytes]]:
    """Read those files that nothing speaks against; one that cannot be read is rejected."""
    for path in paths:
        if result.entries[path].status == "used":
            try:
                data = read_raw(folder.parent, path)
            except RawFileError as error:
                _reject(result, error)
            else:
                yield path, data


def _text(path: str) -> bool:
    return path.lower().endswith((".txt", ".md", ".rst"))


def _exclude(result: Survey, config: Config) -> None:
    for exclusion in config.exclusions.exclude:
        if exclusion.path is not None and exclusion.path in result.entries:
            _leave_out(exclusion.path, exclusion.reason, result)


def _leave_out(path: str, reason: str, result: Survey) -> None:
    result.entries[path] = replace(result.entries[path], status="excluded", reason=reason)


def _reject(result: Survey, error: RawFileError) -> None:
    """Mark a file as rejected, with the place and reason of an error."""
    result.entries[error.path] = result.entries[error.path].rejected(error)


def _register(
    path: str,
    data: bytes,
    folder: Path,
    result: Survey,
    techniques: Mapping[str, AnyTechnique],
    config: Config,
    spellings: Spellings,
) -> None:
    name = path.split("/")[1]
    if name not in techniques:
        reason = no_technique(name, techniques)
        for file in [path, *_files_named(data, path)]:
            if file in result.entries and result.entries[file].status != "excluded":
                role: Role = "register" if file == path else "recording"
                result.entries[file] = replace(
                    result.entries[file], role=role, status="refused", reason=reason, awaits=name
                )
        return
    form = techniques[name].register
    reasons = {exclusion.target: exclusion.reason for exclusion in config.exclusions.exclude}
    mine = f"{folder.name}/{name}/"
    named = {target.removeprefix(mine) for target in reasons if target.startswith(mine)}
    try:
        _is_the_register(path, form, name, result)
        register = read_register(
            data, path, folder.name, name, techniques[name].required, config.instruments.gauges,
            form, spellings, named,
        )  # fmt: skip
    except RawFileError as error:
        _reject(result, error)
        for file in _files_named(data, path):
            if file in result.entries:
                result.entries[file] = replace(
                    result.entries[file], role="recording", status="rejected",
                    reason=f"its register cannot be read: {error}",
                )  # fmt: skip
        return
    owners: Owners = {}
    slips = list(register.errors)
    left_out = [_excluded(row, reasons[row.place]) for row in register.left_out]
    for specimen in register.specimens:
        why = reasons.get(specimen.place, reasons.get(specimen.file or ""))
        if why is not None:
            left_out.append(_excluded(specimen, why))
            continue
        try:
            if _claim(specimen, result, owners):
                result.specimens.append(specimen)
        except RawFileError as error:
            slips.append((None, error))
    _account_for_excluded(left_out, owners, result)
    _reject_rows(path, slips, owners, result)


def _excluded(specimen: Specimen, reason: str) -> Excluded:
    return Excluded(
        specimen.campaign,
        specimen.technique,
        specimen.id,
        reason,
        specimen.material,
        specimen.register,
        specimen.line,
        specimen.file,
    )


def _account_for_excluded(left_out: Sequence[Excluded], owners: Owners, result: Survey) -> None:
    """Exclude the files of rows that are left out, unless another row has the same one."""
    result.excluded += left_out
    for excluded in left_out:
        file = excluded.path
        if file is None or file in owners:
            continue
        entry = result.entries.get(file, FileEntry(file, "", 0, "missing", "rejected"))
        role: Role = "missing" if entry.role == "missing" else "recording"
        result.entries[file] = replace(entry, role=role)
        _leave_out(file, excluded.reason, result)


def _is_the_register(path: str, form: RegisterForm, technique: str, result: Survey) -> None:
    """Insist on the name of the technique's register, as text or workbook, and on one of them.

    Raises
    ------
    RawFileError : another name, or one of several
    """
    stem = path.rpartition(".")[0]
    if stem.rpartition("/")[2] != form.file.rpartition(".")[0]:
        raise RawFileError(
            path, f"the register of {technique} is called {form.file}", hint="give it that name"
        )
    other = next(
        (
            p
            for p in result.entries
            if p != path and p.rpartition(".")[0] == stem and is_register(p)
        ),
        None,
    )
    if other is not None:
        reason = f"two registers of {technique}: this one and {other}"
        raise RawFileError(path, reason, hint="keep one of them")


def _claim(specimen: Specimen, result: Survey, owners: Owners) -> bool:
    """Return a row its file, once; say whether the row can be measured.

    Raises
    ------
    RawFileError : the file is that of another row
    """
    path = specimen.file
    if path is None:
        return True
    place = f"{specimen.register}, line {specimen.line}"
    if path not in result.entries:
        result.entries[path] = FileEntry(
            path, "", 0, "missing", "rejected", reason=f"named in {place}, but not there"
        )
        return False
    entry = result.entries[path]
    if entry.role == "missing":
        reason = f"{entry.reason}\nnamed in {place}, but not there"
        result.entries[path] = replace(entry, reason=reason)
        return False
    sheet = specimen.notes.get(SHEET, "")
    taken = owners.setdefault(path, {})
    rivals = ("", sheet) if sheet else tuple(taken)
    first = next((taken[one] for one in rivals if one in taken), None)
    if first is not None:
        reason = f"its file is that of {first.id} in line {first.line} already"
        raise RawFileError(specimen.register, reason, specimen.line, None, specimen.id)
    taken[sheet] = specimen
    result.entries[path] = replace(entry, role="recording")
    return entry.status == "used"


def _reject_rows(
    register: str,
    slips: Sequence[tuple[str | None, RawFileError]],
    owners: Owners,
    result: Survey,
) -> None:
    """Reject the data file of each bad row, or the register where that is none of its own."""
    by_file: dict[str, list[RawFileError]] = {}
    for named, slip in slips:
        own = named is not None and named in result.entries and named not in owners
        by_file.setdefault(named if own and named else register, []).append(slip)
    for path, errors in by_file.items():
        entry = result.entries[path]
        if entry.status == "excluded":
            continue
        role: Role = "register" if path == register else "recording"
        result.entries[path] = replace(entry.rejected(*errors), role=role)


def _files_named(data: bytes, path: str) -> list[str]:
    """The files that a register names, read without understanding the rest of it."""
    try:
        table = read_table(data, path, ["file"])
    except RawFileError:
        return []
    if "file" not in table.header:
        return []
    at = table.header.index("file")
    folder = path.rpartition("/")[0]
    named = [row[at].strip() for _, row in table.rows if len(row) > at]
    return [f"{folder}/{split_sheet(file)[0]}" for file in named if file]


def _unnamed(result: Survey, folder: Path, techniques: Mapping[str, AnyTechnique]) -> None:
    """A data file that no register names is rejected: nobody can say what it belongs to.

    In a folder that no technique is called after it waits for the folder's right name.
    """
    for path, entry in result.entries.items():
        if entry.role != "unnamed" or entry.status != "used":
            continue
        technique = path.split("/")[1]
        if technique not in techniques:
            reason = no_technique(technique, techniques)
            result.entries[path] = replace(entry, status="refused", reason=reason, awaits=technique)
            continue
        register = f"{folder.name}/{technique}/{techniques[technique].register.file}"
        reason = (
            f"{register} does not name it; add a row (`deamat add` proposes one) or an exclusion"
            if register in result.entries
            else f"there is no register {register}"
        )
        result.entries[path] = replace(entry, status="rejected", reason=reason)
