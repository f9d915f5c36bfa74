"""`deamat exclude` finds what is meant, writes it with its reason, and leaves the rest alone."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner

from deamat.cli import cli
from deamat.core.errors import ConfigError
from deamat.run.exclude import exclude
from deamat.run.folders import Folders
from tests.run.conftest import curves, run

pytestmark = pytest.mark.usefixtures("quick_figures")

NAME = "c-sylgard-182-10to1-after-cure-1"


def declared(folders: Folders) -> Path:
    return folders.config / "exclusions.toml"


def test_a_specimen_is_left_out_by_its_name(folders: Folders) -> None:
    before = declared(folders).read_text()
    exclude(folders, NAME, 'the plate "slipped" \\ Kante')
    added = declared(folders).read_text().removeprefix(before)
    assert added == (
        f'\n[[exclude]]\nspecimen = "demo/compression/{NAME}"\n'
        'reason = "the plate \\"slipped\\" \\\\ Kante"\n'
    )
    document = run(folders)
    assert document["exit_code"] == 0
    assert document["excluded"][0]["reason"] == 'the plate "slipped" \\ Kante'
    with pytest.raises(ConfigError, match="left out already: the plate"):
        exclude(folders, f"demo/compression/{NAME}", "again and again")


def test_a_file_is_left_out_by_its_path(folders: Folders) -> None:
    stray = curves(folders)[0].with_name("stray.txt")
    stray.write_text("1\n")
    path = stray.relative_to(folders.raw).as_posix()
    exclude(folders, path, "a test of the export")
    document = run(folders)
    assert {"path": path, "reason": "a test of the export"} in document["excluded"]
    assert document["rejected"] == []


def test_without_a_file_of_exclusions_one_is_made(folders: Folders) -> None:
    declared(folders).unlink()
    exclude(folders, NAME, "the plate slipped")
    assert declared(folders).read_text().startswith("[[exclude]]\n")


def test_what_is_called_so_twice_is_named_in_full(folders: Folders) -> None:
    shutil.copytree(folders.raw / "demo", folders.raw / "again")
    with pytest.raises(ConfigError, match=f"several specimens.*again/compression/{NAME}, demo/"):
        exclude(folders, NAME, "the plate slipped")
    assert exclude(folders, f"again/compression/{NAME}", "a copy").specimen


@pytest.mark.parametrize(
    ("named", "said"),
    [
        ("c-sylgard-182-10to1-after-cure-l", f"did you mean '{NAME[:-1]}"),
        ("../../etc/passwd", "no specimen and no file"),
        ("demo", "no specimen and no file"),
        ("demo/campaign.toml", "no specimen and no file"),  # a campaign declares itself by it
    ],
)
def test_what_is_not_there_is_an_error(folders: Folders, named: str, said: str) -> None:
    before = declared(folders).read_text()
    with pytest.raises(ConfigError, match=said):
        exclude(folders, named, "the plate slipped")
    assert declared(folders).read_text() == before


@pytest.mark.parametrize("reason", ["", "  ", "a\nb", "no"])
def test_a_reason_is_a_line_of_text(folders: Folders, reason: str) -> None:
    with pytest.raises(ConfigError, match="--reason"):
        exclude(folders, NAME, reason)


def test_the_command_says_what_it_wrote(folders: Folders) -> None:
    where = ["--raw", str(folders.raw), "--config", str(folders.config)]
    said = CliRunner().invoke(cli, ["exclude", NAME, "--reason", "the plate slipped", *where])
    assert said.exit_code == 0
    assert said.output == (
        f"excluded   demo/compression/{NAME}: the plate slipped\nnext       deamat all\n"
    )
