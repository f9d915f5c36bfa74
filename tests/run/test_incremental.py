"""What changed is redone, and nothing else; `explain` says why."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from deamat.run import explain
from deamat.run.folders import Folders
from deamat.run.register import register
from tests.run.conftest import all_of_one_material, curves, run

pytestmark = pytest.mark.usefixtures("quick_figures")

_SOFT = "sylgard-182-40to1"
_OUTPUTS = {"database", "curves", "audit"}


def _redone(folders: Folders) -> set[str]:
    """Stage and subject of everything that a run redid; `explain` must have foretold it."""
    foretold = {line.partition(": ")[0] for line in explain(folders)["now"]}
    done = {line.partition(": ")[0] for line in run(folders)["redone"]}
    assert foretold == done
    assert explain(folders)["now"] == []
    return done


def _stages(done: set[str]) -> dict[str, int]:
    return {
        stage: sum(d.startswith(stage + " ") for d in done)
        for stage in ("measurement", "summary", "card", "figure")
    }


def _touch_a_number(path: Path) -> None:
    """Change the last digit of one load in the middle of a file."""
    lines = path.read_bytes().split(b"\r\n")
    cells = lines[200].split(b"\t")
    cells[1] = cells[1][:-1] + (b"1" if cells[1].endswith(b"0") else b"0")
    lines[200] = b"\t".join(cells)
    path.write_bytes(b"\r\n".join(lines))


def test_nothing_to_do(folders: Folders) -> None:
    first = run(folders)
    assert not first["nothing_to_do"]
    again = run(folders)
    assert again["nothing_to_do"]
    assert {**again, "nothing_to_do": False} == first


def test_a_touched_file_is_no_change(folders: Folders) -> None:
    run(folders)
    os.utime(curves(folders)[0], ns=(1, 1))
    assert _redone(folders) == set()


@pytest.mark.parametrize(("age", "row", "again"), [("after cure", 1, 5), ("2 months", -1, 0)])
def test_what_another_technique_needs_is_foretold_with_it(
    age: str, row: int, again: int, folders: Folders
) -> None:
    """Permittivity needs the modulus of its age, viscosity at the handling time a law."""
    all_of_one_material(folders.raw / "other", "sylgard-184-10to1")
    run(folders)
    assert explain(folders)["now"] == []
    for technique in ("compression", "viscosity"):
        path = folders.raw / "other" / technique / "specimens.csv"
        lines = path.read_text().splitlines(keepends=True)
        assert technique == "viscosity" or age in lines[row]
        del lines[row]
        path.write_text("".join(lines))
    register(folders.raw, "other", accept_all=True)
    why = dict(line.split(": ", 1) for line in explain(folders)["now"])
    assert why["summary other/handling/sylgard-184-10to1[temperature_K=295.15]"] == "laws is redone"
    done = _redone(folders)
    measured = {one for one in done if one.startswith("measurement other/permittivity")}
    assert len(measured) == again
    assert {why[one] for one in measured} == ({"needs is redone"} if again else set())


def test_a_changed_file(folders: Folders) -> None:
    run(folders)
    path = curves(folders)[-1]
    _touch_a_number(path)
    register(folders.raw, "demo", accept_all=True)
    done = _redone(folders)
    assert _stages(done) == {"measurement": 1, "summary": 1, "card": 1, "figure": 2}
    assert {d.partition(" ")[0] for d in done} >= _OUTPUTS
    assert f"card {_SOFT}" in done
    assert run(folders)["exit_code"] == 0


def test_a_removed_row_and_file(folders: Folders) -> None:
    run(folders)
    table = folders.raw / "demo" / "compression" / "specimens.csv"
    table.write_text("".join(table.read_text().splitlines(keepends=True)[:-1]))
    curves(folders)[-1].unlink()
    register(folders.raw, "demo", accept_all=True)
    done = _redone(folders)
    assert _stages(done) == {"measurement": 1, "summary": 1, "card": 1, "figure": 2}


def test_a_changed_register_row(folders: Folders) -> None:
    run(folders)
    table = folders.raw / "demo" / "compression" / "specimens.csv"
    lines = table.read_text().splitlines(keepends=True)
    lines[1] = lines[1].replace(",12,", ",12.5,", 1)
    table.write_text("".join(lines))
    register(folders.raw, "demo", accept_all=True)
    assert _stages(_redone(folders))["measurement"] == 1


def test_a_changed_setting_redoes_its_technique_only(folders: Folders) -> None:
    run(folders)
    (folders.config / "methods.toml").write_text("[tension]\nmin_samples = 12\n")
    assert {d.partition(" ")[0] for d in _redone(folders)} == {"database"}  # its provenance
    (folders.config / "methods.toml").write_text("[compression]\nmin_samples = 12\n")
    assert _stages(_redone(folders)) == {"measurement": 6, "summary": 2, "card": 2, "figure": 3}


def test_a_changed_name_redoes_the_card_and_its_figures(folders: Folders) -> None:
    run(folders)
    text = (folders.config / "materials.toml").read_text()
    (folders.config / "materials.toml").write_text(text.replace("182 (40:1)", "182 (forty)"))
    done = _redone(folders)
    assert _stages(done) == {"measurement": 0, "summary": 0, "card": 1, "figure": 2}


@pytest.mark.parametrize(
    ("file", "line", "again"),
    [
        ("campaign.toml", 'timezone = "America/New_York"', 6),
        ("campaign.toml", "ends_open = true", 6),
        ("README.md", "Load [kN]: compressive force", 6),
        ("campaign.toml", 'operator = "a note of the laboratory"', 0),
    ],
)
def test_what_a_campaign_says_of_all_its_files(
    file: str, line: str, again: int, folders: Folders
) -> None:
    """Stamps, the last line's end and contradicted units depend on it, in no file of theirs."""
    run(folders)
    with (folders.raw / "demo" / file).open("a") as out:
        out.write(f"\n{line}\n")
    register(folders.raw, "demo", accept_all=True)
    why = [said for said in explain(folders)["now"] if said.startswith("measurement")]
    assert [said.partition(": ")[2] for said in why] == again * ["campaign changed"]
    assert _stages(_redone(folders))["measurement"] == again


def test_a_changed_machine_redoes_what_it_measured(folders: Folders) -> None:
    run(folders)
    path = folders.config / "instruments.toml"
    text = path.read_text()
    assert "force_resolution_N = 0.005" in text
    for old, new, again in (("= 0.0001\n", "= 0.0002\n", 0), ("= 0.005\n", "= 0.006\n", 6)):
        text = text.replace(f"force_resolution_N {old}", f"force_resolution_N {new}", 1)
        path.write_text(text)
        assert _stages(_redone(folders))["measurement"] == again


def test_a_deleted_output_is_made_again(folders: Folders) -> None:
    run(folders)
    card = folders.processed / "cards" / f"{_SOFT}.json"
    before = card.read_bytes()
    card.unlink()
    assert set(run(folders)["redone"]) == {f"card {_SOFT}: its output was changed"}
    assert card.read_bytes() == before


def test_an_edited_output_is_made_again(folders: Folders) -> None:
    run(folders)
    card = folders.processed / "cards" / f"{_SOFT}.json"
    before = card.read_bytes()
    card.chmod(0o644)
    card.write_bytes(before.replace(b"Pa", b"kg"))
    run(folders)
    assert card.read_bytes() == before
