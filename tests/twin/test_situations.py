"""Every situation of the one list can be written, and what is written is a campaign for a run."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

import deamat.run.draw
from deamat.cli import cli
from deamat.core.errors import ConfigError
from deamat.run.folders import Folders
from deamat.twin.situations import SITUATIONS
from deamat.twin.situations.written import situation_files, situation_named, write_situation
from tests.run.conftest import ROOT, run, write_words


def test_a_run_reads_every_situation_and_accounts_for_every_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(deamat.run.draw, "draw_one", write_words)
    raw = tmp_path / "raw"
    for name, situation in SITUATIONS.items():
        middle = situation.severities[len(situation.severities) // 2]
        write_situation(raw, situation, middle, 1, tmp_path / f"{name}.json")
    folders = Folders(raw, ROOT / "config", tmp_path / "processed")
    document = run(folders)
    assert document["exit_code"] in (0, 1)
    files = json.loads((folders.processed / "audit" / "files.json").read_bytes())
    told = {name: set[str]() for name in SITUATIONS}
    for entry in files:
        told[entry["path"].partition("/")[0]].add(entry["status"])
        assert entry["status"] in ("used", "metadata", "refused", "rejected"), entry
    for name, statuses in told.items():
        assert statuses & {"used", "refused", "rejected"}, name


def test_the_same_seed_makes_the_same_bytes_and_another_one_others() -> None:
    situation = situation_named("tension-slack")
    assert situation_files(situation, 0.0017, 3) == situation_files(situation, 0.0017, 3)
    one, other = (situation_files(situation, 0.0017, seed) for seed in (3, 4))
    assert one["tension/1.csv"] != other["tension/1.csv"]


def test_a_situation_is_written_by_name_and_its_truth_lies_apart(tmp_path: Path) -> None:
    out = tmp_path / "raw"
    asked = ["simulate", "--situation", "tension-stopped", "--severity", "0.1"]
    done = CliRunner().invoke(cli, [*asked, "--seed", "5", "--out", str(out)])
    assert done.exit_code == 0, done.output
    written = {str(p.relative_to(out)) for p in out.rglob("*") if p.is_file()}
    assert written == {
        f"tension-stopped/{path}"
        for path in ("campaign.toml", "MANIFEST.sha256", "tension/specimens.csv",
                     *(f"tension/{i}.csv" for i in range(1, 6)))
    }  # fmt: skip
    declared = (out / "tension-stopped" / "campaign.toml").read_text()
    assert "synthetic = true" in declared
    assert "--situation tension-stopped --severity 0.1 --seed 5" in declared
    truth = json.loads((tmp_path / "raw.tension-stopped.truth.json").read_text())
    assert truth["key"] == "elongation_at_break"
    assert truth["value"] == pytest.approx(2.5, rel=0.1)
    assert truth["a short script says"] == pytest.approx(0.9 * truth["value"], rel=0.02)
    again = CliRunner().invoke(cli, [*asked, "--seed", "5", "--out", str(out)])
    assert again.exit_code != 0


def test_the_list_names_every_situation() -> None:
    said = CliRunner().invoke(cli, ["simulate", "--list"])
    assert said.exit_code == 0
    assert all(name in said.output for name in SITUATIONS)


def test_an_unknown_name_and_a_severity_beyond_the_named_ones_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="nearest: tension-slack"):
        situation_named("tension-slak")
    situation = situation_named("tension-few-samples")
    with pytest.raises(ConfigError, match="0 \\(no fault\\) or 2 to 8"):
        write_situation(tmp_path / "raw", situation, 100.0, 1, tmp_path / "truth.json")
    assert not (tmp_path / "raw").exists()
