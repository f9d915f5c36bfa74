"""Viscometer logs: stamps of every kind, over-range text, and one exact message per bad input."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile

LOG = (
    "# synthetic, made for tests",
    "2022-03-01T20:30:00\t3#30 RPM  1925 48.1  22.0",
    "2022-03-01T20:45:00\t3#30 RPM  1988 49.7  -.-",
    "2022-03-02T08:00:00\t3#12 RPM  EEEE",
    "2022-03-02T08:01:00\t3#12 RPM  5000 50.0  22.0",
)
CSV = (
    "# synthetic, made for tests",
    "time_h,rotor,speed_rpm,viscosity_Pas,torque_percent,temperature_C",
    "0.25,3,30,1.925,48.1,22.0",
    "0.50,3,30,----,----,",
    "0.75,3,30,1.988,49.7,22.1",
)


def read(lines: Sequence[str], end: str = "\n") -> Recording:
    file = RawFile("x", ("\n".join(lines) + end).encode())
    return detect(file).read(file)


def refused(lines: Sequence[str], end: str = "\n") -> str:
    with pytest.raises(RawFileError) as caught:
        read(lines, end)
    return str(caught.value)


def changed(lines: Sequence[str], at: int, line: str) -> list[str]:
    return [*lines[: at - 1], line, *lines[at:]]


def test_serial_lines_come_out_in_si_with_over_range_left_out_by_line() -> None:
    found = read(LOG)
    assert found.source.reader == "ndj8s"
    assert found.columns["viscosity_Pas"] == pytest.approx([1.925, 1.988, 5.0])
    assert found.columns["torque"] == pytest.approx([0.481, 0.497, 0.5])
    assert found.columns["rotor"].tolist() == [3, 3, 3]
    assert found.columns["speed_rpm"].tolist() == [30, 30, 12]
    assert found.columns["line"].tolist() == [2, 3, 5]
    assert np.diff(found.columns["local_clock_s"]).tolist() == [900, 40560]
    assert [str(flag) for flag in found.flags] == ["over-range: 1 readings left out: lines 4"]
    assert found.columns["temperature_K"] == pytest.approx([295.15] * 3)
    assert found.metadata == {"line 1": "synthetic, made for tests"}
    assert (found.source.first_line, found.source.last_line) == (2, 5)


def test_a_probe_that_half_of_the_readings_lack_is_not_used() -> None:
    found = read(changed(LOG, 2, LOG[1].replace("22.0", "-.-")))
    assert "temperature_K" not in found.columns
    assert "not-in-every-reading: temperature_K is missing in some lines and was not used" in {
        str(flag) for flag in found.flags
    }


def test_the_quoted_line_of_the_instrument_is_read() -> None:
    found = read(["2022-03-01T20:30:00\t3#30 RPM   645 16.1  -.-"])
    assert found.columns["viscosity_Pas"].tolist() == [0.645]
    assert "temperature_K" not in found.columns


def test_times_of_day_go_on_past_midnight_also_in_a_line_that_is_left_out() -> None:
    stamps = ("20:30:00", "23:59:00", "00:05:00", "08:00:00")
    lines = [f"{s}\t3#30 RPM  1925 48.1  22.0" for s in stamps]
    assert read(lines).columns["time_of_day_s"].tolist() == [73800, 86340, 86700, 115200]
    lines[2] = "00:05:00\t3#30 RPM  EEEE"
    assert read(lines).columns["time_of_day_s"].tolist() == [73800, 86340, 115200]


def test_stamps_with_an_offset_are_moments() -> None:
    lines = [
        "2022-03-27T01:30:00+01:00\t3#30 RPM  1925 48.1  22.0",
        "2022-03-27T03:30:00+02:00\t3#30 RPM  1925 48.1  22.0",
    ]
    assert np.diff(read(lines).columns["utc_s"]).tolist() == [3600]


@pytest.mark.parametrize(
    ("at", "line", "message"),
    [
        (
            3,
            "20:45:00\t3#30 RPM  1988 49.7  -.-",
            "x, line 3, column 1: a stamp of another kind than the first, '2022-03-01T20:30:00' "
            "(found '20:45:00'); one file holds one run, stamped in one way",
        ),
        (
            3,
            "yesterday\t3#30 RPM  1988 49.7  -.-",
            "x, line 3, column 1: not a time stamp (found 'yesterday'); stamp with ISO 8601 "
            "(2022-03-01T20:30:00) or with the time of day (20:30:00)",
        ),
        (
            3,
            "2022-03-01T17:45:00\t3#30 RPM  1988 49.7  -.-",
            "x, line 3, column 1: the clock steps back by 9900 s (found '2022-03-01T17:45:00'); "
            "one file holds one run, in the order of time",
        ),
        (
            3,
            "2022-03-01T20:45:00\t3#30 RPM  1988",
            "x, line 3: a reading without its torque; the line seems cut (found "
            "'2022-03-01T20:45:00\\t3#30 RPM  1988'); log the run again",
        ),
        (
            3,
            "2022-03-01T20:45:00\t3#30 RPM  19,88 49.7  -.-",
            "x, line 3, column 3: not a number for the viscosity (found '19,88'); export the file "
            "again",
        ),
        (
            3,
            "2022-03-01T20:45:00 3#30 RPM  1988 49.7  -.-",
            "x, line 3: not a line of an NDJ-8S: stamp, TAB, rotor#rpm RPM, viscosity, torque, "
            "temperature (found '2022-03-01T20:45:00 3#30 RPM  1988 49.7  -.-'); log the run "
            "again, or make it a # remark",
        ),
    ],
)
def test_a_bad_serial_line_is_refused_in_exact_words(at: int, line: str, message: str) -> None:
    assert refused(changed(LOG, at, line)) == message


def test_a_log_cut_in_its_last_line_is_refused() -> None:
    assert refused(LOG, end="") == (
        "x, line 5: no line end after the last reading, so its last number may be cut (found "
        "'2022-03-02T08:01:00\\t3#12 RPM  5000 50.0  22.0'); log the run again, or end the line "
        "if it is whole"
    )


def test_a_log_of_nothing_but_over_range_is_refused() -> None:
    assert refused(["20:30:00\t3#30 RPM  EEEE", "20:45:00\t3#30 RPM  EEEE"]) == (
        "x, line 1: none of the 2 readings is a number (found 'over-range'); measure with a rotor "
        "and speed that keep the torque between 10 and 100 %"
    )


def test_a_plain_csv_comes_out_in_si() -> None:
    found = read(CSV)
    assert found.source.reader == "viscometer_csv"
    assert found.columns["time_s"].tolist() == [900, 2700]
    assert found.columns["viscosity_Pas"].tolist() == [1.925, 1.988]
    assert found.columns["temperature_K"] == pytest.approx([295.15, 295.25])
    assert [str(flag) for flag in found.flags] == ["below-zero: 1 readings left out: lines 4"]


@pytest.mark.parametrize(
    ("labels", "row", "seconds", "viscosity"),
    [
        ("elapsed_s,viscosity_mPas", "60,1925", 60.0, 1.925),
        ("viscosity_mPas,time_min", "1925,1", 60.0, 1.925),
        ("time_s,viscosity_Pas", "60,1.925", 60.0, 1.925),
    ],
)
def test_every_label_of_time_and_viscosity(
    labels: str, row: str, seconds: float, viscosity: float
) -> None:
    found = read([labels, row])
    assert found.columns["time_s"].tolist() == [seconds]
    assert found.columns["viscosity_Pas"].tolist() == [viscosity]


def test_a_csv_may_be_stamped() -> None:
    found = read(["timestamp,viscosity_Pas", "23:50:00,1", "00:10:00,2"])
    assert found.columns["time_of_day_s"].tolist() == [85800, 87000]


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (
            changed(CSV, 2, CSV[1].replace("rotor", "spindle")),
            "x, line 2, column 2: an unknown label (found 'spindle'); known labels: elapsed_h, "
            "elapsed_min, elapsed_s, rotor, speed_rpm, temperature_C, time_h, time_min, time_s, "
            "timestamp, torque_percent, viscosity_Pas, viscosity_mPas",
        ),
        (
            ["time_s,elapsed_s,viscosity_Pas", "1,1,1"],
            "x, line 1, column 2: two columns of the same quantity (found 'elapsed_s'); export each "
            "quantity once",
        ),
        (
            changed(CSV, 5, "0.75,3,30,1,988,49.7,22.1"),
            "x, line 5, column 6: 7 fields where the header names 6 (found "
            "'0.75,3,30,1,988,49.7,22.1'); export with decimal points, every reading in every row",
        ),
        (
            changed(CSV, 5, "0.20,3,30,1.988,49.7,22.1"),
            "x, line 5, column 1: the time steps back from 0.50 (found '0.20'); one file holds one "
            "run, in the order of time",
        ),
        (
            changed(CSV, 5, "0.75,3,30,n/a,49.7,22.1"),
            "x, line 5, column 4: not a number for the viscosity_Pas (found 'n/a'); export the "
            "file again",
        ),
        (list(CSV[:2]), "x: no readings: the file ends with its header; export the file again"),
    ],
)
def test_a_bad_csv_is_refused_in_exact_words(lines: list[str], message: str) -> None:
    assert refused(lines) == message
