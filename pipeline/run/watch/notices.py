"""What the operating system notices of files, as notes on paths; it may miss some."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from watchdog.events import (
    FileClosedEvent,
    FileCreatedEvent,
    FileDeletedEvent,
    FileModifiedEvent,
    FileMovedEvent,
    FileSystemEvent,
    FileSystemEventHandler,
)
from watchdog.observers import Observer
from watchdog.observers.api import BaseObserver
from watchdog.observers.polling import PollingObserver

from deamat.core.errors import ConfigError
from deamat.run.folders import name_as_text
from deamat.run.watch.arrivals import Note

_WRITTEN = (FileCreatedEvent, FileModifiedEvent, FileDeletedEvent)


class Notices(FileSystemEventHandler):
    """Keeps the last note of each path until somebody takes them; never more than there are paths.

    Parameters
    ----------
    roots : each folder that is watched, and what its paths begin with (`raw`)
    """

    def __init__(self, roots: dict[Path, str]) -> None:
        """Start with no notes."""
        self._roots = roots
        self._lock = threading.Lock()
        self._notes: dict[str, Note] = {}
        self.woken = threading.Event()

    def dispatch(self, event: FileSystemEvent) -> None:
        """Note an event; called by the observer's own thread."""
        if isinstance(event, FileMovedEvent):
            self._note(event.dest_path, closed=True)
        elif isinstance(event, FileClosedEvent):
            self._note(event.src_path, closed=True)
        elif isinstance(event, _WRITTEN):
            self._note(event.src_path, closed=False)

    def take(self) -> dict[str, Note]:
        """Return the notes since the last time."""
        self.woken.clear()
        with self._lock:
            notes, self._notes = self._notes, {}
        return notes

    def _note(self, where: str | bytes, *, closed: bool) -> None:
        path = Path(where.decode("utf-8", "surrogateescape") if isinstance(where, bytes) else where)
        for root, prefix in self._roots.items():
            if path.is_relative_to(root):
                name = f"{prefix}/{name_as_text(path.relative_to(root).as_posix())}"
                with self._lock:
                    self._notes[name] = Note(closed, time.monotonic())
                self.woken.set()


@contextmanager
def noticing(roots: dict[Path, str], *, poll: bool) -> Iterator[Notices]:
    """Watch folders and all below them until the end of the block.

    Parameters
    ----------
    poll : ask for the state of files: for network drives, of which the system notices nothing

    Raises
    ------
    ConfigError : the system cannot watch so many folders
    """
    notices = Notices(roots)
    observer: BaseObserver = PollingObserver() if poll else Observer()
    for root in roots:
        observer.schedule(notices, str(root), recursive=True)
    try:
        observer.start()
    except OSError as error:
        raise ConfigError(f"the system cannot watch the folders: {error}; use --poll") from error
    try:
        yield notices
    finally:
        observer.stop()
        observer.join()
