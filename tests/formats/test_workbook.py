"""Workbooks: the sheet with the table, by its rows; what is stored counts, not what is shown."""

from __future__ import annotations

import json
from collections.abc import Sequence
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


def is_curve(recording: Recording) -> bool:
    wanted = {"time_s": [0.0, 0.5, 1.0], "displacement_m": [0.0, 0.25e-3, 0.5e-3]}
    wanted["force_N"] = [0.0, 1.5, 1234.5]
    return all(recording.columns[name].tolist() == values for name, values in wanted.items())


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
        f"workbook, {sheet}!A6:C8",
        6,
        8,
    )
    assert recording.metadata["sheet"] == sheet
    assert recording.metadata["Operator"] == "none"


def test_two_sheets_that_would_do_are_refused() -> None:
    said = refused(xlsx({"1": TABLE, "2": TABLE}))
    assert "an Excel workbook with several tables: sheets 1, 2" in said
    assert said.endswith("name the sheet in the register: `x.xlsx#1`")


def test_a_summary_or_a_hidden_sheet_does_not_stand_in_the_way() -> None:
    """One with the labels of a curve, for a few specimens, and one with unknown labels."""
    short: Rows = (("Specimen", "Load (N)", "Extension (mm)"), (1.0, 1234.5, 0.5))
    other: Rows = (("No", "Peak (N)", "Reach (mm)"), *((1.0 * n, 2.0 * n, n) for n in range(9)))
    long = [*TABLE[:5], *((0.5 * n, 0.25 * n, 1.5 * n) for n in range(8))]
    for beside in (short, other):
        recording = read(xlsx({"Results": beside, "Data": long}))
        assert recording.source.reader == "workbook, Data!A6:C13"
    recording = read(xlsx({"Old": TABLE, "New": TABLE}, put_aside="Old"))
    assert (recording.metadata["sheet"], recording.flags) == ("New", ())
    recording = read(xlsx({"Old": TABLE, "Notes": RESULTS}, put_aside="Old"))
    assert str(recording.flags[0]) == "hidden-rows: sheet Old is hidden; it was read"


def test_a_label_may_stand_over_several_rows_of_the_header() -> None:
    rows = [("Zeit", "Mechanik", None), (None, "Weg", "Kraft"), *TABLE[4:]]
    merged = '<mergeCells count="2"><mergeCell ref="A1:A2"/><mergeCell ref="B1:C1"/></mergeCells>'
    assert is_curve(read(xlsx({"S": rows}, after=merged)))


def test_the_register_names_a_sheet() -> None:
    assert split_sheet("a/x.xlsx#Specimen 2") == ("a/x.xlsx", "Specimen 2")
    assert split_sheet("a#1.csv") == ("a#1.csv", "")
    assert split_sheet("a.csv#d:f") == ("a.csv", "D:F")
    other = [*TABLE[:7], (1.0, 0.5, 7.0)]
    data = xlsx({"1": TABLE, "2": other})
    file = RawFile("x.xlsx", data, technique="tension", place="2")
    assert detect(file).read(file).columns["force_N"].tolist() == [0.0, 1.5, 7.0]
    missing = RawFile("x.xlsx", data, technique="tension", place="3")
    with pytest.raises(RawFileError, match="an Excel workbook without a sheet '3'; it has 1, 2"):
        detect(missing).read(missing)


def test_specimens_side_by_side_are_named_by_their_columns() -> None:
    rows: list[list[str | float | None]] = [[*row, None, *row] for row in TABLE[3:]]
    rows.append([1.5, 0.75, 1500.0, None, None, None, None])  # the first one took longer
    rows.insert(0, ["Specimen 1", None, None, None, "Specimen 2", None, None])
    data = xlsx({"all": rows})
    said = refused(data)
    assert "columns Zeit, Weg, Kraft, Zeit, Weg, Kraft found; duplicate column: columns 2" in said
    assert said.endswith("in the register: `x.xlsx#all!A:C`, `x.xlsx#all!E:G`")
    for place, last in (("all!A:C", 1500.0), ("all!E:G", 1234.5), ("E:G", 1234.5)):
        file = RawFile("x.xlsx", data, technique="tension", place=place)
        recording = detect(file).read(file)
        assert recording.columns["force_N"][-1] == last
        assert "columns not used" not in recording.metadata
    assert recording.source.reader == "workbook, all!E4:G6"


