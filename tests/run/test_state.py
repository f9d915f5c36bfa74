"""The cache of a run: what it knows comes back, and what it cannot trust it starts anew."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import pytest

from deamat.core.errors import ConfigError
from deamat.run.build_cache import STALE, BuildCache, digest, key_of
from deamat.run.folders import Input, Stat
from deamat.run.state import DamagedState, State


def test_what_is_noted_and_made_comes_back_in_the_next_run(tmp_path: Path) -> None:
    folder = tmp_path / "new" / "processed"
    with State(folder) as state:
        assert state.read_note("document") is None
        state.note("document", "first")
        state.note("document", "second")
        state.remember("card", "gel-a", "k1", {"code": "c"}, b"bytes")
    with State(folder) as state:
        assert state.read_note("document") == "second"
        assert state.made("card") == {"gel-a": ("k1", {"code": "c"})}
        assert state.made("figure") == {}
        assert state.result("card", "gel-a") == b"bytes"
        state.forget("card", ["gel-a"])
        assert state.made("card") == {}


def test_what_a_run_noted_that_did_not_end_is_forgotten(tmp_path: Path) -> None:
    def interrupted() -> None:
        with State(tmp_path) as state:
            state.note("document", "never published")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    with State(tmp_path) as state:
        assert state.read_note("document") is None


def test_what_cannot_be_kept_is_an_error_and_no_silence(tmp_path: Path) -> None:
    with State(tmp_path) as state:
        state.db.execute("PRAGMA busy_timeout = 0")
        reader = sqlite3.connect(tmp_path / "state.sqlite")
        reader.execute("BEGIN")
        reader.execute("SELECT * FROM note").fetchall()
        state.note("document", "never kept")
        with pytest.raises(DamagedState, match="database is locked"):
            state.commit()
        reader.close()
        state.db.rollback()


def test_one_run_at_a_time_and_the_next_one_after_it(tmp_path: Path) -> None:
    with State(tmp_path) as state, pytest.raises(ConfigError, match="another run is working in"):
        State(tmp_path)
    with pytest.raises(sqlite3.ProgrammingError, match="closed database"):
        state.db.execute("SELECT 1")
    with State(tmp_path) as again:
        assert again.made("card") == {}


def test_a_cache_of_another_version_is_started_anew(tmp_path: Path) -> None:
    with State(tmp_path) as state:
        state.note("document", "old")
    with sqlite3.connect(tmp_path / "state.sqlite") as database:
        database.execute("PRAGMA user_version = 99")
    with State(tmp_path) as state:
        assert state.read_note("document") is None
        state.note("document", "new")
    with State(tmp_path) as state:
        assert state.read_note("document") == "new"


def test_inputs_are_unchanged_only_if_each_is_as_it_was(tmp_path: Path) -> None:
    seen = {"raw/a": Stat(1, 10, 10, 7), "raw/b": Stat(2, 20, 20, 8)}
    with State(tmp_path) as state:
        assert state.unchanged({})
        state.remember_inputs(seen, {path: Input(s.size, "5ha") for path, s in seen.items()})
        assert state.inputs() == {path: (stat, "5ha") for path, stat in seen.items()}
        assert state.unchanged(dict(reversed(seen.items())))
        for changed in (
            {**seen, "raw/b": Stat(3, 20, 20, 8)},
            {**seen, "raw/b": Stat(2, 21, 20, 8)},
            {**seen, "raw/b": Stat(2, 20, 21, 8)},
            {**seen, "raw/b": Stat(2, 20, 20, 9)},
            {**seen, "raw/c": Stat(2, 20, 20, 8)},
            {"raw/a": seen["raw/a"], "raw/c": seen["raw/b"]},
            {"raw/a": seen["raw/a"]},
        ):
            assert not state.unchanged(changed)


def test_a_subject_is_fresh_only_from_the_same_components(tmp_path: Path) -> None:
    parts = {"code": "c1", "file": "f1"}
    with State(tmp_path) as state:
        cache = BuildCache(state)
        assert not cache.fresh("card", "gel-a", parts)
        assert cache.keep("card", "gel-a", parts, {"value": 3}) == key_of(parts)
        cache.close()
        assert [str(one) for one in cache.redone] == ["card gel-a: new"]
    with State(tmp_path) as state:
        cache = BuildCache(state)
        assert cache.fresh("card", "gel-a", dict(reversed(parts.items())))
        assert cache.result("card", "gel-a") == {"value": 3}
        assert cache.earlier("card", "gel-a", {"code": "c1", "file": "f2"}) == {"value": 3}
        assert cache.earlier("card", "gel-a", {**parts, "code": "c2"}) is None
        assert cache.earlier("card", "gel-b", parts) is None
        assert cache.redone == []
        assert not cache.fresh("card", "gel-a", {"code": "c2", "law": STALE, "age": "a"})
        assert str(cache.redone[0]) == (
            "card gel-a: age is new, code changed, file is gone, law is new"
        )
        assert not cache.fresh("card", "gel-a", {**parts, "file": STALE})
        assert str(cache.redone[1]) == "card gel-a: file is redone"


def test_what_nobody_asks_for_any_more_is_forgotten_and_told(tmp_path: Path) -> None:
    parts = {"code": "c1"}
    with State(tmp_path) as state:
        for stage, subject in (("card", "gel-a"), ("card", "gel-b"), ("figure", "moduli")):
            BuildCache(state).keep(stage, subject, parts, None)
    with State(tmp_path) as state:
        cache = BuildCache(state)
        assert cache.fresh("card", "gel-a", parts)
        cache.close()
        assert sorted(map(str, cache.redone)) == [
            "card gel-b: its source is gone",
            "figure moduli: its source is gone",
        ]
        assert list(state.made("card")) == ["gel-a"]
        assert state.made("figure") == {}


def test_a_failed_subject_is_made_again(tmp_path: Path) -> None:
    parts = {"code": "c1"}
    with State(tmp_path) as state:
        BuildCache(state).keep("card", "gel-a", parts, None)
        BuildCache(state).drop("card", "gel-a")
        assert not BuildCache(state).fresh("card", "gel-a", parts)


def test_keys_tell_contents_apart_and_nothing_else() -> None:
    assert key_of({"a": "1", "b": "2"}) == key_of({"b": "2", "a": "1"})
    keys = {key_of({"a": "1"}), key_of({"a": "2"}), key_of({"b": "1"}), key_of({})}
    assert len(keys) == 4
    assert {len(key) for key in keys} == {24}
    assert digest((1, "a")) == digest((1, "a")) != digest((1, "b"))
    assert len(digest(())) == 16
