"""Cards as one pandas DataFrame: a row for each record, its unit beside its value."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from deamat.core.errors import OutOfRange
from deamat.core.properties import CONDITIONS, property_key
from deamat.core.records import PropertyRecord
from deamat.core.schema import fields_of
from deamat.core.units import read_quantity, si_factor
from deamat.materials.card import MaterialCard

if TYPE_CHECKING:
    import pandas as pd

Limit = float | str | None
Range = tuple[Limit, Limit]
Cell = str | float | bool | None

_WINDOW = "window"  # the one condition of two numbers, so it has two columns
_CONDITIONS = tuple(c for c in CONDITIONS if c != _WINDOW)
_WORDS = ("age", "cure", "electrode")  # the conditions that are no numbers


def to_frame(
    cards: Iterable[MaterialCard],
    ranges: Mapping[str, Range] | None = None,
    units: Mapping[str, str] | None = None,
) -> pd.DataFrame:
    """Return one row for each record of the cards, in the order of cards and records.

    Parameters
    ----------
    cards : such as `database.values()`
    ranges : property key to its lowest and highest value, inclusive: a number in SI, or text with a
        unit (`"50 kPa"`); None leaves that end open. Only materials that have, for each key, a
        record that lies in the range are returned. A record that is an interval lies in it
        whole or not at all; a lower bound lies in it only if the range has no upper end.
    units : property key to the unit in which its rows are returned; SI without

    Returns
    -------
    columns `material`, `name`, `synthetic`, `campaign`, `property`, `value`, `unit`,
    `u_independent`, `u_shared`, `standard_uncertainty`, `sd`, `ci95_low`, `ci95_high` (all in
    `unit`), `n`, `bound` (`exact`, `interval`, `lower`), `method`, `flags`, then one column for
    each condition and each fact that only some records have (`area_ratio_limit`), empty where a
    record does not state it; numbers carry the unit in the name

    Raises
    ------
    MissingProperty : no such property
    OutOfRange : a unit or a limit that does not fit the property
    UnknownUnit : a unit outside the closed table
    """
    import pandas as pd  # costs seconds, so only whoever wants a frame pays for it

    limits = {key: _limits(key, span) for key, span in (ranges or {}).items()}
    wanted = {key: _factor(key, unit) for key, unit in (units or {}).items()}
    rows = [
        _row(card, record, wanted.get(record.key, (record.quantity.unit, 1.0)))
        for card in cards
        if all(_has(card, key, low, high) for key, (low, high) in limits.items())
        for record in card.records
    ]
    return pd.DataFrame(rows, columns=_COLUMNS).astype(dict.fromkeys(_NUMBERS, "float64"))


# What is known of some properties alone, one column each.
_FACTS = tuple(f for f in fields_of(PropertyRecord) if f.optional and len(f.columns) == 1)

_COLUMNS = [
    *("material", "name", "synthetic", "campaign", "property", "value", "unit"),
    *("u_independent", "u_shared", "standard_uncertainty", "sd", "ci95_low", "ci95_high"),
    *("n", "bound", "method", "flags", *_CONDITIONS, "window_low", "window_high"),
    *(field.name for field in _FACTS),
]
# Else a column in which nothing is stated would be one of objects, which cannot be compared.
_NUMBERS = (
    *("sd", *(c for c in _CONDITIONS if c not in _WORDS), "window_low", "window_high"),
    *(field.name for field in _FACTS if field.kind.sql == "REAL"),
)


def _row(card: MaterialCard, record: PropertyRecord, shown: tuple[str, float]) -> list[Cell]:
    unit, factor = shown
    q = record.quantity
    numbers = (q.u_independent, q.u_shared, q.standard_uncertainty, record.sd, *record.ci95)
    window = record.conditions.get(_WINDOW)
    low, high = window if isinstance(window, tuple) else (None, None)
    return [
        *(card.material, card.name, card.synthetic, record.campaign, record.key),
        *(q.value / factor, unit),
        *(None if number is None else number / factor for number in numbers),
        *(record.n, record.bound, record.method, "; ".join(flag.name for flag in record.flags)),
        *(_told(record, condition) for condition in _CONDITIONS),
        *(low, high),
        *(field.get(record) for field in _FACTS),
    ]


def _told(record: PropertyRecord, condition: str) -> Cell:
    value = record.conditions.get(condition)
    return " to ".join(f"{end:g}" for end in value) if isinstance(value, tuple) else value


def _limits(key: str, span: Range) -> tuple[float, float]:
    unit = property_key(key).unit
    low, high = (
        read_quantity(limit, unit, f"a limit of {key}") if isinstance(limit, str) else limit
        for limit in span
    )
    return (-float("inf") if low is None else low), (float("inf") if high is None else high)


def _factor(key: str, unit: str) -> tuple[str, float]:
    wanted = property_key(key).unit
    si, factor, offset = si_factor(unit)
    if si != wanted or offset:
        raise OutOfRange(f"{key} is kept in {wanted}, which cannot be returned in {unit}")
    return unit, factor


def _has(card: MaterialCard, key: str, low: float, high: float) -> bool:
    return any(_within(record, low, high) for record in card.records if record.key == key)


def _within(record: PropertyRecord, low: float, high: float) -> bool:
    ends = (record.quantity.value,) * 2 if record.bound == "exact" else record.ci95
    return low <= ends[0] and ends[1] <= high
