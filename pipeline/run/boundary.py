"""The one boundary for failures: whatever a unit of work raises becomes a value here.

Project errors that a unit expects are data long before (a rejection, a refusal). What nobody
foresaw, in a reader, a room or a library, takes away that unit alone; the run goes on.
"""

from __future__ import annotations

import errno
import re
import sqlite3
import traceback
from collections.abc import Callable, Sequence
from typing import TypeVar

from deamat.core.ledger import Failure

T = TypeVar("T")

FAILED = "failed"  # what stands for the key of something that could not be made

_INSTALLED = re.compile(r'File "[^"\n]*?((?:[^/\\"\n]+[/\\]){0,2}[^/\\"\n]+)"')
_ADDRESS = re.compile(r"\b0x[0-9a-f]{6,}")
# The machine and not the unit is at fault: every other unit would meet it as well.
_OF_THE_MACHINE = frozenset(
    {
        *(errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EACCES, errno.EPERM, errno.EIO),
        *(errno.EFBIG, errno.ENOMEM),
        *(errno.EMFILE, errno.ENFILE),
    }
)
_OF_THE_MACHINE_IN_SQLITE = frozenset(
    {
        *(sqlite3.SQLITE_FULL, sqlite3.SQLITE_READONLY, sqlite3.SQLITE_IOERR),
        *(sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_PERM, sqlite3.SQLITE_NOMEM),
    }
)


def attempt(stage: str, subject: str, files: Sequence[str], work: Callable[[], T]) -> T | Failure:
    """Do a unit of work and return what it returns, or what went wrong.

    Parameters
    ----------
    stage, subject : how the unit is called
    files : raw files that it rests on

    Raises
    ------
    OSError, sqlite3.Error : the disk is full, a folder cannot be written: no matter of this unit
    """
    try:
        return work()
    except Exception as error:  # the one place: a unit may call any room, reader and library
        if is_of_the_machine(error):
            raise
        said = "".join(traceback.format_exception_only(error)).strip().splitlines()[-1]
        told = "".join(traceback.format_exception(error))
        return Failure(stage, subject, _bare(said), _bare(told), tuple(files))


def killed(stage: str, subject: str, files: Sequence[str]) -> Failure:
    """Say that the worker process ended over a unit, twice, without a word."""
    error = "the worker process was killed or crashed over it, perhaps out of memory"
    return Failure(stage, subject, error, "", tuple(files))


def is_of_the_machine(error: Exception) -> bool:
    """Say whether the disk, the file system or the memory is at fault, and not the work."""
    if isinstance(error, sqlite3.Error):
        code = getattr(error, "sqlite_errorcode", None)  # extended: the low byte is the kind
        return code is not None and code & 0xFF in _OF_THE_MACHINE_IN_SQLITE
    return isinstance(error, OSError) and error.errno in _OF_THE_MACHINE


def _bare(text: str) -> str:
    """Leave out where the program is installed and where its objects lie in memory."""
    return _ADDRESS.sub("0x...", _INSTALLED.sub(r'File "\1"', text))
