"""Every corruption of every format: read as if whole, or refused by line, column and reason."""

from __future__ import annotations

import pytest

from deamat.core.errors import RawFileError
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from tests.formats.samples import BY_NAME, SAMPLES, Sample
from tests.formats.test_good_files import every_sample, read, same

ROW, COLUMN = 2, 1  # the spoilt cell, counted from 0
CELLS = {
    "OVER": "over-range text in place of a number",
    "OUT ": "over-range text in place of a number",
    "EEEE": "over-range text in place of a number",
    "----": "over-range text in place of a number",
    "-.-": "over-range text in place of a number",
    "9.9E37": "a number that stands for over-range (9.9E37 or beyond)",
    "-9.99999E+37": "a number that stands for over-range (9.9E37 or beyond)",
    "1e999": "a number too large to hold",
    "": "a blank cell",
    "NA": "a missing value written as text",
    "#N/A": "a missing value written as text",
    "NaN": "a missing value written as text",
    "-inf": "an infinite value",
    "1.5mm": "a unit behind the number",
    "1.5 N": "a unit behind the number",
    "12 %": "a unit behind the number",
    "1.5e": "an incomplete number",
    "-": "an incomplete number",
    "0x1F": "not a number",
    "1_000": "not a number",
    "1 000": "not a number",
    "--5": "not a number",
    "1.2.3": "not a number",
    "stop": "not a number",
    "١": "not a number",
}


def refused(file: RawFile) -> RawFileError:
    with pytest.raises(RawFileError) as caught:
        read(file)
    return caught.value


def facts(error: RawFileError) -> tuple[str, int | None, int | None, str | None]:
    return error.reason, error.line, error.column, error.value


@every_sample
@pytest.mark.parametrize(("text", "reason"), CELLS.items())
def test_a_bad_cell_is_refused_by_line_column_and_value(
    sample: Sample, text: str, reason: str
) -> None:
    text = text.replace(".", sample.decimal)
    cell = f'"{text}"' if sample.quoted else text
    error = refused(sample.with_cell(ROW, COLUMN, cell))
    assert facts(error) == (reason, sample.first + ROW, COLUMN + 1, cell.strip())
    assert error.hint


@every_sample
def test_an_extra_field_is_refused(sample: Sample) -> None:
    cells = sample.cells(ROW)
    error = refused(sample.with_cell(ROW, -1, cells[-1] + sample.delimiter + "1"))
    reason = f"too many fields: {sample.width + 1} where the header names {sample.width}"
    assert facts(error) == (reason, sample.first + ROW, sample.width + 1, "1")


@every_sample
def test_a_missing_field_is_refused(sample: Sample) -> None:
    lines = list(sample.lines)
    lines[sample.first - 1 + ROW] = sample.delimiter.join(sample.cells(ROW)[:-1])
    error = refused(sample.raw(lines))
    reason = f"too few fields: {sample.width - 1} where the header names {sample.width}"
    assert facts(error) == (reason, sample.first + ROW, sample.width - 1, sample.cells(ROW)[-2])


@every_sample
def test_a_short_last_row_seems_cut(sample: Sample) -> None:
    cells = sample.cells(len(sample.lines) - sample.first)
    short = sample.delimiter.join(cells[:-1])
    error = refused(sample.raw([*sample.lines[:-1], short]))
    reason = (
        f"too few fields: {sample.width - 1} where the header names {sample.width}; "
        "the file seems cut"
    )
    assert facts(error) == (reason, sample.last, sample.width - 1, cells[-2])


@every_sample
def test_the_wrong_decimal_mark_is_refused(sample: Sample) -> None:
    wrong = "0.5" if sample.decimal == "," else "0,5"
    cell = f'"{wrong}"' if sample.quoted else wrong
    error = refused(sample.with_cell(ROW, COLUMN, cell))
    place = (sample.first + ROW, COLUMN + 1, cell)
    if sample.decimal == ",":
        assert facts(error) == ("a decimal point in a file with decimal commas", *place)
    elif sample.delimiter == "," and not sample.quoted:
        assert error.reason.startswith("too many fields")
        assert error.hint.endswith("without thousands separators and with decimal points")
    else:
        assert facts(error) == ("a decimal comma in a file with decimal points", *place)


