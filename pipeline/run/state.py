"""`state.sqlite`: what was seen, made and published, so that only what changed is redone.

It is a cache: deleting it costs time, never a result. Standard library only: the no-op path.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import TracebackType

from deamat.core.errors import ConfigError
from deamat.run.folders import Stat
from deamat.run.host import Lock

_SCHEMA = """
CREATE TABLE IF NOT EXISTS input(path TEXT PRIMARY KEY, size INT, mtime_ns INT, sha256 TEXT);
CREATE TABLE IF NOT EXISTS made(
    stage TEXT, subject TEXT, key TEXT, components TEXT, result BLOB, PRIMARY KEY(stage, subject));
CREATE TABLE IF NOT EXISTS note(name TEXT PRIMARY KEY, value TEXT);
"""
_VERSION = 1


class State:
    """The state of one processed folder, locked against a second run while it is open."""

    def __init__(self, processed: Path) -> None:
        processed.mkdir(parents=True, exist_ok=True)
        try:
            self._lock = Lock(processed / ".lock")
        except BlockingIOError as error:
            raise ConfigError(f"another run is working in {processed}; wait for it") from error
        path = processed / "state.sqlite"
        self.db = self._open(path)

    @staticmethod
    def _open(path: Path) -> sqlite3.Connection:
        """Open the cache; one that is damaged or of another version is started anew."""
        try:
            db = sqlite3.connect(path)
            (version,) = db.execute("PRAGMA user_version").fetchone()
            if version not in (0, _VERSION):
                raise sqlite3.DatabaseError("another version")
            if version == 0:  # no write, to wait for the disk with, where everything is there
                _begin(db)
            db.execute("SELECT 1 FROM input, made, note LIMIT 0")
        except sqlite3.DatabaseError:
            db.close()
            path.unlink()
            db = sqlite3.connect(path)
            _begin(db)
        return db

    def __enter__(self) -> State:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if kind is None:
            self.db.commit()
        else:  # what was noted of outputs that were never published must not be believed
            self.db.rollback()
        self.db.close()
        self._lock.release()

    def inputs(self) -> dict[str, tuple[Stat, str]]:
        """Path to what was seen and hashed last time."""
        rows = self.db.execute("SELECT path, size, mtime_ns, sha256 FROM input")
        return {path: (Stat(size, mtime), sha) for path, size, mtime, sha in rows}

    def unchanged(self, seen: Mapping[str, Stat]) -> bool:
        """Say whether exactly these inputs were seen when the last release was published."""
        rows = self.db.execute("SELECT path, size, mtime_ns FROM input").fetchall()
        return len(rows) == len(seen) and all(
            path in seen and seen[path].size == size and seen[path].mtime_ns == mtime
            for path, size, mtime in rows
        )

    def remember_inputs(self, seen: Mapping[str, Stat], hashes: Mapping[str, str]) -> None:
        """Replace what is known of the inputs."""
        self.db.execute("DELETE FROM input")
        self.db.executemany(
            "INSERT INTO input VALUES (?, ?, ?, ?)",
            [(path, s.size, s.mtime_ns, hashes[path]) for path, s in seen.items()],
        )

    def made(self, stage: str) -> dict[str, tuple[str, dict[str, str]]]:
        """Subject to key and components of everything that a stage has made."""
        rows = self.db.execute("SELECT subject, key, components FROM made WHERE stage = ?", [stage])
        return {subject: (key, json.loads(parts)) for subject, key, parts in rows}

    def result(self, stage: str, subject: str) -> bytes:
        """Return what a stage made of a subject."""
        (blob,) = self.db.execute(
            "SELECT result FROM made WHERE stage = ? AND subject = ?", [stage, subject]
        ).fetchone()
        return bytes(blob)

    def remember(
        self, stage: str, subject: str, key: str, components: Mapping[str, str], result: bytes
    ) -> None:
        """Keep what a stage made of a subject, and from what."""
        self.db.execute(
            "INSERT OR REPLACE INTO made VALUES (?, ?, ?, ?, ?)",
            [stage, subject, key, json.dumps(components, sort_keys=True), result],
        )

    def forget_all_but(self, stage: str, subjects: set[str]) -> None:
        """Drop what no longer has a source."""
        self.forget(stage, set(self.made(stage)) - subjects)

    def forget(self, stage: str, subjects: Iterable[str]) -> None:
        """Drop what a stage made of some subjects."""
        self.db.executemany(
            "DELETE FROM made WHERE stage = ? AND subject = ?", [(stage, s) for s in subjects]
        )

    def note(self, name: str, value: str) -> None:
        """Keep a word for the next run."""
        self.db.execute("INSERT OR REPLACE INTO note VALUES (?, ?)", [name, value])

    def read_note(self, name: str) -> str | None:
        """Return the word that an earlier run kept, None if there was none."""
        row = self.db.execute("SELECT value FROM note WHERE name = ?", [name]).fetchone()
        return None if row is None else str(row[0])


def _begin(db: sqlite3.Connection) -> None:
    db.executescript(_SCHEMA)
    db.execute(f"PRAGMA user_version = {_VERSION}")
