"""A small campaign to run on: two materials, three specimens each, out of the committed twin."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path
from typing import Any

import pytest

import pipeline.run.draw
from pipeline.run import run_all
from pipeline.run.draw import FigureJob
from pipeline.run.folders import Folders
from pipeline.run.register import register

ROOT = Path(__file__).resolve().parents[2]
TWIN = ROOT / "raw" / "sylgard-2022-twin"
MATERIALS = ("sylgard-182-10to1", "sylgard-182-40to1")


def run(folders: Folders) -> dict[str, Any]:
    """Run in this process, telling nobody."""
    return run_all(folders, 1, lambda *_: None)


@pytest.fixture
def folders(tmp_path: Path) -> Folders:
    """Three folders of their own, with six compression curves in `raw/demo`."""
    made = Folders(tmp_path / "raw", tmp_path / "config", tmp_path / "processed")
    shutil.copytree(ROOT / "config", made.config)
    small_campaign(made.raw / "demo")
    return made


@pytest.fixture
def quick_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Write words instead of drawing: for tests that are not about figures."""

    def words(folder: Path, job: FigureJob) -> None:
        for name in job.files:
            path = folder.parent / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f"SYNTHETIC {job.title} {len(job.measurements)}")

    monkeypatch.setattr(pipeline.run.draw, "draw_one", words)


def small_campaign(folder: Path) -> None:
    """Write and register a campaign with the first three fresh specimens of two materials."""
    (folder / "compression").mkdir(parents=True)
    shutil.copy(TWIN / "campaign.toml", folder)
    with (TWIN / "compression" / "specimens.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    kept = []
    for material in MATERIALS:
        mine = [r for r in rows if r["material"] == material and r["age"] == "after cure"]
        kept += mine[:3]
    for row in kept:
        target = folder / "compression" / row["file"]
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(TWIN / "compression" / row["file"], target)
    with (folder / "compression" / "specimens.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, list(kept[0]))
        writer.writeheader()
        writer.writerows(kept)
    register(folder.parent, folder.name, accept=True)


def curves(folders: Folders) -> list[Path]:
    """The data files of the small campaign, in order."""
    return sorted(
        p for p in (folders.raw / "demo" / "compression").rglob("*") if p.suffix == ".txt"
    )
