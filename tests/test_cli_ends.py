"""How a command ends that cannot do its work: a sentence and an exit code, never a bare traceback."""

from __future__ import annotations

import errno
import sqlite3
import sys
from typing import Any

import pytest

import deamat.run
from deamat import cli


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
