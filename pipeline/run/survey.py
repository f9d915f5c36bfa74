"""Surveys `raw/`: which campaigns, which specimens, and a first account of every file."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Literal

from deamat.core.campaign import CAMPAIGN_FILE, MANIFEST_FILE, Campaign, load_campaign
from deamat.core.config import Config
from deamat.core.errors import RawFileError
from deamat.core.ledger import Failure, FileEntry, Role
from deamat.core.manifest import Difference, compare, extends, parse_manifest
from deamat.core.recording import Specimen
from deamat.core.records import Excluded
from deamat.core.register import REGISTER_FILES, SHEET, read_register
from deamat.core.slug import Spellings
from deamat.core.technique import AnyTechnique
from deamat.formats.documentation import stated_units
from deamat.formats.rawfile import read_raw
from deamat.run.folders import Input
from deamat.run.other_folders import is_picture, no_technique

_DOCUMENTS = (".md", ".pdf", ".rst")


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
    difference, broken = _manifest(folder, inputs)
    for path, found in inputs.items():
        result.entries[path] = _entry(path, found, difference, techniques)
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
        campaign = load_campaign(folder, _content(campaign_file, folder, inputs))
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
            FileEntry(path, one.sha256, one.size, _role(path, techniques), "used"), failure
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


def _content(path: str, folder: Path, inputs: Mapping[str, Input]) -> bytes:
    """Read a file of a campaign, if it is one that may be opened.

    Raises
    ------
    RawFileError : it may not, or cannot be read any more
    """
    if inputs[path].odd:
        raise RawFileError(path, inputs[path].odd)
    return read_raw(folder.parent, path)


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


def _entry(
    path: str, found: Input, difference: Difference, techniques: Mapping[str, AnyTechnique]
) -> FileEntry:
    name = path.partition("/")[2]
    role, size, sha256 = _role(path, techniques), found.size, found.sha256
    if found.odd:
        changed = name in difference.changed
        manifest: Literal["changed", "ok"] = "changed" if changed else "ok"
        return FileEntry(path, sha256, size, role, "rejected", manifest, found.odd)
    if name in difference.changed:
        reason = "file content differs from the manifest"
        return FileEntry(path, sha256, size, role, "used", "changed", reason)
    if name in difference.extended:
        reason = "rows were appended since it was registered"
        return FileEntry(path, sha256, size, role, "used", "extended", reason)
    if name in difference.extra:
        return FileEntry(path, sha256, size, role, "used", "extra", "not in the manifest")
    return FileEntry(path, sha256, size, role, "used")


def _role(path: str, techniques: Mapping[str, AnyTechnique]) -> Role:
    parts = path.split("/")
    if len(parts) == 2:
        if parts[1] == CAMPAIGN_FILE:
            return "campaign"
        return "manifest" if parts[1] == MANIFEST_FILE else "document"
    if len(parts) == 3 and parts[2] in REGISTER_FILES:
        return "register"
    if parts[-1].lower().endswith(_DOCUMENTS):
        return "document"
    if parts[1] not in techniques and is_picture(path):
        return "document"
    return "unnamed"


def _manifest(folder: Path, inputs: Mapping[str, Input]) -> tuple[Difference, RawFileError | None]:
    path = f"{folder.name}/{MANIFEST_FILE}"
    found = {p.partition("/")[2]: one.sha256 for p, one in inputs.items() if p != path}
    if path not in inputs:
        return compare({}, found), None
    try:
        text = _content(path, folder, inputs).decode("utf-8")
        return compare(parse_manifest(text, path), found, partial(extended, folder)), None
    except UnicodeDecodeError as error:
        return compare({}, found), RawFileError(path, f"not UTF-8: {error}")
    except RawFileError as error:
        return compare({}, found), error


def extended(folder: Path, name: str, sha256: str) -> bool:
    """Say whether a register of a campaign is the one registered with rows appended."""
    if name.count("/") != 1 or name.partition("/")[2] not in REGISTER_FILES:
        return False
    try:
        return extends(read_raw(folder.parent, f"{folder.name}/{name}"), sha256)
    except RawFileError:
        return False


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
    try:
        if path != f"{folder.name}/{name}/{form.file}":
            raise RawFileError(
                path, f"the register of {name} is called {form.file}", hint="give it that name"
            )
        register = read_register(
            data, path, folder.name, name, techniques[name].required, config.instruments.gauges,
            form, spellings,
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
    owners: dict[str, Specimen] = {}
    slips = list(register.errors)
    reasons = {exclusion.target: exclusion.reason for exclusion in config.exclusions.exclude}
    left_out: list[Excluded] = []
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


def _account_for_excluded(
    left_out: Sequence[Excluded], owners: Mapping[str, Specimen], result: Survey
) -> None:
    """Exclude the files of rows that are left out, unless another row has the same one."""
    result.excluded += left_out
    claimed = {specimen.file for specimen in owners.values()}
    for excluded in left_out:
        file = excluded.path
        if file is None or file in claimed:
            continue
        entry = result.entries.get(file, FileEntry(file, "", 0, "missing", "rejected"))
        role: Role = "missing" if entry.role == "missing" else "recording"
        result.entries[file] = replace(entry, role=role)
        _leave_out(file, excluded.reason, result)


def _claim(specimen: Specimen, result: Survey, owners: dict[str, Specimen]) -> bool:
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
    same = [path, f"{path}#{sheet}"] if sheet else [k for k in owners if k.split("#")[0] == path]
    first = next((owners[key] for key in same if key in owners), None)
    if first is not None:
        reason = f"its file is that of {first.id} in line {first.line} already"
        raise RawFileError(specimen.register, reason, specimen.line, None, specimen.id)
    owners[f"{path}#{sheet}" if sheet else path] = specimen
    result.entries[path] = replace(entry, role="recording")
    return entry.status == "used"


def _reject_rows(
    register: str,
    slips: Sequence[tuple[str | None, RawFileError]],
    owners: Mapping[str, Specimen],
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
    text = data.decode("utf-8-sig", "replace")
    try:
        rows = list(csv.reader(io.StringIO(text, newline="")))
    except csv.Error:
        return []
    if not rows or "file" not in [h.strip() for h in rows[0]]:
        return []
    at = [h.strip() for h in rows[0]].index("file")
    folder = path.rpartition("/")[0]
    return [f"{folder}/{row[at].strip()}" for row in rows[1:] if len(row) > at and row[at].strip()]


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
            f"{register} does not name it; add a row or an exclusion"
            if register in result.entries
            else f"there is no register {register}"
        )
        result.entries[path] = replace(entry, status="rejected", reason=reason)
