"""`MANIFEST.sha256`: what `sha256sum -c` reads; says which bytes a campaign was registered with."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from deamat.core.errors import RawFileError

_LINE = re.compile(r"([0-9a-f]{64}) [ *](.+)")


@dataclass(frozen=True, slots=True)
class Difference:
    """How the files of a campaign depart from its manifest; names relative to the campaign.

    Parameters
    ----------
    extended : registers to which rows were appended: all that was registered still stands in them
    """

    changed: tuple[str, ...]
    missing: tuple[str, ...]
    extra: tuple[str, ...]
    extended: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.changed or self.missing or self.extra or self.extended)


def parse_manifest(text: str, path: str) -> dict[str, str]:
    """Read a manifest into file name to sha256.

    Raises
    ------
    RawFileError : a line that is not `<64 hex digits>  <file>`, or a file that is listed twice
    """
    hashes: dict[str, str] = {}
    for number, line in enumerate(text.splitlines(), start=1):
        if not line.strip():
            continue
        match = _LINE.fullmatch(line)
        if not match:
            raise RawFileError(path, "not a line of sha256sum", number, value=line[:80])
        if match[2] in hashes:
            raise RawFileError(path, "a file is listed twice", number, value=match[2])
        hashes[match[2]] = match[1]
    return hashes


def format_manifest(hashes: Mapping[str, str]) -> str:
    """Write a manifest, sorted by name."""
    return "".join(f"{hashes[name]}  {name}\n" for name in sorted(hashes))


def extends(data: bytes, sha256: str) -> bool:
    """Say whether a text begins with whole lines whose hash is this one: rows were appended."""
    digest = hashlib.sha256()
    for line in data.splitlines(keepends=True):
        bare = line.rstrip(b"\r\n")
        digest.update(bare)
        if line != bare and digest.hexdigest() == sha256:  # its last line had no end
            return True
        digest.update(line[len(bare) :])
        if digest.hexdigest() == sha256:
            return True
    return False


def _never(name: str, sha256: str) -> bool:
    del name, sha256
    return False


def compare(
    registered: Mapping[str, str],
    found: Mapping[str, str],
    extended: Callable[[str, str], bool] = _never,
) -> Difference:
    """Hold the hashes found against the registered ones.

    Parameters
    ----------
    extended : told a name and its registered hash, says whether the file only had rows appended
    """
    differs = {n: registered[n] for n in found if n in registered and found[n] != registered[n]}
    grown = {name for name, sha256 in differs.items() if extended(name, sha256)}
    return Difference(
        changed=tuple(sorted(set(differs) - grown)),
        missing=tuple(sorted(set(registered) - set(found))),
        extra=tuple(sorted(set(found) - set(registered))),
        extended=tuple(sorted(grown)),
    )
