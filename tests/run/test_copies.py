"""Files that are copies of others never count as further specimens."""

from __future__ import annotations

import csv
import json
import shutil

import pytest

from deamat.run.folders import Folders
from tests.run.conftest import MATERIALS, curves, run

pytestmark = pytest.mark.usefixtures("quick_figures")


def flags_of(folders: Folders, material: str) -> list[str]:
    card = json.loads((folders.processed / "cards" / f"{material}.json").read_text())
    return [flag for value in card["properties"] for flag in value["flags"]]


def test_equal_bytes_under_two_names_are_rejected_with_both_names(folders: Folders) -> None:
    first, second, *_ = curves(folders)
    shutil.copy(first, second)
    document = run(folders)
    rejected = {r["path"]: r["reason"] for r in document["rejected"]}
    paths = [f.relative_to(folders.raw).as_posix() for f in (first, second)]
    assert sorted(rejected) == paths[1:]  # its bytes are not the registered ones
    assert run(folders)["nothing_to_do"]


def test_a_copy_that_is_registered_takes_both_files_with_it(folders: Folders) -> None:
    first, second, *_ = curves(folders)
    shutil.copy(first, second)
    (folders.raw / "demo" / "MANIFEST.sha256").unlink()
    document = run(folders)
    rejected = {r["path"]: r["reason"] for r in document["rejected"]}
    paths = [f.relative_to(folders.raw).as_posix() for f in (first, second)]
    assert sorted(rejected) == paths
    assert all(p in rejected[q] for p, q in (paths, reversed(paths)))
    assert "equal bytes" in rejected[paths[0]]
    card = json.loads((folders.processed / "cards" / f"{MATERIALS[0]}.json").read_text())
    assert card["properties"][0]["n"] == 1


def test_half_a_curve_that_was_copied_is_flagged_on_both(folders: Folders) -> None:
    first, second, *_ = curves(folders)
    mine, theirs = (f.read_bytes().splitlines(keepends=True) for f in (first, second))
    half = 5 + (len(mine) - 5) // 2
    second.write_bytes(b"".join([*theirs[:half], *mine[half:]]))
    (folders.raw / "demo" / "MANIFEST.sha256").unlink()
    document = run(folders)
    assert document["rejected"] == []
    flag = next(f for f in flags_of(folders, MATERIALS[0]) if f.startswith("copied-rows"))
    assert "2 of 3 specimens" in flag
    told = [f["name"] for f in document["flags"] if f["severity"] == "serious"]
    assert told == ["copied-rows"]


def test_a_radius_for_a_diameter_is_flagged_on_every_value_made_from_it(folders: Folders) -> None:
    register = folders.raw / "demo" / "compression" / "specimens.csv"
    with register.open(newline="") as file:
        rows = list(csv.DictReader(file))
    rows[1]["diameter_mm"] = f"{float(rows[1]['diameter_mm']) / 2:.2f}"
    with register.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    run(folders)
    card = json.loads((folders.processed / "cards" / f"{rows[1]['material']}.json").read_text())
    assert len(card["properties"]) == 2
    for value in card["properties"]:
        assert any(f.startswith("register-slip") for f in value["flags"])
