"""What each file of a campaign is at first sight: its role, and what the manifest says of it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Literal

from deamat.core.campaign import CAMPAIGN_FILE, MANIFEST_FILE
from deamat.core.errors import RawFileError
from deamat.core.ledger import FileEntry, Role
from deamat.core.manifest import Difference, compare, extends, parse_manifest
from deamat.core.register import REGISTER_FILES
from deamat.core.technique import AnyTechnique
from deamat.formats.rawfile import read_raw
from deamat.run.folders import Input
from deamat.run.other_folders import is_picture

_DOCUMENTS = (".md", ".pdf", ".rst")


def content_of(path: str, folder: Path, inputs: Mapping[str, Input]) -> bytes:
    """Read a file of a campaign, if it is one that may be opened.

    Raises
    ------
    RawFileError : it may not, or cannot be read any more
    """
    if inputs[path].odd:
        raise RawFileError(path, inputs[path].odd)
    return read_raw(folder.parent, path)


def is_register(path: str) -> bool:
    """Say whether a path relative to `raw/` is that of a register."""
    parts = path.split("/")
    return len(parts) == 3 and parts[2] in REGISTER_FILES


def entry_of(
    path: str, found: Input, difference: Difference, techniques: Mapping[str, AnyTechnique]
) -> FileEntry:
    """Begin the account of a file with what its name and the manifest say."""
    name = path.partition("/")[2]
    role, size, sha256 = role_of(path, techniques), found.size, found.sha256
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


def role_of(path: str, techniques: Mapping[str, AnyTechnique]) -> Role:
    """Say what a file is to its campaign, by its name."""
    parts = path.split("/")
    if len(parts) == 2:
        if parts[1] == CAMPAIGN_FILE:
            return "campaign"
        return "manifest" if parts[1] == MANIFEST_FILE else "document"
    if is_register(path):
        return "register"
    if parts[-1].lower().endswith(_DOCUMENTS):
        return "document"
    if parts[1] not in techniques and is_picture(path):
        return "document"
    return "unnamed"


def manifest_of(
    folder: Path, inputs: Mapping[str, Input]
) -> tuple[Difference, RawFileError | None]:
    """Hold the files against the manifest; without one, or a broken one, every file is extra."""
    path = f"{folder.name}/{MANIFEST_FILE}"
    found = {p.partition("/")[2]: one.sha256 for p, one in inputs.items() if p != path}
    if path not in inputs:
        return compare({}, found), None
    try:
        text = content_of(path, folder, inputs).decode("utf-8")
        return compare(parse_manifest(text, path), found, partial(extended, folder, inputs)), None
    except UnicodeDecodeError as error:
        return compare({}, found), RawFileError(path, f"not UTF-8: {error}")
    except RawFileError as error:
        return compare({}, found), error


def extended(folder: Path, inputs: Mapping[str, Input], name: str, sha256: str) -> bool:
    """Say whether a register of a campaign is the one registered with rows appended."""
    if name.count("/") != 1 or name.partition("/")[2] not in REGISTER_FILES:
        return False
    try:
        return extends(content_of(f"{folder.name}/{name}", folder, inputs), sha256)
    except RawFileError:
        return False
