"""`deamat register`: write or extend the manifest of a campaign."""

from __future__ import annotations

import difflib
import hashlib
import shlex
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from deamat.core.atomic import write_atomically
from deamat.core.campaign import CAMPAIGN_FILE, MANIFEST_FILE
from deamat.core.errors import ConfigError, RawFileError
from deamat.core.manifest import Difference, compare, format_manifest, parse_manifest
from deamat.formats.rawfile import read_raw
from deamat.run.first_account import extended
from deamat.run.folders import Input, Stat, walk


@dataclass(frozen=True, slots=True)
class Registration:
    """What `register` did or would do.

    Parameters
    ----------
    pending : changed or missing files wait to be accepted, and stand in the manifest as they were
    """

    text: str
    pending: bool


def register(
    raw: Path, campaign: str, accept: Collection[str] = (), *, accept_all: bool = False
) -> Registration:
    """Write or extend a manifest; a changed or missing file stays as it was until it is accepted.

    New files, and registers to which rows were appended, are extensions: they need no acceptance.

    Parameters
    ----------
    accept : changed or missing files to accept, relative to the campaign
    accept_all : accept every one of them

    Raises
    ------
    ConfigError : there is no such campaign, or a file to accept is neither changed nor missing
    RawFileError : the manifest that is there cannot be read
    """
    folder = raw / campaign
    if folder.parent != raw or campaign in ("", ".", ".."):
        raise ConfigError(f"{campaign!r} is not the name of a folder in {raw}")
    if not (folder / CAMPAIGN_FILE).is_file():
        raise ConfigError(f"{folder} is no campaign: it has no {CAMPAIGN_FILE}")
    seen = {path.removeprefix(f"{campaign}/"): stat for path, stat in walk(str(folder), campaign)}
    found = {
        path: hashlib.sha256(read_raw(raw, f"{campaign}/{path}")).hexdigest()
        for path, stat in seen.items()
        if path != MANIFEST_FILE and not stat.odd
    }
    odd = [f"ignored  {path}: {stat.odd}" for path, stat in seen.items() if stat.odd]
    old = {}
    if MANIFEST_FILE in seen:
        old = _registered(raw, f"{campaign}/{MANIFEST_FILE}", seen[MANIFEST_FILE])
    inputs = {
        f"{campaign}/{path}": Input(stat.size, found.get(path, ""), stat.odd)
        for path, stat in seen.items()
    }
    difference = compare(old, found, partial(extended, folder, inputs))
    departing = (*difference.changed, *difference.missing)
    accepted = set(departing) if accept_all else _accepted(accept, campaign, departing)
    waiting = [name for name in departing if name not in accepted]
    if not difference:
        said = f"{campaign}: {len(found)} files, all as in the manifest"
        return Registration("\n".join([*odd, said]), False)
    new = {**found, **{name: old[name] for name in waiting}}
    if new != old:
        write_atomically(folder / MANIFEST_FILE, format_manifest(new).encode())
    lines = [*_told(difference, old, found), *odd]
    if waiting:
        lines.append(
            f"{campaign}: {len(waiting)} changed or missing {_files(len(waiting))} not accepted; "
            f"if a change is right, say `deamat register {campaign} "
            f"--accept {shlex.quote(waiting[0])}`"
            + (", or --accept-all" if len(waiting) > 1 else "")
        )
    if new != old:
        lines.append(f"{campaign}: {len(new)} files registered")
    return Registration("\n".join(lines), bool(waiting))


def _files(count: int) -> str:
    return "file is" if count == 1 else "files are"


def _told(difference: Difference, old: Mapping[str, str], found: Mapping[str, str]) -> list[str]:
    """Say in a line each how the files depart from the manifest."""
    lines = [f"new      {name}" for name in difference.extra]
    lines += [f"extended {name}" for name in difference.extended]
    lines += [f"missing  {name} (was {old[name][:12]})" for name in difference.missing]
    lines += [
        f"changed  {name}: {old[name][:12]} -> {found[name][:12]}" for name in difference.changed
    ]
    return lines


def _accepted(accept: Collection[str], campaign: str, departing: Collection[str]) -> set[str]:
    """Find the files to accept among those that depart from the manifest."""
    names = {path.removeprefix(f"{campaign}/") for path in accept}
    for name in sorted(names - set(departing)):
        near = difflib.get_close_matches(name, departing, n=1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        raise ConfigError(f"{name!r} is no changed or missing file of {campaign}{hint}")
    return names


def _registered(raw: Path, path: str, stat: Stat) -> dict[str, str]:
    if stat.odd:
        raise RawFileError(path, stat.odd)
    try:
        return parse_manifest(read_raw(raw, path).decode("utf-8"), path)
    except UnicodeDecodeError as error:
        raise RawFileError(path, f"not UTF-8: {error}") from error
