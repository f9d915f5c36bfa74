"""Records, laws and refusals as the JSON objects of a card, and back without any loss.

`docs/card.schema.json` is the published form. Everything here is pure and in a canonical order:
sorted wherever order carries no meaning, so that equal content gives equal bytes.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields, replace
from typing import Any, TypeVar

from deamat.core.errors import PipelineError
from deamat.core.properties import CONDITIONS, property_key
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import (
    Condition,
    Detail,
    Flag,
    Law,
    Origin,
    PropertyRecord,
    Refusal,
)

SCHEMA = "urn:deamat:card:1"

Document = dict[str, Any]
T = TypeVar("T")

NOT_FINITE: dict[Detail, float] = {"nan": math.nan, "inf": math.inf, "-inf": -math.inf}
_ORIGIN_FIELDS = tuple(f.name for f in fields(Origin) if f.name != "diagnostics")
_PROPERTY_FIELDS = (
    *("key", "symbol", "value", "unit", "standard_uncertainty", "u_independent", "u_shared"),
    *("sd", "ci95", "bound", "n", "conditions", "campaign", "method", "standard", "budget"),
    *("diagnostics", "flags", "origins"),
)
_LAW_FIELDS = (
    *("key", "symbol", "kind", "unit", "argument", "argument_unit", "coefficients", "covariance"),
    *("valid", "parts", "rates", "degrees_of_freedom", "conditions", "campaign", "method"),
    *("diagnostics", "flags", "origins"),
)
_REFUSAL_FIELDS = ("key", "reason", "campaign", "specimen", "conditions", "diagnostics")


class CardError(PipelineError):
    """A card that does not hold together, or a file that is not a card."""


# json.dumps would build a new encoder for every call.
canonical_json = json.JSONEncoder(
    sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False
).encode
"""JSON on one line with sorted keys: equal content, equal text."""


def _number(value: float) -> float:
    """Give a float; SQLite has no negative zero, so neither has a card."""
    return float(value) + 0.0


# --- conditions, diagnostics, flags: small parts that several objects share


def conditions_document(conditions: Mapping[str, Condition]) -> Document:
    """Write conditions in the order of the closed list.

    Raises
    ------
    CardError : a condition outside `core.properties.CONDITIONS`
    """
    if not conditions.keys() <= CONDITIONS.keys():
        unknown = ", ".join(sorted(conditions.keys() - CONDITIONS.keys()))
        raise CardError(f"unknown condition {unknown}; the closed list is {', '.join(CONDITIONS)}")
    return {key: _condition(conditions[key]) for key in CONDITIONS if key in conditions}


def _condition(value: Condition) -> str | float | list[float]:
    if isinstance(value, str):
        return value
    return [float(v) for v in value] if isinstance(value, tuple) else float(value)


def conditions_from(document: Mapping[str, Any]) -> dict[str, Condition]:
    """Read conditions back."""
    return {k: tuple(v) if isinstance(v, list) else v for k, v in document.items()}


def details_document(details: Mapping[str, Detail]) -> Document:
    """Write diagnostics; JSON has no NaN and no infinity, so these become words."""
    return {key: _detail(details[key]) for key in sorted(details)}


def _detail(value: Detail) -> Detail:
    if isinstance(value, str):
        return value
    if isinstance(value, int):
        return int(value)  # a bool too: the schema knows numbers and words
    return float(value) if math.isfinite(value) else str(float(value))


def details_from(document: Mapping[str, Any]) -> dict[str, Detail]:
    """Read diagnostics back."""
    return {k: NOT_FINITE.get(v, v) for k, v in document.items()}


def _flags_from(texts: Iterable[str]) -> tuple[Flag, ...]:
    return tuple(Flag(*text.split(": ", 1)) for text in texts)


def take(document: Mapping[str, Any], names: Iterable[str], what: str) -> list[Any]:
    """Give the fields of an object in the order of `names`; nothing may lack or be left over."""
    wanted = set(names)
    if set(document) != wanted:
        lacking = ", ".join(sorted(wanted - set(document))) or "nothing"
        unknown = ", ".join(sorted(set(document) - wanted)) or "nothing"
        raise CardError(f"{what}: lacks {lacking}, has unknown {unknown}")
    return [document[name] for name in names]


# --- origins


def origin_document(origin: Origin) -> Document:
    """Write one specimen's value behind a record."""
    document: Document = {name: getattr(origin, name) for name in _ORIGIN_FIELDS}
    for name in ("value", "u_independent", "u_shared"):
        document[name] = _number(document[name])
    document["diagnostics"] = details_document(origin.diagnostics)
    return document


