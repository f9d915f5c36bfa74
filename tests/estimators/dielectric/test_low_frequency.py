"""Ions in a sweep: the power law of polarised electrodes, and the loss of a conductor."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.estimators.dielectric.low_frequency import conducted, polarisation, steepening

F = np.logspace(1, 4, 31)
FILM = 1e-10 * (1 - 0.004 * np.log10(F / 10))
LOSS = np.full(31, 0.004)


@pytest.mark.parametrize("s", [0.8, 1.2, 1.6])
@pytest.mark.parametrize("height", [0.03, 0.4, 2.0])
def test_height_and_exponent_come_back(height: float, s: float) -> None:
    rise = height * (F / 10) ** -s
    found = polarisation(F, FILM * (1 + rise), LOSS + 0.3 * rise, 10.0)
    assert found is not None
    assert found.height == pytest.approx(height, rel=0.03)
    assert found.exponent == pytest.approx(s)
    assert found.at(100.0) == pytest.approx(height * 10.0**-s, rel=0.03)


def test_what_lies_below_the_value_or_far_above_it_plays_no_part() -> None:
    f = np.concatenate([[1.0, 3.0], F, [3e5, 1e6]])
    rise = 0.4 * (f / 10) ** -1.2
    capacitance, loss = 1e-10 * (1 + rise), 0.004 + 0.3 * rise
    capacitance[:2] *= 0.9
    capacitance[-2:] *= 1.3  # another mechanism
    alone = polarisation(F, capacitance[2:-2], loss[2:-2], 10.0)
    found = polarisation(f, capacitance, loss, 10.0)
    assert alone is not None
    assert found is not None
    assert (found.height, found.exponent) == pytest.approx((alone.height, alone.exponent))


def test_a_rise_without_loss_or_a_film_that_depends_on_ln_f_is_none() -> None:
    rise = 0.4 * (F / 10) ** -1.2
    assert polarisation(F, FILM * (1 + rise), LOSS, 10.0) is None
    steep = 1e-10 * (1 - 0.05 * np.log10(F / 10))
    assert polarisation(F, steep, LOSS * (F / 10) ** -0.3, 10.0) is None


def test_five_points_tell_a_strong_rise() -> None:
    f = np.logspace(1, 5, 5)
    rise = 0.4 * (f / 10) ** -1.2
    found = polarisation(f, 1e-10 * (1 + rise), 0.004 + 0.3 * rise, 10.0)
    assert found is not None
    assert found.height == pytest.approx(0.4, rel=0.05)
    assert polarisation(f[:2], 1e-10 * (1 + rise[:2]), 0.004 + rise[:2], 10.0) is None


def test_most_of_a_loss_by_conduction_falls_as_one_over_f() -> None:
    assert conducted(F, 0.003 + 0.05 * (10 / F), 10.0) == pytest.approx(0.05)
    assert conducted(F, 0.05 + 0.003 * (10 / F), 10.0) == 0.0
    assert conducted(F, 0.05 * (10 / F) ** 0.3, 10.0) == 0.0
    assert conducted(F[::10], 0.05 * (10 / F[::10]), 10.0) == 0.0


DECADES = np.array([10.0, 100.0, 1000.0])
RISING = np.array([4.0, 1.0, 0.6])  # by 3 over the first decade, by 2/3 over the next


@pytest.mark.parametrize(
    ("capacitance", "loss_with_it", "rises"),
    [
        (RISING, 1.0, (3.0, 2.0 / 3.0)),
        (RISING, 0.0, (0.0, 0.0)),  # C'' does not rise
        (np.array([1.21, 1.1, 1.0]), 1.0, (0.0, 0.0)),  # by as much in either decade
    ],
)
def test_a_steepening_is_the_rise_over_two_decades(
    capacitance: np.ndarray, loss_with_it: float, rises: tuple[float, float]
) -> None:
    lost = loss_with_it * (capacitance - capacitance[-1]) + 0.01
    found = steepening(DECADES, capacitance, lost / capacitance, 10.0)
    assert found == pytest.approx(rises)


@pytest.mark.parametrize(("share", "counts"), [(1.1, True), (0.9, False)])
def test_a_loss_that_rises_by_less_than_its_share_is_no_polarisation(
    share: float, counts: bool
) -> None:
    lost = np.array([share * 0.1 * (RISING[0] - RISING[1]), 0.0, 0.0])
    assert any(steepening(DECADES, RISING, lost / RISING, 10.0)) == counts


@pytest.mark.parametrize("at_Hz", [3.0, 30.0])
def test_a_sweep_that_does_not_reach_over_both_decades_shows_no_steepening(at_Hz: float) -> None:
    assert steepening(DECADES, RISING, RISING, at_Hz) == (0.0, 0.0)
