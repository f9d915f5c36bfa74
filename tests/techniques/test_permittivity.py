"""Permittivity of films: physics against closed forms, refusals and flags by their exact words."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pipeline.core.config import validate
from pipeline.core.errors import ConfigError
from pipeline.core.instruments import LcrAccuracy, Machine
from pipeline.core.quantity import Quantity
from pipeline.core.records import (
    Flag,
    FloatArray,
    Measurement,
    PropertyRecord,
    Recording,
    Source,
    Specimen,
    Summary,
)
from pipeline.core.technique import Context
from pipeline.estimators.impedance import PAIRS, ComplexArray, shown
from pipeline.estimators.squeeze import squeezed_stretch
from pipeline.techniques.permittivity import TECHNIQUE
from pipeline.techniques.permittivity.config import PermittivityConfig

EPS0 = 8.8541878188e-12
FREQUENCY = np.logspace(1, 4, 31)
LEVEL = {"level_V": "1.0"}
NO_FORCE = Quantity(0.0, "N")
MODULUS = Quantity(1e6, "Pa", 1e4, 5e3)
NUMBERS = {
    "thickness_m": Quantity(300e-6, "m", 1e-6, 1e-6),
    "plate_length_m": Quantity(45e-3, "m", 1e-5, 1e-5),
    "plate_width_m": Quantity(45e-3, "m", 1e-5, 1e-5),
    "micrometer_force_N": Quantity(5.0, "N"),
    "anvil_diameter_m": Quantity(30e-3, "m", 1e-5, 1e-5),
}
# p = 5 N / (pi/4 (30 mm)^2) over 1 MPa
RATIO = 5.0 / (math.pi / 4 * 30e-3**2) / 1e6


def capacitor(eps_r: float, tan: float = 0.003, thickness_m: float = 300e-6) -> ComplexArray:
    """A film of the same permittivity at all frequencies, between plates of 45 mm."""
    c: ComplexArray = np.full(31, EPS0 * 45e-3**2 / thickness_m * eps_r * (1 - 1j * tan))
    return c


def recording(
    capacitance_F: ComplexArray,
    mode: str = "Cp-D",
    frequency_Hz: FloatArray = FREQUENCY,
    over_range: tuple[int, ...] = (),
    metadata: Mapping[str, str] = LEVEL,
    flags: tuple[Flag, ...] = (),
) -> Recording:
    primary, secondary = (values.copy() for values in shown(mode, frequency_Hz, capacitance_F))
    over = np.zeros(frequency_Hz.size)
    for i in over_range:
        over[i], primary[i], secondary[i] = 1.0, 9.9e37, 9.9e37
    columns = {
        "frequency_Hz": frequency_Hz,
        PAIRS[mode].primary: primary,
        PAIRS[mode].secondary: secondary,
        "over_range": over,
    }
    source = Source(
        "c/permittivity/x.log", "0" * 64, 6, 5 + frequency_Hz.size, "utf-8", "lcr6000", 1
    )
    return Recording(columns, metadata, {}, source, flags)


def specimen(**numbers: Quantity | None) -> Specimen:
    mine = {k: v for k, v in {**NUMBERS, **numbers}.items() if v is not None}
    return Specimen(
        "p1", "m", "c", "permittivity", "c/permittivity/x.log", None, mine, {"age": "after cure"},
        {}, "c/permittivity/specimens.csv", 2,
    )  # fmt: skip


def context(
    modulus: Quantity | None = MODULUS, machine: Machine | None = None, **config: Any
) -> Context:
    needs = {} if modulus is None else {"compressive_modulus": modulus}
    return Context(PermittivityConfig(**config), machine or Machine(), needs)


def reduce(
    record: Recording | None, ctx: Context | None = None, **numbers: Quantity | None
) -> Measurement:
    return TECHNIQUE.reduce(specimen(**numbers), record, ctx or context())


def card(measurement: Measurement) -> tuple[float, float]:
    eps, loss = measurement.values
    assert (eps.key, loss.key) == ("relative_permittivity", "loss_tangent")
    return eps.quantity.value, loss.quantity.value


def refused(measurement: Measurement) -> str:
    assert measurement.values == ()
    assert [r.key for r in measurement.refusals] == ["relative_permittivity", "loss_tangent"]
    assert len({r.reason for r in measurement.refusals}) == 1
    return measurement.refusals[0].reason


def flag(measurement: Measurement, name: str, value: int = 0) -> str:
    (found,) = (f.detail for f in measurement.values[value].flags if f.name == name)
    return found


def names(measurement: Measurement, value: int = 0) -> list[str]:
    return [f.name for f in measurement.values[value].flags]


@pytest.mark.parametrize("mode", PAIRS)
def test_every_function_of_the_meter_gives_the_same_film(mode: str) -> None:
    """eps_r = C_p d / (eps0 A), d = d_read / lambda(p/Y)."""
    eps, loss = card(reduce(recording(capacitor(2.63, 0.2), mode)))
    assert eps == pytest.approx(2.63 / squeezed_stretch(RATIO), rel=1e-12)
    assert loss == pytest.approx(0.2, rel=1e-10)


def test_a_thickness_read_without_contact_is_taken_as_it_is() -> None:
    measured = reduce(
        recording(capacitor(2.63)),
        context(None),
        micrometer_force_N=NO_FORCE,
        anvil_diameter_m=None,
    )
    assert card(measured)[0] == pytest.approx(2.63, rel=1e-12)
    assert "thickness read without contact" in measured.values[0].method
    assert all("squeeze" not in line.source for line in measured.values[0].budget)


def test_for_a_stiff_film_the_correction_is_one_plus_p_over_y() -> None:
    eps, _ = card(reduce(recording(capacitor(2.63))))
    assert eps / 2.63 - 1 == pytest.approx(RATIO, rel=0.01)


@given(scale=st.floats(0.3, 3.0))
def test_capacitance_thickness_and_area_scale_as_they_must(scale: float) -> None:
    once, _ = card(reduce(recording(capacitor(2.63)), micrometer_force_N=NO_FORCE))
    thicker, _ = card(
        reduce(
            recording(capacitor(2.63)),
            thickness_m=Quantity(scale * 300e-6, "m"),
            micrometer_force_N=NO_FORCE,
        )
    )
    more, _ = card(reduce(recording(scale * capacitor(2.63)), micrometer_force_N=NO_FORCE))
    wider, _ = card(
        reduce(
            recording(capacitor(2.63)),
            plate_width_m=Quantity(45e-3 / scale, "m"),
            micrometer_force_N=NO_FORCE,
        )
    )
    assert [thicker, more, wider] == pytest.approx(3 * [scale * once], rel=1e-12)


@given(order=st.permutations(range(31)))
def test_the_order_of_the_points_does_not_matter(order: list[int]) -> None:
    c = capacitor(2.63) * np.linspace(1.0, 0.98, 31)
    straight = reduce(recording(c))
    shuffled = reduce(recording(c[order], frequency_Hz=FREQUENCY[order]))
    assert card(shuffled) == card(straight)
    assert np.array_equal(shuffled.curve["frequency_Hz"], FREQUENCY)
    assert shuffled.values[0].diagnostics == straight.values[0].diagnostics
    line = 6 + order.index(0)
    assert shuffled.values[0].lines == (line, line)


def test_the_curve_and_the_lines_are_kept() -> None:
    measured = reduce(recording(capacitor(2.63)))
    assert list(measured.curve) == ["frequency_Hz", "relative_permittivity", "loss_tangent"]
    assert measured.curve["loss_tangent"] == pytest.approx(np.full(31, 0.003))
    assert measured.values[0].lines == (6, 6)
    assert measured.values[0].conditions == {"frequency_Hz": 10.0}


# --- uncertainty


def test_the_budget_names_every_source_with_its_size() -> None:
    measured = reduce(recording(capacitor(2.63)))
    value = measured.values[0]
    eps = value.quantity.value
    sensitivity = RATIO / (squeezed_stretch(RATIO) ** 2 + RATIO)
    z = 1 / (2 * math.pi * 10 * abs(capacitor(2.63)[0]))
    limit = 5e-4 + 3e-4 + 0.3e-9 * z * 1.07 * math.sqrt(10)
    expected = {
        "film thickness, reading": (1 / 300, False),
        "film thickness, gauge calibration": (1 / 300, True),
        "modulus, in the squeeze": (sensitivity * math.hypot(0.01, 0.005), True),
        "micrometer force, in the squeeze": (sensitivity * 0.05, True),
        "anvil diameter, in the squeeze": (sensitivity * 2 * math.sqrt(2) / 3000, True),
        "plate area": (2 / 4500, True),
        "LCR meter": (limit / math.sqrt(3), True),
    }
    assert [(c.source, c.shared) for c in value.budget] == [
        (source, shared) for source, (_, shared) in expected.items()
    ]
    assert [c.u / eps for c in value.budget] == pytest.approx(
        [u for u, _ in expected.values()], rel=1e-4
    )
    assert value.quantity.u_shared == pytest.approx(
        eps * math.sqrt(sum(u**2 for u, shared in expected.values() if shared)), rel=1e-4
    )
    loss = measured.values[1].quantity
    assert loss.u_shared == pytest.approx(1.003 * limit / math.sqrt(3), rel=1e-6)


def test_the_sensitivities_are_the_derivatives() -> None:
    """Moving each input by its uncertainty moves the value by the budget's line."""

    def eps(modulus: float = 1e5, force: float = 5.0, anvil: float = 30e-3) -> float:
        q = {"micrometer_force_N": Quantity(force, "N"), "anvil_diameter_m": Quantity(anvil, "m")}
        return card(reduce(recording(capacitor(2.63)), context(Quantity(modulus, "Pa")), **q))[0]

    measured = reduce(
        recording(capacitor(2.63)), context(Quantity(1e5, "Pa", 1e2, 0.0), u_micrometer_force=1e-3),
        anvil_diameter_m=Quantity(30e-3, "m", 3e-5, 0.0),
    )  # fmt: skip
    u = {c.source: c.u for c in measured.values[0].budget}
    assert u["modulus, in the squeeze"] == pytest.approx(eps(1e5 - 50) - eps(1e5 + 50), rel=1e-4)
    assert u["micrometer force, in the squeeze"] == pytest.approx(
        eps(force=5.0025) - eps(force=4.9975), rel=1e-4
    )
    assert u["anvil diameter, in the squeeze"] == pytest.approx(
        eps(anvil=30e-3 - 1.5e-5) - eps(anvil=30e-3 + 1.5e-5), rel=1e-4
    )


