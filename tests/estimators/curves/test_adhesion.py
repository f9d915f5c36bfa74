"""Spheres that stick: JKR and DMT against their own equations, and Hertz as their limit."""

from __future__ import annotations

import math

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.curves.adhesion import fit_adhesive, shape, tabor_parameter

R, E = 100e-6, 1.3e6


def jkr(work: float, samples: int = 200) -> tuple[FloatArray, FloatArray]:
    """Way out along the radius of contact a, from JKR's two equations, to the pull-off."""
    at_pull_off = (9.0 * math.pi * work * R**2 / (8.0 * E)) ** (1.0 / 3.0)
    a = np.geomspace(math.sqrt(2e-6 * R) * 1.2, at_pull_off, samples)
    depth = a**2 / R - np.sqrt(2.0 * math.pi * a * work / E)
    load = 4.0 * E * a**3 / (3.0 * R) - np.sqrt(8.0 * math.pi * work * E * a**3)
    return depth, load


@pytest.mark.parametrize("work", [1e-3, 1e-2, 5e-2])
def test_jkr_comes_out_of_its_own_equations(work: float) -> None:
    depth, load = jkr(work)
    pull_off = -float(load.min())
    assert pull_off == pytest.approx(1.5 * math.pi * work * R, rel=1e-6)
    found = fit_adhesive(depth + 3e-7, load, pull_off, R, 0.95, 3e-10, 20)
    assert found.model == "JKR"
    assert found.work == pytest.approx(work, rel=1e-6)
    assert found.reduced_modulus == pytest.approx(E, rel=1e-6)
    assert found.depth0 == pytest.approx(3e-7, abs=1e-12)
    assert found.tabor == pytest.approx(tabor_parameter(R, work, E, 3e-10), rel=1e-6)


def test_dmt_holds_for_a_hard_and_small_sphere() -> None:
    radius, modulus, work = 1e-7, 1e11, 1e-2
    pull_off = 2.0 * math.pi * work * radius
    load = np.linspace(50 * pull_off, -pull_off, 300)
    depth = (0.75 * (load + pull_off) / (modulus * math.sqrt(radius))) ** (2.0 / 3.0)
    found = fit_adhesive(depth, load, pull_off, radius, 0.95, 3e-10, 20)
    assert found.model == "DMT"
    assert found.tabor < 0.1
    assert found.reduced_modulus == pytest.approx(modulus, rel=1e-6)
    assert found.work == pytest.approx(work, rel=1e-6)


def test_between_the_two_limits_there_is_no_law() -> None:
    depth, load = jkr(1e-2)
    with pytest.raises(FitRefused, match="between the limits of DMT"):
        fit_adhesive(depth, load, -float(load.min()), R, 0.95, 1e-6, 20)


@pytest.mark.parametrize("model", ["JKR", "DMT"])
def test_far_above_the_pull_off_both_are_hertz(model: str) -> None:
    p = np.array([1e6, 1e8])
    assert shape(model, p) == pytest.approx((p / 4.0) ** (2.0 / 3.0), rel=3e-3)


def test_too_few_samples_before_the_pull_off_are_refused() -> None:
    depth, load = jkr(1e-2, 15)
    with pytest.raises(FitRefused, match="samples of the way out before the pull-off, 20 are"):
        fit_adhesive(depth, load, -float(load.min()), R, 0.95, 3e-10, 20)
    with pytest.raises(FitRefused, match="does not return"):
        fit_adhesive(-jkr(1e-2)[0], jkr(1e-2)[1], 5e-6, R, 0.95, 3e-10, 20)
