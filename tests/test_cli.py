"""The command line: its exit codes and the words a user would read."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from deamat.run.folders import Folders
from tests.run.conftest import curves, folders

__all__ = ["folders"]

HEAVY = ("numpy", "scipy", "pandas", "pydantic", "h5py", "matplotlib", "simdjson", "xarray")


def deamat(folders: Folders, *words: str) -> subprocess.CompletedProcess[str]:
    places = ("--raw", folders.raw, "--config", folders.config, "--processed", folders.processed)
    command = [sys.executable, "-m", "deamat", *words, *map(str, places)]
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=folders.raw)


def test_a_run_and_what_can_be_asked_of_it(folders: Folders) -> None:
    first = deamat(folders, "all", "--workers", "1")
    assert first.returncode == 0
    assert "SYNTHETIC  demo: simulated files, not measurements" in first.stdout
    assert "compression: 6\n" in first.stderr  # no bar where there is no terminal
    again = deamat(folders, "all", "--json")
    assert again.returncode == 0
    assert json.loads(again.stdout)["nothing_to_do"] is True
    card = deamat(folders, "card", "sylgard-182-10to1")
    assert card.returncode == 0
    assert "SYNTHETIC" in card.stdout
    trace = deamat(folders, "trace", "sylgard-182-10to1", "compressive_modulus", "--json")
    chain = json.loads(trace.stdout)
    assert json.dumps(chain).count('"sha256"') >= 3
    audit = json.loads(deamat(folders, "audit", "--json").stdout)
    assert (audit["exit_code"], audit["unaccounted"]) == (0, [])


def test_a_rejected_file_ends_with_one_and_its_place(folders: Folders) -> None:
    path = curves(folders)[0]
    labels, ends, rows = path.read_bytes().partition(b"Time\r\n")
    path.write_bytes(labels + ends + rows.replace(b"\t", b"\tOVER", 30))
    done = deamat(folders, "all", "--workers", "1")
    assert done.returncode == 1
    assert f"REJECTED   demo/compression/{path.parent.name}/{path.name}, line" in done.stdout
    assert "MANIFEST   demo: 1 changed" in done.stdout


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("all", "--workers", "0"), "0 is not in the range x>=1"),
        (("alll",), "No such command 'alll'"),
        (("card", "sylgard-182-10to1"), "no database"),
        (("paper",), "no database"),
        (("register", "nowhere"), "nowhere is no campaign: it has no campaign.toml"),
    ],
)
def test_wrong_usage_ends_with_two_and_a_sentence(
    folders: Folders, words: tuple[str, ...], said: str
) -> None:
    done = deamat(folders, *words)
    assert done.returncode == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr


def test_a_slip_in_the_configuration_ends_with_two(folders: Folders) -> None:
    (folders.config / "methods.toml").write_text("[compression]\nmin_sample = 3\n")
    done = deamat(folders, "all")
    assert done.returncode == 2
    assert "unknown key 'compression.min_sample'; did you mean 'min_samples'?" in done.stderr


def test_a_run_with_nothing_to_do_imports_nothing_heavy(folders: Folders) -> None:
    deamat(folders, "all", "--workers", "1")
    places = [str(p) for p in (folders.raw, folders.config, folders.processed)]
    program = (
        "import sys\n"
        "from pathlib import Path\n"
        "from deamat.cli import cli\n"
        "from deamat.run import run_all\n"
        "from deamat.run.folders import Folders\n"
        f"document = run_all(Folders(*map(Path, {places!r})), 1, print)\n"
        "assert document['nothing_to_do']\n"
        f"print([m for m in {HEAVY!r} if m in sys.modules])\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True,
        cwd=Path(__file__).resolve().parents[1],
    )  # fmt: skip
    assert done.stdout == "[]\n"
