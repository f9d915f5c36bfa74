"""A film under a micrometer: the neo-Hookean law, its limits, and its slope."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deamat.core.errors import FitRefused
from deamat.estimators.dielectric.squeeze import (
    squeeze_sensitivity,
    squeezed_stretch,
    sticking_modulus,
)


@given(st.floats(0.0, 100.0))
def test_the_stretch_satisfies_the_neo_hookean_law(x: float) -> None:
    stretch = squeezed_stretch(x)
    assert 0.0 < stretch <= 1.0
    assert 3 * x * stretch == pytest.approx(1.0 - stretch**3, abs=4e-15)


@given(st.floats(0.01, 0.999))
def test_every_stretch_is_found_again_from_its_pressure(stretch: float) -> None:
    assert squeezed_stretch((1 / stretch - stretch**2) / 3) == pytest.approx(stretch, rel=1e-13)


@pytest.mark.parametrize("x", [1e-9, 1e-6, 1e-3, 1e-2])
def test_small_pressures_give_the_linear_correction(x: float) -> None:
    """d = d_read (1 + p/Y) to first order, d_read / (1 - p/Y) to second."""
    assert 1 / squeezed_stretch(x) - 1 == pytest.approx(x, rel=1.1 * x + 1e-6)
    assert squeezed_stretch(x) == pytest.approx(1 - x, abs=0.34 * x**3 + 1e-15)


def test_no_pressure_no_squeeze_and_no_break_at_tiny_ones() -> None:
    assert squeezed_stretch(0.0) == 1.0
    assert squeezed_stretch(9.9e-13) == pytest.approx(squeezed_stretch(1.01e-12), abs=1e-13)


@given(st.floats(1e-4, 5.0))
def test_the_sensitivity_is_the_logarithmic_derivative(x: float) -> None:
    h = 1e-5
    rise = math.log(squeezed_stretch(x * (1 - h))) - math.log(squeezed_stretch(x * (1 + h)))
    assert squeeze_sensitivity(x) == pytest.approx(rise / (2 * h), rel=1e-5, abs=1e-9)


def test_a_wide_thin_film_that_sticks_hardly_gives_way() -> None:
    """S = 30 / (4 * 0.3) = 25: 1251 times as stiff."""
    assert sticking_modulus(1e6, 0.3e-3, 30e-3) == pytest.approx(1251e6)


@pytest.mark.parametrize("x", [-0.1, math.inf, math.nan])
def test_what_is_no_pressure_is_refused(x: float) -> None:
    with pytest.raises(FitRefused, match="must be finite and not negative"):
        squeezed_stretch(x)
