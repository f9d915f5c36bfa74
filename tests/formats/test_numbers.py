"""Fast path, slow path and Python's float agree bit for bit; a spoilt byte is never misread."""

from __future__ import annotations

import csv
import math
import re

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from deamat.core.arrays import FloatArray
from deamat.core.errors import RawFileError
from deamat.formats.cells import Dialect, read_cells
from deamat.formats.numbers import parse, read_block
from deamat.formats.quoted import unquote
from deamat.formats.rawfile import RawFile

COMMA, SEMICOLON, TAB = Dialect(","), Dialect(";"), Dialect("\t")
DECIMAL_COMMA, QUOTED = Dialect("\t", decimal=","), Dialect(",", quoted=True)
DIALECTS = (COMMA, SEMICOLON, TAB, DECIMAL_COMMA, QUOTED)
PRINTED = ("{!r}", "{:.6f}", "{:.17e}", "{:g}", "{:.0f}", "{:+.3e}")

floats = st.floats(allow_nan=False, allow_infinity=False, min_value=-9e37, max_value=9e37)


@st.composite
def tables(draw: st.DrawFn) -> tuple[list[list[str]], Dialect]:
    """Rows of printed numbers, and how they are to be written."""
    dialect = draw(st.sampled_from(DIALECTS))
    columns = draw(st.integers(1, 4))
    number = st.builds(str.format, st.sampled_from(PRINTED), floats)
    rows = st.lists(number, min_size=columns, max_size=columns)
    return draw(st.lists(rows, min_size=1, max_size=6)), dialect


def write(rows: list[list[str]], dialect: Dialect, newline: str = "\n") -> bytes:
    lines = [
        dialect.delimiter.join(
            f'"{cell}"' if dialect.quoted and (at + len(row)) % 3 else cell
            for at, cell in enumerate(row)
        )
        for row in rows
    ]
    return newline.join([*lines, ""]).replace(".", dialect.decimal).encode()


def bits(table: FloatArray | None) -> bytes:
    assert table is not None
    return table.tobytes()


@given(tables(), st.sampled_from(["\n", "\r\n"]))
def test_fast_slow_and_float_agree_bit_for_bit(
    table: tuple[list[list[str]], Dialect], newline: str
) -> None:
    rows, dialect = table
    file = RawFile("x", write(rows, dialect, newline))
    columns = len(rows[0])
    truth = np.array([[float(cell) for cell in row] for row in rows])
    text = write(rows, dialect).decode().rstrip("\n")
    slow = read_cells(file, text, 1, columns, dialect, ended=True)
    assert bits(read_block(file, 0, columns, dialect)) == bits(truth)
    assert bits(slow) == bits(truth)
    fast = parse(text.replace("\n", newline).encode(), columns, dialect)
    assert fast is None or bits(fast) == bits(truth)


@given(st.lists(floats, min_size=2, max_size=30))
def test_plain_numbers_take_the_fast_path(values: list[float]) -> None:
    text = "\n".join(f"{value!r},{value:.4f}" for value in values).encode()
    truth = np.array([[value, float(f"{value:.4f}")] for value in values])
    assert bits(parse(text, 2, COMMA)) == bits(truth)


@given(st.lists(st.floats(-1e12, 1e12), min_size=1, max_size=30))
def test_thousands_commas_in_quotes_take_the_fast_path(values: list[float]) -> None:
    text = "\n".join(f'"{value:,.3f}","{value:,.0f}",1' for value in values).encode()
    truth = np.array([[float(f"{v:.3f}"), float(f"{v:.0f}"), 1.0] for v in values])
    file = RawFile("x", text + b"\n")
    assert bits(read_block(file, 0, 3, QUOTED)) == bits(truth)
    assert unquote(text) is not None


def oracle(data: bytes, columns: int, dialect: Dialect) -> FloatArray | None:
    """What Python's own parts make of a file, or None where they find something wrong."""
    try:
        text = data.decode()
        if not text.endswith("\n"):
            return None
        lines = text.replace("\r\n", "\n").rstrip(" \n").split("\n")
        rows = [line.split(dialect.delimiter) for line in lines]
        if dialect.quoted:
            tight = [re.sub(r"[ \t]*,[ \t]*", ",", line.strip(" \t")) for line in lines]
            rows = [next(csv.reader([line], strict=True)) for line in tight]
            rows = [[cell.replace(",", "") for cell in row] for row in rows]
        if dialect.decimal == ",":
            rows = [[c.replace(".", "?").replace(",", ".") for c in row] for row in rows]
        values = [[float(cell) for cell in row] for row in rows]
    except (ValueError, csv.Error, StopIteration):
        return None
    if any(len(row) != columns or not all(map(math.isfinite, row)) for row in values):
        return None
    return np.array(values)


@settings(max_examples=400)
@given(
    tables(),
    st.floats(0, 1, exclude_max=True),
    st.sampled_from(["replace", "insert", "delete", "cut"]),
    st.sampled_from(b"0123456789+-.,;\t \r\n\"eE_xN\x00\xb5'[]{}:/"),
)
@example(([["1", "2"], ["-0", "3"]], COMMA), 0.0, "replace", ord("2"))
@example(([["1e5", "2"]], COMMA), 0.9, "insert", ord("0"))
def test_a_spoilt_byte_is_refused_or_harmless(
    table: tuple[list[list[str]], Dialect], where: float, how: str, byte: int
) -> None:
    rows, dialect = table
    data = write(rows, dialect)
    at = int(where * len(data))
    spoilt = {
        "replace": data[:at] + bytes([byte]) + data[at + 1 :],
        "insert": data[:at] + bytes([byte]) + data[at:],
        "delete": data[:at] + data[at + 1 :],
        "cut": data[:at],
    }[how]
    expected = oracle(spoilt, len(rows[0]), dialect)
    refused: RawFileError | None = None
    try:
        found: FloatArray | None = read_block(RawFile("x", spoilt), 0, len(rows[0]), dialect)
    except RawFileError as error:
        refused, found = error, None
    assert (refused is None) != (found is None)
    if refused is not None:
        assert refused.reason
        assert refused.line is not None
    else:
        assert expected is not None
        assert bits(found) == bits(expected)


