"""A register may name the format of a file, which is then read as that and as nothing else."""

from __future__ import annotations

import csv
import json

import pytest

from deamat.run.folders import Folders
from deamat.run.register import register
from tests.run.conftest import MATERIALS, curves, run

pytestmark = pytest.mark.usefixtures("quick_figures")

RIGHT = "mark10"  # of the files of the twin's compression


def test_a_file_is_read_in_the_format_that_its_row_names(folders: Folders) -> None:
    _name_formats(folders, ["", RIGHT, RIGHT, "hysitron", "mark1", ""])
    found = run(folders)
    audit = json.loads((folders.processed / "audit" / "files.json").read_text(encoding="utf-8"))
    reasons = {entry["path"]: entry["reason"] for entry in audit}
    told = [reasons[path.relative_to(folders.raw).as_posix()] for path in curves(folders)]
    assert [reason != "" for reason in told] == [False, False, False, True, True, False]
    assert "as the hysitron form has it" in told[3]
    assert told[4].startswith("demo/compression/specimens.csv, line 6: there is no format 'mark1'")
    assert told[4].endswith("did you mean mark10? (found 'mark1')")
    cards = {path.stem for path in (folders.processed / "cards").iterdir()}
    assert MATERIALS[0] in cards
    assert found["exit_code"] == 1


def _name_formats(folders: Folders, formats: list[str]) -> None:
    path = folders.raw / "demo" / "compression" / "specimens.csv"
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    for row, name in zip(rows, formats, strict=True):
        row["format"] = name
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    register(folders.raw, "demo", accept_all=True)
