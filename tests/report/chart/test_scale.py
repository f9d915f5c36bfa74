"""Axes: where numbers lie on the page, and which of them stand at it."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.chart import Axis
from deamat.report.chart.scale import scale_of, ticks_of

DATA = [np.array([2.0, 97.0]), np.array([np.nan, 40.0])]


def test_a_linear_axis_begins_at_zero_where_its_data_begin_near_it() -> None:
    scale = scale_of(Axis("x"), DATA, 100.0, 500.0)
    assert scale.low == 0.0
    assert scale.high == pytest.approx(97.0 + 0.04 * 95.0)
    assert scale(np.array([0.0, scale.high])).tolist() == [100.0, 500.0]
    assert ticks_of(Axis("x"), scale, 6) == [
        (0.0, "0"), (20.0, "20"), (40.0, "40"), (60.0, "60"), (80.0, "80"), (100.0, "100"),
    ]  # fmt: skip


def test_a_linear_axis_of_data_far_from_zero_stays_with_them() -> None:
    scale = scale_of(Axis("x"), [np.array([95.0, 105.0])], 0.0, 1.0)
    assert [scale.low, scale.high] == pytest.approx([94.6, 105.4])


def test_a_logarithmic_axis_leaves_out_what_is_not_above_zero() -> None:
    axis = Axis("x", "log")
    scale = scale_of(axis, [np.array([-1.0, 0.0, 10.0, 1000.0])], 0.0, 300.0)
    assert scale.low == pytest.approx(10.0**0.92)
    places = scale(np.array([10.0, 100.0, 1000.0, 0.0]))
    assert np.diff(places[:3]) == pytest.approx([places[1] - places[0]] * 2)
    assert np.isnan(places[3])
    assert [text for _, text in ticks_of(axis, scale, 8)] == ["10", "20", "50", "100", "200",
                                                              "500", "1000"]  # fmt: skip
    assert [text for _, text in ticks_of(axis, scale, 4)] == ["10", "100", "1000"]


def test_less_than_a_decade_has_round_numbers() -> None:
    axis = Axis("x", "log", limits=(60.0, 90.0))
    values = [value for value, _ in ticks_of(axis, scale_of(axis, [], 0.0, 1.0), 6)]
    assert values == [60.0, 65.0, 70.0, 75.0, 80.0, 85.0, 90.0]


@pytest.mark.parametrize("data", [[], [np.array([5.0])], [np.array([0.0])], [np.array([np.nan])]])
def test_any_data_have_an_axis(data: list[FloatArray]) -> None:
    for spacing in ("linear", "log"):
        scale = scale_of(Axis("x", "log" if spacing == "log" else "linear"), data, 0.0, 1.0)
        assert scale.low < scale.high
        assert len(ticks_of(Axis("x"), scale, 5)) >= 1