@pytest.mark.parametrize("text", [b"-0,1", b"1,-0", b"-0 ,1", b"1,2\n3,-0"])
def test_the_sign_of_an_integer_zero_survives(text: bytes) -> None:
    assert parse(text, 2, COMMA) is None
    table = read_block(RawFile("x", text + b"\n"), 0, 2, COMMA)
    assert np.signbit(table).sum() == 1


@pytest.mark.parametrize(
    "text",
    [
        b"1,,2",
        b"1;2,3",
        b"01,2,3",
        b"1,2,+-3",
        b"1,2,+ 3",
        b"1,2,3\n",
        b"1,2\n3,4,5,6",
        b"[1],2,3",
        b"1,2,NaN",
    ],
)
def test_the_fast_path_leaves_the_uncertain_alone(text: bytes) -> None:
    assert parse(text, 3, COMMA) is None


@pytest.mark.parametrize(
    "text",
    [
        b"1,2\r\n3\r,4",
        b"1,2\r\n3,\r4",
        b"1,\r2\n3,4",
        b"1,2\r \n3,4",
        b"1,2\r\n3,4\r",
        b"\r1,2\r\n3,4",
        b"1,2\r\r\n3,4",
    ],
)
@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r \n"])
def test_a_carriage_return_belongs_before_a_line_feed(text: bytes, end: bytes) -> None:
    assert parse(text, 2, COMMA) is None
    if text.endswith(b"\r") and end == b"\n":
        return  # together they are a line end
    with pytest.raises(RawFileError, match=r"not a number|a text row"):
        read_block(RawFile("x", text + end), 0, 2, COMMA)


@pytest.mark.parametrize("newline", [b"\n", b"\r\n"])
@pytest.mark.parametrize("end", [b"", b" ", b"\n \n", b"\r\n\n", b" \r\n"])
def test_line_ends_of_both_kinds_and_blank_ends_are_fine(newline: bytes, end: bytes) -> None:
    text = newline.join([b"1,-0", b"3,4", b"5 , 6"]) + end + newline
    table = read_block(RawFile("x", text), 0, 2, COMMA)
    assert bits(table) == bits(np.array([[1.0, -0.0], [3.0, 4.0], [5.0, 6.0]]))
    assert bits(read_block(RawFile("x", b"1,2\n3,4\r\n5,6\n"), 0, 2, COMMA)) == bits(
        np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]])
    )


@pytest.mark.parametrize(
    "text",
    [
        b'"1,23","2"',  # a group of two
        b'"1,2345","2"',  # a group of four
        b'"1234,567","2"',  # four digits before a group
        b'",123","2"',  # none before it
        b'"1.5,000","2"',  # a group behind the point
        b'"1e5,000","2"',  # and in an exponent
        b'"1e-5,000","2"',
        b'"1,","2"',
        b'"0,123","2"',  # a decimal comma, rather
        b'"1","2',
        b'"1"0,"2"',
        b'0"1","2"',
        b'"1""2","3"',
        b'"1,234"5,"2"',
    ],
)
def test_doubtful_quotes_and_groups_are_refused(text: bytes) -> None:
    with pytest.raises(RawFileError):
        read_block(RawFile("x", text + b"\n"), 0, 2, QUOTED)


def test_a_large_block_is_read_in_parts() -> None:
    rows = 90_000
    truth = np.arange(3 * rows, dtype=np.float64).reshape(rows, 3) / 8
    text = "\n".join(f"{a!r},{b!r},{c!r}" for a, b, c in truth.tolist()).encode()
    assert len(text) > 2 << 20
    assert bits(parse(text, 3, COMMA)) == bits(truth)
    assert bits(parse(text.replace(b"\n", b"\r\n"), 3, COMMA)) == bits(truth)
    spoilt = text[:-1] + b"x"
    assert parse(spoilt, 3, COMMA) is None
    with pytest.raises(RawFileError, match=rf"x, line {rows}, column 3: "):
        read_block(RawFile("x", spoilt + b"\n"), 0, 3, COMMA)


def test_a_line_longer_than_any_part_is_not_lost() -> None:
    text = b"1," + b"0" * (1 << 20) + b".5\n2,3\n"
    assert read_block(RawFile("x", text), 0, 2, COMMA).tolist() == [[1.0, 0.5], [2.0, 3.0]]


def test_one_empty_field_is_a_blank_cell() -> None:
    with pytest.raises(RawFileError, match="x, line 1, column 1: a blank cell"):
        read_block(RawFile("x", b'""\n'), 0, 1, QUOTED)


def test_a_line_end_inside_quotes_is_refused() -> None:
    assert unquote(b'"1\n2"') is None
    with pytest.raises(RawFileError):
        read_block(RawFile("x", b'"1\n2"\n'), 0, 1, QUOTED)