@every_sample
def test_thousands_separators_are_refused_where_they_are_not_documented(sample: Sample) -> None:
    cell = "1.234,5" if sample.decimal == "," else "1,234.5"
    error = refused(sample.with_cell(ROW, COLUMN, cell))
    if sample.delimiter == ",":
        assert error.reason.startswith("too many fields")
        assert error.line == sample.first + ROW
    else:
        reason = "a thousands separator, which this format does not use"
        assert facts(error) == (reason, sample.first + ROW, COLUMN + 1, cell)


@pytest.mark.parametrize("sample", [s for s in SAMPLES if not s.quoted], ids=lambda s: s.format)
def test_quotes_are_refused_where_they_are_not_documented(sample: Sample) -> None:
    error = refused(sample.with_cell(ROW, COLUMN, '"0"'))
    reason = "a quoted number, which this format does not use"
    assert facts(error) == (reason, sample.first + ROW, COLUMN + 1, '"0"')


@every_sample
def test_a_nul_byte_is_refused(sample: Sample) -> None:
    error = refused(sample.with_cell(ROW, COLUMN, "0\x000"))
    assert facts(error) == ("a NUL byte in a text file", sample.first + ROW, None, "\x00")


@every_sample
def test_a_repeated_header_is_refused(sample: Sample) -> None:
    at = sample.first + ROW
    error = refused(sample.raw([*sample.lines[:at], sample.header[-1], *sample.lines[at:]]))
    text = sample.header[-1]
    assert facts(error) == ("the header is repeated between the rows", at + 1, None, text)


@every_sample
def test_a_text_row_is_refused(sample: Sample) -> None:
    at = sample.first + ROW
    error = refused(sample.raw([*sample.lines[:at], "specimen slipped", *sample.lines[at:]]))
    assert facts(error) == ("a text row between the rows", at + 1, None, "specimen slipped")


@pytest.mark.parametrize("sample", [s for s in SAMPLES if not s.counted], ids=lambda s: s.format)
def test_a_blank_line_between_the_rows_is_refused(sample: Sample) -> None:
    at = sample.first + ROW
    error = refused(sample.raw([*sample.lines[:at], "", *sample.lines[at:]]))
    assert facts(error) == ("a blank line between the rows", at + 1, None, None)


@every_sample
def test_a_header_alone_is_refused(sample: Sample) -> None:
    error = refused(sample.raw(sample.header))
    reason = "no data rows: the file ends with its header"
    assert facts(error) == (reason, len(sample.header), None, None)


@every_sample
def test_a_file_cut_inside_its_last_number_is_refused(sample: Sample) -> None:
    cut = sample.lines[-1].rstrip('"')[:-1] if sample.format != "zwick" else sample.lines[-1]
    error = refused(sample.raw([*sample.lines[:-1], cut], end=""))
    last = cut.split('","' if sample.quoted else sample.delimiter)[-1]
    if sample.quoted:  # the closing quote is gone as well
        assert error.line == sample.last
        return
    reason = "no line end after the last row, so its last number may be cut"
    assert facts(error) == (reason, sample.last, sample.width, last)
    assert "set `ends_open = true` in campaign.toml" in error.hint


@every_sample
def test_a_file_cut_within_a_line_is_refused_wherever_it_is_cut(sample: Sample) -> None:
    """At every byte of the last two lines: a true prefix, or a refusal naming the line."""
    whole = sample.raw(sample.lines, encoding="utf-8").data
    lines = whole.split(b"\n")
    start = len(whole) - len(lines[-2]) - len(lines[-3]) - 2
    for end in range(start, len(whole)):
        rows = whole[:end].count(b"\n") - sample.first + 1
        file = RawFile("cut", whole[:end])
        if whole[:end].endswith(b"\n") and sample.counted:
            assert refused(file).reason.endswith("; the file seems cut")
        elif whole[:end].endswith(b"\n"):
            assert same(read(file), sample.columns(rows))
        else:
            assert refused(file).line == sample.first + rows


@pytest.mark.parametrize("sample", [s for s in SAMPLES if not s.counted], ids=lambda s: s.format)
def test_a_file_cut_between_two_lines_is_a_true_prefix(sample: Sample) -> None:
    recording = read(sample.raw(sample.lines[:-2]))
    rows = len(sample.lines) - 2 - len(sample.header)
    assert same(recording, sample.columns(rows))
    assert recording.source.last_line == sample.last - 2


