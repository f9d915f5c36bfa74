"""Promises about the parts of a curve: what is loading, what is a window."""

from __future__ import annotations

import re
from itertools import pairwise

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.curves.stress_strain import (
    bin_slopes,
    loading_branch,
    reloads,
    window,
    zero_of_tangent,
)


def ramp(*turns: float, step: float = 5e-4) -> FloatArray:
    """Strain that runs from one turning point to the next."""
    parts = [
        np.linspace(a, b, max(round(abs(b - a) / step), 1), endpoint=False)
        for a, b in pairwise(turns)
    ]
    return np.append(np.concatenate(parts), turns[-1])


def refused(strain: FloatArray, low: float, high: float, samples: int = 10) -> str:
    with pytest.raises(FitRefused) as error:
        window(strain, low, high, samples, 1e-4)
    assert error.value.diagnostics["samples_needed"] == samples
    return error.value.reason


@pytest.mark.parametrize(
    ("strain", "branch"),
    [
        (ramp(0.0, 0.3), 601),
        (ramp(0.0, 0.3, 0.0), 601),
        (ramp(0.0, 0.3, 0.0, 0.3, 0.0), 601),
        (ramp(0.0, 0.3, 0.0, 0.6), 601),
        (np.append(ramp(0.0, 0.3), np.full(50, 0.3)), 601),
        (np.append(ramp(0.0, 0.3), np.zeros(7)), 601),
    ],
)
def test_loading_ends_at_the_first_maximum(strain: FloatArray, branch: int) -> None:
    assert loading_branch(strain) == branch


def test_noise_is_no_turning_point() -> None:
    rng = np.random.default_rng(2)
    strain = ramp(0.0, 0.3, 0.1) + rng.normal(0.0, 2e-4, 1001)
    assert abs(loading_branch(strain) - 601) <= 5


def test_a_second_loading_is_noticed() -> None:
    assert reloads(ramp(0.0, 0.3, 0.0, 0.3), 601)
    assert not reloads(ramp(0.0, 0.3, 0.0), 601)
    assert not reloads(ramp(0.0, 0.3), 601)


def test_window_holds_both_of_its_ends_however_they_round() -> None:
    strain = np.arange(0.0, 3.001e-3, 1.5e-5) / 0.030
    inside = window(strain, 0.0, 0.05, 10, 1e-4)
    assert (inside[0], inside[-1], inside.size) == (0, 100, 101)
    assert window(-0.0 * strain + strain, 0.0, 0.05, 10, 1e-4).size == 101


def test_too_few_samples_are_refused_with_the_rate_that_would_do() -> None:
    assert refused(0.0446 + 0.0227 * np.arange(100.0), 0.0, 0.01) == (
        "0 samples in the window of 0-1 % strain, 10 are needed (`min_samples`); the first sample is at 4.46 % "
        "strain and one follows every 2.3 %: a sampling rate at least 23 times higher, or a speed "
        "as many times lower, would give enough"
    )
    assert refused(0.004 * np.arange(100.0), 0.0, 0.01).startswith(
        "3 samples in the window of 0-1 % strain, 10 are needed (`min_samples`); the first sample is at 0 % strain "
        "and one follows every 0.4 %: a sampling rate at least 4 times higher"
    )
    assert refused(np.array([0.2]), 0.0, 0.01).endswith("record the whole test")
    slower_later = np.concatenate([[0.0], 0.02 + 0.002 * np.arange(100.0)])
    assert "one follows every 0.2 %" in refused(slower_later, 0.0215, 0.03)


def test_the_advised_rate_is_enough() -> None:
    for spacing in (0.0013, 0.003, 0.0227):
        reason = refused(spacing * np.arange(50.0), 0.0, 0.01)
        found = re.search(r"at least (\d+) times", reason)
        assert found is not None
        finer = spacing / int(found.group(1)) * np.arange(50.0 * int(found.group(1)))
        assert window(finer, 0.0, 0.01, 10, 1e-4).size >= 10


def test_a_test_that_ends_before_the_window_says_so() -> None:
    assert refused(ramp(0.0, 0.005), 0.01, 0.05) == (
        "0 samples in the window of 1-5 % strain, 10 are needed (`min_samples`); the first sample is at 0 % strain "
        "and the greatest at 0.5 %: load further"
    )


