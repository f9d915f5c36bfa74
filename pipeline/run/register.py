"""`deamat register`: the one command that writes into `raw/`, and only a manifest."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

from deamat.core.atomic import write_atomically
from deamat.core.campaign import CAMPAIGN_FILE, MANIFEST_FILE
from deamat.core.errors import ConfigError, RawFileError
from deamat.core.manifest import compare, format_manifest, parse_manifest
from deamat.formats.rawfile import read_raw
from deamat.run.folders import Stat, walk


@dataclass(frozen=True, slots=True)
class Registration:
    """What `register` did or would do.

    Parameters
    ----------
    pending : changed or missing files wait for `--accept`; nothing was written
    """

    text: str
    pending: bool


def register(raw: Path, campaign: str, accept: bool) -> Registration:
    """Write or extend a manifest; changed and missing files are shown first, and need `accept`.

    Raises
    ------
    ConfigError : there is no such campaign
    RawFileError : the manifest that is there cannot be read
    """
    folder = raw / campaign
    if folder.parent != raw or campaign in ("", ".", ".."):
        raise ConfigError(f"{campaign!r} is not the name of a folder in {raw}")
    if not (folder / CAMPAIGN_FILE).is_file():
        raise ConfigError(f"{folder} is no campaign: it has no {CAMPAIGN_FILE}")
    manifest = folder / MANIFEST_FILE
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
    difference = compare(old, found)
    lines = [f"new      {name}" for name in difference.extra]
    lines += [f"missing  {name} (was {old[name][:12]})" for name in difference.missing]
    lines += [
        f"changed  {name}: {old[name][:12]} -> {found[name][:12]}" for name in difference.changed
    ]
    if not lines:
        said = f"{campaign}: {len(found)} files, all as in the manifest"
        return Registration("\n".join([*odd, said]), False)
    lines += odd
    if (difference.changed or difference.missing) and not accept:
        lines.append(
            f"{campaign}: nothing written; if these changes are right, say "
            f"`deamat register {campaign} --accept`"
        )
        return Registration("\n".join(lines), True)
    write_atomically(manifest, format_manifest(found).encode())
    lines.append(f"{campaign}: {len(found)} files registered")
    return Registration("\n".join(lines), False)


def _registered(raw: Path, path: str, stat: Stat) -> dict[str, str]:
    if stat.odd:
        raise RawFileError(path, stat.odd)
    try:
        return parse_manifest(read_raw(raw, path).decode("utf-8"), path)
    except UnicodeDecodeError as error:
        raise RawFileError(path, f"not UTF-8: {error}") from error
