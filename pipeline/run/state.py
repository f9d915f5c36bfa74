"""`state.sqlite`: what was seen, made and published, so that only what changed is redone.

It is a cache: deleting it costs time, never a result. A damaged one is set aside and begun anew;
every row carries a checksum, for a wrong bit need not make SQLite stumble. Standard library only:
the no-op path.
"""

from __future__ import annotations

import contextlib
import json
import os
import sqlite3
import zlib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

from deamat.core.atomic import set_aside
from deamat.core.errors import ConfigError, PipelineError
from deamat.run.boundary import is_of_the_machine
from deamat.run.folders import Input, Stat
from deamat.run.host import Lock

STATE_FILE = "state.sqlite"

_SCHEMA = """
CREATE TABLE IF NOT EXISTS input(path TEXT PRIMARY KEY, size INT, mtime_ns INT, ctime_ns INT,
    inode INT, odd TEXT, sha256 TEXT, checksum INT);
CREATE TABLE IF NOT EXISTS made(stage TEXT, subject TEXT, key TEXT, components TEXT, checksum INT,
    result BLOB, checksum_of_result INT, PRIMARY KEY(stage, subject));
CREATE TABLE IF NOT EXISTS note(name TEXT PRIMARY KEY, value TEXT, checksum INT);
"""
_VERSION = 2
_NEVER = -1  # a time of change that no file has: what could not be read is tried again


class DamagedState(PipelineError):
    """The cache is not what this program wrote; whoever meets it begins it anew."""


