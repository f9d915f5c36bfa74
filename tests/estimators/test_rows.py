"""Copies of rows are found, whatever they start with and in whichever unit; noise is told."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.estimators.rows import has_noise, shared_fraction, sketch


def curve(seed: int, n: int = 2000) -> list[np.ndarray]:
    rng = np.random.default_rng(seed)
    x = np.linspace(0.0, 6e-3, n) + rng.normal(0.0, 1e-7, n)
    return [x, np.round(8e3 * x + rng.normal(0.0, 0.01, n), 4)]


def test_two_tests_share_no_rows_and_a_copy_shares_all() -> None:
    one, other = sketch(curve(1)), sketch(curve(2))
    assert shared_fraction(one, other) == 0.0
    assert shared_fraction(one, sketch(curve(1))) == 1.0


@pytest.mark.parametrize("kept", [0.25, 0.5, 0.8])
@pytest.mark.parametrize("n", [120, 2000])
def test_a_copied_stretch_is_measured(kept: float, n: int) -> None:
    one, other = curve(1, n), curve(2, n)
    at = round(kept * n)
    mixed = [np.concatenate([a[:at], b[at:]]) for a, b in zip(one, other, strict=True)]
    assert shared_fraction(sketch(one), sketch(mixed)) == pytest.approx(kept, abs=0.13)


def test_a_copy_without_its_beginning_is_all_there() -> None:
    whole = curve(1)
    part = [column[700:] for column in whole]
    assert shared_fraction(sketch(whole), sketch(part)) > 0.9


def test_a_copy_in_other_units_is_a_copy() -> None:
    millimetres = [np.round(1e3 * column, 5) for column in curve(3)]
    metres = [1e-3 * column for column in millimetres]
    back = [column / 1e3 for column in millimetres]
    assert shared_fraction(sketch(metres), sketch(back)) > 0.95


def test_a_channel_at_rest_and_a_running_number_tell_nothing() -> None:
    number = np.arange(300, dtype=np.float64)
    rest = np.zeros(300)
    assert sketch([number, rest]).count == 0
    assert sketch([]).count == 0


def test_a_channel_that_is_constant_in_one_of_two_files_hides_no_common_rows() -> None:
    ramp = 50.0 * np.arange(150.0)
    one = [np.append(ramp, np.zeros(5)), np.full(155, 2e-6)]
    other = [
        np.append(ramp, np.full(30, 0.6 * ramp[-1])),
        np.append(one[1][:150], np.full(30, 2e-2)),
    ]
    assert shared_fraction(sketch(one), sketch(other)) > 0.9


def test_noise_is_more_than_the_last_digit() -> None:
    x = np.linspace(0.0, 1.0, 200)
    smooth = np.round(3.0 * x - 0.4 * x**2, 4)
    assert not has_noise(smooth)
    assert not has_noise(1e-3 * smooth)
    assert not has_noise(np.repeat(np.arange(20.0), 10))
    assert not has_noise(np.zeros(200))
    count = 0.0741541  # of a load cell that is too coarse to show its noise
    assert not has_noise(np.round(count * np.rint(15.0 * smooth / count), 5))
    assert not has_noise(np.append(np.repeat(500.0 * np.arange(1, 19), 2), [0.0, 0.0]))
    assert not has_noise(0.0137 * np.rint(0.05 * np.arange(200.0) ** 2))  # of a converter
    assert has_noise(np.round(smooth + np.random.default_rng(1).normal(0.0, 3e-4, 200), 4))
