"""A value that was published and is gone is named, with what is known of why."""

from __future__ import annotations

from typing import Any

import pytest

from deamat.run import summary
from deamat.run.folders import Folders
from deamat.run.register import register
from tests.run.conftest import MATERIALS, run, twin_rows, write_campaign

pytestmark = pytest.mark.usefixtures("quick_figures")


def rows_of(folders: Folders, *kept: str) -> None:
    """Keep the rows of some materials in the register."""
    path = folders.raw / "demo" / "compression" / "specimens.csv"
    header, *rows = path.read_text().splitlines(keepends=True)
    path.write_text("".join([header, *(r for r in rows if r.split(",")[1] in kept)]))


def told(document: dict[str, Any]) -> list[tuple[str, str]]:
    return [(value["material"], value["key"]) for value in document["vanished"]]


def test_nothing_is_gone_at_first_nor_where_nothing_changed(folders: Folders) -> None:
    assert run(folders)["vanished"] == []
    assert run(folders)["vanished"] == []


def test_a_removed_file_is_named_once(folders: Folders) -> None:
    run(folders)
    gone = list((folders.raw / "demo" / "compression").glob(f"{MATERIALS[0]}/*"))
    for path in gone:
        path.unlink()
    rows_of(folders, MATERIALS[1])
    register(folders.raw, "demo", accept_all=True)
    document = run(folders)
    keys = ["compressive_modulus", "compressive_modulus_toe_compensated"]
    assert sorted(told(document)) == [(MATERIALS[0], key) for key in keys]
    assert document["vanished"][0]["why"].endswith(f"{min(gone).name} was removed")
    (line, _) = [x for x in summary.text(document).splitlines() if x.startswith("GONE")]
    assert f"{MATERIALS[0]} compressive_modulus (after cure, 2 h at 90 C) of demo" in line
    (folders.config / "exclusions.toml").write_text("# nothing\n")
    assert run(folders)["vanished"] == []


def test_a_refused_value_says_why_it_is_gone(folders: Folders) -> None:
    run(folders)
    (folders.config / "methods.toml").write_text("[compression]\nmin_samples = 100000\n")
    document = run(folders)
    assert (MATERIALS[1], "compressive_modulus") in told(document)
    assert all(value["why"].startswith("refused: ") for value in document["vanished"])


def test_an_excluded_value_says_so(folders: Folders) -> None:
    run(folders)
    path = folders.raw / "demo" / "compression" / "specimens.csv"
    rows = [line.split(",") for line in path.read_text().splitlines()]
    (folders.config / "exclusions.toml").write_text(
        "".join(
            f'[[exclude]]\nspecimen = "demo/compression/{row[0]}"\nreason = "slipped"\n'
            for row in rows
            if row[1] == MATERIALS[0]
        )
    )
    (why, other) = [value["why"] for value in run(folders)["vanished"]]
    assert why == other
    assert why.startswith("demo/compression/")
    assert why.endswith(" is excluded: slipped")


def test_a_law_is_named_beside_the_values_that_it_gave(folders: Folders) -> None:
    rows = [r for r in twin_rows("viscosity/specimens.csv") if r["material"] == MATERIALS[0]]
    write_campaign(rows, folders.raw / "pots", "viscosity/specimens.csv")
    register(folders.raw, "pots", accept_all=True)
    run(folders)
    (folders.config / "exclusions.toml").write_text(
        "".join(
            f'[[exclude]]\nspecimen = "pots/viscosity/{row["specimen"]}"\nreason = "old batch"\n'
            for row in rows
        )
    )
    gone = run(folders)["vanished"]
    assert {value["campaign"] for value in gone} == {"pots"}
    assert {"law of viscosity", "viscosity"} <= {value["key"] for value in gone}
    (law,) = [value for value in gone if value["key"] == "law of viscosity"]
    assert law["why"].endswith("is excluded: old batch")


def test_one_value_of_two_conditions_is_told_by_them(folders: Folders) -> None:
    path = folders.raw / "demo" / "compression" / "specimens.csv"
    lines = path.read_text().splitlines(keepends=True)
    aged = [lines[0], *lines[1:3], *(x.replace("after cure", "2 months") for x in lines[3:])]
    path.write_text("".join(aged))
    register(folders.raw, "demo", accept_all=True)
    run(folders)
    path.write_text("".join(lines))
    register(folders.raw, "demo", accept_all=True)
    gone = run(folders)["vanished"]
    assert {value["conditions"].split(",")[0] for value in gone} == {"2 months"}
    assert {value["why"] for value in gone} == {
        "its rows, or their conditions, were changed in the register"
    }
