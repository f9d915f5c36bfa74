"""Whatever pair a meter shows, it is the same capacitor."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deamat.core.errors import FitRefused
from deamat.estimators.dielectric.impedance import (
    PAIRS,
    complex_capacitance,
    impedance,
    loss_tangent,
    shown,
)

frequencies = st.floats(1.0, 1e6)
capacitances = st.floats(1e-13, 1e-6)
losses = st.floats(1e-6, 50.0)


@pytest.mark.parametrize(("first", "second"), list(itertools.permutations(PAIRS, 2)))
@given(f=frequencies, c=capacitances, d=losses)
def test_every_pair_converts_to_every_other_and_back(
    first: str, second: str, f: float, c: float, d: float
) -> None:
    frequency, capacitance = np.array([f]), np.array([c * (1 - 1j * d)])
    there = complex_capacitance(first, frequency, *shown(first, frequency, capacitance))
    back = complex_capacitance(second, frequency, *shown(second, frequency, there))
    assert back.real[0] == pytest.approx(c, rel=1e-12)
    # an angle near a quarter turn holds a loss to some 1e-16
    assert loss_tangent(back)[0] == pytest.approx(d, rel=1e-12, abs=1e-15)


@given(f=frequencies, c=capacitances, d=losses)
def test_the_pairs_are_the_closed_forms(f: float, c: float, d: float) -> None:
    w = 2 * math.pi * f
    capacitor = np.array([c * (1 - 1j * d)])
    frequency = np.array([f])

    def pair(mode: str) -> tuple[float, float]:
        primary, secondary = shown(mode, frequency, capacitor)
        return float(primary[0]), float(secondary[0])

    z = 1 / (1 / (1 / (w * c * d)) + 1j * w * c)  # a resistor beside a capacitor
    series = c * (1 + d * d)
    assert pair("Cp-D") == pytest.approx((c, d), rel=1e-13)
    assert pair("Cp-Rp") == pytest.approx((c, 1 / (w * c * d)), rel=1e-13)
    assert pair("Cs-D") == pytest.approx((series, d), rel=1e-13)
    assert pair("Cs-Rs") == pytest.approx((series, d / (w * series)), rel=1e-13)
    assert pair("Cp-Q") == pytest.approx((c, 1 / d), rel=1e-13)
    assert pair("Cs-Q") == pytest.approx((series, 1 / d), rel=1e-13)
    assert pair("Cp-G") == pytest.approx((c, w * c * d), rel=1e-13)
    assert pair("G-B") == pytest.approx((w * c * d, w * c), rel=1e-13)
    assert pair("R-X") == pytest.approx((z.real, z.imag), rel=1e-12)
    assert pair("Z-theta") == pytest.approx((abs(z), math.atan2(z.imag, z.real)), rel=1e-12)
    assert impedance(frequency, capacitor)[0] == pytest.approx(z, rel=1e-12)


def test_series_and_parallel_capacitance_differ_by_one_plus_d_squared() -> None:
    frequency, d = np.array([1e3]), np.array([0.1])
    from_series = complex_capacitance("Cs-D", frequency, np.array([1.01e-10]), d)
    assert from_series.real[0] == pytest.approx(1e-10, rel=1e-14)


@pytest.mark.parametrize(
    ("mode", "primary", "secondary"),
    [("R-X", 0.0, 0.0), ("Z-theta", 0.0, -1.57), ("Cp-Rp", 1e-10, 0.0), ("Cp-Q", 1e-10, 0.0)],
)
def test_a_short_circuit_is_refused(mode: str, primary: float, secondary: float) -> None:
    f = np.array([10.0, 20.0])
    with pytest.raises(FitRefused) as caught:
        complex_capacitance(mode, f, np.array([1.0, primary]), np.array([-1.0, secondary]))
    assert str(caught.value) == (
        f"{mode} reads an impedance of zero at 20 Hz: a short circuit is no specimen; look at plates and leads"
    )


def test_readings_of_zero_capacitance_are_numbers_for_the_room_to_judge() -> None:
    zero = np.zeros(1)
    for mode in ("Cp-D", "Cs-D", "Cs-Rs"):
        assert complex_capacitance(mode, np.array([10.0]), zero, zero)[0] == 0.0
