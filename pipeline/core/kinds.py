"""How each kind of value stands in JSON, in JSON Schema and in SQL: the alphabet of `schema`."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from deamat.core.errors import CardError
from deamat.core.properties import CONDITIONS, PROPERTIES

Condition = str | float | tuple[float, float]
Detail = float | int | str

_NOT_FINITE: dict[Detail, float] = {"nan": math.nan, "inf": math.inf, "-inf": -math.inf}


def unchanged(value: Any) -> Any:
    """Return a value as it is."""
    return value


@dataclass(frozen=True, slots=True, eq=False)
class Kind:
    """How values of one kind are written, described and read back.

    Parameters
    ----------
    schema : what JSON Schema says of it
    sql : type of its columns
    nested : its column holds JSON text
    write, read : value to JSON and back
    endings : of the names of its columns, where one value fills several
    nullable : the whole value may be null
    open_ended : a column of it may be NULL although the value is not
    definitions : parts of the schema that are named, by name
    rows_of : class of the rows that it fills in a table of its own, in place of columns
    """

    schema: Mapping[str, Any]
    sql: str
    write: Callable[[Any], Any] = unchanged
    read: Callable[[Any], Any] = unchanged
    endings: tuple[str, ...] = ("",)
    nullable: bool = False
    open_ended: bool = False
    definitions: Mapping[str, Any] = field(default_factory=dict)
    rows_of: Any = None
    nested: bool = False


def named(name: str, kind: Kind, description: str = "") -> Kind:
    """Keep the schema of a kind under a name, for all who refer to it."""
    said = {"description": description} if description else {}
    return replace(
        kind,
        schema={"$ref": f"#/$defs/{name}"},
        definitions={**kind.definitions, name: {**kind.schema, **said}},
    )


def nullable(kind: Kind) -> Kind:
    """Allow null as well."""

    def write(value: Any) -> Any:
        return None if value is None else kind.write(value)

    def read(value: Any) -> Any:
        return None if value is None else kind.read(value)

    if isinstance(kind.schema.get("type"), str):
        schema: Mapping[str, Any] = {**kind.schema, "type": [kind.schema["type"], "null"]}
    else:
        schema = {"oneOf": [kind.schema, {"type": "null"}]}
    return replace(kind, schema=schema, write=write, read=read, nullable=True)


def array(item: Kind, least: int = 0) -> Kind:
    """Return the kind of a tuple of any length, at least `least`."""
    counted = {"minItems": least} if least else {}
    return Kind(
        {"type": "array", "items": item.schema, **counted},
        "TEXT",
        lambda values: [item.write(value) for value in values],
        lambda values: tuple(item.read(value) for value in values),
        definitions=item.definitions,
        nested=True,
    )


def choice(*words: str) -> Kind:
    """Return the kind of a word out of a closed list."""
    return Kind({"enum": list(words)}, "TEXT")


# --- numbers and words


def _number(value: float) -> float:
    return float(value) + 0.0  # SQLite has no negative zero, so neither has a card


TEXT = Kind({"type": "string"}, "TEXT")
NUMBER = Kind({"type": "number"}, "REAL", _number)
INTEGER = Kind({"type": "integer"}, "INTEGER")
BOOLEAN = Kind({"type": "boolean"}, "INTEGER", read=bool)
COEFFICIENT = Kind({"type": "number", "minimum": -1, "maximum": 1}, "REAL", _number)
COUNT = Kind({"type": "integer", "minimum": 1}, "INTEGER")
SAID = Kind({"type": "string", "minLength": 1}, "TEXT")
ID = named("id", SAID)
LINE = named("line", COUNT)
UNCERTAINTY = named("uncertainty", Kind({"type": "number", "minimum": 0}, "REAL", _number))
SHA256 = named("sha256", Kind({"type": "string", "pattern": "^[0-9a-f]{64}$"}, "TEXT"))
PROPERTY_KEY = named("key", choice(*PROPERTIES), "Property key of the one closed table.")
UNIT = named(
    "unit",
    choice(*dict.fromkeys(known.unit for known in PROPERTIES.values())),
    "SI unit; 1 is a pure number.",
)


# --- intervals

_PAIR = {"minItems": 2, "maxItems": 2}

RANGE = named(
    "range",
    Kind(
        {"type": "array", "items": NUMBER.schema, **_PAIR},
        "REAL",
        lambda pair: [_number(end) for end in pair],
        tuple,
        endings=("_low", "_high"),
    ),
)


def _interval_from(ends: list[float | None]) -> tuple[float, float]:
    low, high = ends
    return -math.inf if low is None else low, math.inf if high is None else high


INTERVAL = Kind(
    {"type": "array", "items": {"type": ["number", "null"]}, **_PAIR},
    "REAL",
    lambda ends: [_number(end) if math.isfinite(end) else None for end in ends],
    _interval_from,
    endings=("_low", "_high"),
    open_ended=True,
)


# --- conditions and diagnostics


def _conditions(conditions: Mapping[str, Condition]) -> dict[str, Any]:
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


def _conditions_from(document: Mapping[str, Any]) -> dict[str, Condition]:
    return {k: tuple(v) if isinstance(v, list) else v for k, v in document.items()}


_CONDITION = named(
    "condition",
    Kind({"oneOf": [SAID.schema, NUMBER.schema, RANGE.schema]}, "TEXT"),
    "A word, a number, or a range of numbers.",
)


def _described(text: str) -> dict[str, str]:
    return {**_CONDITION.schema, "description": f"{text[0].upper()}{text[1:]}."}


CONDITIONS_KIND = named(
    "conditions",
    Kind(
        {
            "type": "object",
            "additionalProperties": False,
            "properties": {key: _described(text) for key, text in CONDITIONS.items()},
        },
        "TEXT",
        _conditions,
        _conditions_from,
        definitions={**RANGE.definitions, **_CONDITION.definitions},
        nested=True,
    ),
    "What tells two values of one key apart; the unit stands in the name. A condition that was "
    "not recorded is not there.",
)


def _details(details: Mapping[str, Detail]) -> dict[str, Detail]:
    return {key: _detail(details[key]) for key in sorted(details)}


def _detail(value: Detail) -> Detail:
    if isinstance(value, str):
        return value
    if isinstance(value, int):
        return int(value)  # a bool too: the schema knows numbers and words
    return float(value) if math.isfinite(value) else str(float(value))


def _details_from(document: Mapping[str, Any]) -> Mapping[str, Detail]:
    if _NOT_FINITE.keys().isdisjoint(document.values()):
        return document
    return {k: _NOT_FINITE.get(v, v) for k, v in document.items()}


DETAILS_KIND = named(
    "diagnostics",
    Kind(
        {"type": "object", "additionalProperties": {"type": ["number", "string"]}},
        "TEXT",
        _details,
        _details_from,
        nested=True,
    ),
    "Numbers worth keeping; one that is not finite is the word nan, inf or -inf.",
)
