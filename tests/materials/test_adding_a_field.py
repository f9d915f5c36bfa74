"""A field is added to a record by one edit of one file; all that is kept or published has it."""

from __future__ import annotations

import json
import os
import shutil
import sqlite3
import subprocess
import sys
from pathlib import Path

import jsonschema
import pytest

from tests.materials import samples

ROOT = Path(__file__).parents[2]
PLACE = '    n: Annotated[int, COUNT, "Specimens behind the value."]\n'
LINE = '    batch: Annotated[str | None, "Batch of the material."] = None\n'

SCRIPT = """
import sys
from pathlib import Path
from deamat import open_database
from deamat.materials.card import read_card
from deamat.materials.database import write_database
from deamat.materials.frame import to_frame
from deamat.materials.json_schema import schema_text
from tests.materials.samples import FILES, PROVENANCE, aged, card, modulus

folder = Path(sys.argv[1])
made = card(records=(modulus(batch="B7"), aged()))
(folder / "gel-a.json").write_bytes(made.to_json())
(folder / "schema.json").write_text(schema_text())
write_database(folder / "materials.sqlite", [made], FILES, PROVENANCE)
with open_database(folder) as database:
    for found in (database["gel-a"], read_card(folder / "gel-a.json")):
        assert found == made.canonical()
        print([record.batch for record in found.records])
print(card().release)
print(to_frame([made])["batch"].dropna().tolist())
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[str]]:
    """What a copy of the package with the field makes, and what it says."""
    copy, out = tmp_path_factory.mktemp("copy"), tmp_path_factory.mktemp("out")
    shutil.copytree(ROOT / "pipeline", copy / "deamat")
    records = copy / "deamat" / "core" / "records.py"
    text = records.read_text(encoding="utf-8")
    assert text.count(PLACE) == 1
    records.write_text(text.replace(PLACE, PLACE + LINE), encoding="utf-8")
    paths = os.pathsep.join([str(copy), str(ROOT)])
    run = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(out)],
        capture_output=True,
        text=True,
        check=False,
        cwd=out,
        env={**os.environ, "PYTHONPATH": paths},
    )
    assert run.returncode == 0, run.stderr
    return out, run.stdout.splitlines()


def test_the_field_stands_on_the_card_where_it_is_known(made: tuple[Path, list[str]]) -> None:
    one, other = json.loads((made[0] / "gel-a.json").read_bytes())["properties"]
    assert "batch" not in one
    assert list(other)[list(other).index("n") + 1] == "batch"
    assert other["batch"] == "B7"


def test_the_schema_describes_it_and_does_not_demand_it(made: tuple[Path, list[str]]) -> None:
    schema = json.loads((made[0] / "schema.json").read_text())
    record = schema["$defs"]["property"]
    assert record["properties"]["batch"] == {
        "type": ["string", "null"], "description": "Batch of the material.",
    }  # fmt: skip
    assert "batch" not in record["required"]
    card = json.loads((made[0] / "gel-a.json").read_bytes())
    jsonschema.Draft202012Validator(schema).validate(card)
    with pytest.raises(jsonschema.ValidationError, match="'batch' was unexpected"):
        jsonschema.Draft202012Validator(
            json.loads((ROOT / "docs" / "card.schema.json").read_text())
        ).validate(card)


def test_the_database_has_a_column_of_it(made: tuple[Path, list[str]]) -> None:
    connection = sqlite3.connect(made[0] / "materials.sqlite")
    found = connection.execute("SELECT batch, typeof(batch) FROM properties ORDER BY id").fetchall()
    connection.close()
    assert found == [(None, "null"), ("B7", "text")]


def test_it_comes_back_from_the_database_and_from_the_file(made: tuple[Path, list[str]]) -> None:
    assert made[1][:2] == ["[None, 'B7']", "[None, 'B7']"]


def test_a_frame_has_a_column_of_it(made: tuple[Path, list[str]]) -> None:
    assert made[1][3] == "['B7']"


def test_a_card_without_it_is_the_same_as_before(made: tuple[Path, list[str]]) -> None:
    assert made[1][2] == samples.card().release
