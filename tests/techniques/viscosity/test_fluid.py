"""Power-law fluids that cure, and flow curves at one time."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange
from deamat.core.records import Measurement
from deamat.core.viscometer import full_scale_Pas
from deamat.formats.detect import detect
from deamat.formats.rawfile import RawFile
from deamat.techniques import viscosity
from deamat.techniques.viscosity.config import RateFactor, ViscosityConfig
from deamat.techniques.viscosity.flow_curve import NEWTONIAN, POWER_LAW
from deamat.techniques.viscosity.flow_fit import fit_flow_curve
from deamat.techniques.viscosity.flow_sweeps import parted
from deamat.techniques.viscosity.result import Run
from tests.techniques.viscosity.runs import CONTEXT, HOUR, recording, reduce, specimen

SPEEDS = np.array([0.3, 0.6, 1.5])
K = (108.6, 3.293)
INDEX = (0.3921, -0.001088)


def swept(
    k: tuple[float, ...] = K, n: tuple[float, ...] = INDEX, noise: float = 0.0
) -> dict[str, FloatArray]:
    """Sweeps of three speeds every 15 min with rotor 4, over 0.75 h to 12.5 h."""
    starts = np.arange(0.75, 12.6, 0.25) * HOUR
    time_s = (starts[:, None] + np.array([0.0, 40.0, 80.0])).ravel()
    speed = np.tile(SPEEDS, len(starts))
    hours, rate = time_s / HOUR, 0.09 * speed
    polyval = np.polynomial.polynomial.polyval
    true = polyval(hours, k) * rate ** (polyval(hours, n) - 1.0)
    full = np.array([full_scale_Pas(4, float(s)) for s in speed])
    shown = true + full * noise * np.random.default_rng(5).normal(size=len(full))
    count = len(full)
    return {
        "time_s": time_s,
        "rotor": np.full(count, 4.0),
        "speed_rpm": speed,
        "viscosity_Pas": shown,
        "torque": shown / full,
        "line": np.arange(2.0, count + 2.0),
    }


def values(measured: Measurement[Run]) -> dict[tuple[str, object], float]:
    return {(v.key, v.conditions["time_s"]): v.quantity.value for v in measured.values}


def test_k_and_n_come_out_as_such_each_with_its_law() -> None:
    measured = reduce(swept(noise=0.001))
    found = values(measured)
    for hours in (1.0, 6.0, 12.0):
        k, n = K[0] + K[1] * hours, INDEX[0] + INDEX[1] * hours
        assert found["flow_consistency", hours * HOUR] == pytest.approx(k, rel=5e-3)
        assert found["flow_index", hours * HOUR] == pytest.approx(n, abs=2e-3)
        # a wide cup: the rate is 2 omega / n, and K too large by n^-n where it is taken as 2 omega
        assert found["flow_consistency_wide_cup", hours * HOUR] == pytest.approx(k * n**n, rel=6e-3)
    laws = {law.key: law for law in viscosity.TECHNIQUE.summarise([measured], CONTEXT).laws}
    assert set(laws) == {"viscosity", "flow_consistency", "flow_index"}
    whole = laws["viscosity"]
    assert whole.kind == "power-law-fluid"
    assert {law.rate_per_rpm_per_s for law in laws.values()} == {0.09}
    assert sum(whole.parts) == len(whole.coefficients) == len(whole.covariance)
    joined = laws["flow_consistency"].coefficients + laws["flow_index"].coefficients
    assert joined == whole.coefficients
    at_6_h = [laws[key](6 * HOUR).value for key in ("flow_consistency", "flow_index")]
    at = whole(6 * HOUR, 0.04)
    assert at.value == pytest.approx(at_6_h[0] * 0.04 ** (at_6_h[1] - 1.0), rel=1e-12)


def test_one_surface_and_two_stages_are_both_told() -> None:
    law = viscosity.TECHNIQUE.summarise([reduce(swept(noise=0.001))], CONTEXT).laws[0]
    said = law.diagnostics
    assert float(str(said["two_stage_K_0"])) == pytest.approx(K[0], rel=0.01)
    assert float(str(said["two_stage_n_0"])) == pytest.approx(INDEX[0], abs=4e-3)
    assert float(str(said["two_stage_largest_difference"])) < 0.01
    assert float(str(said["aicc power law"])) < float(str(said["aicc Newtonian"]))
    assert "Sikulskyi" in str(said["rate_source"])


def test_a_fluid_answers_only_for_the_rates_measured_throughout() -> None:
    columns = swept(noise=0.001)
    late = (columns["time_s"] > 3 * HOUR) & (columns["speed_rpm"] == 1.5)
    law = viscosity.TECHNIQUE.summarise(
        [reduce({k: v[~late] for k, v in columns.items()})], CONTEXT
    ).laws[0]
    assert law.rates == pytest.approx((0.027, 0.054))
    with pytest.raises(OutOfRange) as caught:
        law(6 * HOUR, 0.27)
    assert str(caught.value) == (
        "viscosity of silicone is known for shear rates from 0.027 to 0.054 1/s, not at 0.27"
    )
    with pytest.raises(OutOfRange, match="not at no rate"):
        law(6 * HOUR)


def test_speeds_that_show_no_power_law_give_a_newtonian_law() -> None:
    columns = swept((60.0, 3.0), (1.0,), noise=0.001)
    wide = replace(CONTEXT, config=ViscosityConfig(torque_window=(0.0, 1.0)))
    law = viscosity.TECHNIQUE.summarise([reduce(columns, wide)], wide).laws[0]
    assert law.kind == "polynomial"
    assert law.coefficients == pytest.approx((60.0, 3.0 / HOUR), rel=0.05)


def test_a_rotor_without_a_declared_shear_rate_is_refused() -> None:
    declared = {"3": RateFactor(per_s_per_rpm=0.09, source="declared for this test")}
    context = replace(CONTEXT, config=ViscosityConfig(rate_factors=declared))
    assert reduce(swept(), context).refusals[0].reason == (
        "no shear rate is declared for rotor 4 (there is one for: 3); declare "
        "[viscosity.rate_factors] with its source"
    )


def test_the_correction_of_k_is_exact_for_a_cylinder_in_a_wide_cup() -> None:
    """Torque of K rate^n at 2 omega / n, read as if the liquid were Newtonian."""
    omega, k, n = np.geomspace(0.01, 1.0, 12), 50.0, 0.4
    stress = k * (2.0 * omega / n) ** n
    apparent = stress / (2.0 * omega)
    curve = fit_flow_curve(2.0 * omega, apparent)
    assert curve.index == pytest.approx(n, rel=1e-9)
    assert curve.consistency == pytest.approx(k * n**-n, rel=1e-9)
    assert curve.consistency * curve.index**curve.index == pytest.approx(k, rel=1e-9)


def test_a_flow_curve_is_newtonian_where_the_data_support_no_more() -> None:
    rate = np.geomspace(0.01, 10, 15)
    noise = np.exp(np.random.default_rng(11).normal(0, 0.02, 15))
    assert fit_flow_curve(rate, 5.0 * noise).law == NEWTONIAN
    assert fit_flow_curve(rate, 5.0 * noise).consistency == pytest.approx(5.0, rel=0.02)
    found = fit_flow_curve(rate, 5.0 * rate**-0.3 * noise)
    assert found.law == POWER_LAW
    assert abs(found.index - 0.7) < 3 * found.u_index


def test_flow_curves_cover_their_index() -> None:
    rate = np.geomspace(0.01, 10, 15)
    rng = np.random.default_rng(12)
    hits = 0
    for _ in range(200):
        curve = fit_flow_curve(rate, 5.0 * rate**-0.3 * np.exp(rng.normal(0, 0.02, 15)))
        hits += abs(curve.index - 0.7) <= 2.16 * curve.u_index  # Student's t, 13 degrees of freedom
    assert 181 <= hits <= 199


@pytest.mark.parametrize(
    ("rate", "eta", "reason"),
    [
        ([1.0, 2.0], [1.0, 1.0], "a flow curve needs at least 5 readings, not 2"),
        (
            [0.01] * 6,
            [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
            "all readings are at 0.01 1/s: one rate tells nothing of a flow curve",
        ),
        (
            [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
            [1.0, 40.0, 1.0, 40.0, 1.0, 40.0],
            "the readings scatter by 381% about the best power law, more than 50%: this is no "
            "power-law fluid at one state",
        ),
    ],
)
def test_what_is_no_flow_curve_is_refused(rate: list[float], eta: list[float], reason: str) -> None:
    with pytest.raises(FitRefused) as caught:
        fit_flow_curve(np.array(rate), np.array(eta))
    assert str(caught.value) == reason


def test_a_file_of_several_samples_needs_the_name_of_one() -> None:
    rate = np.geomspace(0.01, 10, 8)
    columns = {
        "shear_rate_per_s": np.tile(rate, 2),
        "viscosity_Pas": np.concatenate([5.0 * rate**-0.3, 2.0 * rate**-0.5]),
        "sample": np.repeat([0.0, 1.0], 8),
        "line": np.arange(2.0, 18.0),
    }
    file = recording(columns, {"samples": "a; b"})
    unnamed = viscosity.TECHNIQUE.reduce(specimen(), file, CONTEXT)
    assert unnamed.refusals[0].reason == (
        "the file holds 2 samples; name one in the register's column `sample`: a, b"
    )
    named = viscosity.TECHNIQUE.reduce(specimen(sample="b"), file, CONTEXT)
    found = {v.key: v.quantity.value for v in named.values}
    printing = 2.0 * 95.0**-0.5
    assert found == pytest.approx(
        {"flow_consistency": 2.0, "flow_index": 0.5, "viscosity_at_printing_rate": printing}
    )
    assert named.values[0].lines == (10, 17)


@pytest.mark.shared
def test_the_real_flow_curves_agree_with_the_expected_values(shared: Path) -> None:
    expected = {}
    with (shared / "real" / "expected_viscosity_dielectric.csv").open() as file:
        for row in csv.DictReader(file):
            if row["quantity"].startswith("power law n, K all pts"):
                n, k = row["value"].split(";")
                expected[row["quantity"].rpartition(" ")[2]] = float(n), float(k)
    assert len(expected) == 6
    path = shared / "real" / "flow" / "pdms_flow_schmid" / "Results.txt"
    raw = RawFile(path.name, path.read_bytes())
    whole = detect(raw).read(raw)
    for sample, (n, k) in expected.items():
        measured = viscosity.TECHNIQUE.reduce(specimen(sample=sample), whole, CONTEXT)
        found = {v.key: v.quantity.value for v in measured.values}
        assert found["flow_index"] == pytest.approx(n, abs=6e-6)
        assert found["flow_consistency"] == pytest.approx(k, rel=1e-6)


@pytest.mark.shared
def test_every_real_flow_file_is_fitted_or_refused_with_a_reason(shared: Path) -> None:
    refused = []
    for path in sorted((shared / "real" / "flow").glob("*/*")):
        if path.suffix == ".yaml":
            continue
        raw = RawFile(path.name, path.read_bytes(), ends_open=True)
        if path.name == "rotation_ec07_data.csv":  # rejected: it has no units
            continue
        file = detect(raw).read(raw)
        names = file.metadata["samples"].split("; ") if "samples" in file.metadata else [""]
        for name in names:
            measured = viscosity.TECHNIQUE.reduce(specimen(sample=name), file, CONTEXT)
            if not measured.values:
                refused.append((path.parent.name, measured.refusals[0].reason[:40]))
    assert refused == [
        ("cement_rheocompass_utf16", "the readings scatter by 152% about the b"),
        ("glucose_flow_schmid", "the temperature changes by 12.1 K within"),
        ("glucose_flow_schmid", "the temperature changes by 12.1 K within"),
        ("rheodata_caggioni_pg_carbopol_2pct", "the readings scatter by 56% about the be"),
    ]


SWEPT = np.geomspace(0.1, 100.0, 7)


def _sweeps(*levels: float, noise: float = 0.002) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(14)
    rates = np.tile(SWEPT, len(levels))
    values = np.repeat(levels, 7) * np.exp(rng.normal(0.0, noise, len(rates)))
    return {"shear_rate_per_s": rates, "viscosity_Pas": values}


def test_sweeps_that_differ_by_much_are_no_repeats() -> None:
    measured = viscosity.TECHNIQUE.reduce(
        specimen(), recording(_sweeps(3.5, 2.8, 2.17, 1.645, 1.225)), CONTEXT
    )
    assert measured.values == ()
    assert measured.refusals[0].reason.startswith(
        "the file holds 5 sweeps over the same shear rates whose viscosities differ by 185%, more "
        "than `max_sweep_drift` = 10%: several temperatures, or a liquid that changes"
    )


def test_sweeps_that_drift_a_little_are_within_the_interval_and_flagged() -> None:
    measured = viscosity.TECHNIQUE.reduce(specimen(), recording(_sweeps(3.5, 3.4, 3.3)), CONTEXT)
    record = next(
        r
        for r in viscosity.TECHNIQUE.summarise([measured], CONTEXT).records
        if r.key == "viscosity"
    )
    assert record.ci95[0] < 3.3 < 3.5 < record.ci95[1]
    assert "several-sweeps" in {flag.name for flag in record.flags}
    sources = {line.source for line in record.budget}
    assert {"difference between sweeps", "rheometer calibration"} <= sources
    same = viscosity.TECHNIQUE.reduce(specimen(), recording(_sweeps(3.5, 3.5)), CONTEXT)
    assert not {flag.name for v in same.values for flag in v.flags}


def test_sweeps_at_their_own_temperatures_are_answered_apart() -> None:
    columns = _sweeps(3.5, 2.8, 3.5)
    columns["temperature_K"] = np.repeat([295.15, 305.15, 295.25], 7)
    measured = viscosity.TECHNIQUE.reduce(specimen(), recording(columns), CONTEXT)
    found = {
        v.conditions["temperature_K"]: v.quantity.value
        for v in measured.values
        if v.key == "viscosity"
    }
    assert found == pytest.approx({295.15: 3.5, 305.15: 2.8}, rel=0.01)


@pytest.mark.parametrize(
    ("rates", "lengths"),
    [
        (SWEPT, [7]),
        (SWEPT[::-1], [7]),
        (np.tile(SWEPT, 5), [7] * 5),
        (np.tile(SWEPT[::-1], 3), [7] * 3),
        (np.concatenate([SWEPT, SWEPT[-2::-1]]), [7, 6]),
        (np.concatenate([SWEPT, SWEPT[::-1], SWEPT]), [8, 7, 6]),
        (np.repeat(SWEPT, 3), [7, 7, 7]),
        (np.repeat(SWEPT, 3)[:-1], [20]),
        (np.array([1.0, 5, 2, 8, 3, 9, 4]), [7]),
        (np.concatenate([SWEPT, [1.0, 2, 3, 4]]), [7, 4]),
    ],
)
def test_rates_that_turn_or_start_again_begin_a_sweep(
    rates: np.ndarray, lengths: list[int]
) -> None:
    assert [len(sweep) for sweep in parted(rates)] == lengths


def _in_turn(*levels: float) -> dict[str, np.ndarray]:
    swept = _sweeps(*levels)
    order = np.arange(7 * len(levels)).reshape(len(levels), 7).T.ravel()
    return {name: values[order] for name, values in swept.items()}


def test_readings_in_turn_at_every_rate_are_held_against_each_other() -> None:
    measured = viscosity.TECHNIQUE.reduce(specimen(), recording(_in_turn(3.5, 2.8, 2.1)), CONTEXT)
    assert measured.values == ()
    assert "3 sweeps over the same shear rates" in measured.refusals[0].reason
    same = viscosity.TECHNIQUE.reduce(specimen(), recording(_in_turn(3.5, 3.5, 3.5)), CONTEXT)
    assert not {flag.name for v in same.values for flag in v.flags}
    at_three = _in_turn(3.5, 2.8, 2.1) | {"temperature_K": np.tile([295.15, 305.15, 315.15], 7)}
    found = viscosity.TECHNIQUE.reduce(specimen(), recording(at_three), CONTEXT).values
    assert [v.quantity.value for v in found if v.key == "viscosity"] == pytest.approx(
        [3.5, 2.8, 2.1], rel=0.01
    )
