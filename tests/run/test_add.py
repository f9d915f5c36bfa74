"""Files of a folder become rows to fill in; filled-in rows become specimens, and nothing else."""

from __future__ import annotations

import csv
import os
from pathlib import Path

import pytest

from deamat.core.errors import ConfigError, RawFileError
from deamat.core.sheets import read_sheets, write_workbook
from deamat.run.add import Added, add
from deamat.run.add.folder import Wish
from deamat.run.add.proposal import read_proposal
from deamat.run.folders import Folders
from deamat.run.init import Declared, init
from tests.run.conftest import run
from tests.run.test_init import project

CURVE = "".join(f"{t:.1f};{t / 10:.2f};{t * 0.8:.3f}\n" for t in range(60))


def german(header: str = "") -> bytes:
    """A compression curve as a German export writes it."""
    labels = f"Zeit;Standardweg;Standardkraft\ns;mm;N\n{CURVE}".replace(".", ",")
    return (header + labels).encode("cp1252")


@pytest.fixture
def folders(tmp_path: Path) -> Folders:
    """A project with an empty campaign, and an inbox beside it."""
    made = project(tmp_path / "project")
    init(made, Declared("spring", "t", "l", "CC0", synthetic=True), ["compression", "viscosity"])
    (tmp_path / "inbox").mkdir()
    return made


def inbox(folders: Folders) -> Path:
    return folders.raw.parents[1] / "inbox"


def look(folders: Folders, wish: Wish | None = None) -> Added:
    return add(folders, inbox(folders), wish or Wish())


def table(folders: Folders, technique: str) -> list[dict[str, str]]:
    path = folders.raw.parent / "to-fill-in" / "spring" / f"{technique}.csv"
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def fill_in(folders: Folders, technique: str, cells: dict[str, str], **save: str) -> None:
    """Fill in every marked cell, and save as a spreadsheet program of some country does."""
    rows = table(folders, technique)
    path = folders.raw.parent / "to-fill-in" / "spring" / f"{technique}.csv"
    with path.open("w", encoding=save.get("encoding", "utf-8"), newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), delimiter=save.get("separator", ","))
        writer.writeheader()
        writer.writerows({c: cells[c] if v == "?" else v for c, v in row.items()} for row in rows)


