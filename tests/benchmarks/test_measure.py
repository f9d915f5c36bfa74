"""Statistics and the front, on numbers that can be checked by hand. Nothing is timed here."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.families.family import with_front
from benchmarks.measure import Answer, Contender, front, measured_rows, statistics
from benchmarks.timing import Row
from deamat.core.errors import FitRefused


def test_the_front_holds_who_is_not_beaten() -> None:
    times, errors = [1.0, 2.0, 4.0, 4.0, 8.0], [9.0, 4.0, 5.0, 1.0, 1.0]
    assert front(times, errors) == [0, 1, 3]


def test_differences_that_neither_clock_nor_simulation_can_tell_beat_nobody() -> None:
    assert front([1.0, 1.05], [1.0, 0.99]) == [0, 1]
    assert front([1.0, 1.05], [1.0, 0.9]) == [1]
    assert front([1.0, float("nan"), 3.0], [float("nan"), 1.0, 2.0]) == [2]


def test_neither_a_batch_nor_who_had_fewer_samples_competes() -> None:
    rows: list[Row] = [
        {"contender": "a", "kind": "default", "us per fit": 10.0, "fits": 9, "error": 1.0},
        {"contender": "b", "kind": "batch", "us per fit": 1.0, "fits": 9, "error": 1.0},
        {"contender": "c", "kind": "outside", "us per fit": 5.0, "fits": 8, "error": 0.5},
    ]
    assert [row["front"] for row in with_front(rows, "error")] == ["yes", "no", "no"]


def test_statistics_are_relative_to_the_truth() -> None:
    answers = np.array([[[11.0], [9.0], [12.0]], [[9.0], [8.0], [9.5]]])
    told = statistics(answers, np.full((2, 1), 10.0))
    assert told["bias %"] == pytest.approx(0.0)
    assert told["rmse %"] == pytest.approx(10.0)
    assert told["coverage %"] == 50.0
    # widths 30 and 15 %, and 40 times the 5 % by which the second misses
    assert told["interval error %"] == pytest.approx((30.0 + 15.0 + 200.0) / 2)


def test_intervals_of_a_negative_truth_are_judged_alike() -> None:
    answers = np.array([[[11.0], [9.0], [12.0]], [[9.0], [8.0], [9.5]]])
    turned = -answers[:, [0, 2, 1]]
    assert statistics(turned, np.full((2, 1), -10.0)) == pytest.approx(
        statistics(answers, np.full((2, 1), 10.0))
    )


def test_refusals_are_counted_and_enter_nothing_else() -> None:
    def fit(x: float) -> Answer:
        if x < 0:
            raise FitRefused("no")
        value = np.array([x])
        return Answer(value, value, value)

    samples = [2.0, -1.0, 2.0, 2.0]
    (row,) = measured_rows([Contender("c", fit)], samples, np.full((4, 1), 2.0))
    assert (row["fits"], row["failed %"], row["rmse %"]) == (4, 25.0, 0.0)
