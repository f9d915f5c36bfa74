"""A reduced set of `python -m benchmarks.choice_coverage`, whose table is a page of the docs."""

from __future__ import annotations

import numpy as np

from benchmarks.choice_coverage import FIRST_SEED, PAGE, TRUTHS, one, page, table

CUBIC = "cubic: Sylgard 184 (40:1)"


def test_intervals_of_twelve_readings_hold_after_the_choice_of_a_law() -> None:
    cells = [one(CUBIC, 12, FIRST_SEED + i) for i in range(60)]
    whole = cells[0]
    for cell in cells[1:]:
        whole = whole + cell
    assert whole.runs == 60
    assert np.all(whole.held >= 0.85 * 60)  # 95 % less three and a half standard errors
    assert whole.doubled >= 0.85 * whole.asked > 0
    assert np.all(whole.law_held >= 0.85 * 60)
    assert whole.flags.total() == 0
    (row,) = table([whole])[2:]
    assert row.startswith(f"| {CUBIC} | 12 | ")
    assert page([whole]).startswith(
        "# How often intervals of viscosity hold after a law was chosen"
    )


def test_the_page_has_a_row_for_every_truth_and_number_of_readings() -> None:
    rows = [line for line in PAGE.read_text("utf-8").splitlines() if line.startswith("| ")]
    for truth in TRUTHS:
        assert len([row for row in rows if row.startswith(f"| {truth} |")]) == 3
