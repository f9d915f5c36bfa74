"""Single wild readings are found; breaks, slips, turns and noise are none."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.estimators.curves.lone import lone_readings, without

LINE = np.linspace(0.0, 1.0, 101)


@pytest.mark.parametrize("wild", [0.0, -1.0, 0.4, 0.2, 5.0, 99999.0, 1e6])
def test_a_reading_off_both_neighbours_is_found_and_replaced_by_their_mean(wild: float) -> None:
    values = LINE.copy()
    values[30] = wild
    lone = lone_readings(values)
    assert lone.tolist() == [30]
    assert without(values, lone).tolist() == pytest.approx(LINE.tolist())


def test_several_are_found() -> None:
    values = LINE.copy()
    values[[10, 60, 99]] = 3.0, -0.2, 9.0
    assert lone_readings(values).tolist() == [10, 60, 99]


@pytest.mark.parametrize(
    "values",
    [
        LINE,
        np.zeros(50),
        np.array([1.0]),
        np.array([]),
        np.array([0.0, 9.0, 0.1, 0.2, 0.3]),  # too few to know what is usual
        np.concatenate([LINE, np.zeros(5)]),  # a break
        np.concatenate([LINE, [0.5], np.zeros(5)]),  # a sample in the middle of the break
        np.concatenate([LINE, -0.3 * LINE[:1] - 0.3, [0.1], np.zeros(5)]),  # it rings
        np.concatenate([LINE, LINE[::-1]]),  # a turn
        np.concatenate([LINE, 0.8 + LINE]),  # a slip
        np.where(LINE < 0.5, LINE, LINE + 0.1),  # a step
        np.tile([0.0, 1.0], 30),  # cycles of two samples each
        np.tile([0.0, 0.5, 1.0, 0.5], 30),
    ],
    ids=range(13),
)
def test_what_a_specimen_or_a_machine_does_is_no_wild_reading(values: np.ndarray) -> None:
    assert lone_readings(values).size == 0


def test_noise_of_a_tenth_of_the_range_is_none() -> None:
    rng = np.random.default_rng(1)
    found = [lone_readings(LINE + rng.normal(0.0, 0.1, LINE.size)).size for _ in range(300)]
    assert sum(found) == 0


def test_a_reading_off_by_less_than_eight_steps_or_two_percent_is_left() -> None:
    values = LINE.copy()
    values[50] += 0.07
    assert lone_readings(values).size == 0
    values = np.linspace(0.0, 1.0, 10001)
    values[50] += 0.015
    assert lone_readings(values).size == 0
