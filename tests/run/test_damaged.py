"""What stands in the way of a run is set aside, said in one line, and made anew."""

from __future__ import annotations

import os
import random
import sqlite3
from collections.abc import Callable
from pathlib import Path

import pytest

from deamat.core.errors import PipelineError
from deamat.run import explain, summary
from deamat.run.audit import audit, audit_text
from deamat.run.folders import Folders
from deamat.run.state import DamagedState
from tests.run.conftest import curves, run

pytestmark = pytest.mark.usefixtures("quick_figures")


def _random(path: Path) -> None:
    path.write_bytes(random.Random(7).randbytes(5000))


def _page(path: Path) -> None:
    """Overwrite a page that is read late, and leave the first one as it was."""
    data = bytearray(path.read_bytes())
    data[8192:-4096] = random.Random(7).randbytes(len(data) - 8192 - 4096)
    path.write_bytes(data)


def _statement(statement: str) -> Callable[[Path], None]:
    def damage(path: Path) -> None:
        with sqlite3.connect(path) as db:
            assert db.execute(statement).rowcount != 0

    return damage


def _folder(path: Path) -> None:
    path.unlink()
    path.mkdir()
    (path / "mine.txt").write_text("kept")


def _pipe(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


DAMAGES: dict[str, Callable[[Path], None]] = {
    "random bytes": _random,
    "pages": _page,
    "no table": _statement("DROP TABLE made"),
    "result": _statement("UPDATE made SET result = x'00' || result WHERE stage = 'measurement'"),
    "components": _statement(
        "UPDATE made SET components = replace(components, 'Python', 'Pyhton')"
    ),
    "hash": _statement("UPDATE input SET sha256 = replace(sha256, 'a', 'b')"),
    "note": _statement("UPDATE note SET value = substr(value, 2) WHERE name = 'document'"),
    "folder": _folder,
    "pipe": _pipe,
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_cache_is_set_aside_and_made_again(folders: Folders, damage: str) -> None:
    release = run(folders)["release"]
    state = folders.processed / "state.sqlite"
    DAMAGES[damage](state)
    # Something to do, so that everything of the cache is asked for.
    table = folders.raw / "demo" / "compression" / "specimens.csv"
    os.utime(table, ns=(1, 1))
    document = run(folders)
    assert (document["release"], document["exit_code"]) == (release, 0)
    (warning,) = document["warnings"]
    aside = [p.name for p in folders.processed.iterdir() if p.name.startswith("state.sqlite.")]
    assert aside == [f"state.sqlite.{'set-aside' if damage in ('folder', 'pipe') else 'damaged'}"]
    assert f"it is kept as {aside[0]} and made anew" in warning
    assert f"warning    {warning}" in summary.text(document).splitlines()
    again = run(folders)
    assert (again["nothing_to_do"], again["warnings"]) == (True, [])


def test_explain_says_that_the_cache_is_damaged_and_leaves_it(folders: Folders) -> None:
    run(folders)
    _random(folders.processed / "state.sqlite")
    with pytest.raises(DamagedState, match=r"state\.sqlite: file is not a database.*next run"):
        explain(folders)
    assert not (folders.processed / "state.sqlite.damaged").exists()


@pytest.mark.parametrize("kind", ["file", "folder", "pipe"])
def test_what_is_of_another_kind_is_set_aside(folders: Folders, kind: str) -> None:
    release = run(folders)["release"]
    names = ["releases/.building", "releases/current", "materials.sqlite", "cards"]
    places = [folders.processed / name for name in names]
    for place in places:
        place.unlink(missing_ok=True)
        place.write_text("kept")
        if kind != "file":
            {"folder": _folder, "pipe": _pipe}[kind](place)
    document = run(folders)
    assert (document["release"], document["exit_code"]) == (release, 0)
    if kind == "folder":  # a killed run leaves `.building` behind
        del places[0]
    for place, warning in zip(places, document["warnings"], strict=True):
        aside = place.with_name(f"{place.name.lstrip('.')}.set-aside")
        assert f"it is kept as {aside.name} and made anew" in warning
        assert (aside.is_file(), aside.is_dir()) == (kind == "file", kind == "folder")
    assert (folders.processed / "cards" / "sylgard-182-10to1.json").is_file()
    assert run(folders)["nothing_to_do"]


def test_a_file_in_place_of_all_releases_is_set_aside(folders: Folders) -> None:
    folders.processed.mkdir()
    (folders.processed / "releases").write_text("kept")
    (warning,) = run(folders)["warnings"]
    assert "was no folder; it is kept as releases.set-aside and made anew" in warning
    assert (folders.processed / "releases.set-aside").read_text() == "kept"


def _everything(place: Path) -> dict[str, tuple[int, int]]:
    found = {p: p.lstat() for p in [place, *place.rglob("*")]}
    return {str(p): (s.st_mtime_ns, s.st_ino) for p, s in found.items()}


def test_explain_and_audit_write_nothing_where_nothing_can_be_written(
    folders: Folders, monkeypatch: pytest.MonkeyPatch
) -> None:
    folders.processed.mkdir()
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises(PipelineError, match="no account"):
        audit(folders)
    run(folders)
    before = _everything(folders.processed)
    told = audit(folders)
    assert (told["exit_code"], told["stale"], told["unaccounted"]) == (0, [], [])
    assert explain(folders)["now"] == []
    path = curves(folders)[0]
    path.write_bytes(path.read_bytes().replace(b"0.2", b"0.3", 1))
    told = audit(folders)
    assert told["exit_code"] == 1
    why = "measurement demo/compression/c-sylgard-182-10to1-after-cure-1: file changed"
    assert any(line.startswith(why) for line in told["stale"])
    assert f"not up to date, and cannot be written: {why}" in audit_text(told)
    assert told["stale"] == explain(folders)["now"]
    assert _everything(folders.processed) == before
