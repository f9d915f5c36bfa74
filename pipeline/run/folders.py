"""The three folders of a run and what stands in them. Standard library only: the no-op path."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parents[1]


@dataclass(frozen=True, slots=True)
class Folders:
    """Where raw data, configuration and results stand."""

    raw: Path
    config: Path
    processed: Path


@dataclass(frozen=True, slots=True)
class Stat:
    """A file's size and time of change: equal ones need not be hashed again."""

    size: int
    mtime_ns: int


def look(folders: Folders) -> dict[str, Stat]:
    """List every input: `raw/...`, `config/...` and the package's own sources as `code/...`."""
    roots = {"raw": folders.raw, "config": folders.config, "code": _PACKAGE}
    return {path: stat for prefix, root in roots.items() for path, stat in _walk(str(root), prefix)}


def locate(path: str, folders: Folders) -> Path:
    """Return the place on disk of a path that `look` listed."""
    prefix, _, rest = path.partition("/")
    return {"raw": folders.raw, "config": folders.config, "code": _PACKAGE}[prefix] / rest


def _walk(root: str, prefix: str) -> Iterator[tuple[str, Stat]]:
    with os.scandir(root) as entries:
        for entry in sorted(entries, key=lambda e: e.name):
            if entry.name.startswith(".") or entry.name == "__pycache__":
                continue
            name = f"{prefix}/{entry.name}"
            if entry.is_dir():
                yield from _walk(entry.path, name)
            else:
                stat = entry.stat()
                yield name, Stat(stat.st_size, stat.st_mtime_ns)
