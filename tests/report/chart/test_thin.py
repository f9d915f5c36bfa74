"""Thinned curves look as they did."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.report.chart.thin import TOLERANCE_px, thin

STARTS = np.array([0, 700, 703, 704])


def curves(noise: float) -> tuple[FloatArray, FloatArray]:
    generator = np.random.default_rng(4)
    x = np.concatenate([np.linspace(0.0, 500.0, n) for n in (700, 3, 1, 1200)])
    y = 300.0 - 250.0 * (x / 500.0) ** 3 + generator.normal(0.0, noise, x.size)
    y[1500] -= 40.0  # one sample off its neighbours must stay
    return x, y


@pytest.mark.parametrize("noise", [0.0, 0.05, 0.3, 2.0])
def test_no_sample_is_farther_from_its_curve_than_allowed(noise: float) -> None:
    x, y = curves(noise)
    kept = thin(x, y, STARTS)
    ends = np.append(STARTS[1:], x.size) - 1
    assert set(STARTS) | set(ends) <= set(kept)
    assert 1500 in kept
    for start, end in zip(STARTS, ends, strict=True):
        mine = kept[(kept >= start) & (kept <= end)]
        for a, b in itertools.pairwise(mine):
            inner = np.arange(a, b + 1)
            chord = np.array([x[b] - x[a], y[b] - y[a]])
            unit = chord / np.hypot(*chord)
            away = np.abs((x[inner] - x[a]) * unit[1] - (y[inner] - y[a]) * unit[0])
            assert float(away.max()) <= TOLERANCE_px + 1e-9


def test_a_smooth_curve_needs_few_samples_and_a_straight_one_two() -> None:
    x, y = curves(0.0)
    assert thin(x, y, STARTS).size < 80
    line = np.linspace(0.0, 500.0, 2000)
    assert thin(line, 2.0 * line, np.array([0])).tolist() == [0, 1999]


def test_a_curve_that_turns_back_keeps_its_turn() -> None:
    x = np.concatenate([np.linspace(0.0, 100.0, 51), np.linspace(98.0, 0.0, 50)])
    assert 50 in thin(x, np.zeros(x.size), np.array([0]))
