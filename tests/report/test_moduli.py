"""Which bars a campaign's records and refusals make."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from deamat.core.quantity import Quantity
from deamat.core.records import Condition, PropertyRecord, Refusal
from deamat.report.moduli import ModulusBar, modulus_bars


def record(
    material: str, key: str, conditions: Mapping[str, Condition], campaign: str = "campaign"
) -> PropertyRecord:
    return PropertyRecord(
        key=key, material=material, campaign=campaign, quantity=Quantity(1e5, "Pa", 1e3), n=4,
        sd=2e3, ci95=(9.7e4, 1.03e5), conditions=conditions, method="", budget=(), origins=(),
    )  # fmt: skip


def refusal(
    material: str, key: str, conditions: Mapping[str, Condition], specimen: str | None = None
) -> Refusal:
    return Refusal(key, "too few samples", material, "campaign", specimen, conditions)


def test_a_bar_is_what_the_record_says() -> None:
    (bar,) = modulus_bars([record("a", "compressive_modulus", {"age": "after cure"})])
    assert bar == ModulusBar("a", "compressive modulus, after cure", 4, 1e5, (9.7e4, 1.03e5))


def test_only_moduli_are_drawn() -> None:
    assert modulus_bars([record("a", "relative_permittivity", {})]) == ()
    assert modulus_bars([], [refusal("a", "tensile_strength", {})]) == ()


def test_properties_come_in_the_order_of_their_table_and_later_ages_after_the_usual_state() -> None:
    bars = modulus_bars(
        [
            record("a", "tensile_modulus", {"age": "after cure"}),
            record("a", "compressive_modulus", {"age": "2 months"}),
            record("a", "compressive_modulus", {"age": "after cure"}),
            record("b", "compressive_modulus", {}),
        ]
    )
    assert [bar.series for bar in bars] == [
        "compressive modulus, after cure",
        "compressive modulus",
        "compressive modulus, 2 months",
        "tensile modulus, after cure",
    ]


def test_a_condition_is_named_where_it_tells_two_values_of_one_material_apart() -> None:
    cool, warm = (
        {"temperature_K": 295.0, "humidity": 0.5},
        {"temperature_K": 333.0, "humidity": 0.5},
    )
    bars = modulus_bars(
        [record("a", "tensile_modulus", cool), record("a", "tensile_modulus", warm)]
    )
    assert {bar.series for bar in bars} == {
        "tensile modulus, temperature_K 295.0",
        "tensile modulus, temperature_K 333.0",
    }


def test_a_condition_that_differs_between_materials_only_does_not_split_a_series() -> None:
    bars = modulus_bars(
        [
            record("a", "tensile_modulus", {"temperature_K": 295.0}),
            record("b", "tensile_modulus", {"temperature_K": 295.2}),
        ]
    )
    assert {bar.series for bar in bars} == {"tensile modulus"}


def test_a_refusal_shows_once_and_only_where_there_is_no_value() -> None:
    bars = modulus_bars(
        [record("a", "tensile_modulus", {"age": "after cure"})],
        [
            refusal("a", "tensile_modulus", {"age": "after cure"}, specimen="a-3"),
            refusal("b", "tensile_modulus", {"age": "after cure"}, specimen="b-1"),
            refusal("b", "tensile_modulus", {"age": "after cure"}, specimen="b-2"),
            refusal("a", "tensile_modulus", {"age": "2 months"}),
        ],
    )
    series = "tensile modulus, after cure"
    assert bars == (
        ModulusBar("a", series, 4, 1e5, (9.7e4, 1.03e5)),
        ModulusBar("b", series, 0, None, None),
        ModulusBar("a", "tensile modulus, 2 months", 0, None, None),
    )


def test_campaigns_are_never_mixed() -> None:
    records = [record("a", "tensile_modulus", {}, campaign=name) for name in ("one", "two")]
    with pytest.raises(ValueError, match=r"^one figure shows one campaign, not one, two$"):
        modulus_bars(records)


def test_two_records_of_the_same_modulus_are_an_error() -> None:
    twice = [record("a", "tensile_modulus", {"age": "2 months"})] * 2
    with pytest.raises(ValueError, match=r"^a has two records of its tensile modulus, 2 months$"):
        modulus_bars(twice)
