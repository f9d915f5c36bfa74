"""How a command ends that cannot do its work: a sentence and an exit code, never a bare traceback."""

from __future__ import annotations

import errno
import sqlite3
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import deamat.run
from deamat import cli
from deamat.run.folders import Folders
from tests.run.conftest import ROOT, curves, folders

__all__ = ["folders"]


def _ends(
    error: Exception, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> tuple[Any, str]:
    def run_all(*_: object) -> None:
        raise error

    monkeypatch.setattr(deamat.run, "run_all", run_all)
    monkeypatch.setattr(sys, "argv", ["deamat", "all"])
    with pytest.raises(SystemExit) as end:
        cli.main()
    return end.value.code, capsys.readouterr().err


def _full() -> sqlite3.Error:
    error = sqlite3.OperationalError("database or disk is full")
    error.sqlite_errorcode = sqlite3.SQLITE_FULL
    return error


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (
            OSError(errno.ENOSPC, "No space left on device", "processed/curves.h5"),
            "deamat: processed/curves.h5: No space left on device; nothing new is published\n",
        ),
        (
            OSError(errno.EROFS, "Read-only file system"),
            "deamat: Read-only file system; nothing new is published\n",
        ),
        (
            _full(),
            "deamat: database or disk is full; nothing new is published\n",
        ),
    ],
)
def test_the_machine_ends_a_run_with_four_and_one_sentence(
    error: Exception,
    said: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert _ends(error, monkeypatch, capsys) == (4, said)


def test_an_error_of_the_driver_itself_ends_with_three_and_its_traceback(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    code, said = _ends(RuntimeError("not foreseen"), monkeypatch, capsys)
    assert code == 3
    assert said.startswith("Traceback (most recent call last):\n")
    assert said.endswith(
        "deamat: internal error in command all (RuntimeError: not foreseen); "
        "nothing new is published\n"
    )


_LIMITED = """
import resource, sys
limit = int(sys.argv.pop(1))
resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
from deamat.cli import main
main()
"""


def test_a_disk_that_takes_no_more_leaves_the_last_release(folders: Folders) -> None:
    """No file may grow beyond a limit: what a full disk does, without filling one."""

    def all_(limit: int) -> subprocess.CompletedProcess[str]:
        places = (
            "--raw",
            folders.raw,
            "--config",
            folders.config,
            "--processed",
            folders.processed,
        )
        command = [sys.executable, "-c", _LIMITED, str(limit), "all", "--workers", "2"]
        return subprocess.run(
            [*command, *map(str, places)], capture_output=True, text=True, check=False, cwd=ROOT
        )

    assert all_(10_000_000).returncode == 0
    current = (folders.processed / "releases" / "current").resolve()
    before = {p: p.read_bytes() for p in current.rglob("*") if p.is_file()}
    curves(folders)[0].unlink()
    for limit in (0, 40_000):
        full = all_(limit)
        assert full.returncode == 4
        assert full.stderr.endswith("; nothing new is published\n")
        assert "Traceback" not in full.stderr
    assert (folders.processed / "releases" / "current").resolve() == current
    assert {p: p.read_bytes() for p in current.rglob("*") if p.is_file()} == before
    assert all_(10_000_000).returncode == 1  # the file that is gone


def test_curves_that_the_disk_does_not_take_are_an_error_and_no_crash(tmp_path: Path) -> None:
    code = (
        "import resource, sys; from pathlib import Path\n"
        "from deamat.materials.curves import write_curves\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))\n"
        "try:\n    write_curves(Path(sys.argv[1]), [], synthetic_campaigns=())\n"
        "except OSError as error:\n    print(error.strerror)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "curves.h5")],
        capture_output=True, text=True, check=False, cwd=ROOT,
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (0, "File too large\n"), done.stderr
