"""Sweeps of LCR meters: read with what they are, or refused by line, reason and hint."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.detect import by_name, detect
from deamat.formats.rawfile import RawFile

DATA = Path(__file__).resolve().parent.parent / "data" / "lcr"
LOG, CSV, E4980A = ((DATA / name).read_bytes() for name in ("lcr6000.log", "lcr.csv", "e4980a.csv"))


def read(data: bytes | str, ends_open: bool = False) -> Recording:
    data = data.encode() if isinstance(data, str) else data
    file = RawFile("c/permittivity/x", data, ends_open)
    return detect(file).read(file)


def refused(data: bytes | str) -> str:
    with pytest.raises(RawFileError) as caught:
        read(data)
    return str(caught.value).removeprefix("c/permittivity/")


def test_a_log_of_replies_comes_out_in_si_with_its_lines() -> None:
    recording = read(LOG)
    assert {name: list(values) for name, values in recording.columns.items()} == {
        "frequency_Hz": [10.0, 20.0, 100.0, 1e3, 1e4],
        "parallel_capacitance_F": [1.5821e-10, 1.58102e-10, 1.579e-10, 1.5781e-10, 9.9e37],
        "loss_tangent": [1.2e-3, 1.01e-3, 6e-4, 3e-4, 9.9e37],
        "over_range": [0.0, 0.0, 1.0, 0.0, 1.0],
    }
    source = recording.source
    assert (source.first_line, source.last_line) == (6, 10)
    assert source.reader == "lcr6000"
    assert [str(flag) for flag in recording.flags] == [
        "over-range: 2 of 5 points are marked as invalid by the meter and are not used: line 8 (100 Hz), line 10 (10000 Hz)"
    ]


def test_the_comma_in_the_vendors_name_parts_nothing() -> None:
    said = read(LOG).metadata
    assert said["*IDN?"] == "LCR-6020,REV C1.06,GEX123456,Good Will Instrument Co., Ltd."
    assert (said["model"], said["vendor"]) == ("LCR-6020", "Good Will Instrument Co., Ltd.")
    assert (said["firmware"], said["serial"]) == ("REV C1.06", "GEX123456")
    assert (said["mode"], said["level_V"], said["speed"]) == ("Cp-D", "1.0", "slow")
    assert said["remark"] == "synthetic: written for tests"


@pytest.mark.parametrize(
    ("function", "columns"),
    [
        ("Cp-Rp", ["parallel_capacitance_F", "parallel_resistance_ohm"]),
        ("Cs-D", ["series_capacitance_F", "loss_tangent"]),
        ("Cs-Rs", ["series_capacitance_F", "series_resistance_ohm"]),
        ("R-X", ["series_resistance_ohm", "reactance_ohm"]),
        ("Z-thr", ["impedance_ohm", "phase_rad"]),
        ("cp-d", ["parallel_capacitance_F", "loss_tangent"]),
    ],
)
def test_the_function_names_the_columns(function: str, columns: list[str]) -> None:
    recording = read(LOG.replace(b"Cp-D", function.encode()))
    assert list(recording.columns)[1:3] == columns
    assert recording.columns[columns[0]][0] == 1.5821e-10


@pytest.mark.parametrize("row", ['10,1e-10,"9.9E37",OK', '10,1e-10,"1e-3",OK'])
def test_a_quoted_reply_is_refused_by_its_place(row: str) -> None:
    said = refused(f"# FUNC? => Cp-D\n{row}\n20,1e-10,1e-3,OK\n")
    assert said.startswith("x, line 2, column 3: a quoted number, which this format does not use")


def test_degrees_become_radians() -> None:
    recording = read("# FUNC? => Z-theta-deg\n1e1,1e8,-90,OK\n")
    assert recording.columns["phase_rad"][0] == pytest.approx(-math.pi / 2, rel=1e-15)


def test_a_sentinel_with_the_status_of_a_good_point_is_over_range_all_the_same() -> None:
    recording = read("# FUNC? => Cp-D\n10,1e-10,9.99999E37,OK\n20,1e-10,1e-3,OK\n")
    assert list(recording.columns["over_range"]) == [1.0, 0.0]


def test_names_over_the_rows_and_a_missing_mark_are_fine() -> None:
    recording = read(
        "*IDN? => LCR-6020\nFUNC? => Cs-D\nfrequency_Hz,primary,secondary,flags\n10,1e-10,1e-3,OK\n"
    )
    assert recording.source.first_line == 4
    assert list(recording.columns["series_capacitance_F"]) == [1e-10]


@pytest.mark.parametrize("newline", [b"\n", b"\r\n"])
@pytest.mark.parametrize("data", [LOG, CSV, E4980A])
def test_line_ends_and_encodings_change_no_number(data: bytes, newline: bytes) -> None:
    plain, text = read(data), data.replace(b"\n", newline).decode()
    for again in (text.encode(), text.encode("utf-8-sig"), text.encode("utf-16")):
        recording = read(again)
        assert recording.metadata == plain.metadata
        for name, values in plain.columns.items():
            assert np.array_equal(recording.columns[name], values)


def test_a_plain_table_says_in_its_labels_what_it_holds() -> None:
    recording = read(CSV)
    assert {name: list(values) for name, values in recording.columns.items()} == {
        "frequency_Hz": [10.0, 20.0, 100.0, 1000.0],
        "series_capacitance_F": [1.58212e-10, 1.58104e-10, 1.57901e-10, 9.99999e37],
        "loss_tangent": [0.0012, 0.00101, 0.0006, 0.0003],
        "over_range": [0.0, 0.0, 0.0, 1.0],
    }
    assert (recording.source.reader, recording.source.first_line) == ("lcr_csv", 4)
    assert recording.metadata["LCR"] == "bridge of the third floor"
    assert recording.column_units == {"frequency": "Hz", "Cs": "F", "D": "1"}


@pytest.mark.parametrize(
    "text",
    [
        "frequency_Hz,Cp_pF,D\n10,158.21,0.001\n",
        "freq_kHz,Cp_nF,tan_delta\n0.01,0.15821,0.001\n",
        "frequency_Hz,Cp_\u00b5F,D\n10,158.21e-6,0.001\n",
        "frequency_Hz,Cp_\u03bcF,D\n10,158.21e-6,0.001\n",
        "frequency,Cp,D\nHz,pF,1\n10,158.21,0.001\n",
        "frequency_Hz,Cp_pF,D\nHz,pF,-\n10,158.21,0.001\n",
        "frequency_Hz;Cp_pF;D\n10;158,21;0,001\n",
        "frequency_Hz\tCp_pF\tD\n10\t158.21\t0.001\n",
        "frequency_Hz,Cp_pF,loss_tangent,status\n10,158.21,0.001,OK\n",
        "\n# note\nfrequency_Hz,Cp_pF,D\n10,158.21,0.001\n",
    ],
)
def test_one_point_in_many_spellings(text: str) -> None:
    columns = read(text).columns
    assert columns["frequency_Hz"][0] == pytest.approx(10.0)
    assert columns["parallel_capacitance_F"][0] == pytest.approx(158.21e-12)
    assert columns["loss_tangent"][0] == pytest.approx(0.001)


@pytest.mark.parametrize(
    ("labels", "columns"),
    [
        ("Cp_F,Rp_ohm", ["parallel_capacitance_F", "parallel_resistance_ohm"]),
        ("Cs_F,Rs_ohm", ["series_capacitance_F", "series_resistance_ohm"]),
        ("R_ohm,X_ohm", ["series_resistance_ohm", "reactance_ohm"]),
        ("Z_Mohm,theta_deg", ["impedance_ohm", "phase_rad"]),
        ("Z_kohm,phase_rad", ["impedance_ohm", "phase_rad"]),
    ],
)
def test_the_labels_name_the_columns(labels: str, columns: list[str]) -> None:
    recording = read(f"frequency_Hz,{labels}\n10,1,-1\n")
    assert list(recording.columns)[1:3] == columns


def test_an_e4980a_log_has_its_own_words() -> None:
    recording = read(E4980A)
    assert list(recording.columns["series_resistance_ohm"][:2]) == [50841.6, 6047.98]
    assert list(recording.columns["reactance_ohm"][:2]) == [-5.03374e7, -1.00794e7]
    assert list(recording.columns["over_range"]) == [0.0, 0.0, 1.0, 1.0]
    said = recording.metadata
    assert (said["mode"], said["level_V"], said["speed"]) == ("R-X", "0.5", "long")
    assert recording.source.reader == "e4980a"
    assert recording.source.first_line == 6


def test_a_short_aperture_is_the_fast_speed() -> None:
    for short in (b"SHOR", b"SHORT"):
        assert read(E4980A.replace(b"LONG", short)).metadata["speed"] == "fast"


def test_identical_rows_are_flagged_and_kept() -> None:
    recording = read("# FUNC? => Cp-D\n" + 2 * "10,1e-10,1e-3,OK\n")
    assert [flag.name for flag in recording.flags] == ["identical-rows"]
    assert recording.columns["frequency_Hz"].size == 2


def test_a_campaign_may_declare_that_files_end_open() -> None:
    assert read(LOG.rstrip(b"\n"), ends_open=True).columns["frequency_Hz"].size == 5


NO_FUNCTION = "x, line 1: the file does not say which function the meter measured, so its first number may be a capacitance in parallel or in series, or no capacitance at all; "


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (LOG.replace(b"# FUNC? => Cp-D\n", b""), NO_FUNCTION + "add the meter's own reply as a line such as `# FUNC? => Cp-D`"),
        (b"1e1,+1.5e-10,+1.2e-03,OK\n2e1,+1.5e-10,+1.2e-03,OK\n", NO_FUNCTION + "add the meter's own reply as a line such as `# FUNC? => Cp-D`"),
        (E4980A.replace(b"Function,RX\n", b""), NO_FUNCTION + "add a header line such as `Function,CPD`"),
        (LOG.replace(b"Cp-D", b"Ls-Q"), "x, line 3: a function that gives no permittivity (found 'Ls-Q'); measure one of Cp-D, Cp-Rp, Cs-D, Cs-Rs, R-X, Z-theta-deg, Z-theta-rad"),
        (LOG.replace(b"# APER", b"# FUNC? => Cs-D\n# APER"), "x, line 5: the function changes from Cp-D (line 3) (found 'Cs-D'); log one sweep with one function to one file"),
        (LOG.replace(b"1.000e+00V", b"1.0 A"), "x, line 4: not a test level in V or mV (found '1.0 A'); log the reply of LEV:VOLT? as it is"),
        (LOG.replace(b"OUT ", b"WARM"), "x, line 8, column 4: an unknown status (found 'WARM'); known: ok, out, over"),
        (LOG.replace(b",OK\n", b"\n"), "x, line 6, column 3: 3 fields where frequency, primary, secondary and a status belong (found '1.00000e+01,+1.58210e-10,+1.20000e-03')"),
        (LOG.replace(b"2.00000e+01", b"# FUNC? => Cs-D\n2.00000e+01"), "x, line 7: a header line between the rows (found '# FUNC? => Cs-D'); log one sweep to one file"),
        (LOG.replace(b"+1.58102e-10", b"-----"), "x, line 7, column 2: over-range text in place of a number (found '-----')"),
        (LOG.replace(b"+1.58102e-10", b""), "x, line 7, column 2: a blank cell (found '')"),
        (LOG.replace(b"+1.58102e-10", b"1.58102e-10F"), "x, line 7, column 2: a unit behind the number (found '1.58102e-10F')"),
        (LOG.replace(b"2.00000e+01", b"0.00000e+00"), "x, line 7, column 1: a frequency must be above zero (found '0'); log the sweep again"),
        (LOG.replace(b"2.00000e+01", b"9.90000e+37"), "x, line 7, column 1: a number that stands for over-range (9.9E37 or beyond) (found '9.90000e+37')"),
        (LOG.rstrip(b"\n"), "x, line 10, column 3: no line end after the last row, so its last number may be cut (found '0')"),
        (LOG[: LOG.index(b"1.00000e+01")], "x, line 5: no data rows: the file ends with its header; log the sweep again"),
        (CSV.replace(b"Cs_F", b"C_F"), "x, line 3, column 2: the label does not say whether the capacitance is in parallel or in series (found 'C'); name the column Cp_F or Cs_F, as the meter was set"),
        (CSV.replace(b"Cs_F", b"Cs"), "x, line 3, column 2: a column without a unit, where a unit of F belongs (found 'Cs'); name the column Cs_F"),
        (CSV.replace(b"Cs_F", b"Cs_ohm"), "x, line 3, column 2: a column in ohm, where a unit of F belongs (found 'Cs'); name the column Cs_F"),
        (CSV.replace(b"Cs_F,D", b"Cs_F,Q"), "x, line 3, column 2: not a pair that gives a permittivity (found 'Cs,Q'); known pairs: Z,theta; Cp,D; Cp,Rp; Cs,D; Cs,Rs; R,X"),
        (CSV.replace(b"Cs_F,D", b"Cs_F,D,note"), "x, line 3: 4 columns of numbers (found 'frequency, Cs, D, note'); a sweep is frequency and one pair, such as frequency_Hz,Cp_F,D"),
        (CSV.replace(b"Cs_F,D\n", b"Cs_F,D\nHz,pF,1\n"), "x, line 4, column 2: the label says F, the row of units below says otherwise (found 'pF'); state each unit once"),
        (CSV.replace(b"20,", b"20;"), "x, line 5, column 2: too few fields: 2 where the header names 3 (found '0.00101')"),
        (E4980A.replace(b",+3", b",+7"), "x, line 9, column 4: an unknown status (found '+7'); known: 0, +0, -1, 1, +1, 3, +3, 4, +4"),
        (E4980A.replace(b"RX", b"VDID"), "x, line 2: a function that gives no permittivity (found 'VDID')"),
    ],
)  # fmt: skip
def test_what_is_not_certain_is_refused_by_name(data: bytes, message: str) -> None:
    assert refused(data).startswith(message)


def test_units_in_brackets_below_the_labels_of_a_sweep_are_no_testing_machines() -> None:
    text = "frequency,Cp,D\n(Hz),(pF),(-)\n10,158.21,0.001\n"
    file = RawFile("x", text.encode())
    named = detect(file).read(file)
    assert named.columns["parallel_capacitance_F"][0] == pytest.approx(158.21e-12)


def test_a_register_may_not_send_another_file_to_the_e4980a_reader() -> None:
    with pytest.raises(RawFileError, match="no row of labels as the e4980a form has it"):
        by_name("e4980a").read(RawFile("x", CSV))


@pytest.mark.parametrize(
    "file",
    [
        "gamry_dta_traps/chronoa_de_data.dta",
        "gamry_dta_traps/cv_data_incompleteheader.dta",
        "gamry_dta_traps/eispot_data.dta",
        "havnegpy_novocontrol/test_data.TXT",
        "impedancepy_exports/exampleData.csv",
        "impedancepy_exports/exampleDataParstat.txt",
        "impedancepy_exports/exampleDataPowersuite.txt",
        "impedancepy_exports/exampleDataZPlot.z",
    ],
)
def test_exports_of_impedance_spectrometers_are_refused_and_not_misread(
    shared: Path, file: str
) -> None:
    data = (shared / "real" / "dielectric" / file).read_bytes()
    found = RawFile(file, data, technique="permittivity")
    with pytest.raises(
        RawFileError, match=r"no format recognises this file: |too few fields|must be above zero"
    ):
        detect(found).read(found)


def test_the_sweep_of_a_real_potentiostat_is_read(shared: Path) -> None:
    file = "real/dielectric/impedancepy_exports/exampleDataGamry.DTA"
    raw = RawFile(file, (shared / file).read_bytes(), technique="permittivity")
    recording = detect(raw).read(raw)
    assert (recording.source.reader, recording.source.first_line) == ("plain", 449)
    first = [values[0] for values in recording.columns.values()]
    assert first == [200015.6, 825.8584, -1367.239]  # Hz, ohm, ohm
    assert len(recording.columns["frequency_Hz"]) == 72


def test_the_quoted_replies_of_a_real_meter_are_known_and_their_function_refused(
    shared: Path,
) -> None:
    data = (shared / "real" / "instrument_lines" / "lcr6000_replies.txt").read_bytes()
    assert refused(data).startswith(
        "x, line 2: a function that gives no permittivity (found 'Ls-Q'); measure one of Cp-D"
    )
