"""A sweep is read where it was measured, between its points with notice, and never beyond them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.dielectric.sweep import position, series_resistance, slope_per_decade

F = np.array([5.0, 10.05, 100.0, 1000.0])


def test_a_point_within_the_tolerance_is_taken_as_measured() -> None:
    found = position(F, 10.0, 0.01, 1.0)
    assert not found.interpolated
    assert found.of(np.array([1.0, 2.0, 3.0, 4.0])) == 2.0


def test_points_at_one_frequency_are_averaged() -> None:
    found = position(np.array([10.0, 20.0, 10.0]), 10.0, 0.01, 1.0)
    assert found.of(np.array([1.0, 7.0, 2.0])) == 1.5


def test_between_two_points_log_f_decides() -> None:
    found = position(np.array([100.0, 1.0, 1.0]), 10.0, 0.01, 2.0)
    assert found.interpolated
    assert found.of(np.array([5.0, 1.0, 2.0])) == pytest.approx((5.0 + 1.5) / 2)


@given(order=st.permutations(range(4)), target=st.floats(5.0, 1000.0))
def test_the_order_of_the_points_does_not_matter(order: list[int], target: float) -> None:
    values = np.array([3.0, 2.0, 7.0, 1.0])
    straight = position(F, target, 0.01, 2.0).of(values)
    assert position(F[order], target, 0.01, 2.0).of(values[order]) == pytest.approx(straight)


@pytest.mark.parametrize(
    ("frequency", "message"),
    [
        (F[2:], "10 Hz is not measured: the sweep goes from 100 to 1000 Hz, and nothing is extrapolated"),
        (F[:1], "10 Hz is not measured: the sweep goes from 5 to 5 Hz, and nothing is extrapolated"),
        (F[:0], "10 Hz is not measured: no point is left, and nothing is extrapolated"),
        (np.array([1.0, 1000.0]), "10 Hz lies in a gap from 1 to 1000 Hz, 3 decades wide (1 are bridged); measure nearer to 10 Hz"),
    ],
)  # fmt: skip
def test_nothing_is_extrapolated(frequency: FloatArray, message: str) -> None:
    with pytest.raises(FitRefused) as caught:
        position(frequency, 10.0, 0.01, 1.0)
    assert str(caught.value) == message


def test_a_line_over_log_f_is_found_whatever_the_weights() -> None:
    f = np.logspace(1, 4, 7)
    slope, u = slope_per_decade(f, 3.0 - 0.2 * np.log10(f), np.linspace(1.0, 9.0, 7))
    assert slope == pytest.approx(-0.2)
    assert u == pytest.approx(0.0, abs=1e-12)


def test_weights_decide_between_points_that_disagree() -> None:
    f = np.array([10.0, 100.0, 1000.0, 1e4])
    values = np.array([9.0, 1.0, 1.0, 1.0])
    plain, _ = slope_per_decade(f, values, np.ones(4))
    weighted, _ = slope_per_decade(f, values, np.array([100.0, 1.0, 1.0, 1.0]))
    assert plain == pytest.approx(-2.4)
    assert abs(weighted) < 0.01


def test_the_error_of_the_slope_is_that_of_least_squares() -> None:
    rng = np.random.default_rng(3)
    f = np.logspace(1, 4, 31)
    fits = [slope_per_decade(f, rng.normal(size=31), np.ones(31)) for _ in range(2000)]
    slopes, errors = np.array(fits).T
    assert slopes.std() == pytest.approx(np.sqrt((errors**2).mean()), rel=0.05)


def test_too_few_points_have_no_slope() -> None:
    with pytest.raises(FitRefused, match=r"^a slope needs 4 points at several frequencies, not 3$"):
        slope_per_decade(np.array([1.0, 2.0, 3.0]), np.ones(3), np.ones(3))


@pytest.mark.parametrize("ohm", [1e2, 2e4, 1e5])
def test_a_resistance_in_series_is_found_exactly(ohm: float) -> None:
    """Z = R + 1/(j w C (1 - j tan d)): D = tan d + R w Cs, with Cs as it was."""
    f, c, tan = np.logspace(1, 4, 31), 158e-12, 0.002
    z = ohm + 1 / (2j * math.pi * f * c * (1 - 1j * tan))
    series, loss = -1 / (2 * math.pi * f * z.imag), -z.real / z.imag
    found = series_resistance(f, series, loss)
    assert found is not None
    assert found[0] == pytest.approx(ohm, rel=1e-9)


def test_a_resistance_needs_four_points_in_the_top_decade() -> None:
    f = np.array([10.0, 100.0, 999.0, 3000.0, 1e4])
    assert series_resistance(f, np.full(5, 1e-10), np.ones(5)) is None
