"""`config/exports.toml`: what a declaration may say, how files are read by it, what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from deamat.core.errors import ConfigError, RawFileError
from deamat.core.recording import Recording
from deamat.core.toml import line_of
from deamat.formats.declared import format_of
from deamat.formats.detect import KNOWN_FORMS, by_name, detect
from deamat.formats.exports import Export, load_exports, parse_exports
from deamat.formats.rawfile import RawFile
from tests.formats.workbooks import Rows, xlsx

RAMP = """
[ramp]
title = "Scope of room 2.14"
techniques = ["breakdown"]
separator = "tab"
decimal = ","
columns = [
    { label = "t", quantity = "time_s", unit = "ms" },
    { label = "CH1", quantity = "voltage_V", unit = "V", factor = 2000.0 },
]
"""
FILE = "Scope\nfoo\nt\tCH1\tCH2\n0,0\t0,00\tx\n500,0\t0,25\ty\n1.000,0\t0,50\tz\n"
CURVE = """
[curve]
techniques = ["compression", "tension"]
separator = "blanks"
starts_with = "RIG 7"
first_line = 3
sampling_interval_s = 0.5
ends_before = "END"
columns = [
    { number = 2, quantity = "displacement_m", unit = "mm" },
    { number = 3, quantity = "force_N", unit = "kgf", factor = -1.0 },
]
"""
ROWS = "RIG 7 version 2\n\n 1   0.0  -0.0\n 2   1.0  -2.0\nEND of run\n"


def exports(text: str) -> tuple[Export, ...]:
    return parse_exports(text.encode(), "config/exports.toml", KNOWN_FORMS)


def read(text: str, file: str | bytes, technique: str = "breakdown") -> Recording:
    data = file if isinstance(file, bytes) else file.encode()
    raw = RawFile("c/x.txt", data, technique=technique)
    return detect(raw, exports(text)).read(raw)


def refused(text: str) -> str:
    with pytest.raises(ConfigError) as caught:
        exports(text)
    return str(caught.value)


def test_labels_units_and_a_probe_ratio_are_applied() -> None:
    recording = read(RAMP, FILE)
    assert recording.columns["time_s"].tolist() == [0.0, 0.5, 1.0]
    assert recording.columns["voltage_V"].tolist() == [0.0, 500.0, 1000.0]
    source = recording.source
    assert (source.first_line, source.last_line) == (4, 6)
    version = exports(RAMP)[0].version
    assert source.reader == f"ramp (config/exports.toml, version {version})"
    assert recording.metadata["declared in"] == f"config/exports.toml, [ramp], version {version}"
    assert recording.metadata["columns not used"] == "CH2"


def test_columns_by_number_a_sampling_interval_and_an_end() -> None:
    recording = read(CURVE, ROWS, "tension")
    assert recording.columns["time_s"].tolist() == [0.0, 0.5]
    assert recording.columns["displacement_m"].tolist() == pytest.approx([0.0, 1e-3])
    assert recording.columns["force_N"].tolist() == pytest.approx([0.0, 2 * 9.80665])
    assert recording.source.last_line == 4


@pytest.mark.parametrize("encoding", ["cp1252", "utf-16", "gb18030"])
def test_encodings_are_those_that_are_declared(encoding: str) -> None:
    text = RAMP.replace('"t"', '"µ"').replace("[ramp]\n", f'[ramp]\nencoding = "{encoding}"\n')
    recording = read(text, FILE.replace("t\tCH1", "µ\tCH1").encode(encoding))
    assert recording.columns["time_s"].size == 3


def test_frequencies_may_be_angular_and_a_level_is_declared() -> None:
    text = """
