"""`deamat check`: what a file is before it is registered, and all that is wrong with one."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from deamat.commands.check import check
from deamat.core.sheets import write_workbook
from deamat.formats.blocks import block_in
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.run.check import Asked, Checked, check_files
from deamat.run.check.curves import curve_of
from deamat.run.check.found import Axis, Curve
from deamat.run.check.nearest import nearest_form
from deamat.run.check.preview import preview
from deamat.run.check.text import text
from tests.formats.workbooks import Rows, xlsx

CYLINDER = {"diameter_mm": "28.6", "height_mm": "12.5"}
STIFFNESS_N_per_m = 5000.0
CURVE = "Zeit;Weg;Kraft\ns;mm;N\n" + "".join(
    f"{i * 0.1:.2f};{i * 0.05:.3f};{i * 0.25:.3f}\n".replace(".", ",") for i in range(40)
)
SWEEP = "f_Hz,Cp_pF,D\n" + "".join(f"{10**p:g},100.0,0.004\n" for p in range(1, 6))
RAMP = "time_s,voltage_kV\n" + "".join(f"{i},{0.5 * i}\n" for i in range(12))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path


def put(folder: Path, name: str, content: str | bytes) -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def look(path: Path, technique: str = "", **columns: str) -> Checked:
    (checked,) = check_files([path], Asked(technique, "", columns, path.parent / "no-config"))
    return checked


def run(*words: object) -> Result:
    return CliRunner().invoke(check, [str(word) for word in words])


def test_a_curve_without_dimensions_has_a_stiffness(folder: Path) -> None:
    checked = look(put(folder, "a.csv", CURVE))
    assert checked.read
    assert [reading.technique for reading in checked.readings] == ["compression", "tension"]
    first = checked.readings[0]
    stiffness = next(value for value in first.values if value.name == "stiffness")
    assert stiffness.value == pytest.approx(STIFFNESS_N_per_m)
    assert stiffness.unit == "N/m"
    assert first.missing == ("diameter_mm", "height_mm")
    assert not first.measured


def test_dimensions_give_the_value_of_the_technique_alone(folder: Path) -> None:
    checked = look(put(folder, "a.csv", CURVE), **CYLINDER)
    (reading,) = checked.readings
    modulus = next(value for value in reading.values if value.name == "compressive_modulus")
    area = 3.141592653589793 / 4 * 0.0286**2
    assert modulus.value == pytest.approx(STIFFNESS_N_per_m * 0.0125 / area, rel=1e-6)
    assert reading.row == "the options"


def test_the_columns_the_table_and_its_first_rows_are_said(folder: Path) -> None:
    checked = look(put(folder, "a.csv", CURVE))
    assert [(c.name, c.label, c.unit) for c in checked.columns] == [
        ("displacement_m", "Weg", "mm"), ("force_N", "Kraft", "N"), ("time_s", "Zeit", "s"),
    ]  # fmt: skip
    assert (checked.first_line, checked.last_line) == (3, 42)
    assert checked.rows[0] == "0,00;0,000;0,000"
    assert checked.columns[0].greatest == pytest.approx(1.95e-3)


def test_a_register_beside_the_file_gives_its_row(folder: Path) -> None:
    path = put(folder, "c/compression/a.csv", CURVE)
    put(folder, "c/campaign.toml", 'title="t"\nlaboratory="l"\nlicence="x"\nsynthetic=true\n')
    put(
        folder, "c/compression/specimens.csv",
        "specimen,material,file,diameter_mm,height_mm\ns1,m,a.csv,28.6,12.5\n",
    )  # fmt: skip
    (reading,) = look(path).readings
    assert reading.row == "c/compression/specimens.csv, line 2"
    assert reading.values[0].name == "compressive_modulus"


def test_a_workbook_beside_the_file_is_its_register_as_well(folder: Path) -> None:
    path = put(folder, "c/compression/a.csv", CURVE)
    rows: list[list[str | float]] = [
        ["Specimen", "material", "file", "Diameter [mm]", "height_mm"],
        ["s1", "m", "a.csv", 28.6, 12.5],
    ]
    (path.parent / "specimens.xlsx").write_bytes(write_workbook({"Specimens": rows}))
    (reading,) = look(path).readings
    assert reading.row == "c/compression/specimens.xlsx, line 2"
    assert reading.values[0].name == "compressive_modulus"


def test_sweeps_and_ramps_say_what_they_can(folder: Path) -> None:
    (sweep,) = look(put(folder, "s.csv", SWEEP)).readings
    assert sweep.technique == "permittivity"
    assert [(v.name, v.said) for v in sweep.values] == [
        ("capacitance", "100 pF at 10 Hz"), ("loss tangent", "0.004 at 10 Hz"),
    ]  # fmt: skip
    (ramp,) = look(put(folder, "r.csv", RAMP)).readings
    assert ramp.values[0].said == "5.5 kV"
    assert ramp.curve is not None
    assert ramp.curve.y[-1] == pytest.approx(5.5)


@pytest.mark.parametrize(
    ("name", "content", "fault", "nearest"),
    [
        ("a.xls", b"\xd0\xcf\x11\xe0abc", "it is an Excel workbook of the old form (.xls)", ""),
        ("a.csv", b"", "the file is empty", ""),
        (
            "b.csv", b"Zeit;Kraft;Weg\n0,1;0,2;0,3\n0,2;0,3;0,4\n0,3;0,4;0,5\n",
            "columns Zeit, Kraft, Weg found; no unit stands beside 'Weg' (displacement); no unit "
            "stands beside 'Kraft' (force)",
            "rows of 3 numbers from line 2 to 4, separated by semicolons; line 1 above them reads "
            "Zeit, Kraft, Weg",
        ),
        (
            "c.csv", b"1,2\n3,4\n5,6\n", "no table with labels and units",
            "rows of 2 numbers from line 1 to 3, separated by commas; no row of labels above them",
        ),
        ("d.csv", b"hello\n", "no table with labels and units", "it holds no rows of numbers"),
        (
            "e.log", b"# FUNC? => Cp-D\n1.0e+01;+1.0e-10;+1.0e-03;OK\n",
            "", "lcr6000 (GW Instek LCR-6000, PC-logged replies), but its fields are separated by "
            "semicolons instead of commas",
        ),
        ("specimens.csv", b"specimen\n", "it describes a campaign", ""),
    ],
)  # fmt: skip
def test_an_unread_file_is_described(
    folder: Path, name: str, content: bytes, fault: str, nearest: str
) -> None:
    checked = look(put(folder, name, content))
    assert not checked.read
    assert fault in checked.faults[0]
    assert nearest in checked.nearest


def test_a_folder_is_gone_through_and_its_registers_are_left_out(folder: Path) -> None:
    put(folder, "x/a.csv", CURVE)
    put(folder, "x/deep/b.csv", SWEEP)
    put(folder, "x/specimens.csv", "specimen\n")
    put(folder, "x/.hidden/c.csv", SWEEP)
    found = list(check_files([folder / "x"], Asked("", "", {}, folder / "none")))
    assert [Path(one.path).name for one in found] == ["a.csv", "b.csv"]


def test_a_file_of_another_technique_does_not_end_in_an_internal_error(folder: Path) -> None:
    """Its heading may stand far below the lines in which forms are looked for."""
    deep = "key\tvalue\n" * 90 + "Time\tZreal\tZimag\ns\tohm\tohm\n" + "1\t2\t-3\n2\t2\t-3\n"
    checked = look(put(folder, "a.txt", deep), technique="compression")
    assert "no column is the displacement" in checked.faults[0]


def test_the_command_ends_with_one_where_a_file_is_not_read(folder: Path) -> None:
    good, bad = put(folder, "a.csv", CURVE), put(folder, "b.csv", "hello\n")
    config = ("--config", folder / "none")
    done = run(good, bad, folder / "nowhere.csv", *config, "--diameter-mm", 28.6, "--set",
               "height_mm=12.5")  # fmt: skip
    assert done.exit_code == 1
    assert "compression, with the options" in done.output
    assert "NOT READ   there is no such file" in done.output
    assert run(good, *config).exit_code == 0
    (document,) = json.loads(run(good, "--json", *config).output)
    assert document["readings"][0]["values"][0]["name"] == "stiffness"
    assert run(good, *config, "--set", "height_mm").exit_code == 2


def test_a_slip_in_an_option_is_said_in_the_words_of_a_register(folder: Path) -> None:
    (reading, _) = look(put(folder, "a.csv", CURVE), diameter_mm="28,6", height_mm="1").readings
    assert reading.refused == (
        "the options: not a number (found '28,6'); write it with a decimal point",
    )


def test_pictures_are_drawn(folder: Path) -> None:
    done = run(put(folder, "a.csv", CURVE), "--png", folder / "p", "--config", folder / "none")
    assert done.exit_code == 0
    assert [p.suffix for p in sorted((folder / "p").iterdir())] == [".png", ".svg"]


def test_a_preview_has_its_corners_where_the_curve_has_them() -> None:
    axes = Axis("x", "s"), Axis("y", "N", log=True)
    lines = preview(Curve(*axes, (0.0, 1.0), (1.0, 1000.0)), width=10, height=3)
    assert lines == [
        "      y [N], log",
        "1000 |         *",
        "     |",
        "   1 |*",
        "     +----------",
        "      0 x [s]  1",
    ]
    assert preview(Curve(*axes, (1.0,), (1.0,))) == []
    flat = preview(Curve(Axis("x", "s"), Axis("y", "N"), (0.0, 1.0), (2.0, 2.0)), 10, 3)
    assert flat[2].count("*") == 2


def test_the_longest_run_of_numbers_is_found_with_its_labels() -> None:
    lines = ["title", "A B  C", "1\t2\t3", "2\t2\t3", "3\t2\t3", "end"]
    block = block_in(lines)
    assert block is not None
    assert (block.separator, block.first, block.last, block.columns) == ("\t", 2, 4, 3)
    assert block.labels == ("A", "B", "C")
    assert block_in(["a", "1 2", "b"]) is None


def test_two_techniques_that_make_the_same_of_a_file_are_named_together(folder: Path) -> None:
    said = text(look(put(folder, "a.csv", CURVE)))
    assert "  compression or tension\n" in said
    assert "fill in  width_mm, thickness_um, gauge_length_mm for tension" in said


def test_channels_of_a_recorder_may_be_named_by_options(folder: Path) -> None:
    path = put(folder, "r.csv", "time_s;CH1 (V);CH2 (V)\n0;0;1\n1;1;2\n2;2;3\n3;3;4\n")
    assert "which column is the voltage?" in look(path, "breakdown").faults[0]
    checked = look(path, "breakdown", voltage_channel="CH2", probe_ratio="1000")
    assert checked.columns[1].greatest == 4000.0


def test_each_sheet_of_a_workbook_that_holds_a_table_is_looked_at(folder: Path) -> None:
    rows: Rows = [["Weg", "Kraft"], ["mm", "N"], *([0.1 * i, 0.5 * i] for i in range(12))]
    path = put(folder, "b.xlsx", xlsx({"Notes": [["a", "b"]], "S1": rows, "S2": rows}))
    found = list(check_files([path], Asked("", "", {}, folder / "none")))
    assert [Path(one.path).name for one in found] == ["b.xlsx#S1", "b.xlsx#S2"]
    assert all(one.read for one in found)
    (one,) = check_files([Path(f"{path}#S2")], Asked("", "", {}, folder / "none"))
    assert one.form == "workbook, S2!A3:B14"


def test_several_runs_in_one_file_are_said(folder: Path) -> None:
    """Loaded, unloaded and loaded again; a sweep up and down."""
    travel = [*range(20), *range(18, 0, -1), *range(1, 20)]
    text = "Weg;Kraft\nmm;N\n" + "".join(f"{0.1 * d:.1f};{0.5 * d:.1f}\n" for d in travel)
    assert look(put(folder, "a.csv", text)).readings[0].runs == (
        "loaded more than once; only the first loading is used"
    )
    sweep = SWEEP + "".join(SWEEP.splitlines(keepends=True)[:0:-1])
    assert look(put(folder, "s.csv", sweep)).readings[0].runs == "2 sweeps"
    assert look(put(folder, "r.csv", RAMP)).readings[0].runs == ""


CAMPAIGN = 'title="t"\nlaboratory="l"\nlicence="x"\nsynthetic=true\n'
LCR = "# FUNC? => Cp-D\n" + "".join(f"1.0e+0{p},+1.0e-10,+1.0e-03,OK\n" for p in range(1, 6))


@pytest.mark.parametrize(
    ("row", "fault"),
    [
        ("s1,m,a.csv,28.6,12.5,plain", ""),
        ("s1,m,a.csv,28.6,12.5,hysitron", "as the hysitron form has it"),
        ("s1,m,a.csv,0,12.5,plain", "line 2, column 4: must be positive (found '0')"),
    ],
)
def test_the_row_of_a_registered_file_says_how_it_is_read(
    folder: Path, row: str, fault: str
) -> None:
    path = put(folder, "c/compression/a.csv", CURVE)
    put(folder, "c/campaign.toml", CAMPAIGN)
    header = "specimen,material,file,diameter_mm,height_mm,format"
    put(folder, "c/compression/specimens.csv", f"{header}\n{row}\n")
    checked = look(path)
    assert checked.read == (not fault)
    assert fault in "\n".join(checked.faults)


def test_a_known_form_that_cannot_be_read_is_named_as_it_is(folder: Path) -> None:
    """The meter's function, which the first line would state, is not stated."""
    checked = look(put(folder, "a.log", LCR.partition("\n")[2]))
    assert "does not say which function the meter measured" in checked.faults[0]
    assert checked.nearest == "lcr6000 (GW Instek LCR-6000, PC-logged replies)"


