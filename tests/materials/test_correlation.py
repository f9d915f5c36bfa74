from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from deamat.core.card_lists import JointFit
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import PropertyRecord
from deamat.materials.correlation import (
    _told_from_zero,
    coefficient_of,
    correlation,
    correlations_of,
    independent_correlation,
    shared_covariance,
)
from tests.materials.samples import modulus, origin

CELL = Contribution("load cell calibration", 3.0, True)
STRAIN = Contribution("displacement calibration", 4.0, True)


def value(key: str, *shared: Contribution, own: float = 5.0, **changes: Any) -> PropertyRecord:
    """Return a record of gel-a with these lines, from one specimen."""
    budget = (Contribution("scatter between specimens", own, False), *shared)
    fields = {
        "key": key,
        "quantity": Quantity.from_budget(100.0, "Pa", budget),
        "budget": budget,
        "ci95": (90.0, 110.0),
        "origins": (origin("A1", 100.0, 2),),
        "n": 1,
        **changes,
    }
    return modulus(**fields)


def test_errors_of_one_campaign_and_test_are_shared() -> None:
    one = value("compressive_modulus", CELL, STRAIN.inverted())
    other = value("compressive_modulus_toe_compensated", CELL, STRAIN.inverted())
    assert shared_covariance(one, other) == pytest.approx(25.0)
    found, why = correlation(one, other)
    assert found == pytest.approx(25.0 / 50.0)
    assert why == "both rest on displacement calibration and load cell calibration"
    apart = value("compressive_modulus_toe_compensated", CELL, campaign="other")
    assert correlation(one, apart) == (0.0, "")


def test_the_sign_is_that_of_what_the_error_does() -> None:
    stiffer = value("tensile_modulus", STRAIN.inverted())
    longer = value("elongation_at_break", STRAIN)
    assert correlation(stiffer, longer)[0] == pytest.approx(-16.0 / 41.0)


def test_one_calibration_is_shared_by_campaigns_and_techniques() -> None:
    calibrated = replace(CELL, calibration="cell-7", calibrated="force")
    one = value("compressive_modulus", calibrated)
    pulled = replace(origin("T1", 1.0, 2), technique="tension")
    other = value("tensile_modulus", calibrated, campaign="other", origins=(pulled,))
    assert shared_covariance(one, other) == pytest.approx(9.0)
    assert correlation(one, other)[1] == "both rest on cell-7"
    newer = replace(calibrated, calibration="cell-8")
    assert shared_covariance(one, value("tensile_modulus", newer, campaign="other")) == 0.0
    travel = replace(calibrated, calibrated="displacement")
    assert shared_covariance(one, value("tensile_modulus", travel)) == 0.0


def scattered(key: str, values: tuple[float, ...]) -> PropertyRecord:
    origins = tuple(origin(f"A{i}", v, i + 2) for i, v in enumerate(values))
    return value(key, n=len(values), origins=origins)


def test_the_scatter_of_the_same_specimens_counts_where_it_is_told_from_chance() -> None:
    values = (1.0, 2.0, 3.0, 4.0, 5.0)
    one = scattered("compressive_modulus", values)
    near = scattered("compressive_modulus_toe_compensated", (1.1, 2.0, 3.1, 3.9, 5.0))
    found, why = correlation(one, near)
    assert found == pytest.approx(0.997, abs=2e-3)
    assert why == "the values of the same 5 specimens correlate by 1.00"
    loose = scattered("compressive_modulus_toe_compensated", (1.0, 4.0, 2.0, 3.0, 6.0))
    assert correlation(one, loose) == (0.0, "")
    three = scattered("compressive_modulus_toe_compensated", values[:3])
    assert correlation(scattered("compressive_modulus", values[:3]), three) == (0.0, "")
    equal = scattered("compressive_modulus_toe_compensated", (2.0,) * 5)
    assert correlation(one, equal) == (0.0, "")
    assert correlation(one, replace(near, budget=())) == (0.0, "")  # of nothing known


