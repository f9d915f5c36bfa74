"""Promises of the tension room, on simulated strips (synthetic) and on real ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.records import MeasuredValue, Measurement
from deamat.techniques.shared.modulus import LoadingCurve
from deamat.techniques.tension import TECHNIQUE
from tests.techniques.curves import EXACT, STRIP, context, expected, lengths, reduce, soro, specimen

STRAIN = np.arange(0.0, 2.0, 5e-4)
STRESS = 5e5 * STRAIN
AREA, GAUGE = 18e-6, 33e-3


def pull(
    strain: FloatArray, stress: FloatArray, machine: Machine = EXACT
) -> Measurement[LoadingCurve]:
    columns = {"displacement_m": GAUGE * strain, "force_N": AREA * stress}
    return reduce(TECHNIQUE, STRIP, columns, machine)


def by_key(measured: Measurement[LoadingCurve]) -> dict[str, MeasuredValue]:
    return {value.key: value for value in measured.values}


def budget(value: MeasuredValue, shared: bool) -> dict[str, float]:
    return {c.source: c.u for c in value.budget if c.shared is shared}


def test_modulus_strength_and_elongation_of_a_strip_that_breaks() -> None:
    strain = np.append(STRAIN, STRAIN[-1] + 5e-4 * np.arange(1, 4))
    stress = np.append(STRESS, [50.0, 20.0, 0.0])
    measured = pull(strain, stress)
    values = by_key(measured)
    assert values["tensile_modulus"].quantity.value == pytest.approx(5e5, rel=1e-9)
    assert values["tensile_strength"].quantity.value == pytest.approx(STRESS[-1], rel=1e-12)
    assert values["elongation_at_break"].quantity.value == pytest.approx(STRAIN[-1], rel=1e-12)
    assert values["elongation_at_break"].quantity.unit == "1"
    assert values["tensile_strength"].lines == (9 + 3999, 9 + 3999)
    assert values["tensile_modulus"].lines == (9, 29)
    assert all(value.flags == () for value in values.values())
    assert measured.curve["nominal_strain"].size == STRAIN.size


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_zeros_after_the_break_change_nothing(sign: float) -> None:
    zeros = np.zeros(20)
    values = by_key(pull(sign * np.append(STRAIN, zeros), -sign * np.append(STRESS, zeros)))
    assert values["tensile_strength"].quantity.value == pytest.approx(STRESS[-1])
    assert values["elongation_at_break"].quantity.value == pytest.approx(STRAIN[-1])
    assert values["elongation_at_break"].flags == ()


def test_a_tear_ends_where_half_of_the_load_is_gone() -> None:
    strain = np.append(STRAIN, [2.01, 2.02, 2.03, 2.04])
    stress = np.append(STRESS, [0.9e6, 0.6e6, 0.4e6, 0.0])
    values = by_key(pull(strain, stress))
    assert values["tensile_strength"].quantity.value == pytest.approx(STRESS[-1])
    assert values["elongation_at_break"].quantity.value == pytest.approx(2.02)


@pytest.mark.parametrize(
    ("strain", "stress", "told"),
    [
        (STRAIN, STRESS, "the record ends under load, at 199.9 % strain: a lower limit"),
        (
            np.append(STRAIN, STRAIN[::-1]),
            np.append(STRESS, 0.8 * STRESS[::-1]),
            "the machine turns before the strip breaks, at 199.9 % strain: a lower limit",
        ),
    ],
)
def test_a_strip_that_did_not_break_gives_lower_limits(
    strain: FloatArray, stress: FloatArray, told: str
) -> None:
    values = by_key(pull(strain, stress))
    assert values["elongation_at_break"].quantity.value == pytest.approx(STRAIN[-1])
    assert values["tensile_modulus"].bound == "exact"
    for key in ("tensile_strength", "elongation_at_break"):
        assert values[key].bound == "lower"
        assert [str(f) for f in values[key].flags] == [f"no-break: {told}"]


def broken(strain: FloatArray, stress: FloatArray, zero: float = 0.0) -> dict[str, MeasuredValue]:
    after = strain[-1] + 5e-4 * np.arange(1, 6)
    return by_key(pull(np.append(strain, after), np.append(stress, np.zeros(5)) + zero))


def flags(value: MeasuredValue) -> list[str]:
    return [f.name for f in value.flags]


@pytest.mark.parametrize("start", [1.0, 0.02, -0.7])
def test_an_absolute_position_counts_from_its_start_and_says_so(start: float) -> None:
    values = broken(STRAIN + start, STRESS)
    assert values["tensile_modulus"].quantity.value == pytest.approx(5e5)
    assert values["elongation_at_break"].quantity.value == pytest.approx(STRAIN[-1])
    for value in values.values():
        assert flags(value) == ["displacement-zeroed"]


@pytest.mark.parametrize("zero", [3e4, -3e4])
def test_the_load_after_the_break_is_the_zero_of_the_cell(zero: float) -> None:
    values = broken(STRAIN, STRESS, zero)
    assert values["tensile_strength"].quantity.value == pytest.approx(STRESS[-1])
    assert flags(values["tensile_strength"]) == ["untared-load"]
    assert values["tensile_modulus"].quantity.value == pytest.approx(5e5)


def test_slack_is_flagged_and_the_modulus_of_the_taut_strip_stands_beside() -> None:
    values = broken(STRAIN, 5e5 * np.maximum(STRAIN - 0.004, 0.0))
    assert values["tensile_modulus"].quantity.value < 4.5e5
    assert "slack" in flags(values["tensile_modulus"])
    taut = values["tensile_modulus_toe_compensated"]
    assert taut.quantity.value == pytest.approx(5e5, rel=0.01)
    assert "slack" not in flags(taut)


def test_noise_is_no_modulus() -> None:
    rng = np.random.default_rng(4)
    stress = 5e5 * np.maximum(STRAIN - 0.02, 0.0) + rng.normal(0.0, 3e3, STRAIN.size)
    measured = pull(np.append(STRAIN, [2.0]), np.append(stress, [0.0]))
    (refusal,) = (r for r in measured.refusals if r.key == "tensile_modulus")
    assert refusal.selective
    assert "cannot be told from zero" in refusal.reason


def test_a_slip_leaves_the_strength_flagged_and_refuses_the_elongation() -> None:
    slid = np.where(STRAIN > 1.0, STRESS - 1e5, STRESS)
    measured = pull(np.append(STRAIN, [2.0]), np.append(slid, [0.0]))
    assert "slip" in flags(by_key(measured)["tensile_strength"])
    (refusal,) = measured.refusals
    assert refusal.key == "elongation_at_break"
    assert "at 100 % strain and rises again: slip in the grips" in refusal.reason


def test_cycles_before_the_break_are_not_the_test() -> None:
    cycle = STRAIN[STRAIN <= 0.5]
    strain = np.concatenate([cycle, cycle[::-1], STRAIN])
    stress = np.concatenate([5e5 * cycle, 5e5 * cycle[::-1], STRESS])
    values = broken(strain, stress)
    assert values["elongation_at_break"].quantity.value == pytest.approx(STRAIN[-1])
    assert values["tensile_strength"].quantity.value == pytest.approx(STRESS[-1])
    assert values["tensile_modulus"].quantity.value == pytest.approx(5e5)
    assert all("several-loadings" in flags(v) for v in values.values())


@pytest.mark.parametrize("wild_Pa", [1.1 * STRESS[-1], 1e3 * STRESS[-1], -1e3 * STRESS[-1], 0.0])
def test_one_wild_load_moves_no_value(wild_Pa: float) -> None:
    stress = STRESS.copy()
    stress[3000] = wild_Pa
    values = broken(STRAIN, stress)
    assert values["tensile_strength"].quantity.value == pytest.approx(STRESS[-1])
    assert values["elongation_at_break"].quantity.value == pytest.approx(STRAIN[-1])
    assert values["tensile_modulus"].quantity.value == pytest.approx(5e5)
    assert all("wild-reading" in flags(v) for v in values.values())
    (flag,) = (f for f in values["tensile_modulus"].flags if f.name == "wild-reading")
    assert flag.detail == (
        "force_N stands off both neighbours, which agree, in line 3009: taken as the mean of both"
    )


def test_one_wild_position_moves_no_value() -> None:
    strain = STRAIN.copy()
    strain[3000] = -50.0
    values = broken(strain, STRESS)
    assert values["elongation_at_break"].quantity.value == pytest.approx(STRAIN[-1])
    assert all("wild-reading" in flags(v) for v in values.values())


def test_a_channel_of_many_wild_readings_is_refused() -> None:
    stress = STRESS.copy()
    stress[1000:3000:400] = 1e9
    measured = pull(np.append(STRAIN, [2.0]), np.append(stress, [0.0]))
    assert measured.values == ()
    assert measured.refusals[0].reason == (
        "force_N stands off both neighbours, which agree, in line 1009, 1409, 1809 and 2 others: "
        "the channel is not to be trusted"
    )


def test_an_extensometer_takes_the_place_of_the_crosshead() -> None:
    strain = np.append(STRAIN, [2.0])
    columns = {
        "displacement_m": 1.5 * GAUGE * strain,
        "force_N": AREA * np.append(STRESS, [0.0]),
        "extensometer_strain": np.append(STRAIN, [0.01]),
    }
    values = by_key(reduce(TECHNIQUE, STRIP, columns, EXACT))
    assert values["tensile_modulus"].quantity.value == pytest.approx(5e5)
    assert values["elongation_at_break"].quantity.value == pytest.approx(STRAIN[-1])
    (said,) = (f.detail for f in values["tensile_modulus"].flags if f.name == "extensometer")
    assert "the crosshead over the gauge length says 1.5 times as much" in said


def test_slack_of_a_tenth_is_said_of_the_elongation() -> None:
    loose = np.append(np.zeros(401), 5e5 * (STRAIN[401:] - STRAIN[400]))
    (flag,) = broken(STRAIN, loose)["elongation_at_break"].flags
    assert flag.name == "slack"
    assert "from 20 % strain on: 10 % of this elongation" in flag.detail


def test_the_files_own_strain_is_held_against_the_crosshead_without_a_stress_too() -> None:
    for ratio, names in ((1.5, ["own-columns-disagree"]), (1.0, [])):
        columns = {
            "displacement_m": GAUGE * STRAIN, "force_N": AREA * STRESS,
            "nominal_strain": np.round(STRAIN / ratio, 3),
        }  # fmt: skip
        values = by_key(reduce(TECHNIQUE, STRIP, columns, EXACT))
        assert flags(values["tensile_modulus"]) == names
        assert flags(values["elongation_at_break"]) == [*names, "no-break"][::-1]


def test_a_strain_channel_that_was_not_connected_says_nothing() -> None:
    columns = {
        "displacement_m": GAUGE * STRAIN, "force_N": AREA * STRESS, "nominal_strain": 0.0 * STRAIN,
    }  # fmt: skip
    assert flags(by_key(reduce(TECHNIQUE, STRIP, columns, EXACT))["tensile_modulus"]) == []


def test_a_refused_modulus_leaves_strength_and_elongation() -> None:
    strain = np.append(np.arange(0.0446, 9.0, 0.0227), [9.1])
    measured = pull(strain, np.append(3e5 * strain[:-1], [0.0]))
    assert [v.key for v in measured.values] == ["tensile_strength", "elongation_at_break"]
    (refusal,) = measured.refusals
    assert (refusal.key, refusal.specimen) == ("tensile_modulus", "a")
    assert refusal.reason.startswith(
        "0 samples in the window of 0-1 % strain, 5 are needed (`min_samples`); "
    )
    assert refusal.diagnostics == {"samples": 0, "samples_needed": 5}
    assert refusal.conditions == {"window": (0.0, 0.01)}


def test_a_strip_that_was_never_pulled_is_refused_whole() -> None:
    measured = pull(STRAIN, np.append(np.zeros(STRAIN.size - 1), [-0.0]))
    assert [r.key for r in measured.refusals] == [
        "tensile_modulus", "tensile_strength", "elongation_at_break",
    ]  # fmt: skip
    assert measured.refusals[1].reason == (
        "the greatest stress of the loading is 0 Pa, not positive; nothing was pulled, or the "
        "force is of another sign than the displacement"
    )


def test_budgets_of_strength_and_elongation() -> None:
    numbers = lengths(
        width_m=Quantity(6e-3, "m", 6e-5),
        thickness_m=Quantity(3e-3, "m", 0.0, 6e-5),
        gauge_length_m=Quantity(33e-3, "m", 3.3e-4),
    )
    machine = Machine(force_resolution_N=0.01)
    columns = {"displacement_m": GAUGE * STRAIN, "force_N": AREA * STRESS}
    values = by_key(reduce(TECHNIQUE, numbers, columns, machine))
    top = float(STRESS[-1])
    assert budget(values["tensile_strength"], shared=True) == pytest.approx(
        {"load cell calibration": 0.005 * top, "thickness, gauge calibration": 0.02 * top}
    )
    assert budget(values["tensile_strength"], shared=False) == pytest.approx(
        {"width, reading": 0.01 * top, "load cell resolution": 0.01 / AREA / 12**0.5}
    )
    far = float(STRAIN[-1])
    assert budget(values["elongation_at_break"], shared=True) == pytest.approx(
        {"displacement calibration": 0.002 * far}
    )
    assert budget(values["elongation_at_break"], shared=False) == pytest.approx(
        {"sampling interval at break": 5e-4 / 12**0.5, "gauge length, reading": 0.01 * far}
    )
    for value in values.values():
        u = np.sqrt(sum(c.u**2 for c in value.budget))
        assert value.quantity.standard_uncertainty == pytest.approx(u)


@pytest.mark.shared
def test_soro_strips_refuse_the_modulus_and_give_the_rest(shared: Path) -> None:
    rows = [r for r in expected(shared) if r["mode"] == "tension"]
    folder = shared / "real" / "soro-2019" / "tension" / "curves"
    paths = sorted(folder.glob("*.csv"))
    assert len(paths) == 7
    for path in paths:
        file = soro(path)
        measured = TECHNIQUE.reduce(
            specimen("tension", STRIP, path.stem), file, context(TECHNIQUE, Machine())
        )
        (refusal,) = measured.refusals
        want = {r["quantity"]: r for r in rows if Path(r["file"]).name == path.name}
        strength = want["tensile strength (max eng. stress)"]
        n = int(strength["n_pts_0_1pct"])
        assert refusal.key == "tensile_modulus"
        assert refusal.diagnostics["samples"] == n
        assert f"{n} sample" in refusal.reason
        assert "5 are needed" in refusal.reason
        assert "sampling rate at least" in refusal.reason
        values = by_key(measured)
        stress, strain = file.columns["nominal_stress_Pa"], file.columns["nominal_strain"]
        found = values["tensile_strength"].quantity.value
        assert found == stress.max()
        assert f"{found / 1e6:.5g}" == f"{float(strength['expected']):.5g}"
        stretch = values["elongation_at_break"].quantity.value
        assert stretch == strain[stress.argmax()]
        assert (
            f"{100 * stretch:.5g}" == f"{float(want['elongation at max stress']['expected']):.5g}"
        )
        assert values["elongation_at_break"].flags[0].name == "no-break"


def _broken(stress: FloatArray) -> tuple[FloatArray, FloatArray]:
    strain = np.append(STRAIN, STRAIN[-1] + 5e-4 * np.arange(1, 4))
    return strain, np.append(stress, [50.0, 20.0, 0.0])


def test_a_saturated_load_cell_gives_lower_limits() -> None:
    strain, stress = _broken(np.minimum(STRESS, 8e5))
    values = by_key(pull(strain, stress))
    assert values["tensile_modulus"].quantity.value == pytest.approx(5e5, rel=1e-9)
    for key, limit in (("tensile_strength", 8e5), ("elongation_at_break", 1.6)):
        assert values[key].bound == "lower"
        assert values[key].quantity.value == pytest.approx(limit)
    for value in values.values():
        (flag,) = value.flags
        assert flag.name == "held-channel"
        assert flag.detail.startswith("the load holds 800 kPa from 160 % to 199.9 % strain")


def test_a_frozen_displacement_gives_a_lower_limit_of_elongation() -> None:
    strain, stress = _broken(STRESS)
    values = by_key(pull(np.minimum(strain, 1.5), stress))
    assert values["elongation_at_break"].bound == "lower"
    assert values["elongation_at_break"].quantity.value == pytest.approx(1.5)
    assert values["tensile_strength"].bound == "exact"
    assert values["tensile_strength"].quantity.value == pytest.approx(STRESS[-1])
    assert {f.name for v in values.values() for f in v.flags} == {"held-channel"}


def test_a_load_that_sticks_within_the_window_refuses_the_modulus() -> None:
    strain, stress = _broken(STRESS)
    stress[5:18] = stress[5]
    measured = pull(strain, stress)
    (refusal,) = [r for r in measured.refusals if r.key == "tensile_modulus"]
    assert refusal.reason.startswith("held-channel: the load holds one value from sample 6 to 18")


@pytest.mark.parametrize(
    ("over", "flagged"), [(0.0, False), (0.001, False), (0.005, True), (0.02, True)]
)
def test_a_round_toe_is_in_the_uncertainty_of_the_compensated_modulus(
    over: float, flagged: bool
) -> None:
    taut = STRAIN - 0.004
    stress = 5e5 * 0.5 * (taut + np.hypot(taut, over))
    value = by_key(pull(STRAIN, stress))["tensile_modulus_toe_compensated"]
    q = value.quantity
    assert abs(q.value - 5e5) < 2.0 * q.standard_uncertainty + 1e-3 * 5e5
    assert q.standard_uncertainty < 0.3 * 5e5
    assert ("toe" in {flag.name for flag in value.flags}) == flagged