def test_unloading_inside_the_window_is_refused() -> None:
    strain = ramp(0.0, 0.03, 0.02, 0.2)
    assert refused(strain, 0.0, 0.05) == (
        f"unloading inside the window of 0-5 % strain: strain goes back by 1 % among its "
        f"{np.sum(strain < 0.05 + 1e-9)} samples (10 are needed, all of one loading); export the "
        "loading alone or start the test below the window"
    )


def test_displacement_noise_is_not_unloading() -> None:
    rng = np.random.default_rng(4)
    strain = ramp(0.0, 0.1) + rng.normal(0.0, 2e-4, 201)
    assert np.diff(strain).min() < -2e-4
    assert window(strain, 0.0, 0.05, 10, 1e-4).size > 90


def test_a_window_must_be_covered() -> None:
    assert refused(ramp(0.0, 0.03), 0.0, 0.05) == (
        "the window of 0-5 % strain is not covered: its 61 samples (10 are needed) reach from 0 % "
        "to 3 %; load from below the window to beyond it, with the displacement zeroed at contact"
    )
    assert "reach from 2 % to 5 %" in refused(ramp(0.02, 0.2), 0.0, 0.05)
    assert window(ramp(0.0, 0.046), 0.0, 0.05, 10, 1e-4).size == 93


def test_bins_are_least_squares_each() -> None:
    rng = np.random.default_rng(6)
    x = np.sort(rng.uniform(0.0, 0.05, 90))
    y = 2e6 * x**2 + rng.normal(0.0, 1.0, 90)
    bins = bin_slopes(x, y, 0.0, 0.05, 0.01)
    for k in range(5):
        part = (x >= 0.01 * k) & (x < 0.01 * (k + 1))
        assert bins.slope[k] == pytest.approx(np.polyfit(x[part], y[part], 1)[0], rel=1e-9)
        assert bins.mean_x[k] == pytest.approx(x[part].mean())
        assert bins.mean_y[k] == pytest.approx(y[part].mean())
        assert bins.count[k] == part.sum()
    assert bins.steepest == 4


def test_bins_count_from_the_low_end_and_stay_empty_beyond_the_last_sample() -> None:
    x = np.linspace(0.02, 0.0399, 100)
    bins = bin_slopes(x, 3.0 * x, 0.02, 0.05, 0.01)
    assert bins.count == (50, 50, 0)
    assert bins.slope[:2] == pytest.approx((3.0, 3.0))
    assert np.isnan(bins.slope[2])


def test_a_bin_wider_than_the_window_is_the_window() -> None:
    x = np.linspace(0.0, 0.05, 101)
    for width in (0.06, 1e6):
        assert bin_slopes(x, 2.0 * x, 0.0, 0.05, width).slope == pytest.approx((2.0,))


def test_bins_without_three_samples_have_no_slope() -> None:
    x = np.array([0.001, 0.002, 0.003, 0.011, 0.012, 0.05])
    bins = bin_slopes(x, x, 0.0, 0.05, 0.01)
    assert bins.count == (3, 2, 0, 0, 1)  # the end of the window belongs to the last bin
    assert bins.slope[0] == pytest.approx(1.0)
    assert np.isnan(bins.slope[1:]).all()
    with pytest.raises(
        FitRefused, match=r"^no bin of strain has 3 samples for a slope \(at most 2"
    ):
        _ = bin_slopes(x[2:], x[2:], 0.0, 0.05, 0.01).steepest


def test_tangent_finds_the_zero_of_a_shifted_line() -> None:
    x = np.linspace(0.0, 0.05, 101)
    bins = bin_slopes(x, np.maximum(1e5 * (x - 0.013), 0.0), 0.0, 0.05, 0.01)
    assert zero_of_tangent(bins) == pytest.approx(0.013, rel=1e-9)
    with pytest.raises(
        FitRefused, match=r"^the steepest part of the window does not rise \(slope -"
    ):
        zero_of_tangent(bin_slopes(x, -x, 0.0, 0.05, 0.01))
