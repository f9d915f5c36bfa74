"""A small campaign to run on: two materials, three specimens each, out of the committed twin."""

from __future__ import annotations

import csv
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

import deamat.run.draw
from deamat.run import run_all
from deamat.run.draw import FigureJob
from deamat.run.folders import Folders
from deamat.run.register import register

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
    """Draw nothing: for tests that are not about figures."""
    monkeypatch.setattr(deamat.run.draw, "draw_one", write_words)


def write_words(folder: Path, job: FigureJob) -> None:
    """Write words where a figure would be drawn."""
    for name in job.files:
        path = folder.parent / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"SYNTHETIC {job.title} {len(job.measurements)}")


def small_campaign(folder: Path, materials: Sequence[str] = MATERIALS) -> None:
    """Write and register a campaign with the first three fresh specimens of some materials."""
    rows = twin_rows("compression/specimens.csv")
    kept = []
    for material in materials:
        mine = [r for r in rows if r["material"] == material and r["age"] == "after cure"]
        kept += mine[:3]
    write_campaign(kept, folder, "compression/specimens.csv")
    register(folder.parent, folder.name, accept_all=True)


def all_of_one_material(folder: Path, material: str, most: int | None = None) -> None:
    """Write and register a campaign with what was measured on one material.

    `most` keeps so many files of each technique; None keeps all.
    """
    for path in sorted(TWIN.glob("*/*.csv")):
        name = path.relative_to(TWIN).as_posix()
        mine = [row for row in twin_rows(name) if row["material"] == material]
        if mine:
            write_campaign(mine[:most] if "file" in mine[0] else mine, folder, name)
    register(folder.parent, folder.name, accept_all=True)


def twin_rows(name: str) -> list[dict[str, str]]:
    """The rows of a register of the twin."""
    with (TWIN / name).open(newline="") as file:
        return list(csv.DictReader(file))


def write_campaign(rows: list[dict[str, str]], folder: Path, name: str) -> None:
    """Write a register of some rows of the twin, and copy the files that it names."""
    place = folder / Path(name).parent
    place.mkdir(parents=True)
    shutil.copy(TWIN / "campaign.toml", folder)
    for row in rows:
        if "file" in row:
            target = place / row["file"]
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(TWIN / Path(name).parent / row["file"], target)
    with (folder / name).open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


def curves(folders: Folders, campaign: str = "demo") -> list[Path]:
    """The data files of a small campaign, in order."""
    return sorted(
        p for p in (folders.raw / campaign / "compression").rglob("*") if p.suffix == ".txt"
    )
