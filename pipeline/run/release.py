"""A release: a folder that appears whole or not at all.

`processed/releases/<id>/` is built beside, then renamed; the link `releases/current` is swapped in
one step, and `processed/cards`, `materials.sqlite` and the others point through it. What did not
change is a hard link to the file of the release before.
"""

from __future__ import annotations

import filecmp
import json
import os
import shutil
from pathlib import Path

_KEPT = 3  # releases beside the current one; an auditor may look back, a disk must not fill
_FACES = ("materials.sqlite", "curves.h5", "cards", "figures", "audit")


class Release:
    """A release in the making."""

    def __init__(self, processed: Path, published: str | None) -> None:
        """Start building; `published` is the `listing` of the release before."""
        self.processed = processed
        self.releases = processed / "releases"
        self.releases.mkdir(parents=True, exist_ok=True)
        for left in self.releases.glob(".building*"):  # of a run that was killed
            shutil.rmtree(left)
        self.building = self.releases / ".building"
        self.building.mkdir()
        self.before, self.files = _known(published)

    def path(self, name: str) -> Path:
        """Where to write an output."""
        path = self.building / name
        path.parent.mkdir(parents=True, exist_ok=True)
        return path

    def keep(self, *names: str) -> bool:
        """Take unchanged outputs over from the release before; False if one is not as it was."""
        place = self.releases / self.before
        if not all(n in self.files and _is(place / n, self.files[n]) for n in names):
            return False
        for name in names:
            os.link(place / name, self.path(name))
        return True

    def publish(self, name: str) -> Path:
        """Make the release whole and current."""
        for path in sorted(self.building.rglob("*")):
            _sync(path)
        _sync(self.building)
        place = self.releases / name
        number = 1
        while place.exists() and not _same(self.building, place):
            number += 1  # somebody changed a published file: leave it as evidence
            place = self.releases / f"{name}-{number}"
        if place.exists():
            shutil.rmtree(self.building)
        else:
            self.building.rename(place)
        _sync(self.releases)
        _point(self.releases / "current", place.name)
        for face in _FACES:
            _point(self.processed / face, f"releases/current/{face}")
        self._prune(place)
        return place

    def _prune(self, current: Path) -> None:
        old = [p for p in self.releases.iterdir() if p.is_dir() and not p.is_symlink()]
        old = sorted((p for p in old if p != current), key=lambda p: (p.stat().st_mtime_ns, p.name))
        for path in old[:-_KEPT]:
            shutil.rmtree(path)


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
    name, files = _known(published)
    place = processed / "releases" / name
    links = [processed / face for face in _FACES]
    return (
        bool(name)
        and all(link.is_symlink() for link in links)
        and _leads_to(processed / "releases" / "current", name)
        and all(_is(place / file, seen) for file, seen in files.items())
    )


def _known(published: str | None) -> tuple[str, dict[str, list[int]]]:
    """Read a `listing` back: the release's name and its files."""
    if published is None:
        return "", {}
    name, files = json.loads(published)
    return name, files


def _is(path: Path, seen: list[int]) -> bool:
    """Say whether a file has the size and time of change that were listed."""
    try:
        stat = path.stat()
    except FileNotFoundError:
        return False
    return [stat.st_size, stat.st_mtime_ns] == seen


def _leads_to(link: Path, target: str) -> bool:
    return link.is_symlink() and str(link.readlink()) == target


def _point(link: Path, target: str) -> None:
    """Swap a link in one step."""
    if _leads_to(link, target):
        return
    beside = link.with_name(f".{link.name}.new")
    beside.unlink(missing_ok=True)
    beside.symlink_to(target)
    beside.replace(link)
    _sync(link.parent)


def _same(one: Path, other: Path) -> bool:
    """Say whether two folders hold the same files with the same bytes."""
    names = [{str(p.relative_to(d)) for p in d.rglob("*") if p.is_file()} for d in (one, other)]
    return names[0] == names[1] and all(
        filecmp.cmp(one / n, other / n, shallow=False) for n in names[0]
    )


def _sync(path: Path) -> None:
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
