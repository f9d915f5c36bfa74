"""Rows of `materials.sqlite` back to records; `tables` is the other direction."""

from __future__ import annotations

import json
import math
from collections import defaultdict
from collections.abc import Iterable
from typing import Any, NamedTuple

from pipeline.core.quantity import Contribution, Quantity
from pipeline.core.records import Condition, Detail, Flag, Law, Origin, PropertyRecord, Refusal
from pipeline.materials.document import conditions_from, details_from


class Owned(NamedTuple):
    """Rows that belong to records and laws of one material, under the ids of these."""

    budgets: defaultdict[int, list[Any]]
    origins: defaultdict[int, list[Any]]
    flags: defaultdict[int, list[Any]]


def by_owner(rows: Iterable[Any]) -> defaultdict[int, list[Any]]:
    """Group rows under their id; whoever owns nothing has no rows."""
    groups = defaultdict(list)
    for row in rows:
        groups[row[0]].append(row)
    return groups


def record_of(row: Any, owned: Owned) -> PropertyRecord:
    """Make a record of a row of `properties`."""
    number, material, key, campaign, value, unit, _, u_independent, u_shared, *rest = row
    sd, low, high, n, conditions, method, diagnostics = rest
    return PropertyRecord(
        key=key,
        material=material,
        campaign=campaign,
        quantity=Quantity(value, unit, u_independent, u_shared),
        n=n,
        sd=sd,
        ci95=(-math.inf if low is None else low, math.inf if high is None else high),
        conditions=_conditions(conditions),
        method=method,
        budget=tuple(Contribution(r[2], r[3], bool(r[4])) for r in owned.budgets[number]),
        origins=_origins(number, owned),
        flags=_flags(number, owned),
        diagnostics=_details(diagnostics),
    )


def law_of(row: Any, owned: Owned) -> Law:
    """Make a law of a row of `laws`."""
    number, material, key, campaign, kind, unit, argument, argument_unit, *rest = row
    coefficients, covariance, low, high, conditions, method, diagnostics = rest
    return Law(
        *(key, material, campaign, kind, unit, argument, argument_unit),
        coefficients=tuple(json.loads(coefficients)),
        covariance=tuple(map(tuple, json.loads(covariance))),
        valid=(low, high),
        conditions=_conditions(conditions),
        method=method,
        origins=_origins(number, owned),
        flags=_flags(number, owned),
        diagnostics=_details(diagnostics),
    )


def refusal_of(row: Any) -> Refusal:
    """Make a refusal of a row of `refusals`."""
    _, material, key, reason, campaign, specimen, conditions, diagnostics = row
    return Refusal(
        *(key, reason, material, campaign, specimen),
        *(_conditions(conditions), _details(diagnostics)),
    )


def _origins(number: int, owned: Owned) -> tuple[Origin, ...]:
    return tuple(Origin(*(*row[2:-1], _details(row[-1]))) for row in owned.origins[number])


def _flags(number: int, owned: Owned) -> tuple[Flag, ...]:
    return tuple(Flag(*row[2:]) for row in owned.flags[number])


def _conditions(text: str) -> dict[str, Condition]:
    return {} if text == "{}" else conditions_from(json.loads(text))


def _details(text: str) -> dict[str, Detail]:
    return {} if text == "{}" else details_from(json.loads(text))