[sweep]
techniques = ["permittivity"]
separator = "comma"
level_V = 0.5
columns = [
    { label = "w", quantity = "frequency_Hz", unit = "rad/s" },
    { label = "C'", quantity = "parallel_capacitance_F", unit = "pF" },
    { label = "D", quantity = "loss_tangent" },
]
"""
    recording = read(text, "w,C',D\n6.283185307179586,100,0.01\n62.83185307179586,100,0.01\n",
                     "permittivity")  # fmt: skip
    assert recording.columns["frequency_Hz"].tolist() == pytest.approx([1.0, 10.0])
    assert recording.metadata["level_V"] == "0.5"


def test_a_declared_form_goes_before_those_that_the_program_knows() -> None:
    plain = "time_s,voltage_kV\n0,0\n1,1\n2,2\n"
    own = RAMP.replace("tab", "comma").replace('decimal = ","\n', "").replace('"t"', '"time_s"')
    own = own.replace('"CH1"', '"voltage_kV"')
    assert read(own, plain).source.reader.startswith("ramp (")
    assert detect(RawFile("x", plain.encode(), technique="breakdown")).name == "hv_ramp"


def test_other_files_and_other_techniques_are_read_as_before() -> None:
    other = "Time (s);Load (N);Extension (mm)\n0;1;2\n1;2;3\n"
    assert "ramp" not in read(RAMP, other, "tension").source.reader
    with pytest.raises(RawFileError, match="no format recognises"):
        read(RAMP, FILE, "tension")


def test_two_declared_forms_of_one_file_are_refused_by_name() -> None:
    with pytest.raises(RawFileError, match=r"several forms of config/exports.toml.*: ramp, twin"):
        read(RAMP + RAMP.replace("[ramp]", "[twin]"), FILE)


def test_a_form_without_labels_and_start_is_only_taken_by_its_name() -> None:
    text = CURVE.replace('starts_with = "RIG 7"\n', "")
    raw = RawFile("x", ROWS.encode(), technique="tension")
    with pytest.raises(RawFileError):
        detect(raw, exports(text))
    assert by_name("curve", exports(text)).read(raw).columns["force_N"].size == 2


@pytest.mark.parametrize(
    ("file", "said"),
    [
        (FILE.replace("CH1", "CH7"), "no row holds the labels t, CH1, which ramp of config"),
        (FILE.replace("CH2", "CH1"), "two columns are labelled 'CH1'"),
        (FILE.replace("0,25", "0.25.1"), "line 5, column 2: "),
        (FILE.replace("0,25", "OVER"), "line 5, column 2: "),
        (FILE[:-1], "no line end after the last row"),
        ("Scope\nt\tCH1\tCH2\n", "no data rows where they are declared"),
        (FILE.encode("utf-16"), "not in utf-8, which ramp of config/exports.toml declares"),
        ("", "no row holds the labels"),
    ],
)
def test_a_file_that_is_not_as_declared_is_refused(file: str | bytes, said: str) -> None:
    data = file if isinstance(file, bytes) else file.encode()
    raw = RawFile("c/x.txt", data, technique="breakdown")
    with pytest.raises(RawFileError) as caught:
        format_of(exports(RAMP)[0]).read(raw)
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("voltage_V", "voltge_V"), "line 9: ramp.columns.1.quantity: no quantity is called "
         "'voltge_V'; nearest: voltage_V"),
        (('"ms"', '"mm"'), "line 8: ramp.columns.0: 'mm' is no unit of time_s (it must come to s)"),
        (('unit = "ms"', 'units = "ms"'), "unknown key 'ramp.columns.0.units'; did you mean 'unit'?"),
        (("decimal", "decimals"), "line 6: unknown key 'ramp.decimals'; did you mean 'decimal'?"),
        (('"tab"', '"pipe"'), "line 5: ramp.separator: Input should be 'tab'"),
        (('"breakdown"', '"breakdwn"'), "line 4: ramp.techniques: no technique reads tables as"),
        (('"breakdown"', '"tension"'), "ramp: tension needs displacement_m with force_N or"),
        (("[ramp]", "[Ramp]"), "the form 'Ramp': a name is made of a to z"),
        (("[ramp]", "[bluehill]"), "line 2: bluehill is a form of the program; rename it"),
        (("2000.0", "0.0"), "a factor of zero leaves nothing"),
        (("2000.0", "inf"), "should be a finite number"),
        (('label = "t"', 'label = "t", number = 1'), "a column has a label or a number"),
        (('"t", quantity = "time_s", unit = "ms"', '"t", quantity = "voltage_V", unit = "V"'),
         "two columns are the same quantity"),
        (("techniques", "sampling_interval_s = 1.0\ntechniques"), "declare one of them"),
        (('"Scope of', '"' + "x" * 300), "at most 200 characters"),
        (("[ramp]", "[ramp"), "config/exports.toml: "),
    ],
)  # fmt: skip
def test_a_slip_is_named_with_its_line(change: tuple[str, str], said: str) -> None:
    assert said in refused(RAMP.replace(*change))


def test_all_slips_are_said_at_once() -> None:
    said = refused(RAMP.replace("voltage_V", "voltge_V").replace("decimal", "decimals"))
    assert "voltge_V" in said
    assert "decimals" in said


def test_the_version_is_that_of_what_decides_how_files_are_read() -> None:
    version = exports(RAMP)[0].version
    assert exports(RAMP.replace("room 2.14", "room 3"))[0].version == version
    assert exports(RAMP.replace("2000.0", "1000.0"))[0].version != version
    assert exports("# a remark\n" + RAMP)[0].version == version


def test_a_folder_without_declarations_has_none(tmp_path: Path) -> None:
    assert load_exports(tmp_path) == ()
    (tmp_path / "exports.toml").write_bytes(b"#" * (1 << 21))
    with pytest.raises(ConfigError, match="at most"):
        load_exports(tmp_path)


def test_any_bytes_are_read_or_refused() -> None:
    generator = np.random.default_rng(7)
    form = format_of(exports(RAMP)[0])
    good = FILE.encode()
    for _ in range(400):
        data = bytearray(good)
        for at in generator.integers(0, len(data), 3):
            data[at] = int(generator.integers(0, 256))
        raw = RawFile("x", bytes(data), technique="breakdown")
        try:
            columns = form.read(raw).columns
        except RawFileError:
            continue
        assert all(np.isfinite(values).all() for values in columns.values())


def test_lines_of_keys_are_found() -> None:
    text = b"[a]\nx = 1\n\n[[a.b]]\ny = 2\n[[a.b]]\ny = 3\n"
    assert line_of(text, ("a", "x")) == 2
    assert line_of(text, ("a", "b", 1, "y")) == 7
    assert line_of(text, ("a", "b", 0)) == 4
    assert line_of(text, ("nothing",)) is None


BOOK = """
[rig-book]
techniques = ["compression"]
separator = "workbook"
columns = [
    { label = "CH1", quantity = "force_N", unit = "N" },
    { label = "CH2", quantity = "displacement_m", unit = "mm" },
]
"""
SHEET: Rows = [["Rig 7"], ["n", "CH1", "CH2"], [1.0, 0.5, 0.1], [2.0, 1.0, 0.2], [3.0, 1.5, 0.3]]


def test_a_workbook_may_be_declared() -> None:
    recording = read(BOOK, xlsx({"Notes": [["a", "b"]], "Data": SHEET}), "compression")
    assert recording.columns["force_N"].tolist() == [0.5, 1.0, 1.5]
    assert recording.columns["displacement_m"].tolist() == pytest.approx([1e-4, 2e-4, 3e-4])
    assert recording.source.reader.startswith("rig-book (config/exports.toml, version ")
    assert recording.source.reader.endswith(", sheet Data")
    assert (recording.source.first_line, recording.source.last_line) == (3, 5)


def test_two_sheets_of_a_declared_workbook_are_named_in_the_register() -> None:
    data = xlsx({"S1": SHEET, "S2": SHEET})
    with pytest.raises(RawFileError, match="one sheet must hold the table, and S1, S2 do"):
        read(BOOK, data, "compression")
    file = RawFile("c/x.xlsx", data, technique="compression", place="S2")
    assert detect(file, exports(BOOK)).read(file).metadata["sheet"] == "S2"


def test_other_workbooks_are_read_as_before() -> None:
    rows: Rows = [["Weg", "Kraft"], ["mm", "N"], [0.1, 0.5], [0.2, 1.0]]
    assert "rig-book" not in read(BOOK, xlsx({"Data": rows}), "compression").source.reader
    assert "leave `decimal` out" in refused(BOOK.replace("columns", 'decimal = ","\ncolumns', 1))


def test_a_percentage_of_a_workbook_is_a_fraction() -> None:
    text = BOOK.replace("force_N", "nominal_stress_Pa").replace('"N"', '"kPa"')
    text = text.replace("displacement_m", "nominal_strain").replace('"mm"', '"%"')
    percent = {"C3": '<c r="C3" s="1"><v>0.1</v></c>'}
    data = xlsx({"Data": SHEET}, replaced=percent)
    with pytest.raises(RawFileError, match="CH2 is shown in percent and stored as a fraction"):
        read(text, data, "compression")
