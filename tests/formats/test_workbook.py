"""Workbooks: the sheet with the table, by its rows; what is stored counts, not what is shown."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from deamat.cli import cli
from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.core.register import split_sheet
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from tests.formats.workbooks import Rows, ods, xlsx

TABLE: Rows = (
    ("Tensile test, synthetic", None, None),
    ("Operator", "none", None),
    (None, None, None),
    ("Zeit", "Weg", "Kraft"),
    ("s", "mm", "N"),
    (0.0, 0.0, 0.0),
    (0.5, 0.25, 1.5),
    (1.0, 0.5, 1234.5),
)
RESULTS: Rows = (("Specimen", "Maximum load (N)"), (1.0, 1234.5))


def read(data: bytes) -> Recording:
    file = RawFile("x.xlsx", data, technique="tension")
    return detect(file).read(file)


def refused(data: bytes) -> str:
    with pytest.raises(RawFileError) as caught:
        read(data)
    return str(caught.value)


@pytest.mark.parametrize(
    ("data", "sheet"),
    [
        (xlsx({"Results": RESULTS, "Specimen 1": TABLE}), "Specimen 1"),
        (xlsx({"A &amp; B": TABLE}), "A & B"),
        (ods(TABLE), "Daten"),
    ],
)
def test_the_sheet_is_found_by_its_content(data: bytes, sheet: str) -> None:
    recording = read(data)
    assert recording.columns["force_N"].tolist() == [0.0, 1.5, 1234.5]
    assert recording.columns["displacement_m"].tolist() == [0.0, 0.25e-3, 0.5e-3]
    source = recording.source
    assert (source.reader, source.first_line, source.last_line) == (
        f"workbook, sheet {sheet}",
        6,
        8,
    )
    assert recording.metadata["sheet"] == sheet
    assert recording.metadata["Operator"] == "none"


def test_two_sheets_that_would_do_are_refused() -> None:
    said = refused(xlsx({"1": TABLE, "2": TABLE}))
    assert "an Excel workbook with several tables: sheets 1, 2" in said
    assert said.endswith("name the sheet in the register: `x.xlsx#1`")


def test_the_register_names_a_sheet() -> None:
    assert split_sheet("a/x.xlsx#Specimen 2") == ("a/x.xlsx", "Specimen 2")
    assert split_sheet("a#1.csv") == ("a#1.csv", "")
    other = [*TABLE[:7], (1.0, 0.5, 7.0)]
    data = xlsx({"1": TABLE, "2": other})
    file = RawFile("x.xlsx", data, technique="tension", sheet="2")
    assert detect(file).read(file).columns["force_N"].tolist() == [0.0, 1.5, 7.0]
    missing = RawFile("x.xlsx", data, technique="tension", sheet="3")
    with pytest.raises(RawFileError, match="an Excel workbook without a sheet '3'; it has 1, 2"):
        detect(missing).read(missing)


def test_specimens_side_by_side_are_refused() -> None:
    rows = [[*row, *row] for row in TABLE]
    assert "duplicate column: columns 2 and 5 (Weg, Weg)" in refused(xlsx({"all": rows}))


def test_a_formula_without_its_value_is_refused_by_name() -> None:
    data = xlsx({"S": TABLE}, replaced={"C7": '<c r="C7"><f>B7*6</f></c>'})
    said = refused(data)
    assert "formula in cell C7 has no stored value" in said or "column 3: a blank cell" in said
    data = xlsx({"S": TABLE}, replaced={"C7": '<c r="C7"><f>B7*6</f><v>1.5</v></c>'})
    assert read(data).columns["force_N"].tolist() == [0.0, 1.5, 1234.5]


def test_a_cell_shown_in_percent_is_refused() -> None:
    data = xlsx({"S": TABLE}, replaced={"C7": '<c r="C7" s="1"><v>1.5</v></c>'})
    assert "sheet S: cell C7 is shown in percent and stored as a fraction" in refused(data)


def test_hidden_rows_are_read_and_said() -> None:
    recording = read(xlsx({"S": TABLE}, hidden=7))
    assert len(recording.columns["force_N"]) == 3
    assert [str(flag) for flag in recording.flags] == [
        "hidden-rows: 1 rows of sheet S are hidden; all were read"
    ]


@pytest.mark.parametrize(
    ("rows", "reason"),
    [
        ((*TABLE, ("stopped", None, None)), "line 9"),
        ((*TABLE[:6], (0.5, 0.25, None), *TABLE[7:]), "line 7, column 3: a blank cell"),
        ((*TABLE[:4], *TABLE[5:]), "no unit stands beside 'Weg' (displacement)"),
        (TABLE[:5], "no data rows"),
        (RESULTS, "an Excel workbook: no table with labels and units"),
    ],
)
def test_what_is_not_whole_is_refused(rows: Rows, reason: str) -> None:
    assert reason in refused(xlsx({"S": rows}))


def test_a_cut_or_odd_archive_is_refused() -> None:
    data = xlsx({"S": TABLE})
    assert "an archive that is no whole Excel workbook" in refused(data[:-30])
    assert "an Excel workbook of the old form (.xls)" in refused(b"\xd0\xcf\x11\xe0" + b"\0" * 9)
    for cut in range(60, len(data) - 60, 97):
        spoilt = data[:cut] + b"\xff" * 9 + data[cut + 9 :]
        try:
            assert len(read(spoilt).columns["force_N"]) == 3
        except RawFileError:
            continue


def test_sheets_of_one_workbook_are_specimens(tmp_path: Path) -> None:
    """A row for each sheet: neither is a copy of the other, and no sheet is listed twice."""
    folder = tmp_path / "raw" / "c" / "tension"
    folder.mkdir(parents=True)
    sheets = {name: _pulled(scale) for name, scale in (("A", 1.0), ("B", 1.1))}
    (folder / "b.xlsx").write_bytes(xlsx(sheets))
    declared = 'title = "t"\nlaboratory = "none"\nlicence = "CC0 1.0"\nsynthetic = true\n'
    (folder.parent / "campaign.toml").write_text(declared)
    head = "specimen,material,file,width_mm,thickness_mm,gauge_length_mm\n"
    for third, words in (
        ("", ""),
        ("s3,m1,b.xlsx#A,10,2,40\n", "its file is that of s1 in line 2"),
    ):
        rows = "s1,m1,b.xlsx#A,10,2,40\ns2,m1,b.xlsx#B,10,2,40\n"
        (folder / "specimens.csv").write_text(head + rows + third)
        done = CliRunner().invoke(
            cli, ["all", "--raw", str(tmp_path / "raw"), "--processed", str(tmp_path / "out")]
        )
        assert words in done.output
        card = json.loads((tmp_path / "out" / "cards" / "m1.json").read_text())
        assert {p["n"] for p in card["properties"] if p["key"] == "tensile_modulus"} == {2}


def _pulled(scale: float) -> Rows:
    rows = [(0.01 * i, 0.02 * i, 0.006 * scale * i if i < 150 else 0.01) for i in range(152)]
    return (("Time", "Extension", "Load"), ("s", "mm", "N"), *rows)
