"""Registers as spreadsheet programs of any country save them: text of four kinds, or a workbook."""

from __future__ import annotations

import zipfile
from io import BytesIO

import pytest

from deamat.core.errors import RawFileError
from deamat.core.instruments import Gauge
from deamat.core.register import Register, read_register
from deamat.core.register_table import read_table
from deamat.core.sheets import read_sheets, write_workbook

_PATH = "demo/compression/specimens.csv"
_PLAIN = (
    "specimen,material,file,diameter_mm,height_mm,comment\n"
    "s1,gel-a,gel-a/s1.csv,28.5,12.25,schön\n"
    "s2,gel-a,gel-a/s2.csv,28.4,12.5,\n"
)


def _read(data: bytes) -> Register:
    required = ("diameter_m", "height_m")
    return read_register(data, _PATH, "demo", "compression", required, {"diameter": Gauge()})


def _german(text: str) -> str:
    return text.replace(",", ";").replace(".5", ",5").replace(".4", ",4").replace(".25", ",25")


@pytest.mark.parametrize(
    "data",
    [
        _PLAIN.encode("utf-8-sig"),
        _PLAIN.encode("cp1252"),
        _PLAIN.encode("utf-16"),
        _PLAIN.replace("\n", "\r\n").encode(),
        _PLAIN.replace(",", "\t").encode(),
        _PLAIN.replace(",", ";").encode("cp1252"),
        _german(_PLAIN).encode("cp1252"),
        ("sep=;\r\n" + _german(_PLAIN)).encode("cp1252"),
        _german(_PLAIN).replace("\n", ";;;\r\n").encode("cp1252"),
        _PLAIN.replace("specimen,material,file,", "Specimen,MATERIAL,File,").encode(),
        _german(_PLAIN).replace("diameter_mm", "Diameter [mm]").encode(),
        (_german(_PLAIN) + ";;;;;\r\n").encode(),
        _PLAIN.replace("\n", ",,\n").encode(),
    ],
)
def test_every_way_to_save_a_register_reads_the_same(data: bytes) -> None:
    plain, read = _read(_PLAIN.encode()), _read(data)
    assert read.errors == ()
    for one, other in zip(plain.specimens, read.specimens, strict=True):
        assert other.numbers == one.numbers
        assert (other.id, other.material, other.file) == (one.id, one.material, one.file)
        assert other.notes == one.notes
    assert read.specimens[0].numbers["diameter_m"].value == 0.0285


def test_a_workbook_reads_the_same_whatever_other_sheets_say() -> None:
    rows: list[list[str | float]] = [
        ["Compression, March"],
        ["specimen", "material", "file", "Diameter [mm]", "height_mm", "comment", ""],
        ["s1", "gel-a", "gel-a/s1.csv", 28.5, 12.25, "schön", ""],
        ["s2", "gel-a", "gel-a/s2.csv", 28.4, "12.5", "", ""],
    ]
    read = _read(write_workbook({"Specimens": rows}))
    assert read.errors == ()
    assert [s.numbers for s in read.specimens] == [
        s.numbers for s in _read(_PLAIN.encode()).specimens
    ]
    assert [s.line for s in read.specimens] == [3, 4]


def test_decimal_commas_that_may_be_thousands_are_left_open() -> None:
    text = "specimen;material;diameter_mm;height_mm\ns1;gel-a;{};{}\n"
    told = _read(text.format("28,500", "12,250").encode())
    assert told.specimens == ()
    assert told.errors[0][1].reason == "not a number"
    told = _read(text.format("28,500", "12,5").encode())
    assert told.specimens[0].numbers["diameter_m"].value == pytest.approx(0.0285)
    both = _read(text.format("28,5", "12.25").encode())
    assert both.specimens == ()


@pytest.mark.parametrize(
    "data",
    [
        _PLAIN.encode() + b"s3,gel-\xff,x.csv,28,12,\n",  # UTF-8 and a stray byte
        _PLAIN.replace("schön", "x").encode() + b"s3,gel-\x81,x.csv,28,12,\n",  # no cp1252
        _PLAIN.replace("schön", "x").encode() + b"s3,gel-\xa4,x.csv,28,12,\n",  # no letter
    ],
)
def test_what_is_neither_utf8_nor_ansi_is_refused(data: bytes) -> None:
    with pytest.raises(RawFileError, match=r"neither UTF-8 nor ANSI \(cp1252\)"):
        _read(data)


def test_fields_beyond_the_header_must_be_empty() -> None:
    read = _read((_PLAIN + "s3,gel-a,c.csv,28,12,,,x\n").encode())
    assert [error.reason for _, error in read.errors] == ["8 fields where the header has 6"]


def test_a_damaged_workbook_is_refused() -> None:
    data = write_workbook({"s": [["specimen", "material"]]})
    with pytest.raises(RawFileError, match="a workbook that cannot be read"):
        _read(data[:200])
    with pytest.raises(RawFileError, match="no sheet has the columns specimen and material"):
        _read(write_workbook({"s": [["a", "b"]]}))


def test_a_written_sheet_says_what_was_written() -> None:
    rows: list[list[str | float]] = [["=1+1", 'a<b&"c"'], [1.5, "  x"], ["", 2.0]]
    data = write_workbook({"Sheet <1>": rows})
    assert read_sheets(data, "x.xlsx") == [
        ("Sheet <1>", [["=1+1", 'a<b&"c"'], ["1.5", "x"], ["", "2"]])
    ]
    assert data == write_workbook({"Sheet <1>": rows})
    with zipfile.ZipFile(BytesIO(data)) as archive:
        assert b"<f>" not in archive.read("xl/worksheets/sheet1.xml")


def test_the_header_tells_the_separator() -> None:
    text = "specimen;material;comment\ns1;gel-a;thin, soft, wet, old\n"
    table = read_table(text.encode(), _PATH, ["specimen", "material"])
    assert table.separator == ";"
    assert table.rows == ((2, ["s1", "gel-a", "thin, soft, wet, old"]),)


def test_known_names_may_be_written_in_capitals_and_with_blanks() -> None:
    text = "Specimen;Material;File;Diameter [mm];height_mm;Tested on;AGE;Batch\n"
    read = _read((text + "s1;gel-a;x.csv;28;12;2026-03-12;2 months;7\n").encode())
    (row,) = read.specimens
    assert (row.id, row.material, row.file) == ("s1", "gel-a", "demo/compression/x.csv")
    assert row.conditions == {"age": "2 months"}
    assert row.notes == {"tested_on": "2026-03-12", "Batch": "7"}


def test_a_known_name_in_two_spellings_is_a_duplicate() -> None:
    with pytest.raises(RawFileError, match="not a known column, but nearly one"):
        _read(b"specimen,material,diameter_mm,height_mm,age,Age\ns1,gel-a,28,12,1 d,2 d\n")
    with pytest.raises(RawFileError, match="duplicate column"):
        _read(b"specimen,material,diameter_mm,height_mm,AGE,Age\ns1,gel-a,28,12,1 d,2 d\n")
