"""Several sweeps in one list of frequencies, told apart by where the frequency turns."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.estimators.dielectric.repeats import (
    drift_between,
    same_frequency,
    spread,
    sweep_numbers,
)


@pytest.mark.parametrize(
    ("frequency", "numbers"),
    [
        pytest.param([10, 100, 1000], [0, 0, 0], id="one"),
        pytest.param([1000, 100, 10], [0, 0, 0], id="downwards"),
        pytest.param([10, 100, 10, 100], [0, 0, 1, 1], id="again"),
        pytest.param([100, 10, 100, 10], [0, 0, 1, 1], id="again, downwards"),
        pytest.param([10, 100, 1000, 100, 10], [0, 0, 0, 1, 1], id="up and down"),
        pytest.param([10, 100, 1000, 1000, 100, 10], [0, 0, 0, 1, 1, 1], id="turned at the top"),
        pytest.param([10, 10, 100, 100, 10, 10], [0, 0, 0, 0, 1, 1], id="twice each, up and down"),
        pytest.param([10, 10, 10, 100, 100], [0, 0, 0, 0, 0], id="repeats"),
        pytest.param([1000, 10, 100, 5000], [0, 0, 0, 0], id="out of order, no frequency twice"),
        pytest.param(
            [10, 100, 1000, 10000, 20, 200, 2000, 20000], [0] * 4 + [1] * 4, id="other frequencies"
        ),
        pytest.param([10, 100, 1000, 10000, 20, 200, 2000], [0] * 7, id="three more points"),
        pytest.param([1000, 2000, 3000, 4000, 10, 20, 30, 40], [0] * 8, id="another range"),
    ],
)
def test_a_sweep_ends_where_the_frequency_turns(frequency: list[int], numbers: list[int]) -> None:
    assert sweep_numbers(np.array(frequency, dtype=np.float64)).tolist() == numbers


def test_only_repeated_frequencies_have_a_spread() -> None:
    group = same_frequency(np.array([10.0, 10.0, 20.0, 30.0, 30.0001]))
    assert group.tolist() == [0, 0, 1, 2, 2]
    assert spread(np.array([1.0, 1.5, 9.0, 2.0, 1.0]), group).tolist() == [0.5, 1.0]


def test_later_sweeps_are_read_between_the_points_of_the_first() -> None:
    f = np.array([10.0, 20.0, 100.0, 200.0, 1000.0, 2000.0])
    sweep = np.array([0, 1, 0, 1, 0, 1])
    values = np.log10(f) - 0.03 * sweep
    assert drift_between(f, values, sweep) == pytest.approx([0.03, 0.03])
    f, sweep = np.array([10.0, 10.0, 20.0, 100.0, 100.0, 200.0]), np.array([0, 1, 1, 0, 1, 1])
    values = np.log10(f) - 0.03 * sweep  # the ends of the first are within its range
    assert drift_between(f, values, sweep) == pytest.approx([0.03, 0.03, 0.03])
