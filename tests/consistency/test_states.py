"""Specimens far apart in temperature or humidity are of two states, whatever else they share."""

from __future__ import annotations

import pytest

from deamat.consistency.states import State, states
from deamat.core.config import Pooling
from deamat.core.recording import Specimen
from tests.consistency.test_rows_of_a_register import row

USUAL = Pooling()


def at(*celsius: float | None) -> list[Specimen]:
    return [
        row(f"s{i}", age="after cure")
        if c is None
        else row(f"s{i}", age="after cure", temperature_K=273.15 + c)
        for i, c in enumerate(celsius)
    ]


def parted(found: list[State]) -> list[tuple[object, list[str]]]:
    return [(dict(s.conditions).get("temperature_K"), [r.id for r in s.specimens]) for s in found]


def test_22_and_90_degrees_are_not_pooled() -> None:
    found = states(at(22, 90, 22, 90), USUAL)
    assert parted(found) == [(295.15, ["s0", "s2"]), (363.15, ["s1", "s3"])]
    assert dict(found[0].conditions) == {"age": "after cure", "temperature_K": 295.15}


def test_a_warm_day_is_pooled_with_its_mean() -> None:
    assert parted(states(at(21.5, 22.0, 24.0), USUAL)) == [(295.65, ["s0", "s1", "s2"])]


def test_a_series_in_small_steps_is_not_chained_together() -> None:
    found = states(at(20, 22, 24, 26, 28), USUAL)
    assert [len(s.specimens) for s in found] == [2, 2, 1]


@pytest.mark.parametrize(("tolerance", "groups"), [(0.0, 3), (3.0, 1), (1.0, 2)])
def test_the_tolerance_is_a_setting(tolerance: float, groups: int) -> None:
    pooling = Pooling(temperature_tolerance_K=tolerance)
    assert len(states(at(21.5, 22.0, 24.0), pooling)) == groups


def test_a_row_that_does_not_say_is_pooled_where_the_others_agree_and_said() -> None:
    (state,) = states(at(22, None, 22), USUAL)
    assert [r.id for r in state.specimens] == ["s0", "s1", "s2"]
    assert [(who, flag.name) for who, flag in state.unrecorded] == [("s1", "not-recorded")]
    assert parted(states(at(22, None, 90), USUAL)) == [
        (295.15, ["s0"]), (363.15, ["s2"]), (None, ["s1"]),
    ]  # fmt: skip


def test_nothing_recorded_is_no_condition() -> None:
    (state,) = states(at(None, None), USUAL)
    assert dict(state.conditions) == {"age": "after cure"}
    assert state.unrecorded == ()


def test_humidity_parts_too() -> None:
    rows = [row(f"s{i}", temperature_K=295.15, humidity=h) for i, h in enumerate((0.2, 0.3, 0.8))]
    found = states(rows, USUAL)
    assert [dict(s.conditions)["humidity"] for s in found] == [0.25, 0.8]
