"""Permittivity of films: physics against closed forms, budgets, the card and its figure."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deamat.core.chart import Curves, Points
from deamat.core.config import validate
from deamat.core.errors import ConfigError
from deamat.core.instruments import LcrAccuracy, Machine
from deamat.core.quantity import Quantity
from deamat.core.records import Measurement, PropertyRecord, Summary
from deamat.estimators.dielectric.impedance import PAIRS
from deamat.estimators.dielectric.squeeze import squeezed_stretch
from deamat.techniques.permittivity import TECHNIQUE
from deamat.techniques.permittivity.config import PermittivityConfig
from deamat.techniques.permittivity.result import FilmSpectrum
from tests.techniques.permittivity.films import (
    EPS0,
    FREQUENCY,
    NO_FORCE,
    RATIO,
    capacitor,
    card,
    context,
    flag,
    names,
    recording,
    reduce,
)
from tests.techniques.shown import marks


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


def test_where_the_frequency_asked_for_was_not_measured_the_nearest_is_given_as_such() -> None:
    f = np.logspace(math.log10(20), 4, 31)
    measured = reduce(recording(capacitor(2.63), frequency_Hz=f), micrometer_force_N=NO_FORCE)
    assert card(measured) == pytest.approx((2.63, 0.003), rel=1e-12)
    assert measured.values[0].conditions == {"frequency_Hz": 20.0}
    assert "measured at 20 Hz" in measured.values[0].method
    for value in (0, 1):
        assert flag(measured, "other-frequency", value) == (
            "10 Hz is not measured: the sweep goes from 20 to 10000 Hz, and nothing is "
            "extrapolated; this is the value at 20 Hz, the nearest that was measured "
            "(card_frequency_Hz of [permittivity] in config/methods.toml says which one is asked "
            "for)"
        )


def test_another_card_frequency_may_be_declared() -> None:
    measured = reduce(recording(capacitor(2.63)), context(card_frequency_Hz=1000.0))
    assert measured.values[0].conditions == {"frequency_Hz": 1000.0}
    assert "measured at 1000 Hz" in measured.values[0].method


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


def summarised(measurements: list[Measurement[FilmSpectrum]], **config: Any) -> PropertyRecord:
    return TECHNIQUE.summarise(measurements, context(**config)).records[0]


def dispersive(fall: float, factor: float = 1.0) -> Measurement[FilmSpectrum]:
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
    measured = [dispersive(0.05), dispersive(0.05, 1.02)]
    summary = TECHNIQUE.summarise(measured, context())
    assert TECHNIQUE.figure is not None
    chart = TECHNIQUE.figure(measured, summary)
    assert (chart.x.label, chart.x.spacing) == ("frequency [Hz]", "log")
    assert chart.y.label == "relative permittivity [1]"
    assert chart.right is not None
    assert chart.right.label == "loss tangent [1] (dotted)"
    left, right = marks(chart, Curves)
    assert (left.right, right.right, len(right.curves)) == (False, True, 2)
    assert np.array_equal(left.curves[0].y, measured[0].curve["relative_permittivity"])
    value, loss = marks(chart, Points)
    assert value.label == "permittivity, mean of 2 at 10 Hz"
    record = next(r for r in summary.records if r.key == "loss_tangent")
    assert loss.right
    assert loss.y.tolist() == [record.quantity.value]
    assert loss.low is not None
    assert loss.low.tolist() == [record.ci95[0]]
    refused_film = reduce(recording(capacitor(2.63), over_range=(0,)))
    assert marks(TECHNIQUE.figure([refused_film], Summary(())), Points) == []
