"""Plain tables: every form of separator, mark, unit and language, and what is refused."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import pytest

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.core.unit_spellings import unit_as_written
from deamat.core.units import UnknownUnit
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.formats.vocabulary import ASKED, plain_label, vocabulary

ROWS = ((0.0, 0.0, 0.0), (0.5, 0.25, 1.5), (1.0, 0.5, 1234.5))  # s, mm, N
SI: Mapping[str, list[float]] = {
    "time_s": [0.0, 0.5, 1.0],
    "displacement_m": [0.0, 0.25e-3, 0.5e-3],
    "force_N": [0.0, 1.5, 1234.5],
}


def read(text: str | bytes, technique: str = "tension") -> Recording:
    data = text if isinstance(text, bytes) else text.encode()
    file = RawFile("x", data, technique=technique)
    return detect(file).read(file)


def refused(text: str | bytes, technique: str = "tension") -> str:
    with pytest.raises(RawFileError) as caught:
        read(text, technique)
    return str(caught.value)


def table(header: str, separator: str = ",", decimal: str = ".", quote: str = "") -> str:
    rows = [
        separator.join(f"{quote}{value:.3f}{quote}".replace(".", decimal) for value in row)
        for row in ROWS
    ]
    return "\r\n".join([header.replace(",", separator), *rows, ""])


def is_curve(recording: Recording) -> bool:
    return all(
        recording.columns[name].tolist() == pytest.approx(values) for name, values in SI.items()
    )


@pytest.mark.parametrize(
    "header",
    [
        "time_s,displacement_mm,force_N",
        "Time / s,Displacement / mm,Force / N",
        "t in s,s in mm,F in N".replace("s in mm", "Weg in mm"),
        "Total Time (sec.),Position (MM),Load measurement [N]",
        '"Time (s)","Extension (mm)","Primary load measurement (N)"',
        "Crosshead time_s,Extension_mm,Load_N".replace("Crosshead time", "Elapsed time"),
        "\r\nTime,Crosshead ,Load \r\ns,mm,N",
        "Results 1,,\r\nMaximum load,1234.5,N\r\n\r\nTime,Extension,Load\r\n(s),(mm),(N)\r\n",
        "Temps,Déplacement,Charge\r\n(s),(mm),(N)",
        "Tiempo,Extensión,Carga\r\n(s),(mm),(N)",
        "Tempo,Spostamento,Forza\r\n[s],[mm],[N]",
        "Czas,Przemieszczenie,Siła\r\n(s),(mm),(N)",
        "时间,位移,载荷\r\n(s),(mm),(N)",
        "時間,変位,荷重\r\n(sec),(mm),(N)",
    ],
)
def test_headings_of_every_kind(header: str) -> None:
    assert is_curve(read(table(header)))


def test_quoted_notes_above_bars_are_kept() -> None:
    recording = read('"Remark"|"a|b"\n' + table("time_s,displacement_mm,force_N", "|"))
    assert is_curve(recording)
    assert recording.metadata["Remark"] == "a|b"


@pytest.mark.parametrize("separator", [";", "\t", "|"])
@pytest.mark.parametrize("decimal", [",", "."])
@pytest.mark.parametrize("quote", ["", '"'])
def test_separators_marks_and_quotes(separator: str, decimal: str, quote: str) -> None:
    header = "Zeit,Weg,Kraft\r\nsek,mm,N"
    assert is_curve(read(table(header, separator, decimal, quote)))


@pytest.mark.parametrize(
    ("language", "encoding"),
    [
        ("时间,位移,力", "gbk"),
        ("时间,位移,力", "gb18030"),
        ("時間,ストローク,試験力", "cp932"),
        ("Czas,Wydłużenie,Obciążenie", "cp1250"),
        ("Prüfzeit,Verlängerung,Prüfkraft", "cp1252"),
        ("时间,位移,力", "utf-8-sig"),
        ("时间,位移,力", "utf-16"),
    ],
)
def test_encodings_are_those_in_which_the_labels_are_words(language: str, encoding: str) -> None:
    recording = read(table(f"{language}\r\n(s),(mm),(N)").encode(encoding))
    assert is_curve(recording)
    alike = {"gbk": "gb18030", "cp1252": "latin-1"}
    assert recording.source.encoding == alike.get(encoding, encoding)


@pytest.mark.parametrize("declared", ["cp1252", "windows-1250"])
def test_an_encoding_that_stays_open_is_declared(declared: str) -> None:
    """The same byte is u with an umlaut in one encoding and with a ring in the other."""
    text = "U\tF\u00f9 (N)\tWeg (mm)\n1\t2\t3\n2\t4\t6\n".encode("cp1252")
    recording = detect(file := RawFile("x", text, technique="tension", declared=declared)).read(
        file
    )
    assert recording.source.encoding == declared.replace("windows-", "cp")
    assert list(recording.column_units) == [
        "Weg", "F\u00f9" if declared == "cp1252" else "F\u016f"
    ]  # fmt: skip


def test_an_encoding_that_is_not_that_of_the_file_is_refused() -> None:
    data = table("Zeit (s),Pr\u00fcfweg (mm),Kraft (N)").encode("cp1252")
    for declared, reason in (
        ("utf-8", "it is not in utf-8, which the register declares: byte 11 is no letter there"),
        ("ebcdic", "the register declares an unknown encoding 'ebcdic'; write one of utf-8, "),
    ):
        file = RawFile("x", data, technique="tension", declared=declared)
        with pytest.raises(RawFileError) as caught:
            detect(file)
        assert reason in str(caught.value)


def test_two_encodings_that_mean_different_columns_are_refused() -> None:
    """Bytes that are words for a travel in GB18030 and in Shift-JIS, in two columns."""
    chinese, japanese = "\u4f4d\u79fb".encode("gbk"), "\u5909\u4f4d".encode("cp932")
    data = b"N\t" + chinese + b" (mm)\t" + japanese + b" (mm)\tF (N)\n1\t2\t3\t4\n2\t3\t4\t5\n"
    assert "it may be in gb18030 or cp932, which read its labels differently" in refused(data)
    file = RawFile("x", data, technique="tension", declared="gbk")
    assert detect(file).read(file).columns["displacement_m"][0] == 2e-3


def test_specimens_side_by_side_in_a_text_are_named_by_their_columns() -> None:
    text = "Weg;Kraft;;Weg;Kraft\nmm;N;;mm;N\n0,5;1,5;;0,25;3,5\n1,5;2,5;;0,75;4,5\n2,5;3,5;;;\n"
    assert refused(text).endswith("of each specimen in the register: `x#A:B`, `x#D:E`")
    for place, force_N in (("A:B", [1.5, 2.5, 3.5]), ("D:E", [3.5, 4.5])):
        file = RawFile("x", text.encode(), technique="tension", place=place)
        assert detect(file).read(file).columns["force_N"].tolist() == force_N


def test_times_of_a_clock_are_in_seconds() -> None:
    head = "No,Time,Viscosity (Pa s)\n"
    text = head + "1,0:00:01.5,3\n2,0:15:00,4\n3,30:00:00,9\n"
    assert read(text, "viscosity").columns["time_s"].tolist() == [1.5, 900.0, 108000.0]
    text = head.replace("Time", "Time (mm:ss)") + "1,00:01.5,3\n2,15:00,4\n3,99:00,9\n"
    assert read(text, "viscosity").columns["time_s"].tolist() == [1.5, 900.0, 5940.0]
    for cells, reason in (
        ("14:00:01", "it may be a time of the day or an elapsed time"),
        ("15:00", "no unit stands beside 'Time' (time)"),
        ("2025-03-01 14:00:01", "no unit stands beside 'Time' (time)"),
    ):
        assert reason in refused(head + f"1,{cells},3\n2,{cells},4\n", "viscosity")
    under = head.replace("Time", "Time (s)") + "1,0:00:01,3\n2,0:15:00,4\n"
    assert "line 2, column 2: a time as a clock shows it, under a unit" in refused(
        under, "viscosity"
    )


@pytest.mark.parametrize(
    "spoil",
    [
        lambda text: text,
        lambda text: text.replace("\r\n", ";\r\n"),
        lambda text: text.replace(";", '";"').replace("\r\n", '"\r\n"')[:-1].join(('"', "")),
        lambda text: text.replace(",", "."),
        lambda text: text.replace("-0", "\u22120"),
        lambda text: text.replace("12345", "12 345"),
    ],
)
def test_long_tables_are_read_alike_in_one_pass_and_cell_by_cell(
    spoil: Callable[[str], str],
) -> None:
    rows = "".join(f"{n};{0.25 * n:.2f};{-1.5 * n:.3f};{12345 + n}\r\n" for n in range(40))
    text = "Zeit;Weg;Kraft;Nr\r\ns;mm;N;\r\n" + rows.replace(".", ",")
    plain, odd = read(text), read(spoil(text))
    for name, values in plain.columns.items():
        assert values.tolist() == odd.columns[name].tolist()
    assert (odd.source.first_line, odd.source.last_line) == (3, 42)


def test_every_place_of_a_damaged_cell_in_a_long_table_is_said() -> None:
    rows = [f"{n};{0.25 * n:.2f};{1.5 * n:.3f}" for n in range(40)]
    head = "Zeit;Weg;Kraft\ns;mm;N\n"
    for cell, reason in (
        ("1..5", "not a number"), ("", "a blank cell"), ("OVER", "over-range text"),
        ("1,5", "a decimal comma in a file with decimal points"),
    ):  # fmt: skip
        spoilt = [*rows[:30], f"30;{cell};45", *rows[31:]]
        said = refused(head + "\n".join(spoilt) + "\n")
        assert "line 33, column 2: " in said
        assert reason in said
    assert "line 34: a blank line" in refused(head + "\n".join([*rows[:31], "", *rows[31:], ""]))
    assert "line 33, column 2: too few fields" in refused(
        head + "\n".join([*rows[:30], "30;7.5", *rows[31:], ""])
    )


def test_what_no_technique_asks_for_is_a_note() -> None:
    text = "Set,Time (s),Load (N),Stress (kPa),Travel (mm),Cycle,Date,,\n"
    rows = [f"run|1,{t},{n},{'N/A' if t < 1 else n},{mm},,1/6/2025,,\n" for t, mm, n in ROWS]
    recording = read(text + "".join(rows))
    assert is_curve(recording)
    assert list(recording.columns) == ["displacement_m", "force_N", "time_s"]
    assert recording.metadata["columns not used"] == "Set, Stress, Cycle, Date"


@pytest.mark.parametrize("label", ["Optische Dehnung", "AVE strain", "Déformation vidéo"])
def test_a_strain_whose_label_is_unknown_is_named(label: str) -> None:
    for head in (f"Time (s);Extension (mm);Load (N);{label} (%)", None):
        table = head or f"Time,Extension,Load,{label}\n(s),(mm),(N),(%)"
        rows = "".join(f"{i},{i},{i},{i}\n" for i in range(1, 5))
        recording = read(f"{table}\n{rows.replace(',', ';') if head else rows}")
        (flag,) = recording.flags
        assert flag.name == "columns-not-used"
        told = flag.detail.replace("_", " ").casefold()
        assert f"strain column '{label.casefold()}' has an unknown label" in told


def test_a_further_column_with_gaps_is_left_out_and_said() -> None:
    rows = "".join(f"{t}|{mm}|{n}|{'' if t else 0}\n" for t, mm, n in ROWS)
    recording = read("Time (s)|Extension (mm)|Load (N)|Tensile strain (%)\n" + rows)
    assert is_curve(recording)
    assert "nominal_strain" not in recording.columns
    assert [str(flag) for flag in recording.flags] == [
        "columns-not-used: cells that are no numbers: Tensile strain (line 3: a blank cell)"
    ]


def test_an_unknown_label_is_taken_where_one_column_has_the_unit() -> None:
    recording = read(table("Time (s),Travel (mm),Sensor 7 (N)"))
    plain = read(table("Time (s),Travel (mm),Sensor 7 (N)").replace("Travel", "Slide"))
    assert [flag.name for flag in plain.flags] == ["label-by-unit", "label-by-unit"]
    assert str(recording.flags[0]) == (
        "label-by-unit: Sensor 7 was taken for force_N: its label is unknown, and it is the only "
        "column in N"
    )


@pytest.mark.parametrize(
    ("header", "reason"),
    [
        (
            "Zeit,Weg,Kraft",
            "columns Zeit, Weg, Kraft found; no unit stands beside 'Weg' (displacement); no unit "
            "stands beside 'Kraft' (force)",
        ),
        ("Time (s),Cell A (N),Cell B (N)", "no column is the displacement (unit of m)"),
        ("Travel (mm),Cell A (N),Cell B (N)", "which column is the force? Cell A [N], Cell B [N]"),
        ("Time (s),Travel (mm),Load (lbs)", "the unit 'lbs' may be lbf (a force) or kg (a mass)"),
        ("Time (s),Travel (mm),Load (mm)", "'Load' is in mm, which is no unit of force"),
        ("Time (s),Travel (furlong),Load (kg)", "'Travel' has the unknown unit 'furlong'"),
        (
            "Load (N),Travel (mm),Load (N)",
            "duplicate column: columns 1 and 3 (Load, Load) are both force",
        ),
    ],
)
def test_everything_that_is_missing_is_said_at_once(header: str, reason: str) -> None:
    said = refused(table(header, "|"))
    assert reason in said
    assert said.startswith("x, line 1: no format recognises this file: ")


def test_a_comma_that_may_be_a_mark_or_between_thousands_is_refused() -> None:
    text = "Zeit;Weg;Kraft\ns;mm;N\n1;1,000;1,500\n2;2,000;3,250\n"
    assert "two readings fit: 1,000 is 1.000 with a decimal comma and 1000 with" in refused(text)


def test_points_between_thousands_beside_decimal_commas_are_refused() -> None:
    rows = "".join(f"{n};3.{n}10;22,{n}\n" for n in range(1, 9))
    said = refused("Time (min);Viscosity (cP);Temp (C)\n" + rows, "viscosity")
    assert "two readings fit: 3.110 is 3.110 with a decimal point and 3110 with a point" in said
    sound = read("Time (min);Viscosity (cP);Temp (C)\n" + rows.replace(",", "."), "viscosity")
    assert sound.columns["viscosity_Pas"][0] == pytest.approx(3.11e-3)


def test_thousands_are_read_where_a_decimal_point_proves_them() -> None:
    text = 'Zeit;Weg;Kraft\ns;mm;N\n1;0.5;"1,234.5"\n2;0.75;"2,345"\n'
    assert read(text).columns["force_N"].tolist() == [1234.5, 2345.0]
    text = "Zeit;Weg;Kraft\ns;mm;N\n1;0,5;1.234,5\n2;0,75;2 345,25\n"
    assert read(text).columns["force_N"].tolist() == [1234.5, 2345.25]


@pytest.mark.parametrize(
    ("cell", "reason"),
    [
        ("OVER", "line 3, column 3: over-range text in place of a number"),
        ("", "line 3, column 3: a blank cell"),
        ("9.9E37", "line 3, column 3: a number that stands for over-range"),
        ("1,5", "line 3, column 3: a decimal comma in a file with decimal points"),
        ("1.5;7", "line 3, column 5: too many fields: 5 where the first row has 4"),
        ("1.5;\nstopped", "line 4: a text row between the rows"),
        ("1.5;\n\n1;2;3", "line 4: a blank line between the rows"),
        ("1.5;\nTime (s);Gauge 4 (mm);Last (N)", "line 4: the header is repeated between the rows"),
    ],
)
def test_a_bad_cell_of_a_needed_column_is_refused(cell: str, reason: str) -> None:
    text = f"Time (s);Gauge 4 (mm);Last (N);\n0;0.1;0.5;\n1;0.2;{cell};\n2;0.3;0.7;\n"
    assert reason in refused(text)


def test_a_cut_file_is_refused() -> None:
    text = "Reading,Time (s),Travel (mm),Load (N)\n1,0,0.1,0.5\n2,1,0.2,0.7"
    assert "no line end after the last row" in refused(text)
    assert "the file seems cut" in refused(text[: text.rindex(",")] + "\n")
    assert "no data rows" in refused("Reading,Time (s),Travel (mm),Load (N)\n")


def test_results_above_and_a_running_number_without_label() -> None:
    results = '"Fmax";"dL"\nN;mm\n1234,5;0,5\n1300,1;0,6\n\n'
    rows = "".join(f"{i};{t};{mm};{n}\n".replace(".", ",") for i, (t, mm, n) in enumerate(ROWS))
    recording = read(results + ";Zeit (s);Weg (mm);Kraft (N)\n" + rows)
    assert is_curve(recording)
    assert recording.source.first_line == 7


def test_a_run_without_its_labels_above_is_refused() -> None:
    run = "1,0,0.1,0.5\n" * 6
    text = run + "Reading,Time (s),Travel (mm),Load (N)\n" + run
    assert "line 5: no format recognises this file: rows of numbers above" in refused(text)


@pytest.mark.parametrize("decimal", [".", ","])
def test_columns_aligned_by_blanks(decimal: str) -> None:
    rows = "".join(f"{t:8.2f} {mm:10.3f} {n:12.2f}\n" for t, mm, n in ROWS)
    head = "Test of a strip, nothing more\n  Time (s)   Crosshead travel (mm)    Load (N)\n"
    text = (head + rows).replace(".", decimal)
    recording = read(text.replace("Crosshead travel", "Travel"))
    assert is_curve(recording)
    assert (recording.source.first_line, recording.source.last_line) == (3, 5)
    assert "the file seems cut" in refused(text[: text.rindex(" ")] + "\n")


def test_two_tables_are_refused() -> None:
    first = "Reading,Time (s),Travel (mm),Load (N)\n" + "1,0,0.1,0.5\n" * 6
    other = "Reading,Time (s),Stroke (mm),Force (N)\n" + "1,0,0.1,0.5\n" * 6
    assert "two tables, below lines 1 and 8" in refused(first + other)


def test_the_technique_decides_what_a_label_means() -> None:
    text = "Displacement (nm),Load (uN)\n1,2\n3,4\n"
    assert "depth_m" in read(text, "nanoindentation").columns
    assert "displacement_m" in read(text, "tension").columns
    flow = read("Stress;Shear rate\nPa;1/s\n3,5;1\n7;2\n", "viscosity").columns
    assert flow["viscosity_Pas"].tolist() == [3.5, 3.5]


def test_a_run_at_one_rate_is_one_over_time() -> None:
    text = "Time (s),Shear rate (1/s),Viscosity (Pa s)\n1,10,2\n2,10.01,3\n"
    assert "shear_rate_per_s" not in read(text, "viscosity").columns


def test_angular_frequencies_and_negated_reactances() -> None:
    text = "omega (rad/s)\tRe(Z) (ohm)\t-Im(Z) (ohm)\n6.283185307\t1\t2\n62.83185307\t3\t4\n"
    columns = read(text, "permittivity").columns
    assert columns["frequency_Hz"].tolist() == pytest.approx([1.0, 10.0])
    assert columns["reactance_ohm"].tolist() == [-2.0, -4.0]


@pytest.mark.parametrize(
    ("written", "unit"),
    [("KPa", "kPa"), ("sec.", "s"), ("Mpa", "MPa"), ("dyne/cm\u00b2", "dyn/cm2"), ("Ohm", "ohm"),
     ("inches", "in"), ("N\u00b7m", "N\u00b7m"), ("RPM", "rpm"), ("mPa\u00b7s", "mPa\u00b7s")],
)  # fmt: skip
def test_units_as_instruments_write_them(written: str, unit: str) -> None:
    assert unit_as_written(written) == unit


@pytest.mark.parametrize("written", ["mpa", "MPA", "cps", "lb", "mhz"])
def test_units_that_may_be_two_are_refused_with_the_choices(written: str) -> None:
    with pytest.raises(UnknownUnit, match=f"the unit '{written}' may be .* or "):
        unit_as_written(written)


def test_the_vocabulary_is_in_the_form_in_which_it_is_looked_up() -> None:
    for words in vocabulary().values():
        assert all(plain_label(label) == label for label in words.labels)
    asked = {name for one in ASKED.values() for name in one.quantities}
    assert asked <= vocabulary().keys()
