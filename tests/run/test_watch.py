"""Files are read once they are complete: by a clock of the test's own, and once by a real folder."""

from __future__ import annotations

import json
import os
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import pytest

from deamat.core.errors import ConfigError
from deamat.run.folders import Folders, Stat, look
from deamat.run.watch import Patience, Watching, follow
from deamat.run.watch.arrivals import HELD, Arrivals, Note
from tests.run.conftest import curves

NAME = "raw/demo/compression/gel-a/1.txt"
PATIENCE = Patience(settle_s=0.5, unclosed_s=60.0, gone_s=1.0)


@dataclass
class Scene:
    """A folder and a clock."""

    arrivals: Arrivals = field(default_factory=lambda: Arrivals(PATIENCE))
    files: dict[str, Stat] = field(default_factory=dict)
    now_s: float = 1000.0

    def write(self, name: str, size: int, *, closed: bool, inode: int = 1) -> None:
        """Leave a file with a size, and say whether the writer closed it."""
        self.files[name] = Stat(size, int(self.now_s * 1e9), int(self.now_s * 1e9), inode)
        self.arrivals.note(name, Note(closed, self.now_s))
        self.look()

    def look(self) -> bool:
        return self.arrivals.look(self.files, self.now_s)

    def after(self, seconds: float) -> bool:
        """Let time pass; say whether a run was due in it."""
        end_s, due = self.now_s + seconds, self.look()
        while True:
            next_s = self.arrivals.next_s()
            self.now_s = end_s if next_s is None else min(end_s, max(next_s, self.now_s + 0.01))
            due |= self.look()
            if self.now_s >= end_s:
                return due

    def readable(self, name: str = NAME) -> bool:
        return not self.arrivals.held_back(self.files)[name].odd


@pytest.fixture
def scene() -> Scene:
    return Scene()


def test_a_file_that_was_closed_is_read_when_it_has_settled(scene: Scene) -> None:
    scene.write(NAME, 100, closed=True)
    assert not scene.after(0.4)
    assert scene.arrivals.held_back(scene.files)[NAME].odd == HELD
    assert scene.after(0.1)
    assert scene.readable()
    assert not scene.after(100.0)


def test_a_writer_that_pauses_half_a_minute_is_waited_for(scene: Scene) -> None:
    for size in (100, 200, 300):
        scene.write(NAME, size, closed=False)
        assert not scene.after(30.0)
        assert not scene.readable()
    scene.write(NAME, 400, closed=True)
    assert scene.after(0.5)
    assert scene.readable()


def test_a_file_that_nobody_closes_is_read_after_the_longer_time(scene: Scene) -> None:
    scene.write(NAME, 100, closed=False)
    assert not scene.after(59.9)
    assert scene.after(0.1)


def test_a_file_that_grows_is_taken_back_and_read_again(scene: Scene) -> None:
    scene.write(NAME, 100, closed=True)
    scene.after(1.0)
    scene.write(NAME, 200, closed=False)
    assert not scene.readable()
    assert scene.after(1.0)  # a run without it
    assert not scene.after(30.0)
    scene.write(NAME, 300, closed=True)
    assert scene.after(60.0)
    assert scene.readable()


def test_a_folder_of_bursts_is_given_the_longer_time(scene: Scene) -> None:
    scene.write(NAME, 100, closed=True)
    scene.after(1.0)
    scene.write(NAME, 200, closed=True)
    scene.after(60.0)
    assert scene.readable()
    other = NAME.replace("1.txt", "2.txt")
    scene.write(other, 100, closed=True)
    assert not scene.after(30.0)
    scene.write(other, 200, closed=True)
    assert not scene.after(59.0)
    assert scene.after(1.0)
    assert scene.readable(other)


def test_a_file_that_is_replaced_whole_makes_no_folder_of_bursts(scene: Scene) -> None:
    scene.write(NAME, 100, closed=True)
    scene.after(1.0)
    scene.write(NAME, 200, closed=True, inode=2)
    assert scene.after(0.5)
    assert scene.readable()


def test_a_register_may_grow_row_by_row(scene: Scene) -> None:
    name = "raw/demo/compression/specimens.csv"
    for size in (100, 200, 300):
        scene.write(name, size, closed=True)
        assert scene.after(0.5)
        assert scene.readable(name)


def test_a_rename_is_one_run(scene: Scene) -> None:
    scene.write(NAME, 100, closed=True)
    scene.after(1.0)
    other = NAME.replace("1.txt", "2.txt")
    scene.files[other] = scene.files.pop(NAME)
    scene.arrivals.note(other, Note(closed=True, at_s=scene.now_s))
    assert not scene.look()
    assert scene.after(0.5)
    assert scene.readable(other)
    assert scene.after(0.5)  # the old name is gone
    assert NAME not in scene.arrivals.settled


def test_a_file_that_is_away_for_a_moment_is_not_gone(scene: Scene) -> None:
    scene.write(NAME, 100, closed=True)
    scene.after(1.0)
    kept = scene.files.pop(NAME)
    assert not scene.after(0.3)
    scene.files[NAME] = kept
    assert not scene.after(100.0)
    assert scene.readable()
    del scene.files[NAME]
    assert not scene.after(0.9)
    assert scene.after(0.1)