def test_a_formula_without_its_value_is_refused_by_name() -> None:
    data = xlsx({"S": TABLE}, replaced={"C7": '<c r="C7"><f>B7*6</f></c>'})
    assert "line 7, column 3: sheet S: the formula in cell C7 has no stored value" in refused(data)
    data = xlsx({"S": TABLE}, replaced={"C7": '<c r="C7"><f>B7*6</f><v>1.5</v></c>'})
    assert read(data).columns["force_N"].tolist() == [0.0, 1.5, 1234.5]
    formula = '<table:table-cell table:formula="of:=[.B7]*6"/>'
    assert "formula in cell C7 has no stored value" in refused(
        ods([*TABLE[:6], (0.5, 0.25, formula), TABLE[7]])
    )
    beside = [[*row, None] for row in TABLE]
    data = xlsx({"S": beside}, replaced={"D7": '<c r="D7"><f>B7*6</f></c>'})
    assert is_curve(read(data))  # a column that nobody needs


PERCENT: Rows = (
    ("Strain", "Stress"), ("%", "kPa"), (0.0, 0.0), (0.125, 10.0), (0.25, 20.0),
)  # fmt: skip


def test_a_column_shown_in_percent_holds_fractions() -> None:
    shown = {f"A{n}": f'<c s="1" r="A{n}"><v>{PERCENT[n - 1][0]}</v></c>' for n in (3, 4, 5)}
    assert read(xlsx({"S": PERCENT}, replaced=shown)).columns["nominal_strain"][-1] == 0.25
    assert read(xlsx({"S": PERCENT})).columns["nominal_strain"][-1] == 0.0025
    cell = '<table:table-cell office:value-type="percentage" office:value="{}"/>'
    rows = [*PERCENT[:2], *[(cell.format(strain), stress) for strain, stress in PERCENT[2:]]]
    assert read(ods(rows)).columns["nominal_strain"][-1] == 0.25
    for some in ({"A4": shown["A4"]}, {"A3": shown["A3"], "A4": shown["A4"]}):
        assert "shown in percent and stored as a fraction" in refused(
            xlsx({"S": PERCENT}, replaced=some)
        )
    data = xlsx({"S": TABLE}, replaced={"C7": '<c r="C7" s="1"><v>1.5</v></c>'})
    assert "sheet S: cell C7 is shown in percent and stored as a fraction" in refused(data)


def test_durations_are_in_seconds_and_dates_are_refused() -> None:
    days = {f"A{n}": f'<c r="A{n}" s="2"><v>{(n - 6) * 0.5 / 86400!r}</v></c>' for n in (6, 7, 8)}
    bare = [*TABLE[:4], (None, *TABLE[4][1:]), *TABLE[5:]]
    assert is_curve(read(xlsx({"S": bare}, replaced=days)))
    long = days | {"A8": '<c r="A8" s="2"><v>1.5</v></c>'}  # one and a half days
    assert read(xlsx({"S": bare}, replaced=long)).columns["time_s"][-1] == 129600.0
    under_seconds = read(xlsx({"S": TABLE}, replaced=days))
    assert "Zeit (line 6: a time as a clock shows it, under a unit)" in str(under_seconds.flags[0])
    dates = {f"A{n}": f'<c r="A{n}" s="3"><v>{45000.5 + n!r}</v></c>' for n in (6, 7, 8)}
    log: Rows = (("Time", "Viscosity"), ("s", "Pa s"), *(row[:2] for row in TABLE[5:]))
    stamped = {f"A{n - 3}": cell.replace(f"A{n}", f"A{n - 3}") for (_, cell), n in zip(
        dates.items(), (6, 7, 8), strict=True
    )}  # fmt: skip
    file = RawFile("x.xlsx", xlsx({"S": log}, replaced=stamped), technique="viscosity")
    with pytest.raises(RawFileError, match="line 3, column 1: a date where a number belongs"):
        detect(file).read(file)


