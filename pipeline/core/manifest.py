"""`MANIFEST.sha256`: what `sha256sum -c` reads; says which bytes a campaign was registered with."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from deamat.core.errors import RawFileError

_LINE = re.compile(r"([0-9a-f]{64}) [ *](.+)")


@dataclass(frozen=True, slots=True)
class Difference:
    """How the files of a campaign depart from its manifest; names relative to the campaign."""

    changed: tuple[str, ...]
    missing: tuple[str, ...]
    extra: tuple[str, ...]

    def __bool__(self) -> bool:
        return bool(self.changed or self.missing or self.extra)


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


def compare(registered: Mapping[str, str], found: Mapping[str, str]) -> Difference:
    """Hold the hashes found against the registered ones."""
    return Difference(
        changed=tuple(sorted(n for n in found if n in registered and found[n] != registered[n])),
        missing=tuple(sorted(set(registered) - set(found))),
        extra=tuple(sorted(set(found) - set(registered))),
    )
