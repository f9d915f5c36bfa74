"""Points and steps that no material makes, and curves that materials do make."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deamat.core.arrays import FloatArray
from deamat.estimators.dielectric.smoothness import NONE, jumps

X = np.log(np.logspace(1, 4, 31))
FLAT = 1e-4 * np.random.default_rng(3).standard_normal(31)


def noisy(shape: FloatArray) -> FloatArray:
    return shape + FLAT


@given(at=st.integers(0, 30), off=st.sampled_from([-0.3, -0.03, 0.03, 0.3]))
def test_a_single_point_off_is_found_wherever_it_is(at: int, off: float) -> None:
    y = noisy(-0.002 * X)
    y[at] += off
    found = jumps(X, y, 0.005)
    assert found.outlying == (at,)
    assert found.steps == ()
    assert found.departures[0] == pytest.approx(off, abs=2e-3)


@given(gap=st.integers(1, 28), height=st.sampled_from([-0.3, -0.03, 0.03, 0.3]))
def test_a_step_is_found_between_its_two_points(gap: int, height: float) -> None:
    y = noisy(-0.002 * X)
    y[gap + 1 :] += height
    found = jumps(X, y, 0.005)
    assert (found.outlying, found.steps) == ((), (gap,))
    assert found.heights[0] == pytest.approx(height, abs=2e-3)


@pytest.mark.parametrize(
    "shape",
    [
        pytest.param(np.zeros(31), id="flat"),
        pytest.param(np.log1p(0.4 * np.exp(-1.2 * (X - X[0]))), id="polarised electrodes"),
        pytest.param(np.log1p(2.0 * np.exp(-0.8 * (X - X[0]))), id="strongly polarised"),
        pytest.param(np.log1p(0.5 / (1 + np.exp(2 * (X - X[15])))), id="relaxation"),
        pytest.param(-np.log1p(np.exp(2 * (X - X[25]))), id="resistance in series"),
    ],
)
def test_what_materials_and_leads_do_is_smooth(shape: FloatArray) -> None:
    assert jumps(X, noisy(shape), 0.005) == NONE


@pytest.mark.parametrize("points", [5, 6, 7, 9])
def test_few_points_still_show_a_first_one_that_is_off(points: int) -> None:
    x = np.log(np.logspace(1, 5, points))
    y = np.zeros(points)
    assert jumps(x, y, 0.01) == NONE
    y[0] = 0.15
    assert jumps(x, y, 0.01).outlying == (0,)


def test_scatter_of_the_whole_sweep_is_not_called_anything() -> None:
    rng = np.random.default_rng(5)
    found = [jumps(X, 0.01 * rng.standard_normal(31), 0.003) for _ in range(500)]
    assert np.mean([f != NONE for f in found]) < 0.06


def test_four_points_say_nothing() -> None:
    assert jumps(X[:4], np.array([0.5, 0.0, 0.0, 0.0]), 0.005) == NONE