@pytest.mark.parametrize(
    ("pairs", "critical"), [(4, 0.990), (5, 0.959), (6, 0.917), (10, 0.765), (22, 0.537)]
)
def test_a_correlation_is_told_from_zero_beyond_the_tabulated_value(
    pairs: int, critical: float
) -> None:
    """Two-sided at 1 %: R. A. Fisher, F. Yates, Statistical Tables (1938), table VI."""
    for sign in (-1.0, 1.0):
        assert _told_from_zero(sign * (critical + 0.001), pairs)
        assert not _told_from_zero(sign * (critical - 0.001), pairs)


def test_the_three_greatest_of_the_errors_that_two_values_share_are_named() -> None:
    lines = [Contribution(name, u, True) for name, u in zip("abcd", (1, 4, 2, 3), strict=True)]
    one = value("compressive_modulus", *lines)
    other = value("compressive_modulus_toe_compensated", *lines)
    assert correlation(one, other)[1] == "both rest on b and d and c"


FIT = JointFit(
    keys=("breakdown_strength", "weibull_shape"),
    campaign="soft-2026",
    conditions={"age": "after cure", "window": (0.0, 0.05)},
    correlations=((1.0, 0.3), (0.3, 1.0)),
    why="one fit",
)


def test_a_card_lists_what_a_design_draws_together() -> None:
    strength = value("breakdown_strength", CELL)
    shape = value("weibull_shape")
    (pair,) = correlations_of((strength, shape), [FIT])
    assert (pair.key, pair.other_key, pair.why) == (
        "breakdown_strength",
        "weibull_shape",
        "one fit",
    )
    assert pair.coefficient == pytest.approx(0.3 * 5.0 / math.sqrt(34.0), rel=1e-3)
    assert coefficient_of((pair,), shape, strength) == pair.coefficient
    assert independent_correlation((pair,), strength, shape) == pytest.approx(0.3, rel=1e-3)
    assert independent_correlation((), strength, shape) == 0.0


def test_values_of_two_states_are_not_listed() -> None:
    fresh = {"age": "after cure"}
    one = value("compressive_modulus", CELL, conditions=fresh)
    old = value("compressive_modulus_toe_compensated", CELL, conditions={"age": "2 years"})
    assert correlations_of((one, old), []) == ()
    again = value("compressive_modulus", CELL, conditions={**fresh, "window": (0.0, 0.1)})
    assert correlations_of((one, again), []) == ()
    warm = value("tensile_modulus", CELL, conditions={**fresh, "temperature_K": 350.0})
    cool = value("compressive_modulus", CELL, conditions={**fresh, "temperature_K": 295.0})
    assert correlations_of((cool, warm), []) == ()
    for kelvin, listed in ((296.0, 1), (300.0, 1), (301.0, 0)):
        near = replace(warm, conditions={**fresh, "temperature_K": kelvin})
        assert len(correlations_of((cool, near), [])) == listed


def test_conditions_are_told_where_they_tell_values_apart() -> None:
    states = [{"age": age, "cure": "2 h"} for age in ("after cure", "2 years")]
    keys = ("compressive_modulus", "compressive_modulus_toe_compensated")
    records = [value(key, CELL, conditions=state) for key in keys for state in states]
    pairs = correlations_of(records, [])
    assert [pair.conditions for pair in pairs] == [{"age": s["age"]} for s in states]
    assert [pair.other_conditions for pair in pairs] == [{"age": s["age"]} for s in states]
    assert coefficient_of(pairs, records[0], records[2]) == pairs[0].coefficient
    assert coefficient_of(pairs, records[0], records[3]) == 0.0
    assert coefficient_of(pairs[:1], records[1], records[3]) == 0.0
    third = value("tensile_modulus", CELL, conditions=states[0])
    assert coefficient_of(pairs, records[0], third) == 0.0
