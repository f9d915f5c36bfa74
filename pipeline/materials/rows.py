"""Rows of `materials.sqlite` back to records; `tables` is the other direction.

The JSON cells of many rows are read in one go: a call for each cell would cost more than all the
rest of reading a card.
"""

from __future__ import annotations

import json
import math
from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple, TypeVar

from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import Condition, Detail, Flag, Law, Origin, PropertyRecord, Refusal
from deamat.materials.document import NOT_FINITE, conditions_from, details_from

Rows = Sequence[tuple[Any, ...]]
T = TypeVar("T")


class Owned(NamedTuple):
    """What belongs to the records and laws of one material, under the ids of these."""

    budgets: defaultdict[int, list[Contribution]]
    origins: defaultdict[int, list[Origin]]
    flags: defaultdict[int, list[Flag]]


def owned_of(budgets: Rows, origins: Rows, flags: Rows) -> Owned:
    """Sort out the rows of three tables, each in the order of its id and position."""
    details = _details(origins)
    return Owned(
        _grouped(budgets, (Contribution(r[2], r[3], bool(r[4])) for r in budgets)),
        _grouped(origins, (Origin(*(*r[2:-1], d)) for r, d in zip(origins, details, strict=True))),
        _grouped(flags, (Flag(*r[2:]) for r in flags)),
    )


def _grouped(rows: Rows, made: Iterable[T]) -> defaultdict[int, list[T]]:
    groups: defaultdict[int, list[T]] = defaultdict(list)
    for row, thing in zip(rows, made, strict=True):
        groups[row[0]].append(thing)
    return groups


def records_of(rows: Rows, owned: Owned) -> tuple[PropertyRecord, ...]:
    """Make records of rows of `properties`."""
    told = zip(rows, _conditions(rows, -3), _details(rows), strict=True)
    return tuple(_record(row, conditions, details, owned) for row, conditions, details in told)


def _record(
    row: tuple[Any, ...], conditions: dict[str, Condition], details: dict[str, Detail], owned: Owned
) -> PropertyRecord:
    number, material, key, campaign, value, unit, _, u_independent, u_shared, *rest = row
    sd, low, high, bound, n, _, method, _ = rest
    return PropertyRecord(
        key=key,
        material=material,
        campaign=campaign,
        quantity=Quantity(value, unit, u_independent, u_shared),
        n=n,
        sd=sd,
        ci95=(-math.inf if low is None else low, math.inf if high is None else high),
        bound=bound,
        conditions=conditions,
        method=method,
        budget=tuple(owned.budgets[number]),
        origins=tuple(owned.origins[number]),
        flags=tuple(owned.flags[number]),
        diagnostics=details,
    )


def laws_of(rows: Rows, owned: Owned) -> tuple[Law, ...]:
    """Make laws of rows of `laws`."""
    told = zip(rows, _conditions(rows, -3), _details(rows), strict=True)
    return tuple(_law(row, conditions, details, owned) for row, conditions, details in told)


def _law(
    row: tuple[Any, ...], conditions: dict[str, Condition], details: dict[str, Detail], owned: Owned
) -> Law:
    number, material, key, campaign, kind, unit, argument, argument_unit, *rest = row
    coefficients, covariance, low, high, parts, slow, fast, dof, _, method, _ = rest
    return Law(
        *(key, material, campaign, kind, unit, argument, argument_unit),
        coefficients=tuple(json.loads(coefficients)),
        covariance=tuple(map(tuple, json.loads(covariance))),
        valid=(low, high),
        parts=tuple(json.loads(parts)),
        rates=None if slow is None else (slow, fast),
        degrees_of_freedom=dof,
        conditions=conditions,
        method=method,
        origins=tuple(owned.origins[number]),
        flags=tuple(owned.flags[number]),
        diagnostics=details,
    )


def refusals_of(rows: Rows) -> tuple[Refusal, ...]:
    """Make refusals of rows of `refusals`."""
    told = zip(rows, _conditions(rows, -2), _details(rows), strict=True)
    return tuple(
        Refusal(key, reason, material, campaign, specimen, conditions, details)
        for (_, material, key, reason, campaign, specimen, _, _), conditions, details in told
    )


def _cells(rows: Rows, column: int) -> tuple[str, list[dict[str, Any]]]:
    text = f"[{','.join([row[column] for row in rows])}]"
    return text, json.loads(text)


def _conditions(rows: Rows, column: int) -> list[dict[str, Condition]]:
    return [conditions_from(cell) for cell in _cells(rows, column)[1]]


def _details(rows: Rows) -> list[dict[str, Detail]]:
    """Read the diagnostics, the last column of every table that has them."""
    text, cells = _cells(rows, -1)
    if any(f':"{word}"' in text for word in NOT_FINITE):
        return [details_from(cell) for cell in cells]
    return cells
