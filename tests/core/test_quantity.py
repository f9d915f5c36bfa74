"""Quantities: two kinds of uncertainty, and values that must not exist."""

from __future__ import annotations

import math

import pytest

from deamat.core.errors import OutOfRange
from deamat.core.quantity import Contribution, Quantity
from deamat.core.units import UnknownUnit


def test_budget_adds_in_quadrature_and_keeps_the_shared_part_apart() -> None:
    budget = [
        Contribution("a", 3.0, False),
        Contribution("b", 4.0, False),
        Contribution("c", 12.0, True),
    ]
    q = Quantity.from_budget(1.0, "Pa", budget)
    assert (q.u_independent, q.u_shared, q.standard_uncertainty) == (5.0, 12.0, 13.0)


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_value_must_be_finite(value: float) -> None:
    with pytest.raises(OutOfRange, match="must be finite"):
        Quantity(value, "Pa")


@pytest.mark.parametrize("u", [-1.0, math.nan])
def test_an_uncertainty_is_finite_and_not_negative(u: float) -> None:
    with pytest.raises(OutOfRange, match="u_shared must be finite and not negative"):
        Quantity(1.0, "Pa", 0.0, u)


def test_another_unit_changes_the_numbers_not_the_quantity() -> None:
    shown = Quantity(95667.0, "Pa", 1310.0, 526.0).to("kPa")
    assert shown == Quantity(95.667, "kPa", 1.31, 0.526)
    assert shown.to("Pa").value == pytest.approx(95667.0)
    warm = Quantity(296.15, "K", 0.5).to("degC")
    assert warm.value == pytest.approx(23.0)
    assert warm.u_independent == 0.5
    assert warm.to("K").value == pytest.approx(296.15)


def test_a_unit_of_something_else_is_refused() -> None:
    with pytest.raises(OutOfRange, match="5 Pa cannot be returned in mm"):
        Quantity(5.0, "Pa").to("mm")
    with pytest.raises(UnknownUnit, match="unknown unit 'kp'"):
        Quantity(5.0, "Pa").to("kp")
