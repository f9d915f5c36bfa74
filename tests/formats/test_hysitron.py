"""Hysitron text: segments parted by blank lines, and a number of points that must be right."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from deamat.core.errors import RawFileError
from deamat.core.recording import Recording
from deamat.formats.detect import detect
from deamat.formats.hysitron import FORMAT
from deamat.formats.rawfile import RawFile
from tests.formats.samples import BY_NAME
from tests.formats.test_good_files import same

SAMPLE = BY_NAME["hysitron"]
HEADER, ROWS = SAMPLE.header, SAMPLE.lines[SAMPLE.first - 1 :]


def _refused(lines: list[str]) -> str:
    with pytest.raises(RawFileError) as caught:
        FORMAT.read(SAMPLE.raw(lines))
    return str(caught.value)


def _read(lines: list[str]) -> Recording:
    return FORMAT.read(SAMPLE.raw(lines))


def test_blank_lines_part_segments_and_keep_every_line_number() -> None:
    recording = _read([*HEADER, *ROWS[:3], "", *ROWS[3:6], "", *ROWS[6:]])
    assert same(recording, SAMPLE.columns())
    assert (recording.source.first_line, recording.source.last_line) == (5, 14)
    assert "line 9, column 2: over-range text" in _refused(
        [*HEADER, *ROWS[:3], "", "1.0\tOVER\t0.3\t0\t0", *ROWS[4:]]
    )
    twice = _read([*HEADER, *ROWS[:3], "", ROWS[2], *ROWS[4:]])
    assert [str(flag) for flag in twice.flags] == [
        "identical-rows: rows equal to the row before in every column: 1, the first in line 9; "
        "none was dropped"
    ]


def test_a_file_cut_between_two_lines_is_refused_by_its_number_of_points() -> None:
    assert _refused([*HEADER, *ROWS[:6]]) == (
        "hysitron.txt, line 10: 6 rows where line 3 states 8 points; the file seems cut; "
        "export the file again"
    )


def test_more_rows_than_stated_are_refused() -> None:
    assert _refused([*HEADER, *ROWS, ROWS[-1]]) == (
        "hysitron.txt, line 13: 9 rows where line 3 states 8 points; export the file again"
    )


def test_a_header_without_a_count_is_refused() -> None:
    assert _refused([*HEADER[:2], "Number of Points = many", HEADER[3], *ROWS]) == (
        "hysitron.txt, line 3: Number of Points is not a count (found 'many'); "
        "export the file again"
    )
    assert _refused([*HEADER[:2], HEADER[3], *ROWS]) == (
        "hysitron.txt, line 3: no line `Number of Points = ` above the labels, so a cut file would "
        "not show; export the file again"
    )


@pytest.mark.shared
def test_the_real_file_is_read_whole(shared: Path) -> None:
    path = shared / "real" / "nanoindentation" / "hysitron" / "RobinSteel0000LC.txt"
    file = RawFile(path.name, path.read_bytes())
    assert detect(file) is FORMAT
    recording = FORMAT.read(file)
    table = np.loadtxt(path, skiprows=4, encoding="latin-1")
    for column, factor in zip(recording.columns, (1e-9, 1e-6, 1.0, 1.0, 1.0), strict=True):
        at = list(recording.columns).index(column)
        assert recording.columns[column].tobytes() == (table[:, at] * factor).tobytes()
    assert recording.flags == ()
    assert (recording.source.first_line, recording.source.last_line) == (5, 5312)
    assert recording.source.encoding == "latin-1"
    assert recording.metadata == {
        "timestamp": "Mon Apr 29 10:41:06 2019",
        "Number of Points": "5304",
    }
    with (shared / "real" / "expected_mechanics.csv").open(newline="") as lines:
        (row,) = [row for row in csv.DictReader(lines) if "hysitron" in str(row)]
    assert "3000.027013" in row.values()
    assert recording.columns["force_N"].max() == pytest.approx(3000.027013e-6, rel=1e-12)
    assert recording.columns["depth_m"].max() == pytest.approx(159.745188e-9, rel=1e-12)
    assert np.count_nonzero(recording.columns["depth_m"] < 0.0) == 288
