"""Promises about load that is lost while the crosshead goes on, at once or little by little."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.estimators.curves.slip import find_slip
from tests.estimators.curves.test_rupture import BACK, UP, E, pull, record


def slipped(loss: float, again: float = 2.0) -> tuple[FloatArray, FloatArray]:
    first, then = pull(1.0), np.linspace(1.01, again, 100)
    return record((first, E * first), (then, E * (1.0 - loss) + E * (then - 1.01)))


@pytest.mark.parametrize("loss", [0.04, 0.3, 0.8])
def test_a_sudden_loss_of_load_that_comes_back_is_a_slip(loss: float) -> None:
    strain, stress = slipped(loss)
    found = find_slip(strain, stress, strain.size - 1)
    assert found is not None
    assert (found.at, found.count, found.sudden) == (100, 1, True)
    assert found.loss == pytest.approx(loss)


def test_noise_unloading_and_the_break_itself_are_no_slips() -> None:
    rng = np.random.default_rng(8)
    noisy = UP[1] + rng.normal(0.0, 9e3, 101)
    assert find_slip(UP[0], noisy, 100) is None
    strain, stress = record(UP, BACK, UP)
    assert find_slip(strain, stress, strain.size - 1) is None
    strain, stress = record(UP, (np.array([1.52, 1.54]), np.array([10.0, 5.0])))
    assert find_slip(strain, stress, 102) is None


def test_a_machine_that_turns_on_a_relaxed_specimen_is_no_slip() -> None:
    top = (np.array([0.5]), np.array([0.9 * E * 0.5]))
    half = (pull(0.5), E * pull(0.5))
    strain, stress = record(half, top, (half[0][::-1][1:], 0.9 * half[1][::-1][1:]), UP)
    assert find_slip(strain, stress, strain.size - 1) is None


@pytest.mark.parametrize(("over", "left"), [(0.06, 0.7), (0.3, 0.7), (0.2, 1.0)])
def test_load_that_is_lost_little_by_little_is_a_slip(over: float, left: float) -> None:
    rng = np.random.default_rng(3)
    strain = np.linspace(0.0, 2.5, 2500)
    stress = np.interp(strain, [0.0, 1.0, 1.0 + over, 2.5], [0.0, 1.0, left, left + 1.5 - over])
    found = find_slip(strain, E * (stress + rng.normal(0.0, 0.002, 2500)), 2499)
    assert found is not None
    assert not found.sudden
    assert strain[found.at] == pytest.approx(1.0, abs=0.1)
    assert strain[found.until] == pytest.approx(1.0 + over, abs=0.1)
    assert found.loss == pytest.approx(1.0 - left + over, abs=0.15)


def rubbers(strain: FloatArray) -> dict[str, FloatArray]:
    stretch = 1.0 + strain
    first = stretch**2 + 2.0 / stretch - 3.0
    plain = stretch - stretch**-2
    return {
        "neo-Hooke": plain,
        "stiffening": plain * (1.0 - 0.05 * first + 0.02 * first**2),
        "at its limit": plain / (1.0 - first / (1.03 * first[-1])),
        "with a knee": 1.0 - np.exp(-strain / 0.05) + 0.1 * strain + 0.03 * strain**3,
    }


@pytest.mark.parametrize("samples", [60, 1000])
@pytest.mark.parametrize("elongation", [0.3, 2.5, 6.0])
def test_sound_rubbers_do_not_slip(samples: int, elongation: float) -> None:
    rng = np.random.default_rng(4)
    strain = np.linspace(0.0, elongation, samples)
    for name, stress in rubbers(strain).items():
        for noise in (0.0, 0.001, 0.01, 0.04):
            noisy = stress / stress.max() + rng.normal(0.0, noise, samples)
            assert find_slip(strain, noisy, samples - 1) is None, (name, noise)
        for step in (0.005, 0.05):  # of a coarse load cell
            coarse = np.round(stress / stress.max() / step) * step
            assert find_slip(strain, coarse, samples - 1) is None, (name, step)
