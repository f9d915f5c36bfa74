"""Promises about channels that hold one value: found where the test went on, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.estimators.curves.held import Held, held_load, held_position

N = 400
STRAIN = np.linspace(0.0, 2.0, N)
STRESS = 1e6 * (STRAIN - 0.1 * STRAIN**2)
LAST = N - 1


def scattered(values: FloatArray, sd: float, step: float) -> FloatArray:
    noisy = values + np.random.default_rng(3).normal(0.0, sd, values.size)
    return np.asarray(np.round(noisy / step) * step)


def test_a_saturated_load_is_found_from_its_first_sample_on() -> None:
    stress = np.minimum(scattered(STRESS, 500.0, 1.0), 1.5e6)
    first = int(np.argmax(stress == 1.5e6))
    assert held_load(STRAIN, stress, LAST) == Held(first, LAST)


def test_a_load_that_sticks_on_the_way_is_found() -> None:
    stress = scattered(STRESS, 500.0, 1.0)
    stress[100:120] = stress[100]
    assert held_load(STRAIN, stress, LAST) == Held(100, 119)


def test_a_position_that_freezes_is_found() -> None:
    strain = STRAIN.copy()
    strain[300:] = strain[300]
    assert held_position(strain, STRESS, 0, LAST) == Held(300, LAST)
    strain[350:] = STRAIN[350:]  # it catches up
    assert held_position(strain, STRESS, 0, LAST) == Held(300, 349)


@pytest.mark.parametrize("steps", [20, 50, 500])
def test_coarse_readings_are_not_held(steps: int) -> None:
    load = scattered(STRESS, 0.0, float(STRESS.max()) / steps)
    position = scattered(STRAIN, 0.0, float(STRAIN.max()) / steps)
    assert held_load(STRAIN, load, LAST) is None
    assert held_position(position, STRESS, 0, LAST) is None


def test_a_curve_that_levels_off_is_not_held() -> None:
    flat = 1e6 * (1.0 - np.exp(-STRAIN / 0.3))
    top = 1e6 * (1.0 - (STRAIN - 1.0) ** 2)
    for step in (1e2, 1e3, 1e4, 5e4):
        assert held_load(STRAIN, scattered(flat, 0.0, step), LAST) is None
        assert held_load(STRAIN, scattered(top, 0.0, step), LAST) is None


def test_slack_a_pause_and_a_hold_before_the_pull_are_not_held() -> None:
    slack = np.maximum(STRESS - STRESS[40], 0.0)
    assert held_load(STRAIN, slack, LAST) is None
    strain = np.concatenate([STRAIN[:100], np.full(50, STRAIN[100]), STRAIN[100:-50]])
    relaxed = STRESS[100] * np.linspace(1.0, 0.8, 50)
    stress = np.concatenate([STRESS[:100], relaxed, STRESS[100:-50]])
    assert held_position(strain, stress, 0, LAST) is None
    gripped = np.concatenate([np.zeros(50), STRAIN[:-50]])
    assert held_position(gripped, STRESS, 49, LAST) is None


def test_sound_pulls_raise_no_alarm() -> None:
    rng = np.random.default_rng(4)
    for _ in range(300):
        stress = np.round((STRESS + rng.normal(0.0, 300.0, N)) / 200.0) * 200.0
        strain = np.round(STRAIN / 1e-3) * 1e-3
        assert held_load(strain, stress, LAST) is None
        assert held_position(strain, stress, 0, LAST) is None


def test_a_pause_is_none_however_much_the_load_has_risen_at_the_next_sample() -> None:
    strain = np.concatenate([STRAIN[:100], np.full(50, STRAIN[99]), STRAIN[200:]])
    relaxed = STRESS[99] * np.linspace(1.0, 0.9, 50)
    stress = np.concatenate([STRESS[:100], relaxed, STRESS[200:]])
    assert held_position(strain, stress, 0, strain.size - 1) is None