def _origin_from(document: Mapping[str, Any]) -> Origin:
    take(document, (*_ORIGIN_FIELDS, "diagnostics"), "an origin")
    return Origin(**{**document, "diagnostics": details_from(document["diagnostics"])})


def _origin_order(origin: Origin) -> tuple[object, ...]:
    return (
        *(origin.register, origin.register_line, origin.specimen, origin.technique),
        *(origin.path or "", origin.first_line or 0, origin.value),
    )


def _flag_order(flag: Flag) -> tuple[str, str]:
    return flag.name, flag.detail


# --- records


def canonical_record(record: PropertyRecord) -> PropertyRecord:
    """Bring flags, budget (largest first) and origins of a record into their fixed order.

    Raises
    ------
    CardError : the unit is not that of the property table, or the interval is not one
    """
    _check_unit(record.key, record.material, record.quantity.unit)
    low, high = record.ci95
    if not (low <= high and low < math.inf and high > -math.inf):
        raise CardError(f"{record.key} of {record.material}: {record.ci95} is no interval")
    return replace(
        record,
        conditions=conditions_from(conditions_document(record.conditions)),
        budget=tuple(sorted(record.budget, key=lambda c: (-c.u, c.source, c.shared))),
        origins=tuple(sorted(record.origins, key=_origin_order)),
        flags=tuple(sorted(record.flags, key=_flag_order)),
    )


def _check_unit(key: str, material: str, unit: str) -> None:
    expected = property_key(key).unit
    if unit != expected:
        raise CardError(
            f"{key} of {material} is in {unit!r}, the property table keeps it in {expected!r}"
        )


def record_document(record: PropertyRecord) -> Document:
    """Write a record as one entry of `properties`; an open side of the interval is null."""
    known, quantity = property_key(record.key), record.quantity
    values = (
        *(record.key, known.symbol, _number(quantity.value), quantity.unit),
        *(
            quantity.standard_uncertainty,
            _number(quantity.u_independent),
            _number(quantity.u_shared),
        ),
        None if record.sd is None else _number(record.sd),
        [_number(bound) if math.isfinite(bound) else None for bound in record.ci95],
        *(record.bound, record.n, conditions_document(record.conditions), record.campaign),
        *(record.method, known.standard),
        [{"source": c.source, "u": _number(c.u), "shared": c.shared} for c in record.budget],
        details_document(record.diagnostics),
        [str(flag) for flag in record.flags],
        [origin_document(origin) for origin in record.origins],
    )
    return dict(zip(_PROPERTY_FIELDS, values, strict=True))


def record_from(material: str, document: Mapping[str, Any]) -> PropertyRecord:
    """Read one entry of `properties` back."""
    take(document, _PROPERTY_FIELDS, "a property")
    low, high = document["ci95"]
    return PropertyRecord(
        key=document["key"],
        material=material,
        campaign=document["campaign"],
        quantity=Quantity(
            document["value"], document["unit"], document["u_independent"], document["u_shared"]
        ),
        n=document["n"],
        sd=document["sd"],
        ci95=(-math.inf if low is None else low, math.inf if high is None else high),
        bound=document["bound"],
        conditions=conditions_from(document["conditions"]),
        method=document["method"],
        budget=tuple(
            Contribution(*take(c, ("source", "u", "shared"), "a contribution"))
            for c in document["budget"]
        ),
        origins=tuple(_origin_from(o) for o in document["origins"]),
        flags=_flags_from(document["flags"]),
        diagnostics=details_from(document["diagnostics"]),
    )


