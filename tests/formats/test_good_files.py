"""Every reader on its good file, in every encoding and with every line end."""

from __future__ import annotations

import hashlib
from dataclasses import replace

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.recording import Recording
from deamat.formats.detect import by_name, detect
from deamat.formats.rawfile import RawFile
from tests.formats.samples import SAMPLES, Sample

every_sample = pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: sample.format)


def read(file: RawFile) -> Recording:
    return detect(file).read(file)


def same(recording: Recording, columns: dict[str, FloatArray]) -> bool:
    """The same names in the same order with the same bits."""
    return list(recording.columns) == list(columns) and all(
        recording.columns[name].tobytes() == values.tobytes() for name, values in columns.items()
    )


@every_sample
def test_every_column_comes_out_in_si_bit_for_bit(sample: Sample) -> None:
    recording = read(RawFile(sample.file, sample.data))
    assert same(recording, sample.columns())
    assert all(values.dtype == np.float64 for values in recording.columns.values())


@every_sample
def test_the_recording_says_where_it_comes_from(sample: Sample) -> None:
    recording = read(RawFile(sample.file, sample.data))
    assert recording.source.path == sample.file
    assert recording.source.sha256 == hashlib.sha256(sample.data).hexdigest()
    assert (recording.source.first_line, recording.source.last_line) == (sample.first, sample.last)
    assert recording.source.encoding == sample.encoding
    assert recording.source.reader == sample.format


@every_sample
def test_header_units_and_flags_are_kept(sample: Sample) -> None:
    recording = read(RawFile(sample.file, sample.data))
    assert sample.metadata.items() <= recording.metadata.items()
    assert sample.units.items() <= recording.column_units.items()
    assert tuple(flag.name for flag in recording.flags) == sample.flags
    assert "synthetic" in " ".join(recording.metadata.values()).casefold()


@every_sample
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_encoding_and_line_ends_change_no_number(
    sample: Sample, encoding: str, newline: str
) -> None:
    file = replace(sample, newline=newline).raw(sample.lines, encoding=encoding)
    recording = read(file)
    assert same(recording, sample.columns())
    assert recording.source.encoding == encoding


@every_sample
def test_big_endian_utf_16_is_read(sample: Sample) -> None:
    file = RawFile("x", b"\xfe\xff" + "\n".join([*sample.lines, ""]).encode("utf-16-be"))
    assert same(read(file), sample.columns())


@every_sample
@pytest.mark.parametrize("blank", ["", "   "])
def test_blank_lines_at_the_end_are_fine(sample: Sample, blank: str) -> None:
    recording = read(sample.raw([*sample.lines, "", blank]))
    assert same(recording, sample.columns())
    assert recording.source.last_line == sample.last


@every_sample
def test_blank_lines_above_the_rows_are_fine(sample: Sample) -> None:
    rows = sample.lines[sample.first - 1 :]
    recording = read(sample.raw([*sample.header, "", *rows]))
    assert same(recording, sample.columns())
    assert recording.source.first_line == sample.first + 1


@every_sample
def test_a_campaign_may_declare_that_files_end_open(sample: Sample) -> None:
    closed = sample.raw(sample.lines, end="")
    assert same(read(replace(closed, ends_open=True)), sample.columns())


@every_sample
def test_unusual_but_plain_numbers_are_read(sample: Sample) -> None:
    """The slow reader takes what is unambiguous, and both readers agree on the rest."""
    usual = ("0.500", "5.000", "7.000", "-0.000", "3.000", "0.00012")
    unusual = ("+.5", "5.", "007", "-0", " 3 ", "1.2E-004")
    column = list(sample.written).index("force_N") if "force_N" in sample.written else -1
    for plain, odd in zip(usual, unusual, strict=True):
        text = odd.replace(".", sample.decimal)
        recording = read(sample.with_cell(2, column, f'"{text}"' if sample.quoted else text))
        name = list(recording.columns)[column]
        factor = sample.written[name][1]
        expected = np.float64(plain) * factor
        assert recording.columns[name][2].tobytes() == expected.tobytes()


@every_sample
def test_its_format_can_be_named(sample: Sample) -> None:
    file = RawFile(sample.file, sample.data)
    assert by_name(sample.format) is detect(file)


def test_numbers_may_stand_without_quotes_in_a_bluehill_file() -> None:
    """Some exports quote only the numbers that carry thousands commas, others none."""
    head = "Time,Extension,Load\n(s),(mm),(kN)\n"
    mixed = RawFile("x", (head + '0.0,0.1,"1,234.5"\n0.1,"0.2",3\n').encode())
    plain = RawFile("x", (head + "0.0,0.1,1234.5\n0.1,0.2,3\n").encode())
    assert list(read(mixed).columns["force_N"]) == [1234500.0, 3000.0]
    assert same(read(mixed), dict(read(plain).columns))


def test_mts_units_may_stand_in_a_row_of_their_own() -> None:
    text = "Name:\tsynthetic\r\n\r\nCrosshead\tLoad\tTime\r\nmm\tkN\ts\r\n0,5\t0,25\t0\r\n"
    recording = read(RawFile("x", text.encode()))
    assert {name: values[0] for name, values in recording.columns.items()} == {
        "displacement_m": 0.0005,
        "force_N": 250.0,
        "time_s": 0.0,
    }
    assert recording.source.first_line == 5
