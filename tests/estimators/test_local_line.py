"""Local lines and isolated points, against least squares by hand and counts of false alarms."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.errors import FitRefused
from deamat.estimators.curves.local_line import isolated_points, local_line


def test_a_line_is_met_exactly_whichever_points_are_near() -> None:
    x = np.array([0.0, 1.0, 2.5, 3.0, 7.0, 8.0, 9.5])
    for at in (0.0, 3.1, 9.5):
        found = local_line(x, 2.0 + 0.5 * x, at, 5)
        assert found.value == pytest.approx(2.0 + 0.5 * at, rel=1e-12)
        assert found.standard_uncertainty == pytest.approx(0.0, abs=1e-12)
        assert found.dof == 3


def test_weights_are_tricube_of_the_distance_over_that_of_the_next_point() -> None:
    x = np.arange(6.0)
    y = np.array([1.0, 0.0, 2.0, 1.0, 5.0, 3.0])
    weight = (1.0 - (np.abs(x[:5] - 2.0) / 3.0) ** 3) ** 3
    design = np.stack([np.ones(5), x[:5] - 2.0], axis=1)
    normal = design.T @ (weight[:, None] * design)
    by_hand = np.linalg.solve(normal, design.T @ (weight * y[:5]))
    assert local_line(x, y, 2.0, 5).value == pytest.approx(by_hand[0], rel=1e-12)


def test_intervals_of_a_local_line_hold() -> None:
    rng = np.random.default_rng(5)
    x = np.linspace(0.0, 1.0, 25)
    hits = 0
    for _ in range(1000):
        found = local_line(x, 1.0 + x + 0.1 * rng.normal(size=25), 0.4, 9)
        hits += abs(found.value - 1.4) <= 2.365 * found.standard_uncertainty  # t, 7 degrees
    assert 925 <= hits <= 975


@pytest.mark.parametrize("count", [3, 8])
def test_too_few_points_are_refused(count: int) -> None:
    with pytest.raises(FitRefused, match="a local line needs 4 points or more"):
        local_line(np.arange(5.0), np.arange(5.0), 1.0, min(count, 3))


@pytest.mark.parametrize("n", [12, 45])
def test_noise_alone_has_hardly_an_isolated_point(n: int) -> None:
    rng = np.random.default_rng(6)
    found = sum(isolated_points(rng.normal(size=n)).size > 0 for _ in range(1000))
    assert found <= 8


def test_knocks_are_found_alone_and_in_pairs_but_not_at_the_ends() -> None:
    y = np.random.default_rng(7).normal(0.0, 0.01, 45)
    y[[0, 12, 13, 30]] -= 0.4
    assert isolated_points(y).tolist() == [12, 13, 30]
    assert isolated_points(y, least=0.5).size == 0
    assert isolated_points(y[:10]).size == 0


def test_a_knock_is_found_on_a_slow_wave_that_is_greater() -> None:
    y = np.sin(np.linspace(0.0, 4.0 * np.pi, 101))
    y[[40, 73]] += 0.5
    assert isolated_points(y, least=0.3).tolist() == [40, 73]
