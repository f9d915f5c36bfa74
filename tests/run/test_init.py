"""An empty folder becomes a project that a run accepts; nothing that is there is overwritten."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

from deamat.cli import cli
from deamat.core.errors import ConfigError
from deamat.run.folders import Folders
from deamat.run.init import Declared, init
from deamat.techniques import TECHNIQUES
from tests.run.conftest import run

DECLARED = Declared("spring-2026", "Gels", "Lab", "CC0", synthetic=True)


def project(folder: Path) -> Folders:
    """Return three folders in an empty one."""
    return Folders(folder / "raw", folder / "config", folder / "processed")


def test_an_empty_folder_becomes_a_project_that_a_run_accepts(tmp_path: Path) -> None:
    folders = project(tmp_path)
    made = init(folders, DECLARED, tuple(TECHNIQUES))
    there = {str(path) for path in tmp_path.rglob("*") if path.is_file()}
    assert {*made, str(folders.raw / "spring-2026" / "MANIFEST.sha256")} == there
    document = run(folders)
    assert document["exit_code"] == 0
    assert document["manifest"] == []
    assert [c["name"] for c in document["campaigns"]] == ["spring-2026"]
    assert document["files"]["used"] == len(TECHNIQUES) + 2


def test_a_second_campaign_leaves_the_first_and_the_configuration(tmp_path: Path) -> None:
    folders = project(tmp_path)
    init(folders, DECLARED, ["tension"])
    (folders.config / "materials.toml").write_text('[gel-a]\nname = "Gel A"\n')
    init(folders, Declared("autumn", "Gels", "Lab", "CC0", synthetic=False), ["compression"])
    assert (folders.config / "materials.toml").read_text() == '[gel-a]\nname = "Gel A"\n'
    assert (folders.raw / "spring-2026" / "tension" / "specimens.csv").is_file()
    assert not (folders.raw / "autumn" / "tension").exists()
    with pytest.raises(ConfigError, match=r"autumn is there already; choose another --campaign"):
        init(folders, Declared("autumn", "x", "x", "x", synthetic=False), [])


def test_whatever_people_write_is_declared_as_they_wrote_it(tmp_path: Path) -> None:
    folders = project(tmp_path)
    title = 'Gels "soft" \\ härter = [x] # ='
    init(folders, Declared("a", title, "Lab", "CC0", synthetic=False, timezone="UTC"), [])
    declared = tomllib.loads((folders.raw / "a" / "campaign.toml").read_text())
    assert declared == {
        "title": title, "laboratory": "Lab", "licence": "CC0", "timezone": "UTC",
        "synthetic": False,
    }  # fmt: skip


@pytest.mark.parametrize("name", ["../up", "Spring", "a/b", "", "nul", "a" * 81])
def test_a_campaign_is_named_by_a_slug(name: str, tmp_path: Path) -> None:
    folders = project(tmp_path / "in")
    with pytest.raises(ConfigError, match="nearest valid"):
        init(folders, Declared(name, "t", "l", "c", synthetic=False), [])
    assert list(tmp_path.iterdir()) == []


def test_a_technique_that_is_none_names_the_one_that_is_meant(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="did you mean 'compression'"):
        init(project(tmp_path), DECLARED, ["Compression"])


def test_a_title_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="--title"):
        init(project(tmp_path), Declared("a", "x\ny", "l", "c", synthetic=False), [])


def test_the_command_asks_for_nothing_where_nobody_can_answer(tmp_path: Path) -> None:
    place = tmp_path / "Soft Gels 2026"
    said = CliRunner().invoke(cli, ["init", str(place), "--title", "x"])
    assert said.exit_code == 2
    assert "say --laboratory" in said.output
    options = ["--title", "x", "--laboratory", "l", "--licence", "none", "--measured"]
    said = CliRunner().invoke(cli, ["init", str(place), *options, "--technique", "tension"])
    assert said.exit_code == 0
    assert "next       deamat add FOLDER --campaign soft-gels-2026" in said.output
    assert (place / "raw" / "soft-gels-2026" / "tension" / "specimens.csv").is_file()