@pytest.mark.parametrize(("above", "said"), [(1, "1 line stands"), (2, "2 lines stand")])
def test_lines_above_a_known_form_are_counted(above: int, said: str) -> None:
    nearest = nearest_form(RawFile("r.csv", ("in my words\n" * above + RAMP).encode()))
    assert nearest.endswith(f", but {said} above it")


def test_first_and_last_values_of_a_column_are_said(folder: Path) -> None:
    checked = look(put(folder, "a.csv", CURVE))
    assert (checked.columns[1].first, checked.columns[1].last) == (0.0, 9.75)


def test_a_form_without_a_label_for_each_column_has_them_without(folder: Path) -> None:
    said = text(look(put(folder, "a.log", LCR)))
    assert "  columns    frequency_Hz " in said
    assert " as " not in said


def test_a_curve_leaves_out_what_has_no_place_on_its_axes(folder: Path) -> None:
    rows = "0,3\n1,2\n10,0\n100,1\n"
    path = put(folder, "f.csv", f"Shear rate (1/s),Viscosity (Pa.s)\n{rows}")
    curve = look(path, "viscosity").readings[0].curve
    assert curve is not None
    assert (curve.x, curve.y) == ((1.0, 100.0), (2.0, 1.0))


def test_a_reading_that_is_none_is_not_drawn(folder: Path) -> None:
    file = RawFile("r.csv", RAMP.encode(), technique="breakdown")
    recording = detect(file).read(file)
    volts = recording.columns["voltage_V"].copy()
    volts[3] = np.nan
    gap = replace(recording, columns={**recording.columns, "voltage_V": volts})
    curve = curve_of("breakdown", gap)
    assert curve is not None
    assert curve.x == (0.0, 1.0, 2.0, *map(float, range(4, 12)))


def test_channels_of_a_form_that_names_its_columns_are_refused(folder: Path) -> None:
    checked = look(put(folder, "r.csv", RAMP), "breakdown", probe_ratio="1000")
    assert not checked.read
    assert "a file of the form hv_ramp says itself what its columns are" in checked.faults[-1]
