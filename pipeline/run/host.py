"""What differs between platforms: the number of CPUs, and a lock that ends with its process."""

from __future__ import annotations

import errno
import os
from importlib import import_module
from pathlib import Path

_TAKEN = (errno.EACCES, errno.EAGAIN, errno.EDEADLK)
_held: set[tuple[int, Path]] = set()  # with the process: a worker inherits this set, not the lock


def cpu_count() -> int:
    """Count the CPUs that this process may use, as far as the platform tells."""
    process_cpu_count = getattr(os, "process_cpu_count", None)  # from Python 3.13 on
    if process_cpu_count is not None:
        return process_cpu_count() or 1
    sched_getaffinity = getattr(os, "sched_getaffinity", None)  # Linux
    if sched_getaffinity is not None:
        return len(sched_getaffinity(0))
    return os.cpu_count() or 1


class Lock:
    """An exclusive lock on a file, released at the latest when the process that took it ends.

    It is a record lock (POSIX) or a byte-range lock (Windows): unlike that of `flock`, it is not
    inherited, so a worker that outlives its parent for a moment does not keep it.

    Raises
    ------
    BlockingIOError : another process, or this one, holds it
    OSError : the file cannot be opened or the file system has no locks
    """

    def __init__(self, path: Path) -> None:
        self._holder = os.getpid(), path.resolve()
        if self._holder in _held:  # record locks do not keep a process from itself
            raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN), str(path))
        self._file = path.open("ab")
        try:
            _lock(self._file.fileno())
        except OSError as error:
            self._file.close()
            if error.errno in _TAKEN:
                raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN), str(path)) from error
            raise
        _held.add(self._holder)

    def release(self) -> None:
        """Let others have it."""
        _held.discard(self._holder)
        self._file.close()


def _lock(descriptor: int) -> None:
    try:
        fcntl = import_module("fcntl")
    except ImportError:
        msvcrt = import_module("msvcrt")
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
    else:
        fcntl.lockf(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
