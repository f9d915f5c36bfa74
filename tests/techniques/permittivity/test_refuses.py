"""What the room of permittivity refuses or flags, by its exact words."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.quantity import Quantity
from deamat.core.recording import Recording
from deamat.core.records import Flag
from deamat.estimators.dielectric.impedance import ComplexArray
from tests.techniques.permittivity.films import (
    FREQUENCY,
    MODULUS,
    capacitor,
    card,
    context,
    flag,
    names,
    recording,
    reduce,
    refused,
)

# --- over-range


def test_an_over_range_point_is_dropped_and_the_readers_flag_passed_on() -> None:
    said = Flag("over-range", "1 of 31 points: line 7")
    measured = reduce(recording(capacitor(2.63), over_range=(1,), flags=(said,)))
    assert card(measured)[0] == pytest.approx(card(reduce(recording(capacitor(2.63))))[0])
    assert flag(measured, "over-range") == said.detail
    assert measured.curve["frequency_Hz"].size == 30
    assert measured.values[0].diagnostics["over_range_points"] == 1


@pytest.mark.parametrize("frequency_Hz", [FREQUENCY, np.logspace(0.5, 3.5, 31)])
def test_an_over_range_point_at_the_cards_frequency_is_not_replaced(
    frequency_Hz: FloatArray,
) -> None:
    at = int(np.argmin(np.abs(frequency_Hz - 10.0)))
    measured = reduce(recording(capacitor(2.63), frequency_Hz=frequency_Hz, over_range=(at,)))
    assert refused(measured) == (
        "the point at 10 Hz is marked over-range by the meter; choose a range that holds the film's impedance there, or a larger film"
    )


def test_too_few_points_are_refused() -> None:
    measured = reduce(recording(capacitor(2.63), over_range=tuple(range(27))))
    assert refused(measured) == (
        "4 of 31 points are usable, 5 are needed (min_points of [permittivity] in "
        "config/methods.toml): fewer do not show a point that is off, or a step; measure at more "
        "frequencies, in a range that the meter holds"
    )


# --- other refusals


@pytest.mark.parametrize(
    ("numbers", "modulus", "message"),
    [
        ({}, None, "the thickness was read under 5 N and the compressive_modulus of this material is not known for this campaign and age, so the squeeze cannot be undone; add its compression tests, or read the thickness without contact (micrometer_force_N = 0)"),
        ({"micrometer_force_N": None}, MODULUS, "the register does not say under which force the thickness was read: fill in micrometer_force_N (0 for a reading without contact)"),
        ({"micrometer_force_N": Quantity(-5.0, "N")}, MODULUS, "micrometer_force_N is -5; a force is not negative"),
        ({"anvil_diameter_m": None}, MODULUS, "the thickness was read under 5 N, but on which area is not declared: fill in anvil_diameter_mm of the register"),
        ({"anvil_diameter_m": Quantity(20e-3, "m")}, Quantity(0.0265e6, "Pa"), "5 N on an anvil of 20 mm are 15.9 kPa, 0.6 of the film's modulus: squeezed by 51 %, more than the 30 % up to which the correction is trusted; use a larger anvil, less force, or no contact"),
    ],
)  # fmt: skip
def test_a_thickness_that_cannot_be_known_is_refused(
    numbers: dict[str, Quantity | None], modulus: Quantity | None, message: str
) -> None:
    assert refused(reduce(recording(capacitor(2.63)), context(modulus), **numbers)) == message


def test_what_is_no_capacitor_is_refused() -> None:
    c = capacitor(2.63)
    c[3] = -3.11e-12
    assert refused(reduce(recording(c))) == (
        "1 of 31 points have no positive capacitance, first -3.11 pF at 19.9526 Hz (line 9): not a film between plates; check open and short trimming, the leads, and the function that the file names"
    )


def test_columns_of_another_kind_are_refused() -> None:
    other = Recording(
        {"displacement_m": FREQUENCY, "force_N": FREQUENCY},
        {},
        {},
        recording(capacitor(1.0)).source,
    )
    assert refused(reduce(other)).startswith(
        "the file holds displacement_m, force_N, where a frequency and one of Cp-D, Cp-Rp, Cs-D"
    )
    assert refused(reduce(None)) == (
        "the register names no data file for this specimen; fill in `file`"
    )


# --- flags


def test_a_good_film_has_but_the_flag_of_its_edge_and_of_the_meter() -> None:
    measured = reduce(recording(capacitor(2.63, 0.2)))
    assert names(measured) == ["edge-field", "meter-limit"]
    assert flag(measured, "edge-field") == (
        "not corrected: by ASTM D150 eps_r is 1.3 % too high for a film cut flush with the plates, 1.7 % for a larger one"
    )
    assert flag(measured, "meter-limit") == (
        "at |Z| = 9.9e+07 ohm the meter promises no better than +- 10 %; check it against a reference capacitor of that impedance and declare the result"
    )
    assert names(measured, 1) == []


def test_a_loss_below_what_the_meter_tells_is_flagged() -> None:
    assert flag(reduce(recording(capacitor(2.63))), "loss-unresolved", 1) == (
        "0.003, where the meter tells losses to +- 0.12: not told from zero"
    )


def test_a_thick_film_is_flagged() -> None:
    measured = reduce(recording(capacitor(2.63)), thickness_m=Quantity(500e-6, "m"))
    assert flag(measured, "electrode-aspect") == (
        "sqrt(A)/d = 89.4, where more than 100 is asked for: the edge field counts"
    )


def test_a_squeezed_film_is_flagged_with_its_lower_bound() -> None:
    soft = context(Quantity(0.0265e6, "Pa", 300.0, 100.0))
    measured = reduce(recording(capacitor(2.63)), soft)
    assert flag(measured, "squeezed-film") == (
        "read 25.9 % too thin if it slips under the anvils, beyond the 5 % over which the modulus is known; if it stuck to them, eps_r would be 25.9 % lower"
    )
    stuck = measured.values[0].diagnostics["relative_permittivity_if_film_stuck"]
    sticking = context(Quantity(0.0265e6, "Pa"), anvil_contact="sticking")
    assert card(reduce(recording(capacitor(2.63)), sticking))[0] == pytest.approx(stuck, rel=1e-9)
    assert stuck == pytest.approx(2.63, rel=1e-3)


def with_resistance(ohm: float) -> ComplexArray:
    c = capacitor(2.63)
    seen: ComplexArray = c / (1 + 2j * math.pi * FREQUENCY * ohm * c)
    return seen


def test_a_resistance_in_series_is_detected_and_estimated() -> None:
    measured = reduce(recording(with_resistance(2e4)))
    said = re.sub(r"\(\+- [^)]*\)", "(+- 0)", flag(measured, "series-resistance"))
    assert said == (
        "loss rises in proportion to frequency up to 10000 Hz, as 2e+04 ohm (+- 0) in series with the film do: there it adds 0.2 to the loss and C_p is 3.9 % low; look at electrodes, leads and contacts"
    )
    assert measured.values[0].diagnostics["series_resistance_ohm"] == pytest.approx(2e4, rel=1e-9)
    assert card(measured)[0] == pytest.approx(card(reduce(recording(capacitor(2.63))))[0], rel=1e-5)


def test_a_small_resistance_or_a_noisy_loss_is_not_called_one() -> None:
    assert "series-resistance" not in names(reduce(recording(with_resistance(500.0))))
    rng = np.random.default_rng(1)
    noisy = capacitor(2.63) * (1 - 0.03j * rng.standard_normal(31))
    assert "series-resistance" not in names(reduce(recording(noisy)))


def test_an_undeclared_level_is_flagged() -> None:
    measured = reduce(recording(capacitor(2.63), metadata={}))
    assert flag(measured, "level-declared") == (
        "the file does not say the test level; 1 V is declared"
    )
