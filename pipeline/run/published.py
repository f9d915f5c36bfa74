"""What stands in the published release. Standard library only, and little of it: the no-op path."""

from __future__ import annotations

import json
from pathlib import Path

FACES = ("materials.sqlite", "curves.h5", "cards", "figures", "audit")


def listing(place: Path) -> str:
    """What stands in a release, to be held against `intact` later."""
    files = {
        str(p.relative_to(place)): [p.stat().st_size, p.stat().st_mtime_ns]
        for p in sorted(place.rglob("*"))
        if p.is_file()
    }
    return json.dumps([place.name, files])


def intact(processed: Path, published: str | None) -> bool:
    """Say whether the published release is still there, file for file."""
    name, files = known(published)
    place = processed / "releases" / name
    links = [processed / face for face in FACES]
    return (
        bool(name)
        and all(link.is_symlink() for link in links)
        and leads_to(processed / "releases" / "current", name)
        and all(as_listed(place / file, seen) for file, seen in files.items())
    )


def known(published: str | None) -> tuple[str, dict[str, list[int]]]:
    """Read a `listing` back: the release's name and its files."""
    if published is None:
        return "", {}
    name, files = json.loads(published)
    return name, files


def as_listed(path: Path, seen: list[int]) -> bool:
    """Say whether a file has the size and time of change that were listed."""
    try:
        stat = path.stat()
    except FileNotFoundError:
        return False
    return [stat.st_size, stat.st_mtime_ns] == seen


def leads_to(link: Path, target: str) -> bool:
    """Say whether there is such a link, to that target."""
    return link.is_symlink() and str(link.readlink()) == target
