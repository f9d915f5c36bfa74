"""`materials.sqlite`: written in one piece with the same bytes for the same content, read only.

The bytes depend on the content and on the version of the SQLite library, on nothing else.
"""

from __future__ import annotations

import difflib
import json
import sqlite3
import weakref
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import count
from os import PathLike
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from deamat.core.errors import CardError, PipelineError
from deamat.core.ledger import Failure, FileEntry, Provenance
from deamat.core.schema import entry_of
from deamat.materials.card import MaterialCard
from deamat.materials.rows import card_of, columns_of, entries_of, owned_of
from deamat.materials.tables import (
    APPLICATION_ID,
    ENTRIES,
    OWNED,
    TABLES,
    VERSION,
    card_rows,
    failure_rows,
    file_rows,
    listed_in,
    provenance_rows,
)

if TYPE_CHECKING:
    import pandas as pd
    import xarray

    from deamat.materials.frame import Range

DATABASE_FILE = "materials.sqlite"
CURVES_FILE = "curves.h5"

_SHOWN = 8  # materials that a message names


@cache
def _entry_query(cls: Any) -> str:
    identity = entry_of(cls).identity
    chosen = columns_of(cls) if identity else f"id, {columns_of(cls)}"
    order = ", ".join(identity) or "id"
    return f"SELECT {chosen} FROM {entry_of(cls).table} WHERE material = ?1 ORDER BY {order}"


@cache
def _owned_query(cls: Any) -> str:
    owners = " UNION ALL ".join(
        f"SELECT id FROM {entry_of(owner).table} WHERE material = ?1"
        for owner in ENTRIES
        if cls in (field.kind.rows_of for field in listed_in(owner))
    )
    return (
        f"SELECT id, {columns_of(cls)} FROM {entry_of(cls).table} "
        f"WHERE id IN ({owners}) ORDER BY id, position"
    )


class DatabaseError(PipelineError):
    """A file that is not a database of this program, or not one that it can read."""


class MissingMaterial(PipelineError, KeyError):
    """The database has no such material."""

    def __str__(self) -> str:
        return str(self.args[0])


def write_database(
    path: Path,
    cards: Sequence[MaterialCard],
    files: Sequence[FileEntry],
    provenance: Provenance,
    failures: Sequence[Failure] = (),
) -> None:
    """Write a fresh database; the order of the arguments' elements plays no part.

    The caller synchronises it to the disk and publishes it by renaming: whoever has an older one
    open goes on reading that.

    Parameters
    ----------
    path : the file to make; one that is there is unlinked first, never written into
    cards : one for each material
    files : the account of every file under `raw/`
    provenance : what made the cards
    failures : internal errors of the run that made them

    Raises
    ------
    CardError : two cards of one material, or a card that does not hold together
    """
    if len({card.material for card in cards}) < len(cards):
        names = [card.material for card in cards]
        raise CardError(f"two cards of {next(n for n in names if names.count(n) > 1)}")
    path.unlink(missing_ok=True)
    connection = sqlite3.connect(path, isolation_level=None)
    whole = False
    try:
        connection.executescript(
            "PRAGMA page_size = 4096; PRAGMA encoding = 'UTF-8'; PRAGMA auto_vacuum = NONE;"
            # Nobody else knows the file yet: no journal is needed, and who publishes it syncs it.
            "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;"
            f"PRAGMA application_id = {APPLICATION_ID}; PRAGMA user_version = {VERSION};"
            f"BEGIN; {TABLES}"
        )
        inserts = _inserts(connection)
        connection.executemany(inserts["release"], provenance_rows(provenance))
        connection.executemany(inserts["files"], file_rows(files))
        connection.executemany(inserts["failures"], failure_rows(failures))
        ids = count(1)
        for card in sorted(cards, key=lambda card: card.material):
            for table, row in card_rows(card.to_document(), ids):
                connection.execute(inserts[table], row)
        connection.execute("COMMIT")
        whole = True
    finally:
        connection.close()
        if not whole:
            path.unlink()


def _inserts(connection: sqlite3.Connection) -> dict[str, str]:
    """Return the statement that fills a row of each table."""
    tables = connection.execute("SELECT name FROM sqlite_schema WHERE type = 'table'").fetchall()
    inserts = {}
    for (table,) in tables:
        columns = connection.execute(f"PRAGMA table_info({table})").fetchall()
        inserts[table] = f"INSERT INTO {table} VALUES ({','.join('?' * len(columns))})"
    return inserts


