"""Workers end with their parent, and a lock ends with its process, on every platform."""

from __future__ import annotations

import errno
import multiprocessing
import os
import signal
import subprocess
import sys
import types
from functools import partial
from pathlib import Path

import pytest

from deamat.core.errors import ConfigError
from deamat.run.folders import Folders
from deamat.run.host import Lock, cpu_count
from deamat.run.state import State
from deamat.run.workers import Workers
from tests.run.conftest import ROOT, run

_PATIENCE_S = 60


@pytest.mark.parametrize("blow", [signal.SIGTERM, signal.SIGKILL])
@pytest.mark.usefixtures("quick_figures")
def test_workers_end_with_a_parent_that_was_killed(folders: Folders, blow: signal.Signals) -> None:
    command = [sys.executable, "-m", "tests.run.killed"]
    places = [str(p) for p in (folders.raw, folders.config, folders.processed)]
    with subprocess.Popen([*command, *places], cwd=ROOT, stdout=subprocess.PIPE, text=True) as job:
        try:
            assert job.stdout is not None
            assert {job.stdout.readline()[:7] for _ in range(2)} == {"drawing"}  # two at work
            with pytest.raises(ConfigError, match="another run is working"):
                run(folders)
        finally:  # it never ends by itself
            job.send_signal(blow)
        # The workers have inherited the pipe: it ends when the last of them does.
        job.communicate(timeout=_PATIENCE_S)
    assert run(folders)["exit_code"] == 0


def test_work_comes_back_in_order_from_here_and_from_workers() -> None:
    with Workers(2) as workers:
        assert list(workers.map(abs, [-3, 2, -1], abs, at_once=3)) == [3, 2, 1]
        assert list(workers.map(abs, range(-7, 0), abs, at_once=2)) == [7, 6, 5, 4, 3, 2, 1]
        mine = {process.pid for process in multiprocessing.active_children()}
    assert mine
    assert not mine & {process.pid for process in multiprocessing.active_children()}


def _deadly(met: Path, number: int) -> int:
    """Square a number, but end the process over 3, and over 13 the first time."""
    if number == 3 or (number == 13 and not met.exists()):
        if number == 13:
            met.touch()
        os.kill(os.getpid(), signal.SIGTERM)
    return number**2


def test_a_killed_worker_costs_what_it_was_killed_over_and_nothing_else(tmp_path: Path) -> None:
    with Workers(2) as workers:
        deadly = partial(_deadly, tmp_path / "met")
        results = workers.map(deadly, range(8), lost=lambda n: -n, at_once=2)
        assert list(results) == [0, 1, 4, -3, 16, 25, 36, 49]
        again = workers.map(deadly, range(10, 16), lost=lambda n: -n, at_once=2)
        assert list(again) == [100, 121, 144, 169, 196, 225]
        assert list(workers.map(deadly, range(3), lost=lambda n: -n)) == [0, 1, 4]


def _try(path: Path) -> int:
    try:
        Lock(path).release()
    except BlockingIOError:
        return 1
    return 0


def test_a_lock_is_not_inherited_and_holds_against_others(tmp_path: Path) -> None:
    lock = Lock(tmp_path / "lock")
    with multiprocessing.Pool(1) as pool:  # the worker outlives the lock
        assert pool.apply(_try, (tmp_path / "lock",)) == 1
        assert _try(tmp_path / "lock") == 1
        lock.release()
        assert pool.apply(_try, (tmp_path / "lock",)) == 0
        assert _try(tmp_path / "lock") == 0


def test_a_file_system_without_locks_is_told_as_such(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lockf(*_: int) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    stub = types.SimpleNamespace(LOCK_EX=2, LOCK_NB=4, lockf=lockf)
    with monkeypatch.context() as patch:
        patch.setitem(sys.modules, "fcntl", stub)
        with pytest.raises(OSError, match="No locks available"):
            Lock(tmp_path / "lock")
    Lock(tmp_path / "lock").release()


def test_without_fcntl_the_lock_is_that_of_windows(
    folders: Folders, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[int] = []

    def locking(descriptor: int, mode: int, size: int) -> None:
        os.fstat(descriptor)
        assert (mode, size) == (2, 1)
        asked.append(descriptor)
        if len(asked) > 1:
            raise PermissionError(13, "Permission denied")

    windows = types.SimpleNamespace(LK_NBLCK=2, locking=locking)
    monkeypatch.setitem(sys.modules, "fcntl", None)
    monkeypatch.setitem(sys.modules, "msvcrt", windows)
    with State(folders.processed):
        pass
    with pytest.raises(ConfigError, match="another run is working"):
        State(folders.processed)


def test_the_cpus_are_counted_with_what_the_platform_has(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "process_cpu_count", lambda: 7, raising=False)
    assert cpu_count() == 7
    monkeypatch.delattr(os, "process_cpu_count")
    mine = {0: {0, 3, 4}, 1: {0}}  # of this process, and of the first of the system
    monkeypatch.setattr(os, "sched_getaffinity", mine.__getitem__, raising=False)
    assert cpu_count() == 3
    monkeypatch.delattr(os, "sched_getaffinity")
    monkeypatch.setattr(os, "cpu_count", lambda: 5)
    assert cpu_count() == 5
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert cpu_count() == 1