def test_the_meters_word_on_level_and_speed_is_used() -> None:
    def meter(metadata: Mapping[str, str], **config: Any) -> float:
        measured = reduce(recording(capacitor(2.63), metadata=metadata), context(**config))
        return {c.source: c.u for c in measured.values[0].budget}["LCR meter"]

    usual = meter({"level_V": "1.0", "speed": "slow"})
    assert meter({"level_V": "1.0", "speed": "fast"}) == pytest.approx(2 * usual, rel=0.01)
    assert meter({"level_V": "0.1"}) > 1.3 * usual
    assert meter({}, level_V=0.1) == meter({"level_V": "0.1"})


# --- the frequency of the card


def test_between_two_measured_frequencies_it_says_so() -> None:
    f = np.logspace(0.8, 4, 27)
    c = np.asarray((3 - np.log10(f) / 10) * (1e-10 - 1e-12j), dtype=np.complex128)
    measured = reduce(recording(c, frequency_Hz=f))
    eps, _ = card(measured)
    assert eps == pytest.approx(
        1e-10 * 2.9 * 300e-6 / squeezed_stretch(RATIO) / (EPS0 * 45e-3**2), rel=1e-6
    )
    assert "interpolated in log f to 10 Hz, from Cp-D" in measured.values[0].method
    assert flag(measured, "interpolated") == (
        "10 Hz lies between 8.37678 and 11.1213 Hz, which were measured"
    )
    assert measured.values[0].lines == (7, 8)