class State:
    """The state of one processed folder, locked against a second run while it is open.

    Parameters
    ----------
    read_only : nothing is written, not even a lock; what is to be remembered is forgotten

    Raises
    ------
    ConfigError : another run is working
    DamagedState : the file is no such cache
    """

    def __init__(self, processed: Path, read_only: bool = False) -> None:
        self.aside: list[str] = []  # what was found in the way, in words
        self._read_only = read_only
        self._lock = None if read_only else self._locked(processed)
        try:
            self.db = self._open(processed / STATE_FILE)
        except BaseException:  # also Ctrl-C: nothing is swallowed, but the lock must not stay
            self._unlock()
            raise

    def _locked(self, processed: Path) -> Lock:
        processed.mkdir(parents=True, exist_ok=True)
        for name in (".lock", STATE_FILE):
            if os.path.lexists(processed / name) and not (processed / name).is_file():
                self.aside.append(out_of_the_way(processed / name, "was no regular file"))
        try:
            return Lock(processed / ".lock")
        except BlockingIOError as error:
            raise ConfigError(f"another run is working in {processed}; wait for it") from error

    def _unlock(self) -> None:
        if self._lock is not None:
            self._lock.release()

    def _open(self, path: Path) -> sqlite3.Connection:
        """Open the cache; one of another version is begun anew."""
        if self._read_only and not path.is_file():
            return _begun(sqlite3.connect(":memory:"))
        db = sqlite3.connect(f"{path.absolute().as_uri()}?mode={_mode(self._read_only)}", uri=True)
        try:
            ((version,),) = db.execute("PRAGMA user_version").fetchall()
            if version not in (0, _VERSION):
                db.close()
                return self._another(path)
            if version == 0 and not self._read_only:
                _begun(db)  # no write, to wait for the disk with, where everything is there
            db.execute("SELECT 1 FROM input, made, note LIMIT 0")
        except sqlite3.DatabaseError as error:
            db.close()
            raise _told(error) from error
        return db

    def _another(self, path: Path) -> sqlite3.Connection:
        if self._read_only:
            return _begun(sqlite3.connect(":memory:"))
        path.unlink()
        return _begun(sqlite3.connect(path))

    def __enter__(self) -> State:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            if kind is None:
                self.commit()
            else:  # what was noted of outputs that were never published must not be believed
                with contextlib.suppress(sqlite3.Error):
                    self.db.rollback()
        finally:
            self.db.close()
            self._unlock()

    def _rows(self, query: str, *values: str) -> list[Any]:
        try:
            return self.db.execute(query, values).fetchall()
        except sqlite3.DatabaseError as error:
            raise _told(error) from error

    def _change(self, statement: str, rows: Iterable[Sequence[object]] = ((),)) -> None:
        if self._read_only:
            return
        try:
            self.db.executemany(statement, rows)
        except sqlite3.DatabaseError as error:
            raise _told(error) from error

    def commit(self) -> None:
        """Keep what was remembered so far, whatever becomes of the run."""
        try:
            self.db.commit()
        except sqlite3.DatabaseError as error:
            raise _told(error) from error

    def inputs(self) -> dict[str, tuple[Stat, str]]:
        """Path to what was seen and hashed last time."""
        rows = self._rows(
            "SELECT path, size, mtime_ns, ctime_ns, inode, odd, sha256, checksum FROM input"
        )
        return {path: (Stat(*seen), sha) for path, *seen, sha in map(_sound, rows)}

    def unchanged(self, seen: Mapping[str, Stat]) -> bool:
        """Say whether exactly these inputs were seen when the last release was published."""
        rows = self._rows("SELECT path, size, mtime_ns, ctime_ns, inode, odd FROM input")
        return len(rows) == len(seen) and all(
            path in seen and seen[path] == Stat(*before) for path, *before in rows
        )

    def remember_inputs(self, seen: Mapping[str, Stat], inputs: Mapping[str, Input]) -> None:
        """Replace what is known of the inputs."""
        self._change("DELETE FROM input")
        rows = []
        for path, stat in seen.items():
            lost = inputs[path].odd and not stat.odd
            mtime_ns = _NEVER if lost else stat.mtime_ns
            row = (path, stat.size, mtime_ns, stat.ctime_ns, stat.inode, stat.odd)
            rows.append(_checked(*row, inputs[path].sha256))
        self._change("INSERT INTO input VALUES (?, ?, ?, ?, ?, ?, ?, ?)", rows)

    def stages(self) -> set[str]:
        """The stages of which something is remembered."""
        return {stage for (stage,) in self._rows("SELECT DISTINCT stage FROM made")}

    def made(self, stage: str) -> dict[str, tuple[str, dict[str, str]]]:
        """Subject to key and components of everything that a stage has made."""
        rows = self._rows(
            "SELECT stage, subject, key, components, checksum FROM made WHERE stage = ?", stage
        )
        return {subject: (key, json.loads(parts)) for _, subject, key, parts in map(_sound, rows)}

    def result(self, stage: str, subject: str) -> bytes:
        """Return what a stage made of a subject."""
        query = "SELECT result, checksum_of_result FROM made WHERE stage = ? AND subject = ?"
        rows = self._rows(query, stage, subject)
        if not rows or zlib.crc32(rows[0][0]) != rows[0][1]:
            raise DamagedState(f"what is kept of {stage} {subject} is damaged")
        return bytes(rows[0][0])

    def remember(
        self, stage: str, subject: str, key: str, components: Mapping[str, str], result: bytes
    ) -> None:
        """Keep what a stage made of a subject, and from what."""
        row = _checked(stage, subject, key, json.dumps(components, sort_keys=True))
        self._change(
            "INSERT OR REPLACE INTO made VALUES (?, ?, ?, ?, ?, ?, ?)",
            [(*row, result, zlib.crc32(result))],
        )

    def forget(self, stage: str, subjects: Iterable[str]) -> None:
        """Drop what a stage made of some subjects."""
        rows = [(stage, subject) for subject in subjects]
        self._change("DELETE FROM made WHERE stage = ? AND subject = ?", rows)

    def note(self, name: str, value: str) -> None:
        """Keep a word for the next run."""
        self._change("INSERT OR REPLACE INTO note VALUES (?, ?, ?)", [_checked(name, value)])

    def read_note(self, name: str) -> str | None:
        """Return the word that an earlier run kept, None if there was none."""
        rows = self._rows("SELECT name, value, checksum FROM note WHERE name = ?", name)
        return str(_sound(rows[0])[1]) if rows else None


def set_state_aside(processed: Path, error: DamagedState) -> str:
    """Make room for a new cache; returns the sentence that says so."""
    (processed / f"{STATE_FILE}-journal").unlink(missing_ok=True)  # it would be played back
    return out_of_the_way(processed / STATE_FILE, f"was damaged ({error})", "damaged")


def out_of_the_way(path: Path, why: str, ending: str = "set-aside") -> str:
    """Rename what stands in the way of this program; returns the sentence that says so."""
    return f"{path} {why}; it is kept as {set_aside(path, ending).name} and made anew"


def _mode(read_only: bool) -> str:
    return "ro" if read_only else "rwc"


def _begun(db: sqlite3.Connection) -> sqlite3.Connection:
    db.executescript(_SCHEMA)
    db.execute(f"PRAGMA user_version = {_VERSION}")
    return db


def _told(error: sqlite3.DatabaseError) -> Exception:
    """Tell damage from a full disk and the like."""
    return error if is_of_the_machine(error) else DamagedState(str(error))


def _checked(*cells: object) -> tuple[object, ...]:
    return (*cells, zlib.crc32(repr(cells).encode()))


def _sound(row: Sequence[Any]) -> Sequence[Any]:
    """Return a row without its checksum.

    Raises
    ------
    DamagedState : the checksum is that of another row
    """
    *cells, checksum = row
    if zlib.crc32(repr(tuple(cells)).encode()) != checksum:
        raise DamagedState("a row does not have its checksum")
    return cells
