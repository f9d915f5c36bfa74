"""How the virtual environment is made: by any recent Python, or one sentence says what is missing."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import ROOT

SHIM_WITHOUT_PYTHON = "echo 'pyenv: no such version' >&2; exit 127"
TOO_OLD = 'case "$2" in *version_info*) exit 1 ;; esac'
WITHOUT_ENSUREPIP = (
    'case "$2" in *"import ensurepip"*) exit 1 ;; *print*) echo python3.12-venv ;; esac'
)
REAL = f'exec "{sys.executable}" "$@"'


def make(tmp_path: Path, wanted: str = "", **commands: str) -> subprocess.CompletedProcess[str]:
    """Run the script where no commands exist but these."""
    for name, script in commands.items():
        command = tmp_path / name.replace("_", ".")
        command.write_text(f"#!/bin/sh\n{script}\n")
        command.chmod(0o755)
    return subprocess.run(
        ["/bin/sh", str(ROOT / ".ci" / "venv"), str(tmp_path / "environment"), wanted],
        capture_output=True,
        text=True,
        env={"PATH": str(tmp_path)},
        check=False,
    )


@pytest.mark.parametrize(
    ("commands", "wanted", "message"),
    [
        (
            {},
            "",
            "no Python 3.11 or newer was found (python3.13, python3.12, python3.11, python3); "
            "install one, or name it with make PYTHON=...",
        ),
        (
            {"python3_13": SHIM_WITHOUT_PYTHON, "python3": TOO_OLD},
            "",
            "no Python 3.11 or newer was found (python3.13, python3.12, python3.11, python3); "
            "install one, or name it with make PYTHON=...",
        ),
        (
            {"python3_12": REAL, "python3": TOO_OLD},
            "python3",
            "PYTHON=python3 is not a Python 3.11 or newer that runs",
        ),
        (
            {"python3_12": WITHOUT_ENSUREPIP},
            "",
            "python3.12 lacks its module ensurepip, which makes virtual environments; install it "
            "(Debian and Ubuntu: apt install python3.12-venv)",
        ),
    ],
)
def test_what_is_missing_is_said_in_one_sentence(
    tmp_path: Path, commands: dict[str, str], wanted: str, message: str
) -> None:
    done = make(tmp_path, wanted, **commands)
    assert (done.returncode, done.stdout, done.stderr) == (1, "", f"make: {message}\n")


def test_the_first_python_that_runs_makes_it_and_it_is_made_once(tmp_path: Path) -> None:
    made = make(tmp_path, python3_13=SHIM_WITHOUT_PYTHON, python3_12=TOO_OLD, python3=REAL)
    assert (made.returncode, made.stderr) == (0, "")
    python = tmp_path / "environment" / "bin" / "python"
    subprocess.run([python, "-m", "pip", "--version"], check=True, capture_output=True)
    for command in tmp_path.glob("python*"):
        command.unlink()
    assert make(tmp_path).returncode == 0
