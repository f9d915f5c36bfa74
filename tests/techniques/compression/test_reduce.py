"""Promises of the compression room, on simulated cylinders (synthetic) and on real ones."""

from __future__ import annotations

import math
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from deamat.core.arrays import FloatArray
from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.records import Measurement
from deamat.techniques.compression import TECHNIQUE
from deamat.techniques.compression.config import CompressionConfig
from deamat.techniques.shared.modulus import LoadingCurve
from tests.techniques.curves import (
    CYLINDER,
    EXACT,
    context,
    expected,
    lengths,
    phantom,
    recording,
    reduce,
    specimen,
)

AREA = math.pi * 0.025**2
STRAIN = np.arange(0.0, 0.3, 5e-4)
MODULUS, COMPENSATED = TECHNIQUE.yields


def compress(
    stress: FloatArray, strain: FloatArray = STRAIN, machine: Machine = EXACT
) -> Measurement[LoadingCurve]:
    columns = {"displacement_m": 0.03 * strain, "force_N": AREA * stress}
    return reduce(TECHNIQUE, CYLINDER, columns, machine)


def names(measurement: Measurement[LoadingCurve]) -> list[str]:
    return [flag.name for flag in measurement.values[0].flags]


def test_a_straight_line_gives_its_modulus_twice_and_no_flag() -> None:
    measured = compress(1e5 * STRAIN)
    plain, compensated = measured.values
    assert (plain.key, compensated.key) == (MODULUS, COMPENSATED)
    assert plain.quantity.value == pytest.approx(1e5, rel=1e-12)
    assert compensated.quantity.value == pytest.approx(1e5, rel=1e-12)
    assert plain.flags == ()
    assert plain.conditions == {"window": (0.0, 0.05)}
    assert plain.lines == (9, 109)
    assert plain.diagnostics["samples"] == 101
    assert measured.refusals == ()


def test_a_toe_is_flagged_and_compensated_under_its_own_name() -> None:
    toe = np.where(STRAIN < 0.02, 1e5 * STRAIN**2 / 0.04, 1e5 * (STRAIN - 0.01))
    plain, compensated = compress(toe).values
    inside = STRAIN <= 0.05 + 1e-9
    slope = np.polyfit(STRAIN[inside], toe[inside], 1)[0]
    assert plain.quantity.value == pytest.approx(slope, rel=1e-12)
    assert compensated.diagnostics["zero_strain"] == pytest.approx(0.01, abs=1e-9)
    assert compensated.quantity.value > 1.02 * plain.quantity.value
    assert compensated.quantity.value == pytest.approx(1e5, rel=0.05)
    flag = plain.flags[0]
    assert flag.name == "toe"
    assert flag.detail.startswith("slope 23.75 kPa up to 1 % strain, 100 kPa from ")
    assert "zero of the toe's tangent" in {c.source for c in compensated.budget}


def test_the_toes_zero_counts_as_anywhere_in_its_bin_of_one_percent() -> None:
    # on a parabola the slope over a window moves by 2 x 4e5 Pa for each unit that its zero moves
    value = compress(5e4 * STRAIN + 4e5 * STRAIN**2).values[1]
    (line,) = [c for c in value.budget if c.source == "zero of the toe's tangent"]
    zeros = np.random.default_rng(3).uniform(-0.005, 0.005, 20_000)
    assert line.u == pytest.approx(8e5 * zeros.std(), rel=0.01)
    assert line.u == pytest.approx(8e5 * 0.01 / math.sqrt(12.0), rel=1e-6)
    assert not line.shared


def test_a_load_that_nobody_zeroed_stands_in_the_compensated_budget_alone() -> None:
    toe = 1e5 * (STRAIN - 0.004 * -np.expm1(-STRAIN / 0.004)) * (1.0 + STRAIN)
    zeroed, not_zeroed = compress(toe), compress(toe + 200.0)
    source = "load before the test: on the specimen or not"
    (line,) = [c for c in not_zeroed.values[1].budget if c.source == source]
    assert line.shared
    moved = zeroed.values[1].quantity.value - not_zeroed.values[1].quantity.value
    assert moved > 100.0  # Pa: the tangent's zero lies at a lesser strain, where the curve bends
    assert math.sqrt(3.0) * line.u == pytest.approx(moved, rel=0.3)
    assert source not in {c.source for c in not_zeroed.values[0].budget}
    assert not_zeroed.values[0].quantity.value == pytest.approx(zeroed.values[0].quantity.value)


def test_a_gap_is_a_missing_contact() -> None:
    plain, compensated = compress(np.maximum(1e5 * (STRAIN - 0.0125), 0.0)).values
    assert plain.flags[0].name == "contact"
    assert plain.flags[0].detail.endswith("the plates hardly touched at first")
    assert compensated.quantity.value == pytest.approx(1e5, rel=1e-6)


