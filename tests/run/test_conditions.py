"""Temperature, humidity, instrument, operator and day reach the card; 22 C is not 90 C."""

from __future__ import annotations

import csv
import json
from typing import Any

import pytest

from deamat.run.folders import Folders
from tests.run.conftest import MATERIALS, run

pytestmark = pytest.mark.usefixtures("quick_figures")


def rewrite(folders: Folders, **changes: dict[int, str]) -> None:
    register = folders.raw / "demo" / "compression" / "specimens.csv"
    with register.open(newline="") as file:
        rows = list(csv.DictReader(file))
    for column, cells in changes.items():
        for i, row in enumerate(rows):
            row[column] = cells.get(i, row.get(column, ""))
    with register.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)


def moduli(folders: Folders) -> list[dict[str, Any]]:
    card = json.loads((folders.processed / "cards" / f"{MATERIALS[0]}.json").read_text())
    return [p for p in card["properties"] if p["key"] == "compressive_modulus"]


def test_conditions_reach_record_origin_and_card(folders: Folders) -> None:
    rewrite(folders, operator={0: "A. Tester"})
    run(folders)
    (modulus,) = moduli(folders)
    assert modulus["conditions"]["temperature_K"] == 295.15
    assert modulus["conditions"]["humidity"] == 0.52
    first, second, _ = modulus["origins"]
    assert first["operator"] == "A. Tester"
    assert "operator" not in second
    assert first["instrument"] == "simulated AMETEK CS225, 5 kg cell"
    assert (first["tested_on"], first["temperature_K"], first["humidity"]) == ("2022-01-18", 295.15, 0.52)  # fmt: skip


def test_a_warm_specimen_is_a_record_of_its_own(folders: Folders) -> None:
    rewrite(folders, temperature_C={1: "90"})
    run(folders)
    cold, warm = moduli(folders)
    assert [(m["n"], m["conditions"]["temperature_K"]) for m in (cold, warm)] == [(2, 295.15), (1, 363.15)]  # fmt: skip
    (folders.config / "methods.toml").write_text("[conditions]\ntemperature_tolerance_K = 100\n")
    run(folders)
    (both,) = moduli(folders)
    assert both["n"] == 3
    assert [o["temperature_K"] for o in both["origins"]] == [295.15, 363.15, 295.15]


def test_a_row_that_does_not_say_is_flagged(folders: Folders) -> None:
    rewrite(folders, temperature_C={1: ""})
    run(folders)
    (modulus,) = moduli(folders)
    assert modulus["n"] == 3
    assert any(f.startswith("not-recorded: 1 of 3 specimens") for f in modulus["flags"])
