"""Scopes, LabVIEW text, E4990A and WinDETA: plain tables once a few lines are written otherwise."""

from __future__ import annotations

import pytest

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile

RIGOL = (
    "X,CH1,Start,Increment,\nSequence,Volt,-1.0e+00,5.0e-01\n0,0.0e+00,\n1,1.5e+02,\n2,3.0e+02,\n"
)
TEKTRONIX = (
    "Record Length,2.5E+03,,-1.0,0.0,\nSource,CH1,,-0.5,150.0,\nVertical Units,V,,0.0,300.0,\n"
    "Horizontal Units,s,,0.5,450.0,\n,,,1.0,600.0,\n"
)
LVM = (
    "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\n"
    "Multi_Headings\tNo\nX_Columns\tOne\n***End_of_Header***\t\n\t\nChannels\t1\t\nSamples\t3\t\n"
    "Y_Unit_Label\tkV\t\nX_Dimension\tTime\t\n***End_of_Header***\t\t\nX_Value\tVoltage\tComment\n"
    "0.0\t0.0\tstart\n0.5\t0.15\n1.0\t0.3\n"
)
E4990A = (
    "!Agilent Technologies,E4990A,MY0,A.02.11\n!Date: Mon Jan 06 10:00:00 2025\nBEGIN CH1_DATA\n"
    "Frequency(Hz), R(Ohm)-data, X(Ohm)-data\n+1.0e+01, +4.9e+05, -1.2e+08\n"
    "+2.0e+01, +2.4e+05, -6.1e+07\nEND\n"
)
NOVOCONTROL = (
    "X1, 17.2.2025, 11:19\nDiameter[mm] 4.0e+01  Thickness[mm] 5.0e-01\n"
    "Fixed value(s) :  AC Volt  [Vrms]=1.0000e+00\n Freq. [Hz]\t Eps'    \t Eps''   \n"
    "1.0e+02\t2.9e+00\t1.2e-02\n1.0e+01\t2.9e+00\t1.2e-02\n"
)
LINES = {
    "rigol": (3, 5), "tektronix": (1, 5), "lvm": (15, 17), "e4990a": (5, 6), "novocontrol": (5, 6),
}  # fmt: skip
FILES = {
    "rigol": RIGOL, "tektronix": TEKTRONIX, "lvm": LVM, "e4990a": E4990A,
    "novocontrol": NOVOCONTROL,
}  # fmt: skip


def read(text: str) -> Recording:
    technique = "permittivity" if text.startswith(("!", "X1")) else "breakdown"
    file = RawFile("x", text.encode(), technique=technique)
    return detect(file).read(file)


def refused(text: str) -> str:
    with pytest.raises(RawFileError) as caught:
        read(text)
    return str(caught.value)


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
@pytest.mark.parametrize("name", FILES)
def test_the_lines_of_a_good_file(name: str, newline: str) -> None:
    recording = read(FILES[name].replace("\n", newline))
    source = recording.source
    assert source.reader == name
    assert (source.first_line, source.last_line) == LINES[name]


def test_values_are_in_si() -> None:
    for text in (RIGOL, TEKTRONIX, LVM):
        columns = read(text).columns
        assert columns["voltage_V"].tolist()[:3] == pytest.approx([0.0, 150.0, 300.0])
        assert columns["time_s"][1] - columns["time_s"][0] == pytest.approx(0.5)
    columns = read(E4990A).columns
    assert columns["reactance_ohm"].tolist() == [-1.2e8, -6.1e7]
    assert columns["series_resistance_ohm"].tolist() == [4.9e5, 2.4e5]


def test_the_time_may_have_no_column() -> None:
    text = LVM.replace("X_Columns\tOne", "X_Columns\tNo").replace(
        "X_Dimension", "X0\t0.0\t\nDelta_X\t0.5\t\nX_Dimension"
    )
    for time in ("0.0\t0.0", "0.5\t0.15", "1.0\t0.3"):
        text = text.replace(f"\n{time}", "\n" + time[3:])
    assert read(text).columns["time_s"].tolist() == [0.0, 0.5, 1.0]
    assert "no one Delta_X" in refused(text.replace("Delta_X\t0.5", "Delta_X\t"))


def test_the_maker_may_stand_below_the_form() -> None:
    assert read("!CSV A.01.01\n" + E4990A).source.reader == "e4990a"


def test_a_channel_without_a_name_is_said() -> None:
    assert [str(flag) for flag in read(RIGOL).flags] == [
        "label-by-unit: CH1 was taken for voltage_V: its label is unknown, and it is the only "
        "column in V"
    ]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (RIGOL.replace("\n2,", "\n3,"), "line 5, column 1: the running number does not go on"),
        (RIGOL.replace("5.0e-01", "0"), "line 2: no start and increment of time"),
        (RIGOL.replace("1.5e+02", "OVER"), "line 4, column 2: over-range text"),
        (RIGOL[:-2], "no line end after the last row"),
        (
            "X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,0,1\n0,1,2,\n1,2,3,\n",
            "which column is the voltage? CH1 [V], CH2 [V] have its unit; name the column",
        ),
        (TEKTRONIX.replace("Horizontal Units,s", ",s"), "no Horizontal Units in the header"),
        (TEKTRONIX.replace("-0.5,150.0", "-0.5,"), "line 2, column 2: a blank cell"),
        (TEKTRONIX.replace("1.0,600.0,\n", "1.0\n"), "line 5"),
        (TEKTRONIX[:-2], "no line end after the last row"),
        (LVM.replace("Y_Unit_Label\tkV\t\n", ""), "no unit stands beside 'Voltage' (voltage)"),
        (LVM.replace("1.0\t0.3\n", ""), "2 rows where the header states 3 samples; the file seems"),
        (LVM.replace("X_Columns\tOne", "X_Columns\tMulti"), "X_Columns is not One"),
        (LVM + LVM[LVM.index("Channels") :], "2 blocks of channels where one belongs"),
        (LVM[:-1], "no line end after the last row"),
        (E4990A.replace("END\n", ""), "no line END; the file seems cut"),
        (E4990A + E4990A[E4990A.index("BEGIN") :], "2 channels where one belongs"),
        (E4990A.replace("-6.1e+07", "9.9E37"), "line 6, column 3: a number that stands for over"),
    ],
)
def test_what_is_not_whole_is_refused(text: str, reason: str) -> None:
    assert reason in refused(text)
