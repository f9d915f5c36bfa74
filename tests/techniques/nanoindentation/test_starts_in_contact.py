"""Records that start in contact: the contact is never subtracted as a tilt of the air."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.records import Measurement
from deamat.techniques.nanoindentation.result import Indent
from tests.techniques.curves import lengths
from tests.techniques.nanoindentation.indents import (
    BERKOVICH,
    FLAT,
    FLAT_CURVE,
    SPHERE,
    SPHERE_CURVE,
    MODULUS_Pa,
    flags,
    law,
    noisy,
    pyramid,
    reason,
    reduce,
)

SMALL = {"tip": "spherical"}, lengths(tip_radius_m=100e-6, height_m=5e-3)


def preloaded(preload_m: float, zero_N: float = 0.0) -> tuple[FloatArray, FloatArray]:
    """A sphere that goes 2 um deeper from a preload, where its depth is zeroed, and back."""
    stiffness, exponent = law(MODULUS_Pa, "spherical", 100e-6)
    down = np.linspace(0.0, 2e-6, 100)
    depth = np.concatenate([down, down[-2::-1]])
    return depth, stiffness * (depth + preload_m) ** exponent - zero_N


def value(measured: Measurement[Indent]) -> float:
    return measured.values[0].quantity.value


@pytest.mark.parametrize("preload_m", [1e-8, 5e-8, 2e-7, 1e-6, 4e-6])
@pytest.mark.parametrize("zero_N", [-5e-6, 0.0, 2e-6])
def test_a_sphere_from_a_preload_comes_out_with_its_contact_point(
    preload_m: float, zero_N: float
) -> None:
    measured = reduce(SMALL, noisy(preloaded(preload_m, zero_N), 1e-10))
    assert value(measured) == pytest.approx(MODULUS_Pa, rel=1e-4)
    assert measured.values[0].diagnostics["contact_depth_reading_m"] == pytest.approx(
        -preload_m, rel=1e-2
    )
    assert [flag.split(":")[0] for flag in flags(measured)] == ["starts-in-contact"]


@pytest.mark.parametrize("preload_m", [2e-8, 2e-7, 5e-7])
def test_under_noise_its_interval_holds_the_modulus(preload_m: float) -> None:
    measured = reduce(SMALL, noisy(preloaded(preload_m), 3e-7))
    quantity = measured.values[0].quantity
    assert abs(quantity.value - MODULUS_Pa) < 2.0 * quantity.standard_uncertainty
    assert quantity.standard_uncertainty < 0.03 * MODULUS_Pa
    assert flags(measured)[0].startswith("starts-in-contact: the record starts in contact")
    budget = {line.source for line in measured.values[0].budget}
    assert "tilt of the load, without air" in budget


def test_a_few_samples_in_air_are_no_line_in_air() -> None:
    depth, force = SPHERE_CURVE
    few = reduce(SPHERE, (depth[65:], force[65:]))
    assert value(few) == pytest.approx(MODULUS_Pa, rel=0.01)
    assert flags(few)[0].startswith("starts-in-contact")


def test_a_record_with_air_keeps_its_tilt() -> None:
    depth, force = SPHERE_CURVE
    tilted = reduce(SPHERE, noisy((depth, force + 5.0 * depth), 1e-7))
    assert value(tilted) == pytest.approx(MODULUS_Pa, rel=0.01)
    assert flags(tilted) == []


def test_a_preload_so_large_that_the_load_is_a_line_is_refused() -> None:
    said = reason(reduce(SMALL, noisy(preloaded(4e-5), 3e-7)))
    assert "the record starts in contact" in said


@pytest.mark.parametrize("first", [170, 220, 270])
def test_a_flat_punch_in_contact_is_a_straight_line_and_refused(first: int) -> None:
    """The punch touches at sample 163 of 300: a line through zero shows no contact."""
    depth, force = FLAT_CURVE
    said = reason(reduce(FLAT, noisy((depth[first:], force[first:]), 3e-7)))
    assert said.startswith("the record starts in contact")


def test_a_pyramid_in_contact_is_refused() -> None:
    depth, force = pyramid(7e10, 3e-3)
    for first in (60, 100):
        said = reason(reduce(BERKOVICH, noisy((depth[first:], force[first:]), 1e-6)))
        assert said.startswith("the record starts in contact")
