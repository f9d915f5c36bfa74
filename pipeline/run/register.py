"""`deamat register`: the one command that writes into `raw/`, and only a manifest."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

from deamat.core.atomic import write_atomically
from deamat.core.campaign import CAMPAIGN_FILE, MANIFEST_FILE
from deamat.core.errors import ConfigError
from deamat.core.manifest import compare, format_manifest, parse_manifest


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
    found = {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path != manifest and not path.name.startswith(".")
    }
    old = {}
    if manifest.is_file():
        text = manifest.read_bytes().decode("utf-8")
        old = parse_manifest(text, f"{campaign}/{MANIFEST_FILE}")
    difference = compare(old, found)
    lines = [f"new      {name}" for name in difference.extra]
    lines += [f"missing  {name} (was {old[name][:12]})" for name in difference.missing]
    lines += [
        f"changed  {name}: {old[name][:12]} -> {found[name][:12]}" for name in difference.changed
    ]
    if not lines:
        return Registration(f"{campaign}: {len(found)} files, all as in the manifest", False)
    if (difference.changed or difference.missing) and not accept:
        lines.append(
            f"{campaign}: nothing written; if these changes are right, say "
            f"`deamat register {campaign} --accept`"
        )
        return Registration("\n".join(lines), True)
    write_atomically(manifest, format_manifest(found).encode())
    lines.append(f"{campaign}: {len(found)} files registered")
    return Registration("\n".join(lines), False)
