"""Files and folders that appear whole or not at all."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path

from deamat.core.errors import ConfigError

PART_SUFFIX = ".part"  # what a killed run may leave behind; nothing reads such files


def write_atomically(path: Path, data: bytes) -> None:
    """Write a file so that any reader finds either the old bytes or all of the new ones.

    The bytes go to a hidden file beside the target, are synchronised to the disk, and take the
    target's name in one step; the folder is made if it is not there.

    Parameters
    ----------
    path : the file to make or to replace
    data : everything it shall hold

    Raises
    ------
    OSError : the disk is full, the folder cannot be written, `path` is a folder; the old file is
        untouched then and nothing is left beside it
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    # The name is our own and not tempfile's, whose files nobody but their owner may read.
    part = path.with_name(f".{os.urandom(8).hex()}{PART_SUFFIX}")
    try:
        with part.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
    _synchronise(path.parent)


def turn_link(link: Path, target: str) -> None:
    """Let a link lead to `target` in one step; it is made if it is not there.

    Raises
    ------
    OSError : something that is no file and no link stands at `link`
    """
    part = link.with_name(f".{link.name}{PART_SUFFIX}")
    part.unlink(missing_ok=True)
    part.symlink_to(target)
    part.replace(link)
    _synchronise(link.parent)


def rename_whole(folder: Path, place: Path) -> None:
    """Synchronise everything in a folder to the disk, then let it take its name in one step.

    Raises
    ------
    OSError : a folder that is not empty stands at `place`
    """
    _synchronise_tree(folder)
    folder.rename(place)
    _synchronise(place.parent)


@contextmanager
def new_folder(place: Path) -> Iterator[Path]:
    """Yield an empty folder to fill, which becomes `place` once it is filled without an error.

    Parameters
    ----------
    place : what must not be there yet; its parent is made if it is not there

    Raises
    ------
    OSError : a folder that is not empty stands at `place`
    """
    place.parent.mkdir(parents=True, exist_ok=True)
    part = place.with_name(f".{place.name}{PART_SUFFIX}")
    shutil.rmtree(part, ignore_errors=True)  # what a run that was killed left behind
    part.mkdir()
    try:
        yield part
        rename_whole(part, place)
    finally:
        shutil.rmtree(part, ignore_errors=True)


def set_aside(path: Path, ending: str) -> Path:
    """Rename what stands at a path to a visible name beside it, so that its place is free.

    Parameters
    ----------
    ending : what is put behind the name, with a number where that is taken
    """
    for number in count(1):
        more = "" if number == 1 else f"-{number}"
        aside = path.with_name(f"{path.name.lstrip('.')}.{ending}{more}")
        if not os.path.lexists(aside):
            break
    return path.rename(aside)


@contextmanager
def whole_folder(place: Path) -> Iterator[Path]:
    """Yield an empty folder to fill, which replaces `place` once it is filled without an error.

    `place` is a link that leads to one of two hidden folders beside it. The one that it does not
    lead to is filled, the link is turned, and the other one is removed: a reader finds the old
    content or all of the new one.

    Parameters
    ----------
    place : where readers look; its parent is made if it is not there

    Raises
    ------
    ConfigError : something that is not such a link stands at `place`
    """
    if place.exists() and not place.is_symlink():
        raise ConfigError(f"{place} is not a link made by this program; move it away and try again")
    place.parent.mkdir(parents=True, exist_ok=True)
    slots = [place.with_name(f".{place.name}-{side}") for side in ("a", "b")]
    old = slots[0] if place.is_symlink() and place.readlink() == Path(slots[0].name) else slots[1]
    new = slots[1] if old is slots[0] else slots[0]
    shutil.rmtree(new, ignore_errors=True)  # what a run that was killed left behind
    new.mkdir()
    whole = False
    try:
        yield new
        _synchronise_tree(new)
        turn_link(place, new.name)
        whole = True
    finally:
        if not whole:
            shutil.rmtree(new, ignore_errors=True)
    shutil.rmtree(old, ignore_errors=True)


def _synchronise_tree(folder: Path) -> None:
    for path in sorted(folder.rglob("*")):
        _synchronise(path)
    _synchronise(folder)


def _synchronise(path: Path) -> None:
    # Without it a power cut may forget a new name although the bytes are on the disk.
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
