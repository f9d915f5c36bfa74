"""The published schema of each register is the one of the code, and judges rows as the code does."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from deamat.core.errors import RawFileError
from deamat.core.number_grammar import is_number
from deamat.core.register import read_register
from deamat.run.register_schemas import header_of, schema_of, write_schemas
from deamat.techniques import TECHNIQUES

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs" / "registers"
TWIN = ROOT / "raw" / "sylgard-2022-twin"


@pytest.mark.parametrize("key", TECHNIQUES)
def test_the_published_schema_is_made_of_the_code(key: str) -> None:
    published = (DOCS / f"{key}.schema.json").read_text()
    assert published == schema_of(TECHNIQUES[key]), "run `make schema`"
    jsonschema.Draft202012Validator.check_schema(json.loads(published))


def test_all_schemas_are_written_into_a_folder_that_need_not_be_there(tmp_path: Path) -> None:
    for _ in range(2):
        write_schemas(tmp_path / "docs" / "registers")
    written = {p.name: p.read_text() for p in (tmp_path / "docs" / "registers").iterdir()}
    assert written == {f"{key}.schema.json": schema_of(TECHNIQUES[key]) for key in TECHNIQUES}


def test_no_schema_is_left_of_a_technique_that_is_gone() -> None:
    assert {path.name for path in DOCS.iterdir()} == {f"{key}.schema.json" for key in TECHNIQUES}


@pytest.mark.parametrize("key", TECHNIQUES)
def test_rows_of_the_twin_fit_their_schema(key: str) -> None:
    schema = json.loads(schema_of(TECHNIQUES[key]))
    with (TWIN / key / TECHNIQUES[key].register.file).open(newline="") as file:
        for row in list(csv.DictReader(file))[:5]:
            jsonschema.validate(_typed(row), schema)


@pytest.mark.parametrize(
    ("change", "good"),
    [
        ({}, True),
        ({"diameter_mm": "0.028"}, False),
        ({"diameter_mm": ""}, False),
        ({"diameter_mm": "", "diameter_cm": "2.8"}, True),
        ({"material": "Gel A"}, False),
        ({"tested_on": "yesterday"}, False),
        ({"remark": "wet"}, True),
    ],
)
def test_schema_and_reader_agree(change: dict[str, str], good: bool) -> None:
    row = {"specimen": "s1", "material": "gel-a", "diameter_mm": "28", "height_mm": "12"} | change
    told = {column: cell for column, cell in row.items() if cell}
    technique = TECHNIQUES["compression"]
    validator = jsonschema.Draft202012Validator(json.loads(schema_of(technique)))
    assert validator.is_valid(_typed(told)) is good
    text = ",".join(told) + "\n" + ",".join(told.values()) + "\n"
    try:
        read = read_register(text.encode(), "r.csv", "c", "compression", technique.required, {})
        assert bool(read.specimens) is good
    except RawFileError:
        assert not good


@pytest.mark.parametrize("key", TECHNIQUES)
def test_an_empty_register_has_a_header_that_is_read(key: str) -> None:
    technique = TECHNIQUES[key]
    header = ",".join(header_of(technique)) + "\n"
    read = read_register(
        header.encode(), f"c/{key}/{technique.register.file}", "c", key, technique.required, {},
        technique.register,
    )  # fmt: skip
    assert read.specimens == ()
    assert read.errors == ()


def _typed(row: dict[str, str]) -> dict[str, Any]:
    return {c: float(cell) if is_number(cell) else cell for c, cell in row.items() if cell}