class Database(Mapping[str, MaterialCard]):
    """All cards of one release, read only: `db["ef50-0t"]["compressive_modulus"]`.

    It keeps reading the release that it was opened on, also when a newer one is published.
    Use it as a context manager, or let it go: it closes itself.
    """

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path = path
        self._connection = connection
        self._finalizer = weakref.finalize(self, connection.close)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file; asking anything afterwards raises `DatabaseError`."""
        self._finalizer()

    def _rows(self, query: str, *values: str) -> list[Any]:
        try:
            return self._connection.execute(query, values).fetchall()
        except sqlite3.Error as error:
            raise DatabaseError(f"{self.path}: {error}") from error

    def __len__(self) -> int:
        return int(self._rows("SELECT count(*) FROM materials")[0][0])

    def __iter__(self) -> Iterator[str]:
        return (row[0] for row in self._rows("SELECT material FROM materials ORDER BY material"))

    def __contains__(self, material: object) -> bool:
        query = "SELECT 1 FROM materials WHERE material = ?"
        return isinstance(material, str) and bool(self._rows(query, material))

    def __getitem__(self, material: str) -> MaterialCard:
        """Read one card.

        Raises
        ------
        MissingMaterial : the database does not hold it; the message names the nearest ones
        DatabaseError : the database was closed or is damaged
        """
        about = self._rows(
            f"SELECT {columns_of(MaterialCard)} FROM materials WHERE material = ?", material
        )
        if not about:
            raise MissingMaterial(self._missing(material))
        owned = {cls: owned_of(cls, self._rows(_owned_query(cls), material)) for cls in OWNED}
        lists = {
            cls: entries_of(cls, self._rows(_entry_query(cls), material), owned, material=material)
            for cls in ENTRIES
        }
        return card_of(about[0], lists)

    def _missing(self, material: str) -> str:
        held = list(self)
        near = difflib.get_close_matches(material, held)
        more = f" and {len(held) - _SHOWN} more" if len(held) > _SHOWN else ""
        hint = (
            f"nearest: {', '.join(near)}" if near else f"it holds {', '.join(held[:_SHOWN])}{more}"
        )
        return f"{self.path} has no material {material!r}; {hint}"

    def to_frame(
        self, ranges: Mapping[str, Range] | None = None, units: Mapping[str, str] | None = None
    ) -> pd.DataFrame:
        """Return all records, or those of the materials in ranges of properties: see `frame`."""
        from deamat.materials.frame import to_frame

        return to_frame(self.values(), ranges, units)

    def files(self) -> tuple[FileEntry, ...]:
        """Return the account of every file under `raw/`, by path."""
        return tuple(FileEntry(*row) for row in self._rows("SELECT * FROM files ORDER BY path"))

    def failures(self) -> tuple[Failure, ...]:
        """Return the internal errors of the run that made this release, by stage and subject."""
        rows = self._rows("SELECT * FROM failures ORDER BY stage, subject")
        return tuple(
            Failure(stage, subject, error, traceback, tuple(json.loads(files)))
            for stage, subject, error, traceback, files in rows
        )

    def provenance(self) -> Provenance:
        """Say which code, environment and configuration made this release."""
        version, code, *told = self._rows(
            "SELECT version, code, stages, environment, config FROM release"
        )[0]
        stages, environment, config = (tuple(json.loads(cell).items()) for cell in told)
        return Provenance(version, code, stages, environment, config)

    def curves(self, material: str, technique: str | None = None) -> xarray.Dataset:
        """Read the reduced curves of one material from `curves.h5` beside the database.

        Returns
        -------
        see `curves.read_curves`; the attribute `synthetic` says what the card says

        Raises
        ------
        MissingMaterial : the database does not hold it
        CurvesError : no such file, or not one of curves
        """
        from deamat.materials.curves import read_curves  # h5py: only whoever wants curves pays

        query = "SELECT synthetic FROM materials WHERE material = ?"
        found = self._rows(query, material)
        if not found:
            raise MissingMaterial(self._missing(material))
        dataset = read_curves(self.path.with_name(CURVES_FILE), material, technique)
        dataset.attrs["synthetic"] = found[0][0]
        return dataset


def open_database(path: str | PathLike[str]) -> Database:
    """Open a database for reading.

    Parameters
    ----------
    path : `materials.sqlite`, or the processed folder that holds it

    Raises
    ------
    DatabaseError : no such file, not a database of this program, damaged, or of another version
    """
    # Resolved, so that both files stay those of one release when a link is turned to the next.
    place = Path(path).resolve()
    if place.is_dir():
        place /= DATABASE_FILE
    if not place.is_file():
        raise DatabaseError(f"no database {place}; `make all` writes it")
    try:
        # A published file never changes (the next one takes its name), so it needs no locks.
        connection = sqlite3.connect(
            f"{place.as_uri()}?mode=ro&immutable=1",
            uri=True,
            isolation_level=None,
            check_same_thread=False,
        )
        database = Database(place, connection)
        ((application,),) = connection.execute("PRAGMA application_id").fetchall()
        ((version,),) = connection.execute("PRAGMA user_version").fetchall()
    except sqlite3.DatabaseError as error:
        raise DatabaseError(f"{place} is not a database of materials: {error}") from error
    if application != APPLICATION_ID:
        database.close()
        raise DatabaseError(f"{place} is SQLite, but not a database of materials")
    if version != VERSION:
        database.close()
        raise DatabaseError(
            f"{place} has other tables than those of this deamat; write it again with `make all`, "
            "or read it with the deamat that wrote it"
        )
    return database
