"""The room of viscosity: windows, audits, laws, what is refused and in which words."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.errors import OutOfRange
from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.recording import Specimen
from deamat.core.records import Law, Measurement
from deamat.core.register import read_register
from deamat.core.technique import Context
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.techniques import viscosity
from deamat.techniques.viscosity.config import ViscosityConfig
from deamat.techniques.viscosity.pooled import fit_law
from deamat.techniques.viscosity.readings import audited
from deamat.techniques.viscosity.result import Run
from deamat.techniques.viscosity.time_law import drift_of
from deamat.techniques.viscosity.window import windowed
from tests.techniques.viscosity.runs import (
    CONTEXT,
    HOUR,
    MACHINE,
    newtonian,
    recording,
    reduce,
    specimen,
)

TIMES = np.arange(0.25, 13.01, 0.25) * HOUR
CONFIG = ViscosityConfig()


def line(time_s: FloatArray) -> FloatArray:
    return 4.0 + 0.19 * time_s / HOUR


def value(measurement: Measurement[Run], key: str, time_h: float = 1.0) -> float:
    found = [
        v.quantity.value
        for v in measurement.values
        if v.key == key and v.conditions["time_s"] == time_h * HOUR
    ]
    assert len(found) == 1
    return found[0]


def law_of(measurement: Measurement[Run]) -> Law:
    return viscosity.TECHNIQUE.summarise([measurement], CONTEXT).laws[0]


def flag_names(measurement: Measurement[Run]) -> set[str]:
    return {flag.name for v in measurement.values for flag in v.flags}


def test_a_straight_line_is_recovered_with_its_stated_times() -> None:
    measured = reduce(newtonian(line(TIMES), TIMES, seed=None))
    for hours in (1.0, 6.0, 12.0):
        assert value(measured, "viscosity", hours) == pytest.approx(4 + 0.19 * hours, rel=1e-9)
    law = law_of(measured)
    assert (law.kind, law.valid) == ("polynomial", (HOUR, 12 * HOUR))
    assert law.coefficients == pytest.approx((4.0, 0.19 / HOUR), rel=1e-9)


def test_what_lies_outside_the_window_is_shown_and_not_fitted() -> None:
    odd = line(TIMES)
    odd[TIMES < HOUR] *= 0.8
    odd[TIMES > 12 * HOUR] *= 1.2
    measured = reduce(newtonian(odd, TIMES, seed=None))
    assert value(measured, "viscosity", 12.0) == pytest.approx(4 + 0.19 * 12, rel=1e-9)
    assert len(measured.curve["time_s"]) == len(TIMES)


def test_a_law_that_meets_every_reading_exactly_still_moves_with_the_calibration() -> None:
    slopes = np.stack([np.ones_like(TIMES), TIMES], axis=1).astype(np.float64)
    sigma, shift = np.full(len(TIMES), 0.03), np.full(len(TIMES), 0.025)
    covariance = np.linalg.inv(slopes.T @ slopes / 0.03**2).astype(np.float64)
    for variance in (4.0, 0.0):
        moved = drift_of(variance * covariance, variance, slopes, sigma, shift)
        assert moved == pytest.approx([0.025, 0.0], rel=1e-9, abs=1e-15)


def test_a_law_refuses_to_answer_outside_its_range() -> None:
    law = law_of(reduce(newtonian(line(TIMES), TIMES)))
    with pytest.raises(OutOfRange) as caught:
        law(13 * HOUR)
    assert str(caught.value) == (
        "viscosity of silicone is known for time since mixing from 3600 to 43200 s, not at 46800"
    )
    with pytest.raises(OutOfRange, match="is a law without a shear rate"):
        law(HOUR, 0.1)


@pytest.mark.parametrize(
    ("coefficients", "degree"),
    [
        ((1.64, 0.267), 1),
        ((4.36, 1.2, -0.13, 0.0146), 3),
        ((2.5, 0.493, 0.207, -0.0674, 0.00743), 4),
    ],
)
def test_the_smallest_polynomial_that_the_data_support_is_found(
    coefficients: tuple[float, ...], degree: int
) -> None:
    true = np.asarray(np.polynomial.polynomial.polyval(TIMES / HOUR, coefficients), np.float64)
    measured = reduce(newtonian(true, TIMES, speed_rpm=1.5 if degree == 4 else 3.0), _wide_open())
    law = viscosity.TECHNIQUE.summarise([measured], _wide_open()).laws[0]
    assert (law.kind, len(law.coefficients)) == ("polynomial", degree + 1)
    assert all(f"aicc polynomial of degree {d}" in law.diagnostics for d in range(6))
    assert {"aicc exponential", "refused exponential"} & set(law.diagnostics)
    assert {"aicc power-law-to-gel", "refused power-law-to-gel"} & set(law.diagnostics)
    assert f"leave-one-out polynomial of degree {degree}" in law.diagnostics
    assert str(law.diagnostics["choice"]) in law.method


def _wide_open() -> Context[ViscosityConfig]:
    return replace(CONTEXT, config=ViscosityConfig(torque_window=(0.0, 1.0)))


def test_an_exponential_and_a_gel_law_win_where_they_are_true() -> None:
    grows = 2.0 * np.exp(TIMES / (6 * HOUR))
    law = law_of(reduce(newtonian(grows, TIMES, speed_rpm=6.0), _wide_open()))
    assert law.kind == "exponential"
    assert law.coefficients == pytest.approx((2.0, 1 / (6 * HOUR)), rel=0.02)
    gels = 2.0 * (1.0 - TIMES / (14 * HOUR)) ** -1.2
    law = law_of(reduce(newtonian(gels, TIMES, speed_rpm=1.5), _wide_open()))
    assert law.kind == "power-law-to-gel"
    assert law.coefficients == pytest.approx((2.0, 14 * HOUR, 1.2), rel=0.05)


def test_a_law_neither_falls_nor_goes_below_zero_where_the_readings_do() -> None:
    dips = 4.0 - 0.5 * np.exp(-(((TIMES / HOUR - 5) / 2) ** 2)) + 0.1 * TIMES / HOUR
    law = law_of(reduce(newtonian(dips, TIMES)))
    values = np.array([law(t).value for t in np.linspace(*law.valid, 500)])
    assert values.min() > 0
    assert np.diff(values).min() >= -1e-9


def test_the_unit_of_time_does_not_matter_to_the_law() -> None:
    columns = newtonian(line(TIMES), TIMES)
    plain = law_of(reduce(columns))
    shifted = {**columns, "utc_s": columns["time_s"] + 1_646_161_200.0}
    del shifted["time_s"]
    stamped = law_of(reduce(shifted, mixed_at="2022-03-01T19:00:00+00:00"))
    assert stamped.coefficients == pytest.approx(plain.coefficients, rel=1e-9)


def test_readings_outside_the_torque_window_are_left_out_by_line() -> None:
    columns = newtonian(line(TIMES), TIMES, seed=None)
    columns["viscosity_Pas"][10] = 0.5  # 5 % of 10 Pa.s
    columns["torque"][10] = 0.05
    measured = reduce(columns)
    flags = {str(f) for f in measured.values[0].flags}
    assert "outside-torque-window: torque outside 10-100 %: 1 readings left out, lines 12" in flags
    assert value(measured, "viscosity") == pytest.approx(4.19, rel=1e-9)


def test_readings_that_contradict_themselves_are_left_out_by_line() -> None:
    columns = newtonian(line(TIMES), TIMES, seed=None)
    columns["torque"][[4, 5, 9]] = 0.9
    flags = {str(f) for f in reduce(columns).values[0].flags}
    assert (
        "contradicting: viscosity, torque and speed disagree: 3 readings left out, lines 6-7, 11"
        in flags
    )


def test_a_run_in_the_wrong_unit_or_of_another_rotor_is_refused() -> None:
    columns = newtonian(line(TIMES), TIMES, seed=None)
    columns["viscosity_Pas"] = columns["viscosity_Pas"] / 1000
    measured = reduce(columns)
    assert measured.values == ()
    assert measured.refusals[0].reason == (
        "viscosity, torque and speed contradict each other in 52 of 52 readings, first in line 2: "
        "0.0040475 Pa.s of 10 Pa.s full scale is 0.0 %, not 40.5 %; check rotor, speed and unit"
    )
    columns = newtonian(line(TIMES), TIMES, seed=None)
    columns["speed_rpm"][:] = 10.0
    assert reduce(columns).refusals[0].reason == (
        "line 2: an NDJ-8S turns at 0.3, 0.6, 1.5, 3, 6, 12, 30, 60 rpm, not at 10"
    )


def test_a_change_of_speed_is_flagged_and_weights_follow_full_scale() -> None:
    rises = 1.5 + 0.3 * TIMES / HOUR
    slow, fast = newtonian(rises, TIMES), newtonian(rises, TIMES, speed_rpm=30.0)
    late = rises > 3.6
    columns = {k: np.where(late, slow[k], fast[k]) for k in slow}
    measured = reduce(columns, _wide_open())
    assert "setting-changed" in flag_names(measured)
    noise = measured.curve["noise_Pas"]
    assert noise[~late] == pytest.approx(0.003 * 4.0)
    assert noise[late] == pytest.approx(0.003 * 10.0)


def test_doubling_and_limit_with_their_budgets() -> None:
    rises = 2.0 + 0.5 * TIMES / HOUR
    context = replace(CONTEXT, config=ViscosityConfig(limit_viscosity_Pas=4.0))
    measured = reduce(newtonian(rises, TIMES, seed=None), context)
    found = {v.key: v for v in measured.values}
    assert found["viscosity_doubling_time"].quantity.value == pytest.approx(6 * HOUR, rel=1e-9)
    assert found["time_to_viscosity_limit"].quantity.value == pytest.approx(4 * HOUR, rel=1e-9)
    # one sigma of the calibration adds 0.025 Pa.s to every reading: the limit comes 0.05 h sooner,
    # and doubling, of a start that is 0.025 Pa.s higher too, 0.05 h later
    for key in ("viscosity_doubling_time", "time_to_viscosity_limit"):
        assert found[key].quantity.u_shared == pytest.approx(0.05 * HOUR, rel=1e-6)


def test_a_doubling_beyond_the_law_is_refused_with_what_was_found() -> None:
    measured = reduce(newtonian(line(TIMES), TIMES, seed=None))
    reasons = {r.key: r.reason for r in measured.refusals}
    assert reasons == {
        "viscosity_doubling_time": "at the end of the law, 12 h after mixing, viscosity is 1.5 "
        "times that at 1 h, not 2 times; measure longer",
        "viscosity_at_printing_rate": "the law knows the shear rate of its readings alone, so "
        "nothing tells what viscosity is at 95 1/s; sweep the speeds, or measure a flow curve",
    }


@pytest.mark.parametrize(
    ("notes", "clock", "reason"),
    [
        (
            {},
            "local_clock_s",
            "the readings are stamped by the clock, and the register has no `mixed_at`; fill it in "
            "(2022-03-01T20:15:00)",
        ),
        (
            {"mixed_at": "2022-03-01"},
            "local_clock_s",
            "`mixed_at` '2022-03-01' is not a date and time; write it as 2022-03-01T20:15:00",
        ),
        (
            {"mixed_at": "1970-01-01T01:00:00"},
            "local_clock_s",
            "the first reading is stamped 2700 s before mixing; correct `mixed_at` or the "
            "campaign's time zone",
        ),
        (
            {"mixed_at": "2022-03-01T00:20:00"},
            "time_of_day_s",
            "stamps without a date: the first is 23.9 h after mixing or 0.1 h before it; stamp "
            "with the date",
        ),
    ],
)
def test_clocks_that_do_not_tell_the_time_since_mixing(
    notes: dict[str, str], clock: str, reason: str
) -> None:
    columns = newtonian(line(TIMES), TIMES)
    columns[clock] = columns.pop("time_s")
    assert reduce(columns, CONTEXT, 1, **notes).refusals[0].reason == reason


def test_summer_time_ends_within_a_run() -> None:
    columns = newtonian(line(TIMES), TIMES, seed=None)
    # mixed at 20:00 on 29 October 2022 in Berlin; clocks fell back at 03:00, 7 h later
    start = 1_667_073_600.0  # 20:00 as if it were UTC
    shown = start + TIMES - np.where(TIMES >= 7 * HOUR, HOUR, 0.0)
    columns["local_clock_s"] = shown
    del columns["time_s"]
    berlin = replace(CONTEXT, timezone="Europe/Berlin")
    measured = reduce(columns, berlin, mixed_at="2022-10-29T20:00:00")
    assert measured.curve["time_s"] == pytest.approx(TIMES)
    without = reduce(columns, CONTEXT, mixed_at="2022-10-29T20:00:00")
    assert without.refusals[0].reason == (
        "the clock steps back by 2700 s after line 28, which no change of time in UTC explains"
    )


def test_too_few_readings_are_refused_with_counts() -> None:
    few = TIMES[:8]
    assert reduce(newtonian(line(few), few)).refusals[0].reason == (
        "5 readings are left (readings from 1 h to 12 h after mixing), and a law needs 8; measure "
        "longer or more often, within the torque window"
    )


def test_a_run_without_settings_that_ends_early_is_fitted_from_its_minimum() -> None:
    time_s = np.concatenate([np.arange(11.0, 130.0, 2.0), np.arange(139.0, 400.0, 10.0)])
    true = 0.03 * np.exp(-time_s / 20) + 0.02 * np.exp(time_s / 70)
    rng = np.random.default_rng(3)
    measured = reduce({"time_s": time_s, "viscosity_Pas": true * rng.normal(1, 0.01, len(time_s))})
    law = law_of(measured)
    lowest = time_s[np.argmin(true)]
    assert abs(law.valid[0] - lowest) < 8
    assert law.valid[1] == 129.0
    assert "method-changed" in flag_names(measured)
    assert float(str(law.diagnostics["relative_error"])) < 0.02
    assert "the run ends 399 s after mixing, before the window begins" in law.method


def test_several_runs_give_one_law_of_their_mean() -> None:
    runs = [
        reduce(newtonian(f * line(TIMES), TIMES, seed=i), number=i)
        for i, f in enumerate((0.98, 1.0, 1.02), start=1)
    ]
    summary = viscosity.TECHNIQUE.summarise(runs, CONTEXT)
    law = summary.laws[0]
    levels = [law.diagnostics[f"level_of_run_{i}"] for i in (1, 2, 3)]
    assert levels == pytest.approx([0.98, 1.0, 1.02], abs=2e-3)
    assert law(HOUR).value == pytest.approx(4.19, rel=3e-3)
    assert 2 <= (law.degrees_of_freedom or 0.0) < 30
    assert law.rate_per_rpm_per_s is None
    reordered = viscosity.TECHNIQUE.summarise(runs[::-1], CONTEXT)
    assert reordered.laws[0].coefficients == law.coefficients
    assert reordered.records == summary.records


@pytest.mark.parametrize(("stated_K", "mean_K"), [((295.0, 297.0), 296.0), ((295.0,), None)])
def test_a_law_has_the_mean_temperature_where_every_run_states_it(
    stated_K: tuple[float, ...], mean_K: float | None
) -> None:
    runs = [reduce(newtonian(line(TIMES), TIMES, seed=i), number=i) for i in (1, 2)]
    for i, kelvin in enumerate(stated_K):
        numbers = {"temperature_K": Quantity(kelvin, "K")}
        runs[i] = replace(runs[i], specimen=replace(runs[i].specimen, numbers=numbers))
    assert viscosity.TECHNIQUE.summarise(runs, CONTEXT).laws[0].temperature_K == mean_K


def test_the_intervals_hold_the_truth_of_a_single_run() -> None:
    """200 runs: noise of every reading and one calibration error each, as the room believes."""
    config = ViscosityConfig(laws=("polynomial",), max_degree=2, stated_times_s=(3600.0, 43200.0))
    context = Context(config, MACHINE, {})
    few = np.arange(0.75, 13.0, 0.75) * HOUR
    hits = {3600.0: 0, 43200.0: 0}
    for seed in range(200):
        rng = np.random.default_rng((7, seed))
        true = line(few)
        columns = newtonian(true, few, seed=None)
        errors = rng.normal(0, 0.003, len(few)) + rng.normal(0, 0.0025)
        columns["viscosity_Pas"] = true + 10.0 * errors
        columns["torque"] = np.round(columns["viscosity_Pas"] / 10.0, 3)
        for found in viscosity.TECHNIQUE.reduce(specimen(), recording(columns), context).values:
            time_s = found.conditions.get("time_s")
            if found.key == "viscosity" and isinstance(time_s, float):
                u = found.quantity.standard_uncertainty
                hits[time_s] += abs(found.quantity.value - 4 - 0.19 * time_s / HOUR) <= 1.96 * u
    # 95 % of 200 within three standard deviations of a count
    assert all(181 <= count <= 199 for count in hits.values()), hits


def test_a_config_whose_window_does_not_rise_is_refused() -> None:
    with pytest.raises(ValueError, match="window_s must rise from 0 or more, not 7200 to 3600"):
        ViscosityConfig(window_s=(7200.0, 3600.0))


@pytest.mark.shared
def test_every_curing_resin_is_answered_or_refused_with_a_reason(shared: Path) -> None:
    folder = shared / "real" / "resin-cure-fdboost" / "viscosity"
    register = read_register(
        (folder / "specimens.csv").read_bytes(), "r/viscosity/specimens.csv", "r", "viscosity",
        (), {},
    )  # fmt: skip
    assert register.errors == ()
    assert len(register.specimens) == 32
    context = Context(ViscosityConfig(), Machine(), {})
    refused = []
    for row in register.specimens:
        measured = _resin(row, folder, context)
        if not measured.values:
            assert "misses the readings by" in measured.refusals[0].reason
            refused.append(row.id)
            continue
        law = viscosity.TECHNIQUE.summarise([measured], context).laws[0]
        assert 0 < float(str(law.diagnostics["relative_error"])) <= 0.15
        values = np.array([law(t).value for t in np.linspace(*law.valid, 300)])
        assert values.min() > 0
        assert np.diff(values).min() >= -1e-12
    assert refused == ["resin-13", "resin-21", "resin-63"]


def _resin(row: Specimen, folder: Path, context: Context[ViscosityConfig]) -> Measurement[Run]:
    path = folder / "curves" / str(row.file).rpartition("/")[2]
    file = RawFile(path.name, path.read_bytes())
    return viscosity.TECHNIQUE.reduce(row, detect(file).read(file), context)


def test_all_supported_laws_take_their_scatter_from_the_richest() -> None:
    hours, rng = np.arange(1.0, 13.0), np.random.default_rng(6)
    shown = (1.64 + 0.267 * hours) * (1.0 + 0.03 * rng.normal(size=12))
    whole = audited(
        recording({"time_s": hours * HOUR, "viscosity_Pas": shown}), hours * HOUR, MACHINE, CONFIG
    )
    fitted = fit_law([windowed(whole, CONFIG)], CONFIG)
    assert {law.dof for _, law in fitted.supported} == {6}  # 12 readings less 6 coefficients
    scatter = {law.name: law.estimate(*law.at(6 * HOUR)).scatter for _, law in fitted.supported}
    plain = np.polynomial.polynomial.polyfit(hours, shown, 5, w=1.0 / shown)
    left = (shown - np.polynomial.polynomial.polyval(hours, plain)) / shown
    design = np.stack([np.ones(12), hours], axis=1) / shown[:, None]
    at = np.array([1.0, 6.0])
    by_hand = np.sqrt(at @ np.linalg.inv(design.T @ design) @ at * (left @ left) / 6)
    assert scatter["polynomial of degree 1"] == pytest.approx(by_hand, rel=1e-6)