def test_never_beyond_the_sweep_but_the_curve_is_kept() -> None:
    f = np.logspace(math.log10(20), 4, 31)
    measured = reduce(recording(capacitor(2.63), frequency_Hz=f))
    assert refused(measured) == (
        "10 Hz is not measured: the sweep goes from 20 to 10000 Hz, and nothing is extrapolated; measure at 10 Hz (+- 1 %)"
    )
    assert measured.refusals[0].conditions == {"age": "after cure", "frequency_Hz": 10.0}
    assert measured.curve["frequency_Hz"][0] == pytest.approx(20.0)


def test_another_card_frequency_may_be_declared() -> None:
    measured = reduce(recording(capacitor(2.63)), context(card_frequency_Hz=1000.0))
    assert measured.values[0].conditions == {"frequency_Hz": 1000.0}
    assert "measured at 1000 Hz" in measured.values[0].method


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
        "the point at 10 Hz is over-range by the meter's own word; choose a range that holds the film's impedance there, or a larger film"
    )


def test_too_few_points_are_refused() -> None:
    measured = reduce(recording(capacitor(2.63), over_range=tuple(range(27))))
    assert refused(measured) == (
        "4 of 31 points are usable, 5 are needed; measure again in a range that the meter holds"
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


# --- the edge field as a named option


@pytest.mark.parametrize("edge", ["flush", "overhanging"])
def test_the_edge_field_is_undone(edge: str) -> None:
    pf_per_mm = 0.0087 if edge == "flush" else 0.0068
    lossless = 1e-12 * 180 * (pf_per_mm - 0.00252 * math.log(0.3))
    film = 0.0 if edge == "flush" else 1e-12 * 180 * 0.0019 * 2.63 * (1 - 0.05j)
    seen = capacitor(2.63, 0.05) + lossless + film
    corrected = reduce(recording(seen), context(edge_field=edge), micrometer_force_N=NO_FORCE)
    assert card(corrected) == pytest.approx((2.63, 0.05), rel=1e-9)
    assert "edge-field" not in names(corrected)
    assert f"edge field of a {edge} film" in corrected.values[0].method
    plain = reduce(recording(seen), micrometer_force_N=NO_FORCE)
    excess = card(plain)[0] / 2.63 - 1
    assert 0.01 < excess < 0.02
    u = {c.source: c.u for c in corrected.values[0].budget}["edge field"]
    assert u == pytest.approx(0.2 * 2.63 * excess / (1 + excess), rel=1e-6)


def test_an_unknown_edge_is_an_error_of_the_configuration(tmp_path: Any) -> None:
    with pytest.raises(ConfigError, match=r"permittivity\.edge_field: Input should be 'none'"):
        validate(PermittivityConfig, {"edge_field": "guarded"}, tmp_path, "permittivity")


# --- the material


def summarised(measurements: list[Measurement], **config: Any) -> PropertyRecord:
    return TECHNIQUE.summarise(measurements, context(**config)).records[0]


def dispersive(fall: float, factor: float = 1.0) -> Measurement:
    """Falls linearly in log f by `fall` from 10 Hz to 10 kHz."""
    c = capacitor(2.63 * factor) * (1 - fall * (np.log10(FREQUENCY) - 1) / 3)
    checked = Machine(impedance=LcrAccuracy(high_impedance_per_ohm=((1e6, 0.01e-9),)))
    return reduce(recording(c), context(machine=checked))


def test_the_card_states_the_dependence_on_frequency() -> None:
    record = summarised([dispersive(0.05, 1 + 0.01 * i) for i in range(3)])
    mean = record.quantity.value
    said = record.diagnostics
    for f, share in ((10, 1.0), (100, 1 - 0.05 / 3), (1000, 1 - 0.1 / 3), (10000, 0.95)):
        assert said[f"relative_permittivity_{f}_Hz"] == pytest.approx(mean * share, rel=1e-9)
    assert said["slope_per_decade"] == pytest.approx(-mean * 0.05 / 3, rel=1e-6)
    assert said["change_to_top_frequency"] == pytest.approx(-0.05, rel=1e-6)
    assert record.method.endswith("eps_r falls by 5 % from 10 Hz to 10000 Hz, +- 0.49 %")
    assert record.conditions == {"age": "after cure", "frequency_Hz": 10.0}
    assert (record.n, len(record.origins)) == (3, 3)


def test_no_dependence_is_stated_as_none_within_what_is_told() -> None:
    record = summarised([dispersive(0.002), dispersive(0.002)])
    assert record.method.endswith(
        "eps_r does not depend on frequency from 10 Hz to 10000 Hz by more than is told (-0.2 %), +- 0.5 %"
    )


def test_a_short_sweep_states_nothing_beyond_its_end() -> None:
    f = np.logspace(1, 2.5, 31)
    record = summarised([reduce(recording(capacitor(2.63), frequency_Hz=f))])
    assert "relative_permittivity_100_Hz" in record.diagnostics
    assert "relative_permittivity_1000_Hz" not in record.diagnostics
    assert "from 10 Hz to 316.228 Hz" in record.method


def test_shared_errors_do_not_average_away() -> None:
    one, many = summarised([dispersive(0.01)]), summarised([dispersive(0.01)] * 20)
    assert many.quantity.u_shared == pytest.approx(one.quantity.u_shared, rel=1e-9)
    assert many.quantity.u_shared > 0.003 * many.quantity.value


def test_refusals_reach_the_summary() -> None:
    good, bad = dispersive(0.01), reduce(recording(capacitor(2.63), over_range=(0,)))
    summary = TECHNIQUE.summarise([good, bad], context())
    assert summary.records[0].n == 1
    assert [r.key for r in summary.refusals] == ["relative_permittivity", "loss_tangent"]


def test_the_figure_shows_every_film_and_the_cards_value() -> None:
    from matplotlib.figure import Figure

    measured = [dispersive(0.05), dispersive(0.05, 1.02)]
    summary = TECHNIQUE.summarise(measured, context())
    page = Figure()
    axes = page.add_subplot()
    assert TECHNIQUE.figure is not None
    TECHNIQUE.figure(axes, measured, summary)
    right = next(a for a in page.axes if a is not axes)
    assert axes.get_xscale() == "log"
    assert axes.get_xlabel() == "frequency [Hz]"
    assert axes.get_ylabel() == "relative permittivity [1]"
    assert right.get_ylabel() == "loss tangent [1] (dotted)"
    assert len(right.lines) == 2
    drawn = np.asarray(axes.lines[0].get_ydata())
    assert np.array_equal(drawn, measured[0].curve["relative_permittivity"])
    assert "mean of 2 at 10 Hz" in axes.get_legend_handles_labels()[1]
    refused_film = reduce(recording(capacitor(2.63), over_range=(0,)))
    TECHNIQUE.figure(Figure().add_subplot(), [refused_film], Summary(()))
