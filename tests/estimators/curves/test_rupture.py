"""Promises about the end of a pull: broken, turned back or stopped; slips and cycles before it."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.estimators.curves.rupture import End, count_loadings, find_rupture

E = 600e3


def pull(to: float, n: int = 101) -> FloatArray:
    return np.linspace(0.0, to, n)


def record(*parts: tuple[FloatArray, FloatArray]) -> tuple[FloatArray, FloatArray]:
    strains, stresses = zip(*parts, strict=True)
    return np.concatenate(strains), np.concatenate(stresses)


UP = (pull(1.5), E * pull(1.5))
BACK = (pull(1.5)[::-1], E * pull(1.5)[::-1])
FAST_BACK = (np.array([0.7, 0.3, 0.0]), E * np.array([0.68, 0.29, 0.0]))
ENDS: dict[str, tuple[tuple[FloatArray, FloatArray], End, int]] = {
    "collapse while the crosshead goes on": (
        record(UP, (np.array([1.52, 1.54]), np.array([10.0, 5.0]))), "broke", 100,
    ),
    "one sample after the break": (record(UP, (np.array([1.51]), np.zeros(1))), "broke", 100),
    "an export filled up with zeros": (record(UP, (np.zeros(9), np.zeros(9))), "broke", 100),
    "a crosshead that returns without load": (
        record(UP, (pull(1.5)[::-1], np.full(101, 3.0))), "broke", 100,
    ),
    "the record ends under load": (UP, "stopped", 100),
    "the machine turns": (record(UP, BACK), "reversed", 100),
    "the machine turns between two samples": (record(UP, FAST_BACK), "reversed", 100),
    "a hysteresis of a quarter of the load": (
        record(UP, (pull(1.5)[::-1], 0.75 * E * pull(1.5)[::-1])), "reversed", 100,
    ),
    "a hysteresis of half of the load": (
        record(UP, (pull(1.5)[::-1], 0.49 * E * pull(1.5)[::-1])), "reversed", 100,
    ),
    "a return in coarse steps to a permanent set": (
        record(UP, (pull(1.5)[::-4], 0.45 * E * np.maximum(pull(1.5)[::-4] - 0.3, 0.0))),
        "reversed", 100,
    ),
    "relaxation below half of the load while the machine stands": (
        record(UP, (np.full(300, 1.5), E * 1.5 * (0.4 + 0.6 * np.exp(-np.arange(300) / 50)))),
        "stopped", 100,
    ),
    "relaxation, then a break": (
        record(
            UP, (np.full(30, 1.5), E * 1.5 * (0.9 + 0.1 * np.exp(-np.arange(30) / 9))),
            (np.full(3, 1.5), np.zeros(3)),
        ), "broke", 130,
    ),
    "a break below the top of the cycles": (
        record(UP, BACK, (pull(1.0), E * pull(1.0)), (np.array([1.01]), np.zeros(1))), "broke", 302,
    ),
    "cycles, then a break": (
        record(
            (pull(0.5), E * pull(0.5)), (pull(0.5)[::-1], E * pull(0.5)[::-1]), UP,
            (np.array([1.52]), np.zeros(1)),
        ), "broke", 302,
    ),
    "a lost sample on the way": (
        record((UP[0], np.where(np.arange(101) == 40, 0.0, UP[1])), (np.array([1.52]), np.zeros(1))),
        "broke", 100,
    ),
}  # fmt: skip


@pytest.mark.parametrize(("curve", "end", "last"), ENDS.values(), ids=ENDS)
def test_how_a_pull_ended(curve: tuple[FloatArray, FloatArray], end: End, last: int) -> None:
    found = find_rupture(*curve, 0.5)
    assert (found.end, found.last) == (end, last)
    assert curve[1][found.maximum] == curve[1][: last + 1].max()
    assert found.first_after == (last + 1 if end == "broke" else None)


def test_a_load_that_falls_by_less_than_the_drop_is_still_carried() -> None:
    for left, end in ((0.5, "stopped"), (0.499, "broke")):
        strain, stress = record(UP, (np.array([1.52]), np.array([left * E * 1.5])))
        assert find_rupture(strain, stress, 0.5).end == end


def test_an_unsteady_fall_of_the_load_before_the_end_is_still_one_break() -> None:
    strain, stress = record(UP, (np.linspace(1.5, 1.52, 5), E * np.array([1.4, 1.1, 0.9, 0.2, 0])))
    found = find_rupture(strain, stress, 0.5)
    assert (found.end, found.last, found.maximum) == ("broke", 103, 100)


def test_loadings_are_counted() -> None:
    assert count_loadings(pull(1.5), 100) == 1
    strain = np.concatenate([pull(0.5), pull(0.5)[::-1]] * 3 + [pull(2.0)])
    assert count_loadings(strain, strain.size - 1) == 4
    assert count_loadings(strain, 100) == 1
    assert count_loadings(pull(0.3) + np.tile([0.0, -0.004], 51)[:101], 100) == 1
    assert count_loadings(np.array([0.0, 10.0, 9.0, 20.0]), 3) == 1  # back by 5 % and no more
    assert count_loadings(np.array([0.0, 10.0, 8.9, 20.0]), 3) == 2
