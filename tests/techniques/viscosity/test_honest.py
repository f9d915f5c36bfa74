"""What viscometers and liquids do to a run: found, left out, corrected, flagged or refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.instruments import Machine
from deamat.core.records import Measurement, PropertyRecord, Summary
from deamat.core.register import read_register
from deamat.core.technique import Context
from deamat.core.viscometer import full_scale_Pas
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.techniques import viscosity
from deamat.techniques.viscosity.config import ActivationEnergy, ViscosityConfig
from deamat.techniques.viscosity.result import Run
from tests.techniques.viscosity.runs import CONTEXT, HOUR, newtonian, reduce

TIMES = np.arange(0.25, 12.51, 0.25) * HOUR
RISES = 1.64 + 0.1 * TIMES / HOUR
ROOM_K = 295.15


def summary(measured: Measurement[Run]) -> Summary:
    return viscosity.TECHNIQUE.summarise([measured], CONTEXT)


def at(measured: Measurement[Run], time_h: float, key: str = "viscosity") -> PropertyRecord:
    found = [
        r
        for r in summary(measured).records
        if r.key == key and r.conditions["time_s"] == time_h * HOUR
    ]
    assert len(found) == 1
    return found[0]


def flags(measured: Measurement[Run]) -> dict[str, str]:
    return {flag.name: flag.detail for v in measured.values for flag in v.flags}


def run(viscosity_Pas: FloatArray, speed_rpm: float = 30.0) -> dict[str, FloatArray]:
    return newtonian(viscosity_Pas, TIMES, speed_rpm=speed_rpm, seed=2)


def test_a_sound_run_has_none_of_these_flags() -> None:
    measured = reduce(run(RISES))
    assert flags(measured) == {}
    assert at(measured, 6.0).quantity.value == pytest.approx(2.24, rel=0.01)


def test_a_law_ends_where_the_readings_fall_to_the_end() -> None:
    slips = RISES * (1.0 - 0.4 * np.clip((TIMES / HOUR - 8.0) / 4.0, 0.0, None))
    measured = reduce(run(slips))
    assert flags(measured)["falls"].startswith("viscosity falls by ")
    assert "from 7.75 h after mixing to the end of the run" in flags(measured)["falls"]
    assert at(measured, 6.0).quantity.value == pytest.approx(2.24, rel=0.01)
    assert summary(measured).laws[0].valid == (HOUR, 7.75 * HOUR)
    late = [r.reason for r in measured.refusals if r.conditions.get("time_s") == 12 * HOUR]
    assert late == ["the law holds from 1 h to 7.75 h after mixing, not at 12 h"]


@pytest.mark.parametrize("low", [0.25, 0.4])
def test_bubbles_are_left_out_by_line(low: float) -> None:
    seen = RISES.copy()
    seen[[18, 19, 34]] *= 1.0 - low
    measured = reduce(run(seen))
    assert flags(measured)["outlying-readings"] == (
        "3 of 45 readings lie far off those before and after them, as with bubbles at the rotor: "
        "lines 20-21, 36 left out"
    )
    assert at(measured, 6.0).quantity.value == pytest.approx(2.24, rel=0.01)


def test_a_last_reading_far_off_is_named_and_stays_in() -> None:
    seen = RISES.copy()
    seen[-3] *= 1.05  # at 12 h, where nothing after it says that it is wrong
    measured = reduce(run(seen))
    assert flags(measured)["outlying-readings"] == (
        "1 of 45 readings lies far off the law; it stays in the fit: line 49"
    )
    low, high = at(measured, 6.0).ci95
    assert low <= 2.24 <= high


def test_of_a_few_readings_that_the_law_leaves_at_its_end_each_is_named() -> None:
    times = np.arange(1.0, 12.1) * HOUR
    hours = times / HOUR
    falls = 1.64 * (1.0 + 0.06 * hours) * (1.0 - 0.1 * np.clip(hours - 10.2, 0.0, None))
    measured = reduce(newtonian(falls, times, speed_rpm=30.0, seed=2))
    assert "of 12 readings" in flags(measured)["outlying-readings"]
    steady = newtonian(1.64 * (1.0 + 0.06 * hours), times, speed_rpm=30.0, seed=2)
    assert "outlying-readings" not in flags(reduce(steady))


def test_where_no_law_follows_the_readings_nearby_answer() -> None:
    hours = TIMES / HOUR
    gels = 1.5 * (1.0 + 0.01 * hours) * (1.0 + 4.5 * np.clip((hours - 8.0) / 4.0, 0.0, None) ** 2)
    measured = reduce(run(gels, 12.0), replace(CONTEXT, config=ViscosityConfig()))
    told = flags(measured)["systematic-misfit"]
    assert "follow each other (von Neumann ratio 0." in told
    for hour in (1.0, 6.0, 12.0):
        true = float(np.interp(hour, hours, gels))
        low, high = at(measured, hour).ci95
        assert low <= true <= high
        assert at(measured, hour).quantity.value == pytest.approx(true, rel=0.03)
    law = summary(measured).laws[0]
    inside = (hours >= 1.0) & (hours <= 12.0)
    held = [
        law.ci95(t)[0] <= v <= law.ci95(t)[1]
        for t, v in zip(TIMES[inside].tolist(), gels[inside].tolist(), strict=True)
    ]
    assert np.mean(held) >= 0.95
    doubled = next(r for r in summary(measured).records if r.key == "viscosity_doubling_time")
    start = float(np.interp(1.0, hours, gels))
    assert doubled.quantity.value == pytest.approx(
        float(np.interp(2 * start, gels, TIMES)), rel=0.02
    )


def test_a_fall_in_the_middle_is_held_to_the_shape_and_said() -> None:
    hours = TIMES / HOUR
    dips = 4.0 - 1.0 * np.exp(-(((hours - 5.0) / 1.5) ** 2)) + 0.1 * hours
    measured = reduce(newtonian(dips, TIMES, seed=2))
    assert "held-to-shape" in flags(measured)
    low, high = at(measured, 6.0).ci95
    assert low <= float(np.interp(6.0, hours, dips)) <= high


def _thermal(kelvin: FloatArray, joule_per_mol: float = 2.6e4) -> FloatArray:
    return np.asarray(np.exp(joule_per_mol / 8.314462618 * (1.0 / kelvin - 1.0 / ROOM_K)))


def test_a_drift_of_temperature_refuses_the_law_and_stands_with_each_value() -> None:
    kelvin = ROOM_K + 5.0 * TIMES / TIMES[-1]
    columns = {**run(RISES * _thermal(kelvin)), "temperature_K": kelvin}
    measured = reduce(columns)
    assert "[viscosity.activation_energy]" in flags(measured)["temperature-drift"]
    late = at(measured, 12.0)
    assert late.conditions["temperature_K"] == pytest.approx(ROOM_K + 4.8)
    assert late.quantity.value == pytest.approx(float((RISES * _thermal(kelvin))[-3]), rel=0.02)
    reasons = {r.key: r.reason for r in summary(measured).refusals}
    assert reasons["viscosity_doubling_time"].startswith("the temperature moves by ")
    assert reasons["viscosity"].startswith("the temperature drifts in v-1, and a law is of one")
    assert summary(measured).laws == ()


@pytest.mark.parametrize("declared", [False, True])
def test_a_swing_of_temperature_is_corrected_with_its_uncertainty(declared: bool) -> None:
    kelvin = ROOM_K + 3.0 * np.sin(2 * np.pi * TIMES / HOUR / 6.0)
    columns = {**run(RISES * _thermal(kelvin)), "temperature_K": kelvin}
    energy = ActivationEnergy(J_per_mol=2.5e4, u_J_per_mol=2e3, source="a rheometer")
    config = ViscosityConfig(activation_energy=energy if declared else None)
    measured = reduce(columns, replace(CONTEXT, config=config))
    told = flags(measured)["temperature-corrected"]
    assert ("declared: a rheometer" if declared else "fitted beside the curing") in told
    for hour in (1.0, 6.0, 12.0):
        found = at(measured, hour)
        assert found.conditions["temperature_K"] == pytest.approx(ROOM_K, abs=0.3)
        there = _thermal(np.array([float(str(found.conditions["temperature_K"]))]))[0]
        low, high = found.ci95
        assert low <= (1.64 + 0.1 * hour) * there <= high
        assert "correction of temperature" in {line.source for line in found.budget}
    law = summary(measured).laws[0]
    assert law.temperature_K == pytest.approx(ROOM_K, abs=0.3)


def test_runs_at_two_temperatures_are_not_pooled() -> None:
    runs = [
        reduce({**run(RISES), "temperature_K": np.full(len(TIMES), ROOM_K + warmer)}, number=i)
        for i, warmer in enumerate((0.0, 0.2, 8.0), start=1)
    ]
    found = viscosity.TECHNIQUE.summarise(runs, CONTEXT)
    early = [r for r in found.records if r.key == "viscosity" and r.conditions["time_s"] == HOUR]
    assert [r.n for r in early] == [2, 1]
    assert [float(str(r.conditions["temperature_K"])) for r in early] == pytest.approx(
        [ROOM_K + 0.1, ROOM_K + 8.0]
    )
    assert found.laws == ()
    assert "the runs were at several temperatures" in found.refusals[-1].reason


def test_a_log_without_rotor_and_speed_carries_the_declared_calibration() -> None:
    noisy = RISES * (1.0 + 0.001 * np.random.default_rng(4).normal(size=len(TIMES)))
    measured = reduce({"time_s": TIMES, "viscosity_Pas": noisy})
    found = at(measured, 6.0)
    assert found.quantity.u_shared == pytest.approx(0.03 * found.quantity.value, rel=0.02)
    assert "viscometer calibration" in {line.source for line in found.budget}


def test_single_readings_lie_in_the_prediction_band_of_a_law() -> None:
    law = summary(reduce(run(RISES))).laws[0]
    again = newtonian(RISES, TIMES, speed_rpm=30.0, seed=9)["viscosity_Pas"]
    inside = [
        law.prediction95(t)[0] <= v <= law.prediction95(t)[1]
        for t, v in zip(TIMES.tolist(), again.tolist(), strict=True)
        if HOUR <= t <= 12 * HOUR
    ]
    assert np.mean(inside) >= 0.9


def test_a_power_law_leaves_bubbles_out() -> None:
    rng = np.random.default_rng(8)
    speeds = np.tile([0.6, 1.5, 3.0, 6.0], 45)
    times = np.repeat(np.arange(1.0, 12.01, 0.25) * HOUR, 4) + np.tile([0.0, 40, 80, 120], 45)
    rate = 0.09 * speeds
    true = (6.0 + 0.2 * times / HOUR) * rate**-0.5
    full = np.array([full_scale_Pas(4, s) for s in speeds.tolist()])
    seen = true + full * rng.normal(0.0, 0.003, len(true))
    seen[rng.choice(len(seen), 12, replace=False)] *= 0.5
    columns = {
        "time_s": times, "rotor": np.full(len(times), 4.0), "speed_rpm": speeds,
        "viscosity_Pas": seen, "torque": np.round(seen / full, 3),
        "line": np.arange(2.0, len(times) + 2.0),
    }  # fmt: skip
    context = replace(CONTEXT, config=ViscosityConfig(torque_window=(0.0, 1.0)))
    measured = reduce(columns, context)
    assert "outlying-readings" in flags(measured)
    found = {v.key: v for v in measured.values if v.conditions["time_s"] == 6 * HOUR}
    assert found["flow_index"].quantity.value == pytest.approx(0.5, abs=0.01)
    assert found["flow_consistency"].quantity.value == pytest.approx(7.2, rel=0.02)
    printing = found["viscosity_at_printing_rate"]
    assert printing.quantity.value == pytest.approx(7.2 * 95.0**-0.5, rel=0.05)
    fastest = (summary(measured).laws[0].rates or (0.0, 0.0))[1]
    beyond = np.log(95.0 / fastest)
    line = next(c for c in printing.budget if c.source == "n beyond the shear rates measured")
    assert line.u == pytest.approx(0.05 * beyond * printing.quantity.value, rel=1e-6)
    assert "extrapolated" in {flag.name for flag in printing.flags}
    short = replace(context, config=context.config.model_copy(update={"extrapolation_decades": 1}))
    refused = {r.key: r.reason for r in reduce(columns, short).refusals}
    assert (
        "more than `extrapolation_decades` = 1; measure a flow curve"
        in (refused["viscosity_at_printing_rate"])
    )


@pytest.mark.parametrize(
    ("factor", "said"),
    [(1.0 / 3600.0, "the run ends 12.5 s after mixing (0.000145 days), before 60 s"),
     (60.0, "the run ends 2.7e+06 s after mixing (31.2 days), after 7 days")],
)  # fmt: skip
def test_a_run_that_ends_when_no_cure_can_is_refused(factor: float, said: str) -> None:
    measured = reduce({**run(RISES), "time_s": factor * TIMES})
    assert measured.values == ()
    assert measured.refusals[0].reason.startswith(said)
    assert "`run_s` in [viscosity]" in measured.refusals[0].reason


def test_a_flow_curve_whose_stress_contradicts_its_viscosity_is_refused() -> None:
    rates = np.geomspace(0.1, 100.0, 13)
    columns = {
        "shear_rate_per_s": 60.0 * rates, "viscosity_Pas": 20.0 * rates**-0.3,
        "shear_stress_Pa": 20.0 * rates**0.7,
    }  # fmt: skip
    measured = reduce(columns)
    assert {r.key for r in measured.refusals} == {"viscosity", "flow_consistency", "flow_index"}
    assert measured.refusals[0].reason.startswith(
        "stress over shear rate is 0.01667 times the viscosity beside it"
    )
    assert reduce({**columns, "shear_rate_per_s": rates}).values != ()


@pytest.mark.shared
def test_real_resin_curves_agree_with_their_readings(shared: Path) -> None:
    folder = shared / "real" / "resin-cure-fdboost" / "viscosity"
    register = read_register(
        (folder / "specimens.csv").read_bytes(), "r/viscosity/specimens.csv", "r", "viscosity",
        (), {},
    )  # fmt: skip
    context = Context(ViscosityConfig(), Machine(), {})
    laws = hits = 0
    for row in register.specimens:
        path = folder / "curves" / str(row.file).rpartition("/")[2]
        raw = RawFile(path.name, path.read_bytes())
        columns = detect(raw).read(raw).columns
        measured = viscosity.TECHNIQUE.reduce(row, detect(raw).read(raw), context)
        if not measured.values:
            continue
        found = viscosity.TECHNIQUE.summarise([measured], context)
        law = found.laws[0]
        laws += 1
        time_s, read = columns["time_s"], columns["viscosity_Pas"]
        kept = (time_s >= law.valid[0]) & (time_s <= law.valid[1])
        inside = [
            law.prediction95(t)[0] <= v <= law.prediction95(t)[1]
            for t, v in zip(time_s[kept].tolist(), read[kept].tolist(), strict=True)
        ]
        assert np.mean(inside) >= 0.9, row.id
        doubled = next(r for r in found.records if r.key == "viscosity_doubling_time")
        start = float(np.interp(float(str(doubled.conditions["time_s"])), time_s, read))
        later = time_s >= float(str(doubled.conditions["time_s"]))
        first = int(np.argmax(later & (read >= 2.0 * start)))
        step = slice(first - 1, first + 1)
        direct = float(np.interp(2.0 * start, read[step], time_s[step]))
        hits += int(doubled.ci95[0] <= direct <= doubled.ci95[1])
    assert laws >= 29
    assert hits >= 0.9 * laws
