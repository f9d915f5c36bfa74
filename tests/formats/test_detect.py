"""Exactly one format recognises a file, or the file is refused with what was found."""

from __future__ import annotations

import importlib
import re
from pathlib import Path

import pytest

from deamat import formats
from deamat.core.errors import ConfigError, RawFileError
from deamat.formats import FORMATS, detect, plain, tdms, workbook
from deamat.formats.format import Format
from deamat.formats.rawfile import Head, RawFile
from tests.formats.samples import BY_NAME, SAMPLES, Sample
from tests.formats.test_good_files import every_sample

EVERY = (*FORMATS, plain.FORMAT, tdms.FORMAT, workbook.FORMAT)
NAMES = ", ".join(form.name for form in EVERY)


def refused(data: bytes) -> str:
    with pytest.raises(RawFileError) as caught:
        detect.detect(RawFile("x", data))
    return str(caught.value)


@every_sample
def test_no_other_format_claims_a_file(sample: Sample) -> None:
    head = RawFile(sample.file, sample.data).head
    assert [form.name for form in FORMATS if form.recognises(head)] == [sample.format]


def test_every_format_has_a_sample_or_tests_of_its_own() -> None:
    others = [
        p.read_text()
        for p in Path(__file__).parent.glob("test_*.py")
        if p.name != Path(__file__).name
    ]
    for form in FORMATS:
        module = f"deamat.formats.{form.read.__module__.rpartition('.')[2]}"
        assert form.name in BY_NAME or any(
            module in text or f'"{form.name}"' in text for text in others
        )
    assert len(SAMPLES) == len(BY_NAME)


def test_an_unknown_file_is_described() -> None:
    assert refused(b"aa;bb;cc\n1;2;3\n4;5;6\n") == (
        "x, line 1: no format recognises this file: no table with labels and units (utf-8, "
        "probably semicolon-separated with 3 columns) (found 'aa;bb;cc'); export a table with a row "
        "of labels and the unit of each column, such as `Load (N)`, or name the format in the "
        "register's `format` column"
    )


def test_plain_prose_has_no_delimiter() -> None:
    assert "(utf-8, no delimiter) (found 'Dear colleague')" in refused(b"Dear colleague\n")


@pytest.mark.parametrize("data", [b"", b"\n \n", b"\xef\xbb\xbf", "\n".encode("utf-16")])
def test_an_empty_file_is_refused(data: bytes) -> None:
    assert refused(data) == "x: the file is empty; export the file again"


def test_two_formats_that_match_are_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    greedy = Format("greedy", "anything", lambda head: bool(head), FORMATS[0].read)
    monkeypatch.setattr(detect, "FORMATS", (*FORMATS, greedy))
    # With a line of its own above it shares no answer with the heads of other tests.
    data = b"claimed twice\n" + BY_NAME["phantom"].data
    assert "several formats recognise this file: phantom, greedy" in refused(data)


@pytest.mark.parametrize(
    "text",
    [
        "Wavelength (nm)\tAbsorbance\n400\t0.1\n",  # a spectrometer's
        "2theta;counts\n10.0;512\n",  # a diffractometer's
        "date,room,celsius\n2022-03-01,lab,21.5\n",  # a thermometer's
        "Step;Torque (mN.m);Angle (rad)\n1;0.1;500\n",  # a rheometer's
        "time_s,ch1_C,ch2_C\n0.0,0.1,0.2\n",  # a logger's
    ],
)
def test_other_instruments_are_ignored(text: str) -> None:
    assert "no format recognises this file" in refused(text.encode())


def test_a_format_can_be_named() -> None:
    assert [detect.by_name(form.name) for form in EVERY] == list(EVERY)


def test_an_unknown_name_is_refused_with_the_nearest() -> None:
    with pytest.raises(ConfigError) as caught:
        detect.by_name("bluhill")
    assert str(caught.value) == (
        f"there is no format 'bluhill'; there are {NAMES}; did you mean bluehill?"
    )


@pytest.mark.parametrize("form", EVERY, ids=lambda form: form.name)
def test_every_reader_documents_itself_under_the_same_headings(form: Format) -> None:
    module = importlib.import_module(f"deamat.formats.{form.name}")
    assert module.FORMAT is form
    headings = re.findall(r"^(\w+)\n-+\n\S", module.__doc__ or "", re.MULTILINE)
    assert headings == ["Usage", "Format", "Columns", "Uncertainties", "Metadata"]
    assert form.title


def test_the_list_holds_every_reader_there_is() -> None:
    folder = Path(formats.__file__).parent
    readers = {
        path.stem
        for path in folder.glob("*.py")
        if re.search(r"^FORMAT = Format\(", path.read_text(), re.MULTILINE)
    }
    assert readers == {form.name for form in EVERY}


def test_the_head_is_short_and_knows_no_line_ends() -> None:
    file = RawFile("x", b"a\r\nb\n" + b"1,2\r\n" * 5000)
    assert file.head == ["a", "b", *["1,2"] * 14]


def test_a_long_header_is_seen_to_its_64th_line() -> None:
    lines = [f"label {i};{i}" for i in range(80)]
    assert RawFile("x", "\n".join(lines).encode()).head == lines[:64]


@every_sample
def test_detection_looks_at_no_number(sample: Sample) -> None:
    """Heads that differ in the numbers of their rows share answers, so these must not differ."""
    file = RawFile(sample.file, sample.data)
    first = len(file.head) - file.head.rows
    digits = str.maketrans("0123456789", "7390518264")
    rows = [line.translate(digits) for line in file.head[first:]]
    other = Head([*file.head[:first], *rows])
    for form in FORMATS:
        assert form.recognises(other) == (form.name == sample.format)


def test_heads_with_the_same_header_share_what_was_found_out() -> None:
    asked = []

    def question(head: Head) -> str:
        asked.append(head[2])
        return head[0]

    rows = [f"{i}.5,-{i}.003" for i in range(20)]
    for header, lines in (("a", rows), ("a", rows[::-1]), ("b", rows), ("a", rows[:6])):
        text = "\n".join([header, "s,mm", *lines, ""])
        assert RawFile("x", text.encode()).once(question) == header
    assert asked == ["0.5,-0.003", "0.5,-0.003", "0.5,-0.003"]


@pytest.mark.parametrize("rows", [9, 10, 13, 14, 40])
@pytest.mark.parametrize("longest", [1, 150])
def test_a_remark_among_the_first_lines_is_seen_whatever_was_read_before(
    rows: int, longest: int
) -> None:
    def remarked(head: Head) -> bool:
        return "stopped" in head

    table = [f"header {rows} {longest}", "s,mm", *["0." + "5" * longest + ",1"] * rows]
    for lines in ([], ["stopped"], ["0.5,1"] * 60):
        file = RawFile("x", "\n".join([*table, *lines, ""]).encode())
        assert file.once(remarked) == remarked(file.head)


def test_offsets_find_the_line() -> None:
    file = RawFile("x", b"\xef\xbb\xbfab\nc\n")
    assert [file.offset(line) for line in range(4)] == [0, 3, 5, 5]
    assert file.body[file.offset(1) :] == b"c\n"