def registered(folders: Folders, technique: str) -> list[dict[str, str]]:
    with (folders.raw / "spring" / technique / "specimens.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_a_dimension_is_marked_and_never_guessed(folders: Folders) -> None:
    (inbox(folders) / "gel-a_druck_d28mm_3.csv").write_bytes(german())
    said = look(folders)
    assert "1 row; fill in diameter_mm, height_mm" in said.lines[0]
    (row,) = table(folders, "compression")
    assert row["specimen"] == "gel-a_druck_d28mm_3"
    assert row["diameter_mm"] == row["height_mm"] == "?"
    assert row["file"] == "gel-a_druck_d28mm_3.csv"
    assert registered(folders, "compression") == []


def test_what_a_file_states_stands_in_its_row(folders: Folders) -> None:
    header = "Prüfer;K. Weiß\nPrüfdatum;12.03.2026\nDurchmesser;28,5 mm\nHöhe;12,000 mm\nProbe;G7-innen\n\n"
    (inbox(folders) / "druck 1.csv").write_bytes(german(header))
    look(folders, Wish(material="gel-b"))
    (row,) = table(folders, "compression")
    assert row["diameter_mm"] == "28.5"
    assert row["height_mm"] == "?"  # 12,000 mm may be twelve or twelve thousand
    assert row["operator"] == "K. Weiß"
    assert row["tested_on"] == "2026-03-12"
    assert row["specimen"] == "G7-innen"
    assert row["material"] == "gel-b"
    assert "file: diameter_mm, tested_on, operator" in row["found_in"]


def test_a_filled_in_row_is_taken_over_and_its_file_copied(folders: Folders) -> None:
    source = inbox(folders) / "gel-a druck 1.csv"
    source.write_bytes(german())
    look(folders)
    fill_in(
        folders, "compression", {"diameter_mm": "28,5", "height_mm": "12"}, separator=";",
        encoding="cp1252",
    )  # fmt: skip
    said = look(folders)
    assert said.lines[0] == (
        "copied     gel-a druck 1.csv -> spring/compression/gel-a/gel-a-druck-1.csv"
    )
    (row,) = registered(folders, "compression")
    assert (row["diameter_mm"], row["height_mm"]) == ("28.5", "12")
    assert row["file"] == "gel-a/gel-a-druck-1.csv"
    copied = folders.raw / "spring" / "compression" / row["file"]
    assert copied.read_bytes() == source.read_bytes()
    assert not (folders.raw.parent / "to-fill-in" / "spring" / "compression.csv").exists()
    document = run(folders)
    assert document["exit_code"] == 0
    assert document["manifest"] == []
    assert (folders.processed / "cards" / "gel-a.json").is_file()
    assert look(folders).lines[0] == "there      1 of the files are in spring already"
    assert len(registered(folders, "compression")) == 1


def test_files_are_moved_where_that_is_asked_for(folders: Folders) -> None:
    source = inbox(folders) / "gel-a druck 1.csv"
    source.write_bytes(german())
    look(folders)
    fill_in(folders, "compression", {"diameter_mm": "28", "height_mm": "12"})
    said = look(folders, Wish(move=True))
    assert [line.split()[0] for line in said.lines[:-1]] == ["moved"]
    assert not source.exists()
    assert (folders.raw / "spring" / "compression" / "gel-a" / "gel-a-druck-1.csv").is_file()


def test_a_row_that_does_not_hold_waits_and_the_others_go(folders: Folders) -> None:
    (inbox(folders) / "gel-a druck 1.csv").write_bytes(german())
    (inbox(folders) / "gel-a druck 2.csv").write_bytes(german().replace(b"0,80", b"0,81"))
    look(folders)
    rows = table(folders, "compression")
    path = folders.raw.parent / "to-fill-in" / "spring" / "compression.csv"
    text = path.read_text(encoding="utf-8-sig").replace("?,?", "28,12", 1).replace("?,?", "28,x", 1)
    path.write_text(text)
    said = look(folders)
    assert said.faulty
    assert "NOT TAKEN  gel-a druck 2.csv: spring/compression/specimens.csv" in "\n".join(said.lines)
    assert [r["specimen"] for r in registered(folders, "compression")] == [rows[0]["specimen"]]
    assert [r["file"] for r in table(folders, "compression")] == ["gel-a druck 2.csv"]
    assert [p.name for p in (folders.raw / "spring" / "compression").rglob("*.csv")] == [
        "specimens.csv", "gel-a-druck-1.csv",
    ]  # fmt: skip


def test_new_files_join_the_rows_that_wait(folders: Folders) -> None:
    (inbox(folders) / "gel-a druck 1.csv").write_bytes(german())
    look(folders)
    before = table(folders, "compression")
    (inbox(folders) / "gel-a druck 2.csv").write_bytes(german().replace(b"0,80", b"0,81"))
    look(folders)
    assert table(folders, "compression")[:1] == before
    assert len(table(folders, "compression")) == 2


@pytest.mark.parametrize(("second", "proposed"), [("K. Weiß", "K. Weiß"), ("A. Kern", "")])
def test_what_all_rows_of_a_register_say_is_proposed_for_the_next(
    folders: Folders, second: str, proposed: str
) -> None:
    register = folders.raw / "spring" / "compression" / "specimens.csv"
    register.write_text(
        "specimen,material,file,diameter_mm,height_mm,operator\n"
        f"old-1,gel-z,,28,12,K. Weiß\nold-2,gel-z,,28,12,{second}\n"
    )
    (inbox(folders) / "gel-a druck 1.csv").write_bytes(german())
    look(folders)
    (row,) = table(folders, "compression")
    assert row["operator"] == proposed
    assert ("other rows: operator" in row["found_in"]) == bool(proposed)


def test_compression_or_tension_is_asked_where_nothing_tells(folders: Folders) -> None:
    (inbox(folders) / "gel-a 1.csv").write_bytes(german())
    said = look(folders)
    assert "which-technique.csv: 1 row; fill in technique" in said.lines[0]
    (row,) = table(folders, "which-technique")
    assert row["it_may_be"] == "compression or tension"
    fill_in(folders, "which-technique", {"technique": "tension"})
    look(folders)
    (row,) = table(folders, "tension")
    assert (row["width_mm"], row["thickness_um"], row["gauge_length_mm"]) == ("?", "?", "?")
    assert not (folders.raw.parent / "to-fill-in" / "spring" / "which-technique.csv").exists()


def test_a_workbook_with_a_specimen_a_sheet_gives_a_row_each(folders: Folders) -> None:
    rows = [line.split(";") for line in CURVE.splitlines()]
    sheet: list[list[str | float]] = [["Time (s)", "Displacement (mm)", "Load (N)"]]
    sheet += [[float(cell) for cell in row] for row in rows]
    (inbox(folders) / "gel-a compression.xlsx").write_bytes(
        write_workbook({"S1": sheet, "S2": [*sheet[:-1], [5.9, 0.59, 4.8]], "Notes": [["x"]]})
    )
    look(folders)
    rows_ = table(folders, "compression")
    assert [row["file"] for row in rows_] == [
        "gel-a compression.xlsx#S1", "gel-a compression.xlsx#S2",
    ]  # fmt: skip
    assert [row["material"] for row in rows_] == ["gel-a", "gel-a"]
    fill_in(folders, "compression", {"diameter_mm": "28", "height_mm": "12"})
    look(folders)
    assert [row["file"] for row in registered(folders, "compression")] == [
        "gel-a/gel-a-compression.xlsx#S1", "gel-a/gel-a-compression.xlsx#S2",
    ]  # fmt: skip
    assert look(folders).lines[0] == "there      2 of the files are in spring already"
    assert run(folders)["files"]["rejected"] == 0


def test_tables_are_workbooks_where_that_is_asked_for(folders: Folders) -> None:
    (inbox(folders) / "gel-a druck 1.csv").write_bytes(german())
    look(folders, Wish(workbook=True))
    path = folders.raw.parent / "to-fill-in" / "spring" / "compression.xlsx"
    ((name, rows),) = read_sheets(path.read_bytes(), "x")
    assert name == "compression"
    table_: list[list[str | float]] = [["28" if c == "?" else c for c in row] for row in rows]
    path.write_bytes(write_workbook({name: table_}))
    look(folders)
    assert registered(folders, "compression")[0]["diameter_mm"] == "28"
    assert not path.exists()


def test_names_that_would_run_as_formulas_do_not(folders: Folders) -> None:
    (inbox(folders) / "=cmd druck.csv").write_bytes(german())
    (inbox(folders) / "@sum druck.csv").write_bytes(german("Bediener;=HYPERLINK(1)\n\n"))
    look(folders, Wish(material="gel-a"))
    path = folders.raw.parent / "to-fill-in" / "spring" / "compression.csv"
    with path.open(encoding="utf-8-sig", newline="") as file:
        cells = [cell for row in csv.reader(file) for cell in row]
    assert not [cell for cell in cells if cell.startswith(("=", "+", "-", "@"))]
    fill_in(folders, "compression", {"diameter_mm": "28", "height_mm": "12"})
    look(folders)
    rows = registered(folders, "compression")
    assert sorted(row["specimen"] for row in rows) == ["cmd druck", "sum druck"]
    assert "'=HYPERLINK(1)" in [row["operator"] for row in rows]
    written = (folders.raw / "spring" / "compression" / "specimens.csv").read_text()
    assert ",=" not in written
    assert "\n=" not in written


def test_nothing_is_written_outside_the_project(folders: Folders) -> None:
    root = folders.raw.parents[1]
    (inbox(folders) / "gel-a druck 1.csv").write_bytes(german())
    look(folders)
    path = folders.raw.parent / "to-fill-in" / "spring" / "compression.csv"
    filled = path.read_text(encoding="utf-8-sig").replace("?", "28")
    for material in ("../../../up", "/tmp/up", "..", "gel/a"):
        path.write_text(filled.replace(",gel-a,", f",{material},"))
        before = sorted(p for p in root.rglob("*"))
        said = look(folders)
        assert said.faulty
        assert sorted(p for p in root.rglob("*")) == before
    (inbox(folders) / "secret").write_text("x")
    path.write_text(filled.replace("gel-a druck 1.csv,", "../inbox/secret,"))
    look(folders)
    assert registered(folders, "compression") == []


def test_a_folder_that_leads_out_of_raw_is_not_written_to(folders: Folders) -> None:
    outside = folders.raw.parents[1] / "outside"
    outside.mkdir()
    (inbox(folders) / "gel-a druck 1.csv").write_bytes(german())
    look(folders)
    fill_in(folders, "compression", {"diameter_mm": "28", "height_mm": "12"})
    (folders.raw / "spring" / "compression" / "gel-a").symlink_to(outside)
    said = look(folders)
    assert said.faulty
    assert list(outside.iterdir()) == []


def test_a_row_goes_into_a_register_of_any_dialect_and_unit(folders: Folders) -> None:
    register = folders.raw / "spring" / "compression" / "specimens.csv"
    register.write_bytes(
        "Specimen;material;File;Diameter [cm];height_mm;comment\r\n"
        "old;gel-z;;2,85;12,5;schön".encode("cp1252")
    )
    (inbox(folders) / "gel-a druck 1.csv").write_bytes(german())
    look(folders)
    fill_in(folders, "compression", {"diameter_mm": "28.4", "height_mm": "12"})
    assert not look(folders).faulty
    assert register.read_bytes().decode("cp1252").splitlines() == [
        "Specimen;material;File;Diameter [cm];height_mm;comment",
        "old;gel-z;;2,85;12,5;schön",
        "gel-a druck 1;gel-a;gel-a/gel-a-druck-1.csv;2,84;12;",
    ]


def test_a_file_that_stands_in_its_folder_stays_there(folders: Folders) -> None:
    place = folders.raw / "spring" / "compression"
    (place / "gel-a").mkdir()
    (place / "gel-a" / "Test 1.CSV").write_bytes(german())
    before = sorted(place.rglob("*"))
    add(folders, place, Wish())
    fill_in(folders, "compression", {"diameter_mm": "28", "height_mm": "12"})
    add(folders, place, Wish(move=True))
    (row,) = registered(folders, "compression")
    assert (row["file"], row["material"]) == ("gel-a/Test 1.CSV", "gel-a")
    assert sorted(place.rglob("*")) == before
    assert run(folders)["exit_code"] == 0


def test_the_project_itself_is_no_folder_of_new_files(folders: Folders) -> None:
    for place in (folders.raw, folders.raw.parent, folders.raw.parents[1]):
        with pytest.raises(ConfigError, match="holds the project itself"):
            add(folders, place, Wish())


def test_what_is_no_data_is_named_and_left(folders: Folders) -> None:
    (inbox(folders) / "notes.pdf").write_bytes(b"%PDF-1.4")
    (inbox(folders) / "prices.csv").write_text("item,price\nbolt,3\n")
    os.mkfifo(inbox(folders) / "pipe")
    said = "\n".join(look(folders).lines)
    assert "notes.pdf" not in said
    assert "not read   prices.csv: " in said
    assert "not read   pipe: a named pipe" in said
    (inbox(folders) / "lcr.log").write_text("# FUNC? => Cp-D\n1.0e+01,+1.0e-10,+1.0e-03,OK\n")
    said = "\n".join(look(folders, Wish(technique="compression")).lines)
    assert "not read   lcr.log: it holds nothing that a technique looks at" in said


def test_commas_that_part_thousands_are_no_decimal_commas(tmp_path: Path) -> None:
    path = tmp_path / "compression.csv"
    for cells, read in ((("2,5", "12,25"), ("2.5", "12.25")), (("1,234.5", "12,250"), None)):
        path.write_text(f"file;material;height_mm;diameter_mm\nx,y.csv;m;{';'.join(cells)}\n")
        (row,) = read_proposal(tmp_path, "compression", workbook=False).rows
        assert row["file"] == "x,y.csv"
        assert (row["height_mm"], row["diameter_mm"]) == (read or cells)


def test_what_is_asked_must_be_there(folders: Folders, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="no campaign 'autumn'"):
        look(folders, Wish(campaign="autumn"))
    with pytest.raises(ConfigError, match="did you mean 'tension'"):
        look(folders, Wish(technique="tensile"))
    with pytest.raises(ConfigError, match="is no folder"):
        add(folders, tmp_path / "nowhere", Wish())
    place = folders.raw.parent / "to-fill-in" / "spring"
    place.mkdir(parents=True)
    (place / "compression.csv").write_text("specimen,material\n")
    with pytest.raises(RawFileError, match="no column 'file'"):
        look(folders)