# --- laws


def canonical_law(law: Law) -> Law:
    """Bring flags and origins of a law into their fixed order.

    Raises
    ------
    CardError : the unit is not that of the property table
    """
    _check_unit(law.key, law.material, law.unit)
    return replace(
        law,
        conditions=conditions_from(conditions_document(law.conditions)),
        origins=tuple(sorted(law.origins, key=_origin_order)),
        flags=tuple(sorted(law.flags, key=_flag_order)),
    )


def law_document(law: Law) -> Document:
    """Write a law as one entry of `laws`."""
    values = (
        *(law.key, property_key(law.key).symbol, law.kind, law.unit),
        *(law.argument, law.argument_unit),
        [float(c) for c in law.coefficients],
        [[float(c) for c in row] for row in law.covariance],
        [_number(bound) for bound in law.valid],
        list(law.parts),
        None if law.rates is None else [_number(rate) for rate in law.rates],
        None if law.degrees_of_freedom is None else _number(law.degrees_of_freedom),
        *(conditions_document(law.conditions), law.campaign, law.method),
        details_document(law.diagnostics),
        [str(flag) for flag in law.flags],
        [origin_document(origin) for origin in law.origins],
    )
    return dict(zip(_LAW_FIELDS, values, strict=True))


def law_from(material: str, document: Mapping[str, Any]) -> Law:
    """Read one entry of `laws` back."""
    take(document, _LAW_FIELDS, "a law")
    low, high = document["valid"]
    return Law(
        key=document["key"],
        material=material,
        campaign=document["campaign"],
        kind=document["kind"],
        unit=document["unit"],
        argument=document["argument"],
        argument_unit=document["argument_unit"],
        coefficients=tuple(document["coefficients"]),
        covariance=tuple(tuple(row) for row in document["covariance"]),
        valid=(low, high),
        parts=tuple(document["parts"]),
        rates=None if document["rates"] is None else (document["rates"][0], document["rates"][1]),
        degrees_of_freedom=document["degrees_of_freedom"],
        conditions=conditions_from(document["conditions"]),
        method=document["method"],
        origins=tuple(_origin_from(o) for o in document["origins"]),
        flags=_flags_from(document["flags"]),
        diagnostics=details_from(document["diagnostics"]),
    )


# --- refusals


def refusal_document(refusal: Refusal) -> Document:
    """Write a refusal as one entry of `refused`."""
    values = (
        *(refusal.key, refusal.reason, refusal.campaign, refusal.specimen),
        conditions_document(refusal.conditions),
        details_document(refusal.diagnostics),
    )
    return dict(zip(_REFUSAL_FIELDS, values, strict=True))


def refusal_from(material: str, document: Mapping[str, Any]) -> Refusal:
    """Read one entry of `refused` back."""
    key, reason, campaign, specimen, conditions, details = take(
        document, _REFUSAL_FIELDS, "a refusal"
    )
    return Refusal(
        *(key, reason, material, campaign, specimen),
        conditions=conditions_from(conditions),
        diagnostics=details_from(details),
    )


def read_entries(
    documents: Iterable[Mapping[str, Any]],
    read: Callable[[Mapping[str, Any]], T],
    name: str,
) -> tuple[T, ...]:
    """Read a list of entries; whatever does not fit is named by its place.

    Raises
    ------
    CardError : an entry that is not what the schema says
    """
    entries = []
    for number, document in enumerate(documents):
        try:
            entries.append(read(document))
        except (PipelineError, KeyError, TypeError, ValueError) as error:
            raise CardError(f"{name}[{number}]: {error}") from error
    return tuple(entries)