def test_an_open_document_keeps_fractions_of_a_second() -> None:
    cell = '<table:table-cell office:value-type="time" office:time-value="PT00H02M{}S"/>'
    rows: list[Sequence[str | float | None]] = [("Zeit", "Weg", "Kraft"), (None, "mm", "N")]
    rows += [(cell.format(f"15.{25 * n:02d}"), 0.25 * n, 1.5 * n) for n in range(3)]
    assert read(ods(rows)).columns["time_s"].tolist() == [135.0, 135.25, 135.5]


def test_numbers_that_are_stored_as_text_are_numbers() -> None:
    rows = [*TABLE[:5], *[tuple(str(cell) for cell in row) for row in TABLE[5:]]]
    assert is_curve(read(xlsx({"S": rows})))


def test_hidden_rows_are_read_and_said() -> None:
    recording = read(xlsx({"S": TABLE}, hidden=7))
    assert len(recording.columns["force_N"]) == 3
    assert [str(flag) for flag in recording.flags] == [
        "hidden-rows: 1 rows of sheet S are hidden; all were read"
    ]
    after = '<autoFilter ref="A4:C8"><filterColumn colId="0"/></autoFilter>'
    filtered = read(xlsx({"S": TABLE}, hidden=7, after=after))
    assert "1 rows of sheet S are filtered out" in str(filtered.flags[0])
    assert read(xlsx({"S": TABLE}, hidden=2)).flags == ()  # a note above the table
    for seen, word in (("collapse", "hidden"), ("filter", "filtered out")):
        assert f"1 rows of sheet Daten are {word}" in str(read(ods(TABLE, {6: seen})).flags[0])


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


def test_a_cell_that_stands_far_off_is_refused_before_memory_ends() -> None:
    far = '<c r="C8"><v>1234.5</v></c><c r="{}8"><v>1</v></c>'
    assert is_curve(read(xlsx({"S": TABLE}, replaced={"C8": far.format("AZ")})))
    last = f'{far.format("XFD")}</row><row r="1048576"><c r="A1048576"><v>1</v></c>'
    said = refused(xlsx({"S": TABLE}, replaced={"C8": last}))
    assert "sheet S reaches to XFD1048576; delete what stands far from the table" in said


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


def test_columns_and_encodings_of_a_text_stand_in_the_register(tmp_path: Path) -> None:
    folder = tmp_path / "raw" / "c" / "tension"
    folder.mkdir(parents=True)
    one, other = _pulled(1.0)[2:], _pulled(1.1)[2:]
    labels = "Pr\u00fcfzeit,Weg,Kraft\n".strip()
    lines = [f"{labels},{labels}", "s,mm,N,s,mm,N"]
    lines += [",".join(map(str, [*a, *b])) for a, b in zip(one, other, strict=True)]
    (folder / "b.csv").write_bytes("\n".join([*lines, ""]).encode("cp1250"))
    declared = 'title = "t"\nlaboratory = "none"\nlicence = "CC0 1.0"\nsynthetic = true\n'
    (folder.parent / "campaign.toml").write_text(declared)
    (folder / "specimens.csv").write_text(
        "specimen,material,file,width_mm,thickness_mm,gauge_length_mm,encoding\n"
        "s1,m1,b.csv#A:C,10,2,40,cp1250\ns2,m1,b.csv#D:F,10,2,40,cp1250\n"
    )
    done = CliRunner().invoke(
        cli, ["all", "--raw", str(tmp_path / "raw"), "--processed", str(tmp_path / "out")]
    )
    assert "3 used, 0 refused, 0 rejected" in done.output
    card = json.loads((tmp_path / "out" / "cards" / "m1.json").read_text())
    assert {p["n"] for p in card["properties"] if p["key"] == "tensile_modulus"} == {2}


def _pulled(scale: float) -> Rows:
    rows = [(0.01 * i, 0.02 * i, 0.006 * scale * i if i < 150 else 0.01) for i in range(152)]
    return (("Time", "Extension", "Load"), ("s", "mm", "N"), *rows)