def test_what_is_there_at_the_start_is_complete_unless_it_is_fresh(scene: Scene) -> None:
    fresh, register = NAME.replace("1.txt", "2.txt"), "raw/demo/compression/specimens.csv"
    stat = Stat(1, 1, 1, 1)
    scene.files = {NAME: stat, fresh: stat, register: stat}
    ages = {NAME: 3600.0, fresh: 20.0, register: 20.0}
    scene.arrivals.begin(scene.files, ages, scene.now_s)
    assert [scene.readable(n) for n in (NAME, fresh, register)] == [True, False, True]
    assert not scene.after(39.9)
    assert scene.after(0.1)
    assert scene.readable(fresh)


def test_thousands_of_arrivals_leave_nothing_but_their_files(scene: Scene) -> None:
    for number in range(3000):
        name = f"raw/demo/t/{number}.txt"
        scene.files[name] = Stat(100, number, number, number)
        scene.arrivals.note(f"raw/demo/t/.tmp{number}", Note(closed=True, at_s=scene.now_s))
        scene.arrivals.note(name, Note(closed=True, at_s=scene.now_s))
        if number % 100 == 0:
            scene.after(0.2)
    scene.after(200.0)
    kept = scene.arrivals
    assert len(kept.settled) == 3000
    assert (kept._waiting, kept._notes, kept._taken_back, kept.bursts) == ({}, {}, set(), set())


def _until(true: Callable[[], bool], seconds: float = 120.0) -> bool:
    end = time.monotonic() + seconds
    while not true():
        if time.monotonic() > end:
            return False
        time.sleep(0.05)
    return True


@pytest.mark.usefixtures("quick_figures")
def test_a_folder_is_followed(folders: Folders) -> None:
    """Written in two parts, then renamed, replaced, and removed; its card follows."""
    file = curves(folders)[0]
    data = file.read_bytes()
    file.unlink()
    for path in folders.raw.rglob("*"):
        os.utime(path, (0, 0))  # written long ago
    card = folders.processed / "cards" / "sylgard-182-10to1.json"

    def n() -> int:
        if not card.is_file():
            return -1
        found = json.loads(card.read_text())["properties"]
        return max((p["n"] for p in found if p["key"] == "compressive_modulus"), default=0)

    said: list[str] = []
    done = threading.Event()
    watching = Watching(Patience(settle_s=0.1, unclosed_s=3600.0, gone_s=0.3), workers=1)
    thread = threading.Thread(target=follow, args=(folders, watching, said.append, done.is_set))
    thread.start()
    try:
        assert _until(lambda: n() == 2)
        assert _until(lambda: any(line.startswith("watching") for line in said))
        with file.open("wb") as writer:
            writer.write(data[: len(data) // 2])
            writer.flush()
            assert not _until(lambda: n() == 3, 3.0)
            writer.write(data[len(data) // 2 :])
        assert _until(lambda: n() == 3)
        part = file.with_name(".part")
        part.write_bytes(data)
        part.replace(file)
        file.unlink()
        assert _until(lambda: n() == 2)
        part.write_bytes(data)
        part.replace(file)
        assert _until(lambda: n() == 3)
        (folders.config / "methods.toml").write_text("[compresion]\n")
        assert _until(lambda: any("nearest: compression" in line for line in said))
    finally:
        done.set()
        thread.join()


@pytest.mark.usefixtures("quick_figures")
def test_a_network_drive_is_asked(folders: Folders) -> None:
    file = curves(folders)[0]
    data = file.read_bytes()
    file.unlink()
    for path in folders.raw.rglob("*"):
        os.utime(path, (0, 0))
    said: list[str] = []
    before: list[bool] = []
    card = folders.processed / "cards" / "sylgard-182-10to1.json"

    def held() -> bool:
        return card.is_file() and file.name in card.read_text()

    def stopped() -> bool:
        if not file.exists():
            before.append(held())
            file.write_bytes(data)
        return held()

    watching = Watching(Patience(settle_s=0.1, unclosed_s=0.5, gone_s=0.3), poll=True, workers=1)
    follow(folders, watching, said.append, stopped)
    assert (before, held()) == ([False], True)


def test_what_prevents_a_run_is_said_once_and_tried_again(
    folders: Folders, monkeypatch: pytest.MonkeyPatch
) -> None:
    failures = iter([OSError("disk full"), OSError("disk full"), ConfigError("a slip"), None])
    said: list[str] = []
    done = threading.Event()

    def run_all(*_: object, **__: object) -> dict[str, object]:
        failure = next(failures)
        if failure is not None:
            raise failure
        done.set()
        return {"nothing_to_do": True}

    monkeypatch.setattr("deamat.run.watch.loop.run_all", run_all)
    monkeypatch.setattr("deamat.run.watch.loop._AGAIN_s", 0.0)
    follow(folders, Watching(), said.append, done.is_set)
    assert [line.partition(";")[0] for line in said if line.startswith("NOT RUN")] == [
        "NOT RUN    disk full", "NOT RUN    a slip",
    ]  # fmt: skip


def test_a_changed_program_ends_the_watch(
    folders: Folders, monkeypatch: pytest.MonkeyPatch
) -> None:
    module, calls = "deamat.run.watch.loop", iter(range(100))

    def changed(where: Folders) -> dict[str, Stat]:
        seen = look(where)
        path = next(p for p in seen if p.startswith("code/"))
        return {**seen, path: replace(seen[path], size=next(calls))}

    monkeypatch.setattr(f"{module}.look", changed)
    monkeypatch.setattr(f"{module}.run_all", lambda *_, **__: {"nothing_to_do": True})
    with pytest.raises(ConfigError, match="the program was changed"):
        follow(folders, Watching(), lambda _: None)


def test_folders_must_be_there(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="give one with --raw"):
        follow(Folders(tmp_path / "raw", tmp_path, tmp_path), Watching(), lambda _: None)
