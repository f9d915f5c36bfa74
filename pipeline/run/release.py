"""A release: a folder that appears whole or not at all.

`processed/releases/<id>/` is built beside, then renamed; the link `releases/current` is swapped in
one step, and `processed/cards`, `materials.sqlite` and the others point through it. What did not
change is a hard link to the file of the release before.
"""

from __future__ import annotations

import filecmp
import os
import re
import shutil
from collections.abc import Callable
from pathlib import Path

from deamat.core.atomic import rename_whole, turn_link
from deamat.run.published import FACES, as_listed, known, leads_to
from deamat.run.state import out_of_the_way

_NAME = re.compile(r"[0-9a-f]{12}(-[0-9]+)?")  # of a release; other folders are not ours to delete
_READ_ONLY = 0o444
_KEPT = 3  # releases beside the current one; an auditor may look back, a disk must not fill


class Release:
    """A release in the making."""

    def __init__(self, processed: Path, published: str | None) -> None:
        """Start building; `published` is the `listing` of the release before."""
        self.processed = processed
        self.releases = processed / "releases"
        self.aside: list[str] = []  # what was found in the way, in words
        self._make_room(self.releases, Path.is_dir, "was no folder")
        self.releases.mkdir(parents=True, exist_ok=True)
        for left in self.releases.glob(".building*"):  # of a run that was killed
            self._make_room(left, _is_own_folder, "was no folder")
            shutil.rmtree(left, ignore_errors=True)
        self.building = self.releases / ".building"
        self.building.mkdir()
        self.before, self.files = known(published)

    def _make_room(self, place: Path, is_expected: Callable[[Path], bool], why: str) -> None:
        if os.path.lexists(place) and not is_expected(place):
            self.aside.append(out_of_the_way(place, why))

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
            try:
                os.link(place / name, self.path(name))
            except OSError:  # a file system without hard links, or too many of them
                shutil.copy2(place / name, self.path(name))
        return True

    def drop(self, *names: str) -> None:
        """Leave outputs out that could not be made whole."""
        for name in names:
            if os.path.lexists(self.building / name):  # False as well for a name that is too long
                (self.building / name).unlink()

    def publish(self, name: str) -> Path:
        """Make the release whole and current; its files can be read, but not written into.

        A file that did not change is one with that of the release before: whoever wrote into it
        would rewrite the past.
        """
        for path in self.building.rglob("*"):
            if path.is_file():
                path.chmod(_READ_ONLY)
        place = self.releases / name
        number = 1
        while os.path.lexists(place) and not _same(self.building, place):
            number += 1  # somebody changed a published file: leave it as evidence
            place = self.releases / f"{name}-{number}"
        if place.exists():
            shutil.rmtree(self.building)
            os.utime(place)  # as young as one that was made now
        else:
            rename_whole(self.building, place)
        self._point(self.releases / "current", place.name)
        for face in FACES:
            self._point(self.processed / face, f"releases/current/{face}")
        self._prune(place)
        return place

    def _prune(self, current: Path) -> None:
        old = [p for p in self.releases.iterdir() if _NAME.fullmatch(p.name) and _is_own_folder(p)]
        old = sorted((p for p in old if p != current), key=lambda p: (p.stat().st_mtime_ns, p.name))
        for path in old[:-_KEPT]:
            shutil.rmtree(path, ignore_errors=True)

    def _point(self, link: Path, target: str) -> None:
        self._make_room(link, Path.is_symlink, "was no link of this program")
        if not leads_to(link, target):
            turn_link(link, target)


def _is_own_folder(path: Path) -> bool:
    return path.is_dir() and not path.is_symlink()


def _same(one: Path, other: Path) -> bool:
    """Say whether two folders hold the same files with the same bytes."""
    names = [{str(p.relative_to(d)) for p in d.rglob("*") if p.is_file()} for d in (one, other)]
    return names[0] == names[1] and all(
        filecmp.cmp(one / n, other / n, shallow=False) for n in names[0]
    )
