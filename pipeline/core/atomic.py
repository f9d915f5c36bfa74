"""Files that appear whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

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
    _synchronise_folder(path.parent)


def _synchronise_folder(folder: Path) -> None:
    # Without it a power cut may forget the new name although the bytes are on the disk.
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