@every_sample
def test_lone_carriage_returns_are_no_line_ends(sample: Sample) -> None:
    file = RawFile("x", "\r".join([*sample.lines, ""]).encode())
    assert "no format recognises this file" in refused(file).reason


def test_the_twelve_corruptions_in_their_exact_words() -> None:
    """What the user reads, word for word, for the plainest of the formats."""
    phantom = BY_NAME["phantom"]
    at, export = phantom.lines.index, "export the file again"
    third = phantom.lines[phantom.first - 1 + ROW]
    assert at(third) == 9
    rows = {
        "OVER": "phantom.csv, line 10, column 2: over-range text in place of a number "
        "(found 'OVER'); repeat the test within the instrument's range, or exclude the file",
        "": "phantom.csv, line 10, column 2: a blank cell (found ''); "
        f"{export} with every reading in every row",
        "NA": "phantom.csv, line 10, column 2: a missing value written as text (found 'NA'); "
        f"{export} with every reading in every row",
        "0.028,1": "phantom.csv, line 10, column 6: too many fields: 6 where the header names 5 "
        f"(found '-0.013909'); {export}, without thousands separators and with decimal points",
        "0\x00": "phantom.csv, line 10: a NUL byte in a text file (found '\\x00'); "
        f"{export} as UTF-8 text",
        "9.9E37": "phantom.csv, line 10, column 2: a number that stands for over-range (9.9E37 or "
        "beyond) (found '9.9E37'); repeat the test within the instrument's range, or exclude the "
        "file",
    }
    for cell, message in rows.items():
        assert str(refused(phantom.with_cell(ROW, COLUMN, cell))) == message
    files = {
        phantom.raw([*phantom.lines[:-1], "0.7,0.1,0.2,0.3"]): "phantom.csv, line 15, column 4: "
        "too few fields: 4 where the header names 5; the file seems cut (found '0.3'); "
        f"{export}",
        phantom.raw([*phantom.lines, phantom.header[-1]]): "phantom.csv, line 16: the header is "
        f"repeated between the rows (found {phantom.header[-1]!r}); one file holds one run: "
        "export each run to a file of its own",
        phantom.raw(phantom.header): "phantom.csv, line 7: no data rows: the file ends with its "
        f"header; {export}",
        phantom.raw(phantom.lines, end=""): "phantom.csv, line 15, column 5: no line end after "
        f"the last row, so its last number may be cut (found '-0.103988'); {export}; if this "
        "exporter never writes a final line end, set `ends_open = true` in campaign.toml",
    }
    for file, message in files.items():
        assert str(refused(file)) == message


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_utf_16_without_its_mark_is_read_unless_it_is_cut(encoding: str) -> None:
    text = "\n".join([*BY_NAME["nexygen"].lines, ""])
    recording = read(RawFile("x", text.encode(encoding)))
    assert recording.source.encoding == encoding
    assert len(recording.columns["force_N"]) > 1
    error = refused(RawFile("x", text.encode(encoding)[:-1]))
    assert error.reason == "a NUL byte in a text file"


def test_utf_16_cut_inside_a_character_is_refused() -> None:
    data = BY_NAME["nexygen"].data[:-1]
    error = refused(RawFile("x", data))
    assert error.reason == f"starts as UTF-16 but breaks at byte {len(data) - 1}"


def test_latin_1_is_read_where_utf_8_fails() -> None:
    text = "Bemerkung: künstlich\nTime (s),Load (µN)\n0.1,5\n"
    recording = read(RawFile("x", text.encode("latin-1")))
    assert recording.source.encoding == "latin-1"
    assert recording.metadata == {"Bemerkung": "künstlich"}
    assert recording.columns["force_N"][0] == 5 * 1e-6


@every_sample
def test_a_wrongly_named_format_is_refused(sample: Sample) -> None:
    other = {"bluehill": "mark10", "mark10": "soro"}.get(sample.format, "bluehill")
    with pytest.raises(RawFileError, match=f"no row of labels and units as the {other} form"):
        detect(BY_NAME[other].raw(BY_NAME[other].lines)).read(sample.raw(sample.lines))
