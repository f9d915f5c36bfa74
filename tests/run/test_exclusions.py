"""What is left out on purpose stands, with its reason, wherever its material does."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from deamat import open_database
from deamat.core.errors import ConfigError
from deamat.materials.present import card_text
from deamat.materials.trace import trace
from deamat.run.folders import Folders
from deamat.run.register import register
from tests.run.conftest import MATERIALS, curves, run, twin_rows, write_campaign

pytestmark = pytest.mark.usefixtures("quick_figures")

KEY = "compressive_modulus"


def exclude(folders: Folders, reason: str = "the plate slipped", **target: str) -> dict[str, Any]:
    (named,) = target.items()
    (folders.config / "exclusions.toml").write_text(
        f"[[exclude]]\n{named[0]} = {json.dumps(named[1])}\nreason = {json.dumps(reason)}\n"
    )
    return run(folders)


def first(folders: Folders) -> tuple[str, Path]:
    """Specimen and file of the first row of the campaign."""
    row = next(r for r in twin_rows("compression/specimens.csv") if r["material"] == MATERIALS[0])
    return row["specimen"], folders.raw / "demo" / "compression" / row["file"]


@pytest.mark.parametrize("by", ["path", "specimen"])
def test_the_card_the_database_and_the_trace_say_what_was_left_out(
    folders: Folders, by: str
) -> None:
    specimen, file = first(folders)
    path = file.relative_to(folders.raw).as_posix()
    target = path if by == "path" else f"demo/compression/{specimen}"
    document = exclude(folders, **{by: target})
    assert document["exit_code"] == 0
    assert document["excluded"] == [{"path": path, "reason": "the plate slipped"}]
    with open_database(folders.processed) as database:
        card = database[MATERIALS[0]]
        (left_out,) = card.excluded
        assert (left_out.place, left_out.path) == (f"demo/compression/{specimen}", path)
        assert left_out.reason == "the plate slipped"
        assert card.record(KEY, age="after cure").n == 2
        assert database[MATERIALS[1]].excluded == ()
        told = trace(database, MATERIALS[0], KEY, age="after cure")
    assert told.to_document()["excluded"][0]["specimen"] == specimen
    assert f"\nExcluded\n  demo, {specimen}: the plate slipped\n" in told.text()
    assert f"demo/compression/{specimen}: the plate slipped" in card_text(card)
    assert card == type(card).from_document(card.to_document())


def test_a_row_without_a_file_can_be_left_out(folders: Folders) -> None:
    rows = [r for r in twin_rows("handling/observations.csv") if r["material"] == MATERIALS[0]]
    write_campaign(rows, folders.raw / "beds", "handling/observations.csv")
    register(folders.raw, "beds", accept_all=True)
    names = ("material", "batch", "bed_temperature_C", "time_h", "line")
    row = f"beds/handling/{' '.join(rows[0][name] for name in names)}"
    document = exclude(folders, "the heater was off", specimen=row)
    assert document["exit_code"] == 0
    assert document["excluded"] == [{"specimen": row, "reason": "the heater was off"}]
    with open_database(folders.processed) as database:
        (left_out,) = database[MATERIALS[0]].excluded
        text = trace(database, MATERIALS[0], "handling_time", temperature_K=323.15).text()
    assert (left_out.place, left_out.path) == (row, None)
    assert f"place  beds/handling/observations.csv, line {left_out.register_line}" in text


def test_another_row_keeps_the_file_that_both_name(folders: Folders) -> None:
    register_file = folders.raw / "demo" / "compression" / "specimens.csv"
    lines = register_file.read_text().splitlines(keepends=True)
    lines.insert(2, "twin-row," + lines[1].split(",", 1)[1])
    register_file.write_text("".join(lines))
    register(folders.raw, "demo", accept_all=True)
    document = exclude(folders, specimen=f"demo/compression/{first(folders)[0]}")
    assert (document["exit_code"], document["rejected"]) == (0, [])
    with open_database(folders.processed) as database:
        record = database[MATERIALS[0]].record(KEY, age="after cure")
    assert {origin.specimen for origin in record.origins} >= {"twin-row"}
    assert record.n == 3


def test_a_file_that_is_not_there_can_be_left_out(folders: Folders) -> None:
    specimen, file = first(folders)
    file.unlink()
    register(folders.raw, "demo", accept_all=True)
    assert run(folders)["exit_code"] == 1
    document = exclude(folders, "lost with the disk", specimen=f"demo/compression/{specimen}")
    assert (document["exit_code"], document["rejected"]) == (0, [])


@pytest.mark.parametrize(
    "register_file", ["compression/specimens.csv", "handling/observations.csv"]
)
def test_the_faults_of_a_row_that_is_left_out_do_not_matter(
    folders: Folders, register_file: str
) -> None:
    rows = [r for r in twin_rows(register_file) if r["material"] == MATERIALS[0]][:6]
    bad = dict(rows[0], **({"height_mm": "tall"} if "file" in rows[0] else {"time_h": "late"}))
    write_campaign([*rows[1:], bad], folders.raw / "other", register_file)
    register(folders.raw, "other", accept_all=True)
    assert run(folders)["exit_code"] == 1
    names = ("material", "batch", "bed_temperature_C", "time_h", "line")
    row = bad["specimen"] if "file" in bad else " ".join(bad[name] for name in names)
    technique = register_file.partition("/")[0]
    document = exclude(folders, specimen=f"other/{technique}/{row}")
    assert (document["exit_code"], document["rejected"]) == (0, [])
    with open_database(folders.processed) as database:
        (left_out,) = database[MATERIALS[0]].excluded
    assert (left_out.specimen, left_out.register_line) == (row, len(rows) + 1)


@pytest.mark.parametrize(
    ("target", "nearest"),
    [
        ({"path": "demo/compression/specimen.csv"}, "'demo/compression/specimens.csv'"),
        ({"specimen": "demo/compresion/x"}, "'demo/compression/"),
        ({"specimen": "demo/tension/none-such-at-all"}, ""),
    ],
)
def test_an_exclusion_of_nothing_is_an_error_with_the_nearest_name(
    folders: Folders, target: dict[str, str], nearest: str
) -> None:
    said = re.escape(next(iter(target.values())))
    with pytest.raises(ConfigError, match=f"is called '{said}'.*{re.escape(nearest)}"):
        exclude(folders, **target)


def test_rows_that_cannot_be_read_are_not_missed(folders: Folders) -> None:
    register_file = folders.raw / "demo" / "compression" / "specimens.csv"
    register_file.write_bytes(register_file.read_bytes() + b"\xff")
    assert exclude(folders, specimen="demo/compression/any")["exit_code"] == 1


def test_every_file_can_be_left_out_by_its_path(folders: Folders) -> None:
    spare = curves(folders)[0].with_name("spare.txt")
    spare.write_bytes(curves(folders)[0].read_bytes() + b"\r\n")
    register(folders.raw, "demo", accept_all=True)
    document = exclude(folders, path=spare.relative_to(folders.raw).as_posix())
    assert document["exit_code"] == 0
    with open_database(folders.processed) as database:
        assert all(card.excluded == () for card in database.values())
