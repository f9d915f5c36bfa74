"""Promises of the breakdown room for a material: Weibull records, flags, refusals, the figure."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from deamat.core.chart import Band, Line, Points
from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.records import PropertyRecord
from deamat.core.register import read_register
from deamat.estimators.weibull.area import scale_to_area
from deamat.techniques.breakdown import TECHNIQUE
from deamat.techniques.breakdown.config import BreakdownConfig
from deamat.techniques.breakdown.summarise import widened
from tests.techniques.breakdown.breakdowns import (
    B1,
    B10,
    LAWLESS_I,
    SHAPE,
    STRENGTH,
    UNBIASED,
    fields,
    film,
    records,
    reduce,
    summarise,
)
from tests.techniques.curves import context
from tests.techniques.shown import marks


def test_the_fit_is_the_maximum_likelihood_of_both_parameters() -> None:
    found = records(fields(LAWLESS_I))
    assert list(found) == [STRENGTH, SHAPE, UNBIASED, B10, B1]
    assert round(found[STRENGTH].quantity.value / 1e6, 3) == 47.781
    assert round(found[SHAPE].quantity.value, 3) == 9.383
    ross = 18.0 / 19.32 * found[SHAPE].quantity.value
    assert found[UNBIASED].quantity.value == pytest.approx(ross)
    assert found[UNBIASED].ci95 == found[SHAPE].ci95
    scale, shape = found[STRENGTH].quantity.value, found[SHAPE].quantity.value
    for key, p in ((B10, 0.1), (B1, 0.01)):
        assert found[key].quantity.value == pytest.approx(scale * (-math.log1p(-p)) ** (1 / shape))
    for record in found.values():
        low, high = record.ci95
        assert low < record.quantity.value < high
        assert record.quantity.u_shared == 0.0
        assert high - low == pytest.approx(2 * 1.96 * record.quantity.u_independent, rel=0.1)
        assert (record.n, record.sd) == (20, None)
        assert record.method.endswith("interval: exact conditional")
        assert [o.value for o in record.origins] == pytest.approx([1e6 * x for x in LAWLESS_I])
        assert [o.diagnostics["censored"] for o in record.origins] == [0] * 20
        assert record.diagnostics["failures"] == 20
        assert record.diagnostics["low_outlier"] == "none"
        assert float(record.diagnostics["goodness_p"]) > 0.05
    assert [f.name for f in found[STRENGTH].flags] == ["field-as-given"]
    assert [f.name for f in found[B1].flags] == ["field-as-given", "extrapolated", "form-untested"]


def test_the_order_of_the_specimens_changes_nothing() -> None:
    measured = fields(LAWLESS_I)
    assert summarise(measured[::-1]) == summarise(measured)


@pytest.mark.shared
def test_lawless_comes_out_to_all_printed_digits(shared: Path) -> None:
    register = "lawless-cable-1982/breakdown/specimens.csv"
    data = (shared / "real" / register).read_bytes()
    found = read_register(data, register, "lawless-cable-1982", "breakdown", TECHNIQUE.required, {})
    assert found.errors == ()
    for material, scale, shape in (
        ("cable-insulation-i", 47.781, 9.383),
        ("cable-insulation-ii", 59.125, 9.141),
    ):
        mine = [reduce(s) for s in found.specimens if s.material == material]
        got = records(mine)
        assert round(got[STRENGTH].quantity.value / 1e6, 3) == scale
        assert round(got[SHAPE].quantity.value, 3) == shape
        assert got[STRENGTH].n == 20


def test_right_censored_specimens_stay_in_the_fit() -> None:
    limit = 47.4
    cut = [min(x, limit) for x in LAWLESS_I]
    marks = [x > limit for x in LAWLESS_I]
    found = records(fields(cut, marks))
    record = found[STRENGTH]
    assert record.quantity.value / 1e6 == pytest.approx(47.8, rel=0.05)
    assert (record.n, record.diagnostics["failures"], record.diagnostics["censored"]) == (20, 14, 6)
    assert record.diagnostics["censoring"] == "type I or random"
    assert record.method.endswith("interval: conditional, approximate for this censoring")
    names = [f.name for f in record.flags]
    assert {"right-censored", "approximate-interval"} <= set(names)
    assert [o.diagnostics["censored"] for o in record.origins] == [int(c) for c in marks]
    ignoring = records(fields(cut))[STRENGTH]
    assert record.quantity.value > 1.02 * ignoring.quantity.value
    assert "modified profile likelihood" in found[UNBIASED].method


@pytest.mark.parametrize(
    ("values", "unbroken", "reason"),
    [
        (
            [40.0, 0.0, 50.0, 45.0],
            None,
            "1 of 4 values are not positive (the first is value 2: 0); a Weibull fit needs finite "
            "values above 0; correct the register row of s3, or leave it out for a stated reason",
        ),
        (
            [40.0, 40.0, 50.0],
            None,
            "only 2 distinct failure(s) among 3 values; at least 3 are needed: test more specimens, "
            "or read the instrument to more digits",
        ),
        (
            [40.0, 41.0, 50.0],
            [True, True, True],
            "all 3 values are censored: nothing failed; at least 3 distinct failures are needed: "
            "test thinner films, or with an amplifier that goes further",
        ),
        (
            [40.0, 40.00001, 40.00002],
            None,
            "the 3 failures differ by 5.0e-07 of the largest; less than 1e-06 is rounding, not "
            "strength: read the instrument to more digits",
        ),
    ],
)
def test_samples_that_cannot_be_fitted_are_refused_with_a_hint(
    values: list[float], unbroken: list[bool] | None, reason: str
) -> None:
    summary = summarise(fields(values, unbroken))
    assert summary.records == ()
    assert [r.key for r in summary.refusals] == list(TECHNIQUE.yields)
    assert {r.reason for r in summary.refusals} == {reason}
    assert {r.specimen for r in summary.refusals} == {None}


def test_few_failures_a_low_outlier_a_poor_fit_and_lost_specimens_are_flagged() -> None:
    few = records(fields([40.0, 45.0, 47.0, 50.0]))[STRENGTH]
    assert "few-failures: 4 failures; 5 are the usual least" in map(str, few.flags)
    weak = records(fields([*LAWLESS_I[:-1], 12.0]))[STRENGTH]
    (flag,) = [f for f in weak.flags if f.name == "low-outlier"]
    assert flag.detail.startswith("s21 broke at 12 V/um; only ")
    assert flag.detail.endswith("hold one as weak; it is in the fit all the same")
    assert weak.diagnostics["low_outlier"] == "s21"
    assert weak.n == 20
    two = np.concatenate((np.linspace(20.0, 21.0, 10), np.linspace(60.0, 61.0, 10)))
    poor = records(fields(two.tolist()))[STRENGTH]
    assert "poor-fit" in {f.name for f in poor.flags}
    coarse = records(fields([40.0, 40.0, 40.0, 45.0, 45.0, 50.0]))[STRENGTH]
    assert "coarse-rounding" in {f.name for f in coarse.flags}
    lost = reduce(film("lost", 30, breakdown_voltage_V=Quantity(1e3, "V")))
    summary = summarise([*fields(LAWLESS_I), lost])
    assert "specimens-refused: 1 gave no value: lost" in map(str, summary.records[0].flags)
    assert [r.specimen for r in summary.refusals] == ["lost"]


def test_areas_and_rates_are_never_mixed_and_scaling_has_a_limit() -> None:
    small = fields(LAWLESS_I, electrode_area_m2=78.5e-6)
    large = fields([0.8 * x for x in LAWLESS_I], electrode_area_m2=785e-6)
    summary = summarise([*small, *large], area_ratio_limit=4.0)
    strengths = [r for r in summary.records if r.key == STRENGTH]
    assert [r.conditions for r in strengths] == [
        {"electrode_area_m2": 78.5e-6},
        {"electrode_area_m2": 785e-6},
    ]
    assert strengths[1].quantity.value == pytest.approx(0.8 * strengths[0].quantity.value)
    assert strengths[0].diagnostics["area_scaling"] == (
        "E2 = E1 (A1/A2)^(1/shape) from A1 = 78.5 mm2, for A1/A2 of 0.25 to 4"
    )
    assert strengths[0].area_ratio_limit == 4.0
    other = scale_to_area(strengths[0].quantity.value, 9.383, 78.5e-6, 314e-6, 4.0)
    assert other == pytest.approx(strengths[0].quantity.value * 0.25 ** (1 / 9.383))
    bare = records(fields(LAWLESS_I))[STRENGTH]
    assert bare.area_ratio_limit is None
    assert str(bare.diagnostics["area_scaling"]).startswith("not possible: the register declares")


def test_shared_errors_widen_fields_and_leave_the_shape_alone() -> None:
    def volts(machine: Machine, gauge_m: float) -> dict[str, PropertyRecord]:
        settings = context(TECHNIQUE, machine)
        thickness = Quantity(100e-6, "m", 0.0, gauge_m)
        measured = [
            TECHNIQUE.reduce(
                film(f"s{i}", i, thickness_m=thickness, breakdown_voltage_V=Quantity(100 * x, "V")),
                None,
                settings,
            )
            for i, x in enumerate(LAWLESS_I)
        ]
        return {r.key: r for r in TECHNIQUE.summarise(measured, settings).records}

    sure = volts(Machine(u_voltage_calibration=0.0), 0.0)
    unsure = volts(Machine(u_voltage_calibration=0.03), 4e-6)
    assert unsure[SHAPE].ci95 == sure[SHAPE].ci95
    for key in (STRENGTH, B10, B1):
        value = sure[key].quantity.value
        assert unsure[key].quantity.u_shared == pytest.approx(0.05 * value)
        for i in (0, 1):
            own = math.log(sure[key].ci95[i] / value)
            assert abs(math.log(unsure[key].ci95[i] / value)) == pytest.approx(
                math.hypot(own, 1.96 * 0.05), rel=1e-4
            )
        assert {c.source for c in unsure[key].budget if c.shared} == {
            "voltage calibration",
            "thickness gauge",
        }


def test_an_interval_without_shared_errors_is_left_as_it_is() -> None:
    assert widened(2.0, (1.0, 3.0), 0.0) == pytest.approx((1.0, 3.0))


def test_intervals_cover_with_large_shared_errors() -> None:
    """Ten register voltages a campaign, 2 % of calibration and 2 um of gauge on all of them."""
    rng = np.random.default_rng(2022)
    shape, scale, campaigns = 9.0, 50e6, 400
    settings = context(TECHNIQUE, Machine(u_voltage_calibration=0.02))
    truth = {
        STRENGTH: scale,
        SHAPE: shape,
        UNBIASED: shape,
        B10: scale * 0.1053605 ** (1 / shape),
        B1: scale * 0.01005034 ** (1 / shape),
    }
    hits = dict.fromkeys(truth, 0)
    for _ in range(campaigns):
        monitor, gauge = 1.0 + 0.02 * rng.standard_normal(), 2e-6 * rng.standard_normal()
        measured = []
        for i in range(10):
            thickness = rng.uniform(100e-6, 150e-6)
            volts = monitor * scale * rng.weibull(shape) * thickness
            reading = Quantity(thickness + gauge + 1e-6 * rng.standard_normal(), "m", 1e-6, 2e-6)
            row = film(f"s{i}", i, thickness_m=reading, breakdown_voltage_V=Quantity(volts, "V"))
            measured.append(TECHNIQUE.reduce(row, None, settings))
        for record in TECHNIQUE.summarise(measured, settings).records:
            hits[record.key] += record.ci95[0] <= truth[record.key] <= record.ci95[1]
    for key, count in hits.items():
        assert 0.93 <= count / campaigns <= 0.97, key


@pytest.mark.parametrize(
    ("section", "message"),
    [
        ({"amplifier_limit_V": 0}, "greater than 0"),
        ({"amplifier_limit": 1e4}, "Extra inputs are not permitted"),
        ({"area_ratio_limit": 0.5}, "greater than or equal to 1"),
        ({"collapse": 1.0}, "less than 1"),
    ],
)
def test_config_says_what_is_wrong(section: dict[str, Any], message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        BreakdownConfig(**section)


def test_the_figure_is_a_weibull_plot_with_line_band_and_unbroken_specimens() -> None:
    unbroken = [x > 50.0 for x in LAWLESS_I]
    measured = fields([min(x, 50.0) for x in LAWLESS_I], unbroken)
    assert TECHNIQUE.figure is not None
    chart = TECHNIQUE.figure(measured, summarise(measured))
    (line,) = marks(chart, Line)
    assert line.label.startswith("fit")
    shape = records(measured)[SHAPE].quantity.value
    slope = np.diff(line.y) / np.diff(np.log(line.x))
    assert slope == pytest.approx(np.full(slope.size, shape))
    points = {mark.label: mark.x for mark in marks(chart, Points)}
    assert points["broken (n = 16)"] == pytest.approx([x for x in LAWLESS_I if x <= 50.0])
    assert points["not broken at this field (n = 4)"].tolist() == [50.0] * 4
    (band,) = (mark for mark in chart.marks if isinstance(mark, Band))
    assert np.all(band.low < np.interp(band.along, line.y, line.x))
    assert np.all(band.high > np.interp(band.along, line.y, line.x))
    assert (chart.x.label, chart.x.spacing) == ("electric field [V/µm]", "log")


def test_a_sample_that_is_refused_still_has_axes() -> None:
    measured = fields([40.0, 41.0], [True, True])
    assert TECHNIQUE.figure is not None
    chart = TECHNIQUE.figure(measured, summarise(measured))
    assert [mark.label for mark in marks(chart, Points)] == ["not broken at this field (n = 2)"]
    assert chart.y.label == "broken [%], as ln(-ln(1 - F))"
