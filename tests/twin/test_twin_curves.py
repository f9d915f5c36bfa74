"""The noise-free curves have exactly the moduli and break points that they claim."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from deamat.core.arrays import FloatArray
from deamat.core.errors import OutOfRange
from deamat.twin.curves import (
    COMPRESSION_WINDOW,
    LINEAR_TO,
    TENSION_WINDOW,
    compressive_stress,
    tensile_stress,
    window_slope,
)
from deamat.twin.truth import materials, true_value


def _at(curve: Callable[..., FloatArray], strain: float, *parameters: float) -> float:
    return float(curve(np.array([strain]), *parameters)[0])


@pytest.mark.parametrize("material", materials())
@pytest.mark.parametrize("toe", [0.0015, 0.004])
def test_the_compressive_slope_is_the_modulus_toe_included(material: str, toe: float) -> None:
    modulus = true_value("compressive_modulus", material).value
    half = COMPRESSION_WINDOW / 2

    def moment(e: float) -> float:
        return (e - half) * _at(compressive_stress, e, modulus, toe)

    # the definition of a least-squares slope, by adaptive quadrature instead of Gauss-Legendre
    slope = quad(moment, 0, 2 * half, epsabs=0, epsrel=1e-12)[0] * 12 / COMPRESSION_WINDOW**3
    assert slope == pytest.approx(modulus, rel=1e-9)


def test_plain_least_squares_on_samples_tends_to_the_window_slope() -> None:
    for samples, tolerance in ((150, 2e-3), (15_000, 2e-5)):
        strain = np.linspace(0.0, COMPRESSION_WINDOW, samples)
        slope = np.polyfit(strain, compressive_stress(strain, 1e6, 0.003), 1)[0]
        assert slope == pytest.approx(1e6, rel=tolerance)


def test_soft_contact_lowers_the_slope_of_the_first_percent() -> None:
    for toe, low, high in ((0.0015, 0.80, 0.92), (0.004, 0.50, 0.70)):

        def stress(strain: FloatArray, toe: float = toe) -> FloatArray:
            return compressive_stress(strain, 1.0, toe)

        assert low < window_slope(stress, 0.01) < high


@pytest.mark.parametrize("material", materials())
def test_the_tensile_curve_is_straight_then_rises_to_the_break(material: str) -> None:
    modulus = true_value("tensile_modulus", material).value
    strength = true_value("tensile_strength", material).value
    elongation = true_value("elongation_at_break", material).value
    strain = np.linspace(0.0, elongation, 20_001)
    stress = tensile_stress(strain, modulus, strength, elongation)
    first = strain <= TENSION_WINDOW
    fine = np.linspace(0.0, TENSION_WINDOW, 51)
    slope = np.polyfit(fine, tensile_stress(fine, modulus, strength, elongation), 1)[0]
    assert slope == pytest.approx(modulus, rel=1e-9)
    assert stress[first] == pytest.approx(modulus * strain[first], rel=1e-12)
    assert stress[-1] == pytest.approx(strength, rel=1e-12)
    assert np.all(np.diff(stress) > 0)
    just = 1e-6
    left = _at(tensile_stress, LINEAR_TO - just, modulus, strength, elongation)
    right = _at(tensile_stress, LINEAR_TO + just, modulus, strength, elongation)
    assert (right - left) / (2 * just) == pytest.approx(modulus, rel=1e-4)


@given(
    strength=st.floats(0.4, 50.0),
    elongation=st.floats(0.5, 10.0),
    scale=st.floats(1e3, 1e8),
)
def test_a_curve_rises_or_is_refused_and_scales(
    strength: float, elongation: float, scale: float
) -> None:
    strain = np.linspace(0.0, elongation, 400)
    try:
        stress = tensile_stress(strain, 1.0, strength, elongation)
    except OutOfRange:
        assert (elongation - LINEAR_TO) / (strength - LINEAR_TO) > 2.9 - 1e-9
        return
    assert np.all(np.diff(stress) > 0)
    assert tensile_stress(strain, scale, strength * scale, elongation) == pytest.approx(
        scale * stress, rel=1e-9
    )


def test_a_break_that_no_rising_curve_reaches_is_refused() -> None:
    message = (
        "a break at 200000 Pa and strain 3 is too far below a line of 1e+06 Pa for a curve that "
        "only rises"
    )
    with pytest.raises(OutOfRange, match=f"^{re.escape(message)}$"):
        tensile_stress(np.array([0.01]), 1e6, 2e5, 3.0)
    with pytest.raises(OutOfRange, match=r"too far below"):
        tensile_stress(np.array([0.01]), 1e6, 4e4, 3.0)  # weaker than the end of the line


def test_nothing_is_known_beyond_the_break() -> None:
    with pytest.raises(OutOfRange, match=r"^strain 2\.1 lies beyond the break at 2$"):
        tensile_stress(np.array([0.5, 2.1]), 1e6, 5e6, math.nextafter(2.0, 3.0))
