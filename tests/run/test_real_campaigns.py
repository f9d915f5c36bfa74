"""The published campaigns, end to end: what must come out of them comes out."""

from __future__ import annotations

import csv
import json
import tomllib
from pathlib import Path
from typing import Any

import pytest

from deamat import open_database
from deamat.run.folders import Folders
from tests.run.conftest import ROOT, run


@pytest.fixture(scope="module")
def real(shared: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Folders, dict[str, Any]]:
    folders = Folders(shared / "real", ROOT / "config", tmp_path_factory.mktemp("real") / "out")
    return folders, run(folders)


def _expected(shared: Path, mode: str, quantity: str) -> dict[str, float]:
    with (shared / "real" / "expected_mechanics.csv").open(newline="") as file:
        return {
            row["file"].rpartition("/")[2]: float(row["expected"])
            for row in csv.DictReader(file)
            if row["mode"] == mode and row["quantity"].startswith(quantity)
        }


def _card(folders: Folders, material: str) -> dict[str, Any]:
    text = (folders.processed / "cards" / f"{material}.json").read_text()
    card: dict[str, Any] = json.loads(text)
    return card


def test_the_run_is_well(real: tuple[Folders, dict[str, Any]]) -> None:
    _, document = real
    assert document["exit_code"] == 0
    assert document["rejected"] == []
    assert "flow/" in document["ignored"]


def test_published_moduli_within_five_percent(
    real: tuple[Folders, dict[str, Any]], shared: Path
) -> None:
    campaign = shared / "real" / "ecoflex-phantom-2026" / "campaign.toml"
    published = tomllib.loads(campaign.read_text())["published"]["compressive_modulus_kPa"]
    assert len(published) == 3
    with open_database(real[0].processed) as database:
        for material, (kilopascal, _) in published.items():
            modulus = database[material]["compressive_modulus"]
            assert modulus.unit == "Pa"
            assert modulus.value == pytest.approx(1e3 * kilopascal, rel=0.05)


def test_every_specimens_slope(real: tuple[Folders, dict[str, Any]], shared: Path) -> None:
    expected = _expected(shared, "compression", "slope 0-5 %")
    found = {
        origin["path"].rpartition("/")[2]: origin["value"]
        for material in ("ef50-0t", "ef30-25t", "ef10-50t")
        for value in _card(real[0], material)["properties"]
        if value["key"] == "compressive_modulus"
        for origin in value["origins"]
    }
    assert len(found) == len(expected) == 30
    for name, kilopascal in expected.items():
        assert found[name] == pytest.approx(1e3 * kilopascal, rel=1e-3), name


def test_the_contradiction_of_units_is_flagged(real: tuple[Folders, dict[str, Any]]) -> None:
    flags = _card(real[0], "ef50-0t")["properties"][0]["flags"]
    assert any("the README says N/mm^2, the column says kPa" in flag for flag in flags)


def test_tensile_moduli_are_refused_with_counts(real: tuple[Folders, dict[str, Any]]) -> None:
    refused = [r for r in real[1]["refused"] if r["campaign"] == "soro-2019"]
    assert len(refused) == 7
    assert all(r["key"] == "tensile_modulus" for r in refused)
    assert all(
        "samples in the window of 0-1 % strain, 5 are needed" in r["reason"] for r in refused
    )


@pytest.mark.parametrize(
    ("key", "quantity", "factor"),
    [
        ("tensile_strength", "tensile strength", 1e6),
        ("elongation_at_break", "elongation at max stress", 1e-2),
    ],
)
def test_strength_and_elongation(
    real: tuple[Folders, dict[str, Any]], shared: Path, key: str, quantity: str, factor: float
) -> None:
    expected = {
        name: value
        for name, value in _expected(shared, "tension", quantity).items()
        if name.endswith(".csv")
    }
    found = {
        origin["path"].rpartition("/")[2]: value["value"]
        for path in (real[0].processed / "cards").glob("*.json")
        for value in json.loads(path.read_text())["properties"]
        if value["key"] == key
        for origin in value["origins"]
    }
    for name in _soro(shared):
        # the table prints five digits: equal to the last of them
        assert found[name] / factor == pytest.approx(expected[name], rel=5e-5), name
        assert found[name] == _greatest(shared, name)[key], name


def _soro(shared: Path) -> list[str]:
    folder = shared / "real" / "soro-2019" / "tension" / "curves"
    names = [path.name for path in folder.iterdir()]
    assert len(names) == 7
    return names


def _greatest(shared: Path, name: str) -> dict[str, float]:
    """Greatest engineering stress and its strain, read with the standard library alone."""
    path = shared / "real" / "soro-2019" / "tension" / "curves" / name
    rows = [line.split(";") for line in path.read_text("utf-8").splitlines()[18:]]
    stress, strain = max((float(row[4]), float(row[3])) for row in rows)
    return {"tensile_strength": stress * 1e6, "elongation_at_break": strain}
