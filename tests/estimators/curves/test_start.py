"""Promises about the start of a test: positions, holds, and a load cell that was not zeroed."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.curves.start import find_hold, zero_of_load, zero_of_position

STRAIN = np.linspace(0.0, 1.5, 301)
STRESS = 600e3 * STRAIN


@pytest.mark.parametrize("offset", [0.01, 1.0, -0.5, -12.0])
def test_a_position_without_its_load_is_the_place_of_the_crosshead(offset: float) -> None:
    assert zero_of_position(STRAIN + offset, STRESS) == "absolute"
    untared = STRESS + 0.1 * 600e3 * abs(offset)
    assert zero_of_position(STRAIN + offset, untared) == "absolute"


def test_a_position_with_its_load_is_a_strain() -> None:
    for first in (0.002, 0.0446, 0.3):
        late = STRAIN + first
        assert zero_of_position(late, 600e3 * late) == "at contact"
        softening = 400e3 * np.log1p(3.0 * late)
        assert zero_of_position(late, softening) == "at contact"


def test_an_approach_in_air_is_no_position() -> None:
    strain = np.linspace(-0.02, 0.1, 241)
    assert zero_of_position(strain, 600e3 * np.maximum(strain, 0.0)) == "at contact"


@pytest.mark.parametrize(("carried", "zero"), [(0.4, "at contact"), (0.6, "absolute")])
def test_an_approach_carries_less_than_half_of_what_its_length_as_a_strain_would(
    carried: float, zero: str
) -> None:
    strain = np.linspace(-0.02, 0.02, 401)
    stress = 600e3 * np.minimum(strain + 0.02, carried * 0.02)
    assert zero_of_position(strain, stress) == zero


def test_the_stiffness_at_the_start_decides_however_stiff_the_specimen_becomes() -> None:
    late = STRAIN + 0.1
    stiffening = 600e3 * late + 50e6 * np.maximum(late - 1.0, 0.0)
    assert zero_of_position(late, stiffening) == "at contact"


def test_a_start_that_is_neither_is_refused_with_both_numbers() -> None:
    with pytest.raises(FitRefused, match="starts at 10 % of the length with 35 % of the load"):
        zero_of_position(STRAIN + 0.1, STRESS + 0.35 * 600e3 * 0.1)


def test_a_small_start_within_the_noise_of_the_load_is_left_as_it_is() -> None:
    rng = np.random.default_rng(5)
    assert zero_of_position(STRAIN + 0.004, STRESS + rng.normal(0.0, 5e3, 301)) == "at contact"


def test_a_hold_ends_before_the_machine_moves() -> None:
    strain = np.concatenate([np.zeros(7), STRAIN])
    closing = np.concatenate([np.full(3, 0.0), np.full(4, -80e3), STRESS - 80e3])
    hold = find_hold(strain, closing)
    assert (hold.last, hold.gripping) == (7, True)
    still = find_hold(strain, np.concatenate([np.zeros(7), STRESS]))
    assert (still.last, still.gripping, still.load_change) == (7, False, 0.0)
    assert find_hold(STRAIN, STRESS).last == 0
    without_load = find_hold(strain, np.zeros(strain.size))
    assert (without_load.last, without_load.load_change) == (7, 0.0)


def broken(zero: float) -> FloatArray:
    return np.concatenate([STRESS, [0.0, 0.0, 0.0]]) + zero


@pytest.mark.parametrize("zero", [25e3, -25e3, 200e3])
def test_a_load_before_the_pull_and_after_the_break_is_the_zero_of_the_cell(zero: float) -> None:
    found = zero_of_load(broken(zero), 0, 301)
    assert found is not None
    assert found.zero_Pa == pytest.approx(zero)
    assert found.u_Pa == pytest.approx(0.0, abs=1e-6)


def test_a_load_before_the_pull_alone_is_an_uncertainty_and_no_correction() -> None:
    for record, broken_at in ((STRESS + 25e3, None), (np.append(STRESS + 25e3, [0.0, 0.0]), 301)):
        found = zero_of_load(record, 0, broken_at)
        assert found is not None
        assert found.zero_Pa == 0.0
        assert found.u_Pa == pytest.approx(25e3 / np.sqrt(3.0))


def test_a_load_within_its_noise_is_zero() -> None:
    rng = np.random.default_rng(3)
    accused = sum(
        zero_of_load(broken(0.0) + rng.normal(0.0, 10e3, 304), 0, 301) is not None
        for _ in range(300)
    )
    assert accused <= 2