def test_a_preload_is_flagged_and_not_compensated() -> None:
    measured = compress(2e3 + 1e5 * STRAIN)
    assert names(measured) == ["preload"]
    assert "2 kPa, 40 % of its rise" in measured.values[0].flags[0].detail
    (refusal,) = measured.refusals
    assert refusal.key == COMPENSATED
    assert refusal.reason == (
        "the steepest tangent meets zero stress at -2 % strain, before the test began: that is a "
        "preload, not a toe; zero the force before contact"
    )


def test_only_the_first_loading_counts() -> None:
    there_and_back = np.concatenate((STRAIN, STRAIN[::-1]))
    stress = np.concatenate((1e5 * STRAIN, 4e4 * STRAIN[::-1]))
    measured = compress(stress, there_and_back)
    assert measured.values[0].quantity.value == pytest.approx(1e5, rel=1e-12)
    assert measured.values[0].flags == ()
    assert measured.curve["nominal_strain"].size == STRAIN.size
    twice = compress(np.tile(stress, 2), np.tile(there_and_back, 2))
    assert names(twice) == ["several-loadings"]
    assert twice.values[0].quantity.value == pytest.approx(1e5, rel=1e-12)


def test_unloading_in_the_window_refuses_both_moduli() -> None:
    up, down = np.arange(0.0, 0.03, 5e-4), np.arange(0.03, 0.02, -5e-4)
    strain = np.concatenate((up, down, np.arange(0.02, 0.2, 5e-4)))
    measured = compress(1e5 * strain, strain)
    assert measured.values == ()
    assert [r.key for r in measured.refusals] == [MODULUS, COMPENSATED]
    assert measured.refusals[0].reason.startswith("unloading inside the window of 0-5 % strain")
    assert measured.refusals[0].conditions == {"window": (0.0, 0.05)}


def test_a_falling_force_is_refused_with_counts() -> None:
    strain = np.append(STRAIN, [0.4])
    stress = np.append(-1e4 * STRAIN, [1e6])
    (refusal, _) = compress(stress, strain).refusals
    assert refusal.reason == (
        "the slope of the 101 samples in the window (10 are needed) is -1e+04 Pa, not positive; "
        "check the contact, the signs and the zero of the displacement, or use a smaller load cell"
    )


def test_no_file_and_no_geometry_are_refusals_of_every_property() -> None:
    measured = TECHNIQUE.reduce(specimen("compression", CYLINDER), None, context(TECHNIQUE))
    assert [r.key for r in measured.refusals] == [MODULUS, COMPENSATED]
    assert measured.refusals[0].reason == (
        "the register names no data file for this specimen; fill in `file`"
    )
    bare = reduce(TECHNIQUE, lengths(height_m=0.03), {})
    assert bare.refusals[0].reason.startswith("the register gives no diameter of this specimen")


def test_speed_becomes_a_strain_rate() -> None:
    numbers = {**CYLINDER, "speed_m_per_s": Quantity(1e-2 / 60.0, "m/s")}
    measured = reduce(TECHNIQUE, numbers, {"displacement_m": 0.03 * STRAIN, "force_N": STRAIN})
    assert measured.values[0].conditions["rate_per_s"] == pytest.approx(1 / 180, rel=1e-5)


def test_geometry_scales_as_it_should() -> None:
    columns = {"displacement_m": 0.03 * STRAIN, "force_N": AREA * 1e5 * STRAIN}
    tall = reduce(TECHNIQUE, lengths(diameter_m=0.05, height_m=0.06), columns)
    thick = reduce(TECHNIQUE, lengths(diameter_m=0.10, height_m=0.03), columns)
    assert tall.values[0].quantity.value == pytest.approx(2e5, rel=1e-12)
    assert thick.values[0].quantity.value == pytest.approx(2.5e4, rel=1e-12)


def test_resolution_is_the_least_that_the_uncertainty_can_be() -> None:
    coarse = Machine(force_resolution_N=0.5, u_force_calibration=0, u_displacement_calibration=0)
    value = compress(1e5 * STRAIN, machine=coarse).values[0]  # no residuals at all
    spread = np.sum((STRAIN[:101] - STRAIN[:101].mean()) ** 2)
    floor = 0.5 / AREA / math.sqrt(12.0 * spread)
    assert value.quantity.u_independent == pytest.approx(floor, rel=1e-9)
    rng = np.random.default_rng(1)
    noisy = 1e5 * STRAIN + rng.normal(0.0, 2e3, STRAIN.size)
    seen = compress(noisy, machine=coarse).values[0]
    assert seen.quantity.u_independent == pytest.approx(
        float(seen.diagnostics["standard_error_Pa"]), rel=1e-9
    )


