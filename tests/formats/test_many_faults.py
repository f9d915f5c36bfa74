"""All that is wrong with a file is said at once: the first fault in full, others by their place."""

from __future__ import annotations

import pickle

import pytest

from deamat.core.errors import RawFileError
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from tests.formats.test_rewritten import TEKTRONIX

HEAD = "Zeit;Kraft;Weg\ns;N;mm\n"


def refused(text: str, technique: str = "compression") -> RawFileError:
    file = RawFile("c/x.csv", text.encode(), technique=technique)
    with pytest.raises(RawFileError) as caught:
        detect(file).read(file)
    return caught.value


def test_cells_of_several_rows_and_columns() -> None:
    error = refused(HEAD + "0;1;2\n1;x;2\n2;3;y\n3;OVER;5\n")
    assert str(error) == (
        "c/x.csv, line 4, column 2: not a number (found 'x'); export the file again, or correct "
        "the export settings; 2 more: line 5, column 3: not a number (found 'y'); line 6, column 2: "
        "over-range text in place of a number (found 'OVER')"
    )
    assert [(one.line, one.column) for one in error.others] == [(5, 3), (6, 2)]


def test_rows_of_another_length_and_cells_together() -> None:
    error = refused(HEAD + "0;1;2\n1;2\n\n2;x;3\n3;4;5;6\n")
    places = [(one.line, one.column) for one in (error, *error.others)]
    assert places == [(4, 2), (5, None), (6, 2), (7, 4)]


def test_many_faults_are_counted() -> None:
    error = refused(HEAD + "0;1;2\n" + "1;x;2\n" * 20 + "2;3;4\n")
    assert len(error.others) == 19
    assert str(error).endswith("line 8, column 2: not a number (found 'x'); and 15 further")


def test_a_form_by_name_says_all_of_them_too() -> None:
    text = '"Time","Extension","Load"\n"(s)","(mm)","(N)"\n'
    rows = ["0.0", "x", "2.0"], ["1.0", "2.0", "OVER"], ["2.0", "3.0", "1.0"]
    error = refused(text + "".join(",".join(f'"{c}"' for c in row) + "\n" for row in rows))
    assert [(one.line, one.column) for one in (error, *error.others)] == [(3, 2), (4, 3)]


def test_all_units_and_labels_that_are_missing_are_said() -> None:
    assert "no unit stands beside 'Weg' (displacement); no unit stands beside 'Kraft' (force)" in (
        refused("Kraft;Weg\n1;2\n2;3\n").reason
    )


def test_lines_of_a_rewritten_form_are_those_of_the_file() -> None:
    error = refused(TEKTRONIX.replace("150.0", "x").replace("450.0", "y"), "breakdown")
    assert [one.line for one in (error, *error.others)] == [2, 4]


def test_an_error_survives_the_way_from_a_worker() -> None:
    error = refused(HEAD + "0;1;2\n1;x;2\n2;3;y\n")
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


def test_columns_that_may_be_left_out_are_no_faults() -> None:
    file = RawFile("c/x.csv", (HEAD + "x;1;2\n1;2;3\ny;3;4\n").encode(), technique="compression")
    recording = detect(file).read(file)
    assert "time_s" not in recording.columns
    assert [flag.name for flag in recording.flags] == ["columns-not-used"]
