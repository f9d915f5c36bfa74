"""`processed/paper/`: every printed number has its row, the page says it all, same bytes always."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest

from deamat.core.errors import ConfigError
from deamat.materials.database import DatabaseError, open_database
from deamat.report.paper import printed
from deamat.report.paper.discrepancies import discrepancies
from deamat.report.paper.entry import CORRECTED
from deamat.report.paper.laws import Reading
from deamat.report.paper.write import collect, write_paper

from .samples import database

Rows = dict[str, dict[str, Any]]


@pytest.fixture(scope="module")
def paper(tmp_path_factory: pytest.TempPathFactory) -> Path:
    processed = database(tmp_path_factory.mktemp("results") / "processed")
    write_paper(processed)
    return processed / "paper"


@pytest.fixture(scope="module")
def rows(paper: Path) -> Rows:
    listed = json.loads((paper / "paper.json").read_bytes())
    by_id = {row["id"]: row for row in listed}
    assert len(by_id) == len(listed)
    return by_id


@pytest.fixture(scope="module")
def page(paper: Path) -> str:
    return (paper / "index.html").read_text(encoding="utf-8")


def test_rows_have_the_declared_fields(rows: Rows) -> None:
    fields = ["id", "printed", "recomputed", "unit", "standard_uncertainty", "note"]
    assert all(list(row) == fields for row in rows.values())
    assert all(row["note"] for row in rows.values())


def test_every_printed_number_has_its_row_and_every_row_its_number(rows: Rows) -> None:
    numbers = dict(printed.numbers())
    assert numbers.keys() <= rows.keys()
    for path, row in rows.items():
        number = printed.part(path.removesuffix(CORRECTED))
        assert row["printed"] == number or isinstance(number, dict)


@pytest.mark.shared
def test_every_number_of_the_shared_facts_has_its_row(rows: Rows, shared: Path) -> None:
    facts = tomllib.loads((shared / "paper" / "facts.toml").read_text(encoding="utf-8"))

    def walk(at: Any, path: str) -> None:
        if isinstance(at, dict | list):
            for key, below in at.items() if isinstance(at, dict) else enumerate(at):
                walk(below, f"{path}.{key}")
        elif not isinstance(at, bool | str):
            assert rows[path[1:]]["printed"] == at

    walk(facts, "")
    for path in rows:
        table, *keys = path.removesuffix(CORRECTED).split(".")
        if not table.startswith(("figure", "text")):
            found = facts[table]
            for key in keys:
                found = found[int(key) if isinstance(found, list) else key]


@pytest.mark.parametrize(
    "row",
    [
        {
            "id": "table4.sylgard-182-10to1.compressive_modulus_MPa",
            "printed": 0.957,
            "recomputed": 0.952,
            "unit": "MPa",
            "standard_uncertainty": 0.012,
            "note": "SYNTHETIC: simulated, not measured; campaign twin-1; n = 5, "
            "95 % interval 0.928 to 0.976 MPa",
        },
        {
            "id": "table4.sylgard-184-10to1.tensile_modulus_MPa",
            "printed": 1.25,
            "recomputed": 1.4,
            "unit": "MPa",
            "standard_uncertainty": 0.05,
            "note": "campaign lab-1; n = 5, 95 % interval 1.3 to 1.5 MPa",
        },
        {
            "id": "table4.sylgard-182-10to1.breakdown_strength_V_per_um",
            "printed": 96.9,
            "recomputed": None,
            "unit": "V/um",
            "standard_uncertainty": None,
            "note": "not recomputed: sylgard-182-10to1 has no breakdown_strength, it was refused: "
            "3 films, 5 are needed",
        },
        {
            "id": "table3.sylgard-182-10to1-bed50C.hours",
            "printed": 9.0,
            "recomputed": 8.5,
            "unit": "h",
            "standard_uncertainty": None,
            "note": "SYNTHETIC: simulated, not measured; campaign twin-1; n = 5, a lower bound: "
            "above 8.5 h",
        },
        {
            "id": "table3.sylgard-182-10to1.hours",
            "printed": 11.0,
            "recomputed": 11.0,
            "unit": "h",
            "standard_uncertainty": None,
            "note": "SYNTHETIC: simulated, not measured; campaign twin-1; n = 5, "
            "seen to lie within 11 to 11.5 h",
        },
        {
            "id": "table4.sylgard-182-20to1.tensile_modulus_MPa",
            "printed": 0.634,
            "recomputed": None,
            "unit": "MPa",
            "standard_uncertainty": None,
            "note": "not recomputed: the database has no material sylgard-182-20to1",
        },
        {
            "id": "table1.kadooka_2016.V",
            "printed": 550.0,
            "recomputed": None,
            "unit": "V",
            "standard_uncertainty": None,
            "note": "input, or measured in the cited work; used as printed",
        },
    ],
    ids=lambda row: row["id"],
)
def test_golden_rows(rows: Rows, row: dict[str, Any]) -> None:
    assert rows[row["id"]] == row


def test_the_age_and_the_frequency_of_the_table_are_asked_for(rows: Rows) -> None:
    here = "table4.sylgard-182-10to1"
    assert rows[f"{here}.compressive_modulus_2_months_MPa"]["recomputed"] == 0.843
    assert rows[f"{here}.relative_permittivity_10Hz"]["recomputed"] == 2.6
    assert rows[f"{here}.elongation_percent"]["recomputed"] == 286.9


def test_the_page_says_synthetic_first_and_credits_the_authors(page: str) -> None:
    body = page[page.index("<body>") :]
    assert body.index("SYNTHETIC DATA") < body.index("<h1>")
    assert "simulated campaign twin-1. They are not measurements." in body
    assert "Sikulskyi" in body
    assert "doi:10.3389/frobt.2022.1034914" in body
    assert "CC BY" in body


def test_all_discrepancies_are_stated_where_they_belong(page: str) -> None:
    with_places = {
        "D1": "table1", "D2": "table5", "D3": "table2", "D4": "figure7", "D5": "table1",
        "D6": "table1", "D7": "table4",
    }  # fmt: skip
    for key, place in with_places.items():
        section = page[page.index(f'<h2 id="{place}">') :]
        section = section[: section.index("<h2", 3)]
        assert f'<a href="#{key}"><b>{key}</b></a>' in section


@pytest.mark.parametrize(
    "said",
    [
        "0.0850, right is 0.1330",
        "Duduta 2016 77.32 as printed, 95.83 corrected",
        "13.11 per m and an optimum of 13.23",
        "0.99 MPa, or of 2.9 µm",
        "Not decided by data: the database has no material sylgard-186-10to1",
        "0.40 µm and 146 per m",
        "D/(4h) = 0.58",
    ],
)
def test_discrepancies_come_with_their_numbers(page: str, said: str) -> None:
    assert said in page


def test_a_reading_of_synthetic_data_is_no_evidence() -> None:
    off = {"e = n": 0.01, "e = 1 - n": 0.37, "e = n - 1": 0.99}
    found = Reading("sylgard-186-10to1", "e = n", off, (0.30, 0.31), synthetic=True)
    d3 = discrepancies([found])[2]
    assert "the data have n = 0.300 to 0.310 and support e = n; not the footnote's" in d3.text
    assert "no evidence for what the authors measured" in d3.text


def test_figures_of_simulated_data_are_marked_and_computed_ones_are_not(paper: Path) -> None:
    marked = {
        path.stem: "SYNTHETIC" in path.read_text(encoding="utf-8")
        for path in (paper / "figures").glob("*.svg")
    }
    assert len(marked) == 15
    assert {name for name, mark in marked.items() if mark} == {
        "figure-8a", "figure-9a", "figure-9b", "figure-10a",
    }  # fmt: skip


def test_the_page_needs_nothing_from_elsewhere(page: str) -> None:
    assert "<script" not in page
    assert "src=" not in page
    assert page.count("<svg") == 15
    for stylesheet in ("@import", 'rel="stylesheet"'):
        assert stylesheet not in page


def test_same_database_same_bytes(paper: Path, tmp_path: Path) -> None:
    write_paper(database(tmp_path / "elsewhere"))
    other = tmp_path / "elsewhere" / "paper"
    names = {str(p.relative_to(paper)) for p in paper.rglob("*") if p.is_file()}
    assert names == {str(p.relative_to(other)) for p in other.rglob("*") if p.is_file()}
    assert all((paper / n).read_bytes() == (other / n).read_bytes() for n in names)


def test_without_a_database_nothing_is_written(tmp_path: Path) -> None:
    with pytest.raises(DatabaseError, match="no database"):
        write_paper(tmp_path)
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_not_ours_is_ignored(tmp_path: Path) -> None:
    database(tmp_path)
    (tmp_path / "paper").mkdir()
    with pytest.raises(ConfigError, match="is not a link made by this program; move it away"):
        write_paper(tmp_path)


def test_a_value_that_comes_later_joins_without_a_change(tmp_path: Path) -> None:
    with open_database(database(tmp_path)) as opened:
        known = [e for e in collect(opened) if e.id.startswith("table4.")]
    assert {e.id.rpartition(".")[2] for e in known if e.recomputed is not None} == {
        "compressive_modulus_MPa", "compressive_modulus_2_months_MPa", "elongation_percent",
        "relative_permittivity_10Hz", "tensile_modulus_MPa",
    }  # fmt: skip
