"""The three folders of a run and what stands in them. Standard library only: the no-op path."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from stat import S_IFIFO, S_IFMT, S_IFSOCK, S_ISDIR, S_ISREG

_PACKAGE = Path(__file__).resolve().parents[1]
_SPACE = 0x20


@dataclass(frozen=True, slots=True)
class Folders:
    """Where raw data, configuration and results stand."""

    raw: Path
    config: Path
    processed: Path


@dataclass(frozen=True, slots=True)
class Stat:
    """What tells that a file is as it was: an equal one need not be hashed again.

    Parameters
    ----------
    ctime_ns, inode : change with the file also where its size and `mtime_ns` are put back
    odd : why it must not be opened, empty for a regular file
    """

    size: int
    mtime_ns: int
    ctime_ns: int
    inode: int
    odd: str = ""


@dataclass(frozen=True, slots=True)
class Input:
    """A file as a run reads it.

    Parameters
    ----------
    sha256 : of its bytes, empty where they cannot be read
    odd : why they cannot, empty where they can
    """

    size: int
    sha256: str
    odd: str = ""


def look(folders: Folders) -> dict[str, Stat]:
    """List every input: `raw/...`, `config/...` and the package's own sources as `code/...`."""
    roots = {"raw": folders.raw, "config": folders.config, "code": _PACKAGE}
    return {path: stat for prefix, root in roots.items() for path, stat in walk(str(root), prefix)}


def locate(path: str, folders: Folders) -> Path:
    """Return the place on disk of a path that `look` listed."""
    prefix, _, rest = path.partition("/")
    return {"raw": folders.raw, "config": folders.config, "code": _PACKAGE}[prefix] / rest


def walk(root: str, prefix: str, passed: tuple[str, ...] = ()) -> Iterator[tuple[str, Stat]]:
    """List the files of a folder and of those in it, hidden ones left out, without opening any.

    Parameters
    ----------
    prefix : what names begin with, in place of the folder's own
    passed : folders that links led to on the way here
    """
    with os.scandir(root) as entries:
        for entry in sorted(entries, key=lambda e: e.name):
            if entry.name.startswith(".") or entry.name == "__pycache__":
                continue
            name = f"{prefix}/{name_as_text(entry.name)}"
            try:
                stat = entry.stat()
                through = _through(entry, root, passed) if S_ISDIR(stat.st_mode) else passed
                odd = _oddity(entry.name, stat.st_mode)
                if not odd and S_ISDIR(stat.st_mode):
                    yield from walk(entry.path, name, through)
                    continue
            except OSError as error:
                stat, odd = None, _unreadable(entry, error)
            if odd or stat is None:
                yield name, Stat(0, 0, 0, 0, odd)
            else:
                at = stat.st_mtime_ns, stat.st_ctime_ns
                yield name, Stat(stat.st_size, *at, stat.st_ino)


def _through(entry: os.DirEntry[str], root: str, passed: tuple[str, ...]) -> tuple[str, ...]:
    """Add a folder to those that links led to.

    Raises
    ------
    OSError : it holds the link that leads to it
    """
    if not entry.is_symlink():
        return passed
    real, here = os.path.realpath(entry.path), os.path.realpath(root)
    if real in passed or real == here or here.startswith(real + os.sep):
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
    return (*passed, real)


def _oddity(name: str, mode: int) -> str:
    """Say why a file is not to be opened; empty for a regular file and for a folder."""
    if name_as_text(name) != name:
        return "its name is not UTF-8 text; rename it"
    if any(ord(character) < _SPACE for character in name):
        return "its name holds a control character; rename it"
    if S_ISREG(mode) or S_ISDIR(mode):
        return ""
    kinds = {S_IFIFO: "a named pipe (FIFO)", S_IFSOCK: "a socket"}
    return f"{kinds.get(S_IFMT(mode), 'a device')}, no regular file; it was not opened"


def _unreadable(entry: os.DirEntry[str], error: OSError) -> str:
    if error.errno == errno.ELOOP:
        return "a link that leads back to itself"
    if entry.is_symlink() and isinstance(error, FileNotFoundError):
        return "a link that leads nowhere"
    return f"it cannot be read: {error.strerror}"


def name_as_text(name: str) -> str:
    """Return a name as text that can be printed and stored, whatever its bytes."""
    return os.fsencode(name).decode("utf-8", "backslashreplace")
