"""A release: a folder that appears whole or not at all.

`processed/releases/<id>/` is built beside, then renamed; the link `releases/current` is swapped in
one step, and `processed/cards`, `materials.sqlite` and the others point through it. What did not
change is a hard link to the file of the release before.
"""

from __future__ import annotations

import filecmp
import os
import shutil
from pathlib import Path

from deamat.core.atomic import rename_whole, turn_link
from deamat.run.published import FACES, as_listed, known, leads_to

_KEPT = 3  # releases beside the current one; an auditor may look back, a disk must not fill


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
        self.before, self.files = known(published)

    def path(self, name: str) -> Path:
        """Where to write an output."""
        path = self.building / name
        path.parent.mkdir(parents=True, exist_ok=True)
        return path

    def keep(self, *names: str) -> bool:
        """Take unchanged outputs over from the release before; False if one is not as it was."""
        place = self.releases / self.before
        if not all(n in self.files and as_listed(place / n, self.files[n]) for n in names):
            return False
        for name in names:
            os.link(place / name, self.path(name))
        return True

    def drop(self, *names: str) -> None:
        """Leave outputs out that could not be made whole."""
        for name in names:
            if os.path.lexists(self.building / name):  # False as well for a name that is too long
                (self.building / name).unlink()

    def publish(self, name: str) -> Path:
        """Make the release whole and current."""
        place = self.releases / name
        number = 1
        while place.exists() and not _same(self.building, place):
            number += 1  # somebody changed a published file: leave it as evidence
            place = self.releases / f"{name}-{number}"
        if place.exists():
            shutil.rmtree(self.building)
        else:
            rename_whole(self.building, place)
        _point(self.releases / "current", place.name)
        for face in FACES:
            _point(self.processed / face, f"releases/current/{face}")
        self._prune(place)
        return place

    def _prune(self, current: Path) -> None:
        old = [p for p in self.releases.iterdir() if p.is_dir() and not p.is_symlink()]
        old = sorted((p for p in old if p != current), key=lambda p: (p.stat().st_mtime_ns, p.name))
        for path in old[:-_KEPT]:
            shutil.rmtree(path)


def _point(link: Path, target: str) -> None:
    if not leads_to(link, target):
        turn_link(link, target)


def _same(one: Path, other: Path) -> bool:
    """Say whether two folders hold the same files with the same bytes."""
    names = [{str(p.relative_to(d)) for p in d.rglob("*") if p.is_file()} for d in (one, other)]
    return names[0] == names[1] and all(
        filecmp.cmp(one / n, other / n, shallow=False) for n in names[0]
    )
