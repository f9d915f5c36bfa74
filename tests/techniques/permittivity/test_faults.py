"""Sweeps with something amiss: the film's value, a wider interval, a named cause or a refusal."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.instruments import LcrAccuracy, Machine
from deamat.core.records import Measurement, PropertyRecord
from deamat.estimators.dielectric.impedance import ComplexArray
from deamat.techniques.permittivity import TECHNIQUE
from deamat.techniques.permittivity.result import FilmSpectrum
from tests.techniques.permittivity.films import (
    FREQUENCY,
    NO_FORCE,
    capacitor,
    card,
    context,
    flag,
    names,
    recording,
    reduce,
    refused,
)

CHECKED = Machine(impedance=LcrAccuracy(high_impedance_per_ohm=((150e3, 0.03e-9),)))


def measure(
    factor: FloatArray, f: FloatArray = FREQUENCY, tan: float = 0.01, **config: Any
) -> Measurement[FilmSpectrum]:
    """A film of 2.7 whose capacitance is read times `factor`."""
    seen: ComplexArray = capacitor(2.7, tan)[0] * factor
    return reduce(
        recording(seen, frequency_Hz=f),
        context(machine=CHECKED, **config),
        micrometer_force_N=NO_FORCE,
    )


def lossy(loss: FloatArray) -> Measurement[FilmSpectrum]:
    seen = capacitor(2.7)[0].real * (1 - 1j * loss)
    return reduce(recording(seen), context(machine=CHECKED), micrometer_force_N=NO_FORCE)


def u(measured: Measurement[FilmSpectrum], source: str, value: int = 0) -> float:
    return {c.source: c.u for c in measured.values[value].budget}[source]


# --- outlying points


@pytest.mark.parametrize("off", [-0.3, -0.03, 0.03, 0.15, 3.0])
def test_a_first_point_that_is_off_is_read_from_its_neighbours(off: float) -> None:
    slope = 1 - 0.004 * np.log10(FREQUENCY / 10)
    measured = measure(np.where(FREQUENCY < 11, 1 + off, 1.0) * slope)
    assert card(measured) == pytest.approx((2.7, 0.01), rel=1e-4)
    assert measured.values[0].conditions == {"frequency_Hz": 10.0}
    assert "continued in log f from its neighbours to 10 Hz" in measured.values[0].method
    assert flag(measured, "outlying-point").startswith(
        f"off its neighbours, C at 10 Hz by {100 * off:+.2g} % (the meter had not settled"
    )
    # the nearest neighbour is a tenth of a decade away
    assert u(measured, "read from the neighbours") == pytest.approx(2.7 * 0.0004 / 3**0.5, rel=0.01)


def test_an_outlying_point_between_others_is_interpolated() -> None:
    measured = measure(np.where(FREQUENCY[10] == FREQUENCY, 1.1, 1.0), card_frequency_Hz=100.0)
    assert card(measured)[0] == pytest.approx(2.7)
    assert {"outlying-point", "interpolated"} <= set(names(measured))


def test_too_far_from_its_neighbours_the_nearest_sound_frequency_is_given() -> None:
    f = np.array([10.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5])
    measured = measure(np.where(f < 11, 1.2, 1.0), f)
    assert card(measured)[0] == pytest.approx(2.7)
    assert measured.values[0].conditions == {"frequency_Hz": 100.0}
    assert "the value at 100 Hz, the nearest" in flag(measured, "other-frequency")


def test_one_wild_loss_does_not_make_the_loss() -> None:
    wild = np.full(31, 0.0007)
    wild[0] = 0.72
    measured = lossy(wild)
    assert card(measured) == pytest.approx((2.7, 0.0007), rel=1e-9)
    assert "D at 10 Hz with 0.72" in flag(measured, "outlying-point", 1)


def test_a_loss_that_steps_is_refused_and_the_permittivity_is_not() -> None:
    measured = lossy(np.where(FREQUENCY < 40, 0.2, 0.003))
    assert [v.key for v in measured.values] == ["relative_permittivity"]
    (refusal,) = measured.refusals
    assert refusal.key == "loss_tangent"
    assert refusal.reason.startswith("the loss steps from 0.2 at 39.8107 Hz to 0.003 at 50.1187 Hz")


# --- steps


@pytest.mark.parametrize("step", [-0.03, 0.03, 0.09])
@pytest.mark.parametrize("edge_Hz", [21.0, 95.0, 3000.0])
def test_between_both_sides_of_a_step_lies_the_value(step: float, edge_Hz: float) -> None:
    measured = measure(np.where(edge_Hz > FREQUENCY, 1 + step, 1.0))
    value = measured.values[0]
    assert value.quantity.value == pytest.approx(2.7 * (1 + step) ** 0.5, rel=1e-6)
    for side in (2.7, 2.7 * (1 + step)):
        assert abs(side - value.quantity.value) < 2 * value.quantity.standard_uncertainty
    assert "steps by" in flag(measured, "range-step")


def test_a_high_step_is_refused_by_the_setting() -> None:
    said = refused(measure(np.where(FREQUENCY < 95, 1.3, 1.0)))
    assert "steps by -23 % between 79.4328 and 100 Hz" in said
    assert "10 % of max_step of [permittivity] in config/methods.toml" in said
    assert measure(np.where(FREQUENCY < 95, 1.3, 1.0), max_step=0.4).values


# --- polarised electrodes, conduction


def polarised(height: float, f: FloatArray = FREQUENCY) -> Measurement[FilmSpectrum]:
    rise = height * (f / 10) ** -1.2
    seen = capacitor(2.7)[0].real * (1 + rise) * (1 - 1j * (0.004 + 0.3 * rise))
    return reduce(
        recording(seen, frequency_Hz=f), context(machine=CHECKED), micrometer_force_N=NO_FORCE
    )


def test_a_small_rise_by_polarisation_is_flagged_and_in_the_interval() -> None:
    measured = polarised(0.03)
    value = measured.values[0].quantity
    assert measured.values[0].conditions == {"frequency_Hz": 10.0}
    assert abs(value.value - 2.7) < 2 * value.standard_uncertainty
    assert "3 % of the film's at 10 Hz. Electrodes polarise" in flag(
        measured, "electrode-polarisation"
    )


@pytest.mark.parametrize("height", [0.1, 0.4])
def test_a_large_one_moves_the_value_to_a_frequency_free_of_it(height: float) -> None:
    measured = polarised(height)
    assert card(measured)[0] == pytest.approx(2.7, rel=0.01)
    at = 100.0 if height == 0.1 else 1000.0
    assert measured.values[0].conditions == {"frequency_Hz": at}
    assert [r.key for r in measured.refusals] == ["relative_permittivity", "loss_tangent"]
    for refusal in measured.refusals:
        assert refusal.conditions["frequency_Hz"] == 10.0
        assert "card_frequency_Hz of [permittivity] in config/methods.toml" in refusal.reason


@pytest.mark.parametrize("height", [1.0, 3.0, 10.0])
def test_polarisation_that_multiplies_the_capacitance_is_found(height: float) -> None:
    rise = height * (FREQUENCY / 10) ** -1.2
    seen = capacitor(2.7)[0].real * (1 + rise) * (1 - 1j * (0.004 + 0.2 * rise / (1 + rise)))
    measured = reduce(recording(seen), context(machine=CHECKED), micrometer_force_N=NO_FORCE)
    assert card(measured)[0] == pytest.approx(2.7, rel=0.01)
    assert measured.values[0].conditions != {"frequency_Hz": 10.0}


@pytest.mark.parametrize(("exponent", "flagged"), [(0.5, True), (0.35, True), (0.1, False)])
def test_a_rise_as_slow_as_a_relaxations_is_flagged_and_kept(
    exponent: float, flagged: bool
) -> None:
    rise = 0.3 * (FREQUENCY / 10) ** -exponent
    seen = capacitor(2.7)[0].real * (1 + rise) * (1 - 1j * (0.004 + 0.3 * rise))
    measured = reduce(recording(seen), context(machine=CHECKED), micrometer_force_N=NO_FORCE)
    assert card(measured)[0] == pytest.approx(2.7 * 1.3, rel=1e-3)
    assert ("low-frequency-rise" in names(measured)) == flagged


def test_a_permittivity_that_depends_on_the_logarithm_of_frequency_is_not_flagged() -> None:
    slope = 1 - 0.05 * np.log10(FREQUENCY / 10)
    seen = capacitor(2.7)[0].real * slope * (1 - 1j * (0.03 + 0.01 * slope))
    measured = reduce(recording(seen), context(machine=CHECKED), micrometer_force_N=NO_FORCE)
    assert "low-frequency-rise" not in names(measured)


def test_a_sweep_that_polarisation_fills_is_refused() -> None:
    assert "no stated frequency of the sweep is free of it" in refused(
        polarised(0.4, np.logspace(1, 2.2, 25))
    )


def test_a_loss_by_conduction_says_so() -> None:
    measured = lossy(0.003 + 0.05 * 10 / FREQUENCY)
    assert card(measured) == pytest.approx((2.7, 0.053), rel=1e-9)
    assert flag(measured, "conduction", 1).startswith("0.05 of the loss falls as 1/f from 10 Hz on")
    assert "conduction" not in names(measured)
    # what the meter's error could feign is not called so
    assert "conduction" not in names(lossy(0.003 + 0.015 * 10 / FREQUENCY), 1)


# --- several sweeps, repeats


def sweeps(*factors: float, back: bool = False) -> Measurement[FilmSpectrum]:
    turns = [FREQUENCY[:: -1 if back and k % 2 else 1] for k in range(len(factors))]
    return measure(np.repeat(factors, FREQUENCY.size), np.concatenate(turns))


@pytest.mark.parametrize("back", [False, True])
def test_sweeps_that_agree_are_one(back: bool) -> None:
    measured = sweeps(1.0, 1.001, back=back)
    assert card(measured)[0] == pytest.approx(2.7 * 1.0005)
    assert names(measured) == names(sweeps(1.0))


def test_a_second_sweep_at_other_frequencies_is_compared_too() -> None:
    f = np.concatenate([FREQUENCY, 1.1 * FREQUENCY])
    apart = np.repeat([1.0, 0.97], FREQUENCY.size)
    measured = measure(apart, f)
    assert card(measured)[0] == pytest.approx(2.7)
    assert "2 sweeps in one file differ by 3" in flag(measured, "several-sweeps")
    assert "2 sweeps in one file differ by 11 %" in refused(measure(apart**3.7, f))
    assert "several-sweeps" not in names(measure(np.ones(f.size), f))


@pytest.mark.parametrize("back", [False, True])
def test_of_sweeps_that_drift_the_first_is_the_value(back: bool) -> None:
    measured = sweeps(1.0, 0.99, 0.97, back=back)
    assert card(measured)[0] == pytest.approx(2.7)
    assert flag(measured, "several-sweeps").startswith("3 sweeps in one file differ by 3 %")
    assert u(measured, "drift between repeated readings") == pytest.approx(
        2.7 * -np.log(0.97) / 3**0.5, rel=0.01
    )
    assert measured.values[0].lines == (6, 6)


def test_sweeps_at_six_temperatures_are_refused() -> None:
    said = refused(sweeps(1.0, 0.92, 0.84, 0.76, 0.68, 0.6))
    assert said.startswith("6 sweeps in one file differ by 51 % in capacitance (other temperatures")
    assert "register it with its temperature" in said


def test_repeats_that_creep_are_flagged_then_refused() -> None:
    f = np.repeat(FREQUENCY, 3)
    creeping = measure(np.tile([1.0, 1.01, 1.02], 31), f)
    assert names(creeping)[0] == "drifting-repeats"
    assert "frequencies measured several times differ by 20 %" in refused(
        measure(np.tile([1.0, 1.1, 1.22], 31), f)
    )


# --- intervals of a loss


def losses(*values: float) -> tuple[list[PropertyRecord], list[str]]:
    summary = TECHNIQUE.summarise(
        [lossy(np.full(31, value)) for value in values], context(machine=CHECKED)
    )
    return [r for r in summary.records if r.key == "loss_tangent"], [
        r.reason for r in summary.refusals
    ]


def test_the_interval_of_a_loss_ends_at_zero() -> None:
    (record,), _ = losses(0.001, 0.002, -0.0005)
    low, high = record.ci95
    assert low == 0.0
    assert high == pytest.approx(
        record.quantity.value + 2 * record.quantity.standard_uncertainty, rel=0.05
    )


def test_a_loss_that_comes_out_a_little_below_zero_is_zero_with_its_upper_end() -> None:
    (record,), _ = losses(-0.001, -0.002)
    assert record.quantity.value == 0.0
    assert record.ci95[0] == 0.0
    assert record.ci95[1] == pytest.approx(
        -0.0015 + 2 * record.quantity.standard_uncertainty, rel=0.05
    )


def test_a_loss_far_below_zero_is_refused() -> None:
    records, reasons = losses(-0.1, -0.11)
    assert records == []
    assert reasons[0].startswith("the loss comes out below zero, -0.1")


def test_readings_at_one_frequency_are_no_sweep() -> None:
    assert refused(measure(np.ones(6), np.full(6, 1000.0))).startswith(
        "a sweep over 1 frequencies, 5 are needed (min_points of [permittivity]"
    )