def test_interval_of_one_specimen_covers_with_every_error_drawn() -> None:
    rng = np.random.default_rng(12)
    strain = np.arange(0.0, 0.06, 5e-4)
    machine = Machine(force_resolution_N=0.02, u_force_calibration=0.01)
    settings = context(TECHNIQUE, machine)
    hits, repeats = 0, 600
    for _ in range(repeats):
        d, h = 0.05 + 3e-4 * rng.standard_normal(), 0.03 + 2e-4 * rng.standard_normal()
        noise = rng.standard_normal(strain.size)
        for i in range(1, strain.size):
            noise[i] = 0.5 * noise[i - 1] + math.sqrt(0.75) * noise[i]
        force = math.pi * d**2 / 4 * (1e5 * strain + 60.0 * noise)
        force *= 1.0 + 0.01 * rng.standard_normal()
        travel = h * strain * (1.0 + 0.002 * rng.standard_normal())
        numbers = lengths(diameter_m=Quantity(0.05, "m", 3e-4), height_m=Quantity(0.03, "m", 2e-4))
        file = recording(displacement_m=travel, force_N=0.02 * np.round(force / 0.02))
        value = TECHNIQUE.reduce(specimen("compression", numbers), file, settings).values[0]
        hits += abs(value.quantity.value - 1e5) < 1.96 * value.quantity.standard_uncertainty
    assert 0.925 <= hits / repeats <= 0.975


def test_summary_covers_the_truth_of_scattering_specimens() -> None:
    rng = np.random.default_rng(21)
    strain = np.arange(0.0, 0.06, 1e-3)
    settings = context(TECHNIQUE, Machine(u_force_calibration=0.02))
    hits, repeats = 0, 300
    for _ in range(repeats):
        cell = 1.0 + 0.02 * rng.standard_normal()
        measured = [
            TECHNIQUE.reduce(
                specimen("compression", CYLINDER, f"s{i}", i),
                recording(
                    displacement_m=0.03 * strain,
                    force_N=AREA * cell * strain * rng.normal(1e5, 3e3)
                    + 0.05 * rng.standard_normal(strain.size),
                ),
                settings,
            )
            for i in range(5)
        ]
        low, high = TECHNIQUE.summarise(measured, settings).records[0].ci95
        hits += low < 1e5 < high
    assert 0.92 <= hits / repeats <= 0.98


@pytest.mark.parametrize(
    ("section", "message"),
    [
        ({"window": (0.05, 0.01)}, r"a window must be 0 <= low < high, not \[0\.05, 0\.01\]"),
        ({"windw": (0.0, 0.05)}, "Extra inputs are not permitted"),
        ({"min_samples": 2}, "greater than or equal to 3"),
    ],
)
def test_config_says_what_is_wrong(section: dict[str, Any], message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        CompressionConfig(**section)


@pytest.mark.shared
def test_each_phantom_comes_out_as_published(shared: Path) -> None:
    folder = shared / "real" / "ecoflex-phantom-2026" / "compression"
    measured: dict[str, list[Measurement[LoadingCurve]]] = defaultdict(list)
    for row in expected(shared):
        if row["mode"] != "compression" or "*" in row["file"]:
            continue
        path = folder / row["material"] / Path(row["file"]).name
        for own_only in (False, True):
            found = TECHNIQUE.reduce(
                specimen("compression", CYLINDER, path.stem),
                phantom(path, own_only),
                context(TECHNIQUE, Machine()),
            )
            value = found.values[0]
            assert value.quantity.value == pytest.approx(1e3 * float(row["expected"]), rel=1e-3)
            assert value.diagnostics["samples"] == int(row["n_pts_0_5pct"])
            assert "own-columns-disagree" not in {f.name for f in value.flags}
            if not own_only:
                measured[row["material"]].append(found)
    published = {"EF50_0T": 158.80e3, "EF30_25T": 50.21e3, "EF10_50T": 16.29e3}
    for material, modulus in published.items():
        (record, _) = TECHNIQUE.summarise(measured[material], context(TECHNIQUE)).records
        assert record.n == 10
        assert record.quantity.value == pytest.approx(modulus, rel=0.05)
        assert record.ci95[0] - 0.03 * modulus < modulus < record.ci95[1] + 0.03 * modulus


@pytest.mark.shared
def test_a_phantom_with_another_diameter_contradicts_its_own_columns(shared: Path) -> None:
    path = shared / "real/ecoflex-phantom-2026/compression/EF50_0T/EF50_0T_A1.csv"
    numbers = lengths(diameter_m=0.049, height_m=0.03)
    found = TECHNIQUE.reduce(
        specimen("compression", numbers), phantom(path), context(TECHNIQUE, Machine())
    )
    (flag,) = [f for f in found.values[0].flags if f.name == "own-columns-disagree"]
    assert "the file's own stress is 0.9604 times" in flag.detail
