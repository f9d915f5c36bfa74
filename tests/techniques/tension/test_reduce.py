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


def test_a_break_that_was_not_recorded_is_flagged() -> None:
    for measured in (
        pull(STRAIN, STRESS),
        pull(np.append(STRAIN, STRAIN[::-1]), np.append(STRESS, 0.8 * STRESS[::-1])),
    ):
        values = by_key(measured)
        assert values["elongation_at_break"].quantity.value == pytest.approx(STRAIN[-1])
        for key in ("tensile_strength", "elongation_at_break"):
            assert [f.name for f in values[key].flags] == ["break-not-recorded"]
        assert "sample 4000 of" in values["tensile_strength"].flags[0].detail
        assert "the break not being recorded" in values["elongation_at_break"].method


def test_a_refused_modulus_leaves_strength_and_elongation() -> None:
    strain = np.append(np.arange(0.0446, 9.0, 0.0227), [9.1])
    measured = pull(strain, np.append(3e5 * strain[:-1], [0.0]))
    assert [v.key for v in measured.values] == ["tensile_strength", "elongation_at_break"]
    (refusal,) = measured.refusals
    assert (refusal.key, refusal.specimen) == ("tensile_modulus", "a")
    assert refusal.reason.startswith("0 samples in the window of 0-1 % strain, 10 are needed; ")
    assert refusal.diagnostics == {"samples": 0, "samples_needed": 10}
    assert refusal.conditions == {"window": (0.0, 0.01)}


def test_a_strip_that_was_never_pulled_is_refused_whole() -> None:
    measured = pull(STRAIN, np.append(np.zeros(STRAIN.size - 1), [-0.0]))
    assert [r.key for r in measured.refusals] == list(TECHNIQUE.yields)
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
        assert "10 are needed" in refusal.reason
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
        assert values["elongation_at_break"].flags[0].name == "break-not-recorded"
