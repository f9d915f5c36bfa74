"""The page on the speed of reading says what was measured, and what was missed."""

from __future__ import annotations

from pathlib import Path

from benchmarks.reading_page import write_reading_page
from benchmarks.timing import Row

NAMES = [
    *("form", "contender", "files", "rounds", "ms per file", "median round"),
    *("times ours", "times read and hash", "worst error"),
]


def test_every_contender_has_a_line_and_every_target_its_verdict(tmp_path: Path) -> None:
    rows: list[Row] = [
        dict(zip(NAMES, row, strict=True))
        for row in (
            ("mts", "ours", 500, 9, 0.2501, 0.4, 1.0, 5.5, 0.001004),
            ("mts", "pandas + lmfit", 500, 9, 2.6, 3.8, 10.396, 57.2, 0.001004),
            ("mts", "read and hash", 500, 9, 0.0455, 0.05, 0.182, 1.0, 0.0),
        )
    ]
    page = tmp_path / "page.md"
    write_reading_page(rows, ["met: one", "MISSED: other"], page)
    lines = page.read_text().splitlines()
    assert "SYNTHETIC" in page.read_text()
    assert lines[-12].endswith("; 500 files of each form, 9 rounds.")
    assert lines[-9:] == [
        "|---|---|---|---|---|---|---|",
        "| mts | ours | 250 us | 400 us | 1 | 5.5 | 0.1 % |",
        "| mts | pandas + lmfit | 2600 us | 3800 us | 10.4 | 57.2 | 0.1 % |",
        "| mts | read and hash | 46 us | 50 us | 0.182 | 1 |  |",
        "",
        "Against the targets:",
        "",
        "- met: one",
        "- MISSED: other",
    ]
