"""Promises of the unloading stiffness, on simulated (synthetic) unloadings."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.curves.unloading import Unloading, fit_unloading

PEAK = 3e-3
FINAL, RISE = 4e-7, 2e-7  # h_f and C


def curve(exponent: float, samples: int = 200) -> tuple[FloatArray, FloatArray]:
    """A linear loading, and an unloading h = h_f + C (P / P_m)^(1/m)."""
    up, down = np.linspace(0.0, PEAK, 50), np.linspace(PEAK, 0.0, samples)
    back = FINAL + RISE * (down / PEAK) ** (1.0 / exponent)
    depth = np.concatenate([(FINAL + RISE) * np.sqrt(up / PEAK), back])
    return depth, np.concatenate([up, down])


def fit(depth: FloatArray, load: FloatArray) -> Unloading:
    return fit_unloading(depth, load, (0.4, 0.95), 20)


@pytest.mark.parametrize("exponent", [1.0, 1.25, 1.5, 2.0, 3.0])
def test_an_unloading_without_noise_gives_its_stiffness_back(exponent: float) -> None:
    found = fit(*curve(exponent))
    assert found.stiffness == pytest.approx(PEAK * exponent / RISE, rel=1e-6)
    assert found.exponent == pytest.approx(exponent, rel=1e-6)
    assert (found.peak_load, found.peak_depth) == pytest.approx((PEAK, FINAL + RISE), rel=1e-9)
    load = curve(exponent)[1]
    assert 0.4 * PEAK <= load[found.last] < load[found.first] <= 0.95 * PEAK


def test_the_stated_error_is_that_of_the_scatter() -> None:
    rng = np.random.default_rng(6)
    depth, load = curve(1.5)
    truth = PEAK * 1.5 / RISE
    pulls = []
    for _ in range(300):
        found = fit(depth + rng.normal(0.0, 2e-10, depth.size), load)
        pulls.append((found.stiffness - truth) / found.u_stiffness)
    assert abs(np.mean(pulls)) < 0.25
    assert 0.88 < np.std(pulls) < 1.12


def test_a_dozen_samples_still_tell_their_noise_and_their_error() -> None:
    rng = np.random.default_rng(7)
    depth, load = curve(1.5, 24)
    pulls, variances = [], []
    for _ in range(600):
        found = fit_unloading(depth + rng.normal(0.0, 2e-11, depth.size), load, (0.4, 0.95), 10)
        pulls.append((found.stiffness - PEAK * 1.5 / RISE) / found.u_stiffness)
        variances.append(found.residual_sd**2)
    assert found.last - found.first + 1 == 12
    assert np.mean(variances) == pytest.approx(4e-22, rel=0.06)
    assert 0.97 < np.std(pulls) < 1.15


@pytest.mark.parametrize(
    ("keep", "message"),
    [
        (
            50,
            "0 samples in 40-95 % of the peak load of the unloading, 20 are needed; record the "
            "unloading, or sample it faster",
        ),
        (
            70,
            "10 samples in 40-95 % of the peak load of the unloading, 20 are needed; record the "
            "unloading, or sample it faster",
        ),
    ],
)
def test_an_unloading_that_was_not_recorded_is_refused(keep: int, message: str) -> None:
    depth, load = curve(1.5)
    with pytest.raises(FitRefused) as caught:
        fit(depth[:keep], load[:keep])
    assert caught.value.reason == message


def test_a_depth_that_does_not_return_is_refused() -> None:
    depth, load = curve(1.5)
    depth[50:] = FINAL + RISE + 1e-9 * np.arange(depth.size - 50)
    with pytest.raises(FitRefused, match=r"^the depth does not return over 40-95 % of the peak"):
        fit(depth, load)
