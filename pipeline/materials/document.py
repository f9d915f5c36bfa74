"""The canonical order of what stands on a card, so that equal content gives equal bytes."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any, TypeVar

from deamat.core.errors import CardError, PipelineError
from deamat.core.kinds import CONDITIONS_KIND, Condition
from deamat.core.properties import property_key
from deamat.core.records import Flag, Law, Origin, PropertyRecord

Document = dict[str, Any]
T = TypeVar("T")

# json.dumps would build a new encoder for every call.
canonical_json = json.JSONEncoder(
    sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False
).encode
"""JSON on one line with sorted keys: equal content, equal text."""


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
        conditions=_in_order(record.conditions),
        budget=tuple(
            sorted(record.budget, key=lambda c: (-c.u, c.source, c.shared, c.calibration or ""))
        ),
        origins=tuple(sorted(record.origins, key=_origin_order)),
        flags=tuple(sorted(record.flags, key=_flag_order)),
    )


def canonical_law(law: Law) -> Law:
    """Bring flags and origins of a law into their fixed order.

    Raises
    ------
    CardError : the unit is not that of the property table
    """
    _check_unit(law.key, law.material, law.unit)
    return replace(
        law,
        conditions=_in_order(law.conditions),
        origins=tuple(sorted(law.origins, key=_origin_order)),
        flags=tuple(sorted(law.flags, key=_flag_order)),
    )


def _check_unit(key: str, material: str, unit: str) -> None:
    expected = property_key(key).unit
    if unit != expected:
        raise CardError(
            f"{key} of {material} is in {unit!r}, the property table keeps it in {expected!r}"
        )


def _in_order(conditions: Mapping[str, Condition]) -> Mapping[str, Condition]:
    ordered: Mapping[str, Condition] = CONDITIONS_KIND.read(CONDITIONS_KIND.write(conditions))
    return ordered


def _origin_order(origin: Origin) -> tuple[object, ...]:
    return (
        *(origin.register, origin.register_line, origin.specimen, origin.technique),
        *(origin.path or "", origin.first_line or 0, origin.value),
    )


def _flag_order(flag: Flag) -> tuple[str, str]:
    return flag.name, flag.detail


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
