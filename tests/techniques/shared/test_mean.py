"""Promises of the record that averages specimens."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping

import pytest

from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution, Quantity
from deamat.core.recording import Specimen
from deamat.core.records import (
    Condition,
    Flag,
    MeasuredValue,
    Measurement,
    PropertyRecord,
    Refusal,
    Summary,
)
from deamat.techniques.shared.mean import summarise_by_mean
from tests.techniques.curves import CYLINDER, source, specimen

KEY = "compressive_modulus"


def measurement(
    name: str,
    line: int,
    value: float | None,
    conditions: Mapping[str, Condition] | None = None,
    flags: tuple[Flag, ...] = (),
    shared: float = 0.01,
    speed: float | None = None,
) -> Measurement:
    numbers = CYLINDER if speed is None else {**CYLINDER, "speed_m_per_s": Quantity(speed, "m/s")}
    who: Specimen = specimen("compression", numbers, name, line, {"age": "after cure"})
    if value is None:
        refusal = Refusal(KEY, "too few samples", "m", "c", name)
        return Measurement(who, (), (refusal,), None, source(100))
    budget = (
        Contribution("scatter about the line, autocorrelated", 0.02 * value, shared=False),
        Contribution("load cell calibration", shared * value, shared=True),
        Contribution("diameter, gauge calibration", 0.004 * value, shared=True),
    )
    measured = MeasuredValue(
        KEY,
        Quantity.from_budget(value, "Pa", budget),
        budget,
        "OLS slope",
        {"window": (0.0, 0.05), **(conditions or {})},
        (9, 99),
        {"samples": 91},
        flags,
    )
    return Measurement(who, (measured,), (), None, source(100))


def summary(*measurements: Measurement) -> Summary:
    return summarise_by_mean(measurements, "compression", (KEY,))


def only(*measurements: Measurement) -> PropertyRecord:
    (record,) = summary(*measurements).records
    return record


def test_record_of_three_specimens() -> None:
    record = only(*(measurement(f"s{i}", i, v) for i, v in enumerate((9e4, 10e4, 11e4))))
    assert (record.key, record.material, record.campaign, record.n) == (KEY, "m", "c", 3)
    assert record.quantity.value == 10e4
    assert record.sd == pytest.approx(1e4)
    assert record.quantity.u_independent == pytest.approx(1e4 / math.sqrt(3))
    assert record.quantity.u_shared == pytest.approx(10e4 * math.hypot(0.01, 0.004))
    assert {c.source: c.u for c in record.budget} == {
        "scatter between specimens": pytest.approx(1e4 / math.sqrt(3)),
        "load cell calibration": pytest.approx(1e3),
        "diameter, gauge calibration": pytest.approx(400.0),
    }
    assert record.conditions == {"age": "after cure", "window": (0.0, 0.05)}
    assert record.method == "mean of 3 specimens; OLS slope"
    assert record.diagnostics["min"] == 9e4
    assert record.diagnostics["max"] == 11e4
    assert record.flags == ()
    half = (record.ci95[1] - record.ci95[0]) / 2.0
    assert half > 4.30265 * 1e4 / math.sqrt(3)


def test_origins_lead_to_the_lines_of_the_file() -> None:
    record = only(measurement("s1", 2, 1e5), measurement("s2", 3, 1.1e5))
    first = record.origins[0]
    assert (first.specimen, first.value) == ("s1", 1e5)
    assert first.u_independent == pytest.approx(2e3)
    assert first.u_shared == pytest.approx(1e5 * math.hypot(0.01, 0.004))
    assert (first.register, first.register_line) == ("c/t/s.csv", 2)
    assert (first.path, first.sha256) == ("c/t/a.csv", "0" * 64)
    assert (first.first_line, first.last_line) == (9, 99)
    assert (first.reader, first.technique) == ("test", "compression")
    assert first.diagnostics == {"samples": 91}


def test_the_order_of_the_specimens_does_not_matter() -> None:
    specimens = [measurement(f"s{i}", i, v) for i, v in enumerate((1.1e5, 0.3e5, 0.7e5, 1.3e5))]
    records = {str(summary(*order)) for order in itertools.permutations(specimens)}
    assert len(records) == 1


def test_one_specimen_keeps_its_own_budget() -> None:
    record = only(measurement("s1", 2, 1e5))
    assert (record.n, record.sd) == (1, None)
    assert record.quantity.u_independent == pytest.approx(2e3)
    assert record.budget[0].source == "scatter about the line, autocorrelated"
    assert [f.name for f in record.flags] == ["single-specimen"]
    assert record.method == "OLS slope"


def test_refused_specimens_are_named_beside_the_record() -> None:
    found = summary(measurement("s1", 2, 1e5), measurement("s2", 3, None))
    assert found.records[0].n == 1
    assert [r.specimen for r in found.refusals] == ["s2"]
    nothing = summary(measurement("s1", 2, None), measurement("s2", 3, None))
    assert nothing.records == ()
    assert [r.specimen for r in nothing.refusals] == ["s1", "s2"]


def test_an_outlier_is_flagged_and_stays_in_the_mean() -> None:
    values = (1.00e5, 1.01e5, 0.99e5, 1.02e5, 2.00e5)
    record = only(*(measurement(f"s{i}", i, v) for i, v in enumerate(values)))
    (flag,) = record.flags
    assert flag.name == "outlier"
    assert flag.detail.startswith("s4 with 2e+05 Pa stands apart from the other 4")
    assert record.n == 5
    assert record.quantity.value == pytest.approx(sum(values) / 5)


def test_implausible_values_are_flagged() -> None:
    record = only(measurement("s1", 2, 1e5), measurement("s2", 3, 2e8))
    (flag,) = record.flags
    assert str(flag) == (
        "implausible: a soft elastomer has 1000 to 1e+08 Pa; mean 1.0005e+08; outside: s2 2e+08"
    )


def test_flags_of_specimens_are_said_once() -> None:
    toe = (Flag("toe", "slope 5 kPa"),)
    record = only(measurement("s1", 2, 1e5, flags=toe), measurement("s2", 3, 1e5))
    assert record.flags == (Flag("toe", "1 of 2 specimens, such as s1: slope 5 kPa"),)


def test_the_scatter_of_a_few_specimens_states_its_degrees_of_freedom() -> None:
    record = only(*(measurement(f"s{i}", i, 1e5 + i) for i in range(2, 5)))
    dof = {line.source: line.degrees_of_freedom for line in record.budget}
    assert dof.pop("scatter between specimens") == 2
    assert set(dof.values()) == {None}


def test_rates_that_differ_by_height_only_are_one_condition() -> None:
    record = only(
        measurement("s1", 2, 1e5, {"rate_per_s": 0.0050}, speed=1e-4),
        measurement("s2", 3, 1e5, {"rate_per_s": 0.0061}, speed=1e-4),
    )
    assert record.conditions["rate_per_s"] == pytest.approx(0.00555)


def test_other_conditions_are_other_records() -> None:
    found = summary(
        measurement("s1", 2, 1e5, {"rate_per_s": 0.0055}, speed=1e-4),
        measurement("s2", 3, 2e5, {"rate_per_s": 0.055}, speed=1e-3),
        measurement("s3", 4, 3e5),
    )
    assert sorted(r.quantity.value for r in found.records) == [1e5, 2e5, 3e5]


def test_materials_are_never_mixed() -> None:
    with pytest.raises(
        FitRefused, match=r"^a summary is of one material in one campaign, not of 0"
    ):
        summary()
