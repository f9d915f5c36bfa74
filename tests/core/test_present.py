from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deamat.core import present
from deamat.core.present import (
    aligned,
    readable,
    readable_conditions,
    readable_interval,
    readable_uncertainty,
    scale_of,
    si_text,
)
from deamat.core.properties import CONDITIONS, PROPERTIES
from deamat.core.quantity import Quantity
from deamat.core.records import Condition
from deamat.core.units import from_si, si_factor


@pytest.mark.parametrize(
    ("value", "u", "unit", "key", "text"),
    [
        (158812.5, 1118.0, "Pa", "", "158.8 ± 1.1 kPa"),
        (1151490.4, 16776.3, "Pa", "", "1.151 ± 0.017 MPa"),
        (957e3, 12e3, "Pa", "", "957 ± 12 kPa"),
        (2.1e9, 3e7, "Pa", "", "2.100 ± 0.030 GPa"),
        (35.0, 2.0, "Pa", "", "35.0 ± 2.0 Pa"),
        (96.9e6, 4.2e6, "V/m", "", "96.9 ± 4.2 V/um"),
        (21600.0, 1800.0, "s", "", "6.00 ± 0.50 h"),
        (1800.0, 60.0, "s", "", "30.0 ± 1.0 min"),
        (2.036, 0.038, "1", "elongation_at_break", "203.6 ± 3.8 %"),
        (2.63, 0.04, "1", "relative_permittivity", "2.630 ± 0.040"),
        (0.0012, 0.0003, "1", "loss_tangent", "0.00120 ± 0.00030"),
        (1.64, 0.05, "Pa.s", "", "1.640 ± 0.050 Pa.s"),
        (0.5, 0.01, "Pa.s", "", "500 ± 10 mPa.s"),
        (1030.0, 5.0, "kg/m3", "", "1030.0 ± 5.0 kg/m3"),
        (5.0, 0.0996, "1", "", "5.00 ± 0.10"),
        (158812.5, 0.0, "Pa", "", "158.812 kPa"),
        (5200.0, 250000.0, "Pa", "", "10 ± 250 kPa"),
        (5200.0, 1234e3, "Pa", "", "0 ± 1200 kPa"),
        (-0.001, 1.0, "1", "", "0.0 ± 1.0"),
        (0.0, 2500.0, "Pa", "", "0.0 ± 2.5 kPa"),
        (0.0, 0.0, "Pa", "", "0 Pa"),
    ],
)
def test_a_quantity_is_rounded_by_its_uncertainty(
    value: float, u: float, unit: str, key: str, text: str
) -> None:
    assert readable(Quantity(value, unit, u), key) == text


@given(st.floats(-1e12, 1e12), st.floats(1e-6, 1e12))
def test_rounding_moves_a_value_by_less_than_a_tenth_of_its_uncertainty(
    value: float, u: float
) -> None:
    quantity = Quantity(value, "Pa", u)
    scale = scale_of(quantity)
    factor = si_factor(scale.unit)[1]
    assert abs(float(scale.number(value)) * factor - value) <= 0.051 * u + 1e-9 * abs(value)
    assert float(scale.number(u)) * factor == pytest.approx(u, rel=0.051)


@pytest.mark.parametrize(
    ("interval", "text"),
    [
        ((156412.5, 161212.5), "156.4 to 161.2 kPa"),
        ((156412.5, math.inf), "above 156.4 kPa"),
        ((-math.inf, 161212.5), "below 161.2 kPa"),
        ((-math.inf, math.inf), "no bound"),
    ],
)
def test_an_interval_stands_on_the_scale_of_its_quantity(
    interval: tuple[float, float], text: str
) -> None:
    assert readable_interval(interval, scale_of(Quantity(158812.5, "Pa", 1118.0))) == text


def test_a_contribution_keeps_two_digits_however_small() -> None:
    assert readable_uncertainty(53.1, "kPa") == "0.053 kPa"
    assert readable_uncertainty(0.038, "%") == "3.8 %"
    assert readable_uncertainty(0.0, "kPa") == "0 kPa"


def test_conditions_are_told_in_the_order_of_the_closed_list() -> None:
    conditions: dict[str, Condition] = {
        "rate_V_per_s": 500.0,
        "electrode_area_m2": 1e-4,
        "electrode": "carbon black",
        "time_s": 3600.0,
        "window": (0.0, 0.05),
        "rate_per_s": 0.00555556,
        "frequency_Hz": 10.0,
        "humidity": 0.45,
        "temperature_K": 296.15,
        "cure": "2 h at 90 C",
        "age": "after cure",
    }
    assert set(conditions) == set(CONDITIONS)
    assert readable_conditions(conditions) == (
        "age after cure, cure 2 h at 90 C, temperature 23 C, humidity 45 %, frequency 10 Hz, "
        "rate 0.00555556 1/s, time since mixing 1 h, window 0 to 0.05, electrode carbon black, "
        "electrode area 100 mm2, rate of rise 500 V/s"
    )
    assert readable_conditions({}) == "none stated"
    assert readable_conditions({"temperature_K": "room"}) == "temperature room"


def test_a_condition_outside_the_list_is_not_dropped() -> None:
    with pytest.raises(ValueError, match="weather"):
        readable_conditions({"weather": "fair"})


def test_every_readable_unit_is_one_of_its_si_unit() -> None:
    for unit, ladder in present._LADDERS.items():
        assert [low for low, _ in ladder] == sorted((low for low, _ in ladder), reverse=True)
        assert ladder[-1][0] == 0.0
        for low, name in ladder:
            assert si_factor(name)[0] == unit
            assert low == 0.0 or from_si(low, name) == pytest.approx(1.0)


def test_every_property_can_be_told() -> None:
    for key, known in PROPERTIES.items():
        low = known.plausible[0] or 0.01
        assert readable(Quantity(low, known.unit, low / 10), key)


def test_si_text_keeps_every_digit() -> None:
    assert si_text(158812.53861612928, "Pa") == "158812.53861612928 Pa"
    assert si_text(0.1 + 0.2, "1") == "0.30000000000000004"


def test_columns_stand_under_each_other() -> None:
    assert aligned([("a", "b"), ("long", ""), ("ä", "x")], "  ") == [
        "  a     b",
        "  long",
        "  ä     x",
    ]
