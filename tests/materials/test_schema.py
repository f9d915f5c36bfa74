from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import given, settings

from deamat.core.card_lists import CalibrationRecord, Correlation, Excluded
from deamat.core.properties import CONDITIONS, PROPERTIES
from deamat.core.quantity import Contribution
from deamat.core.records import Law, Origin, PropertyRecord, Refusal
from deamat.core.schema import entry_of, fields_of
from deamat.materials.card import SCHEMA, Credit, MaterialCard
from deamat.materials.json_schema import schema_text
from tests.materials import samples

_PATH = Path(__file__).parents[2] / "docs" / "card.schema.json"
_SCHEMA = json.loads(_PATH.read_text())
_VALIDATOR = jsonschema.Draft202012Validator(_SCHEMA)


def document() -> Any:
    return json.loads(samples.card().to_json())


def test_the_schema_is_one_and_names_itself() -> None:
    jsonschema.Draft202012Validator.check_schema(_SCHEMA)
    assert _SCHEMA["$id"] == SCHEMA == _SCHEMA["properties"]["schema"]["const"]


def test_the_published_schema_is_that_of_the_fields() -> None:
    assert _PATH.read_text(encoding="utf-8") == schema_text(), "run `make schema`"


def test_the_schema_knows_the_closed_tables() -> None:
    definitions = _SCHEMA["$defs"]
    assert set(definitions["key"]["enum"]) == set(PROPERTIES)
    assert set(definitions["unit"]["enum"]) == {p.unit for p in PROPERTIES.values()}
    assert list(definitions["conditions"]["properties"]) == list(CONDITIONS)


def test_every_object_of_the_schema_is_closed_and_complete() -> None:
    classes = (
        *(MaterialCard, Credit, PropertyRecord, Law, Refusal, Excluded, CalibrationRecord),
        *(Origin, Contribution, Correlation),
    )
    closed = {entry_of(cls).name: cls for cls in classes}
    objects = {"card": _SCHEMA, **{n: d for n, d in _SCHEMA["$defs"].items() if "required" in d}}
    assert objects.keys() == closed.keys()
    for name, definition in objects.items():
        facts = {field.name for field in fields_of(closed[name]) if field.optional}
        assert definition["additionalProperties"] is False
        assert definition["required"] == [
            name for name in definition["properties"] if name not in facts
        ]
    assert "area_ratio_limit" not in objects["property"]["required"]


def test_the_fields_of_a_card_stand_in_the_order_of_the_schema() -> None:
    found = document()
    assert list(found) == _SCHEMA["required"]
    for name, entries in (("property", "properties"), ("law", "laws"), ("refusal", "refused")):
        assert list(found[entries][0]) == _SCHEMA["$defs"][name]["required"]
    origin = found["properties"][0]["origins"][0]
    assert list(origin) == _SCHEMA["$defs"]["origin"]["required"]


def test_a_card_is_valid() -> None:
    _VALIDATOR.validate(document())


@given(samples.cards)
@settings(max_examples=50)
def test_every_card_is_valid(any_card: MaterialCard) -> None:
    _VALIDATOR.validate(json.loads(any_card.to_json()))


def _at(*path: str | int) -> Callable[[Any], Any]:
    def walk(found: Any) -> Any:
        for step in path:
            found = found[step]
        return found

    return walk


@pytest.mark.parametrize(
    ("place", "field", "value"),
    [
        (_at(), "schema", "urn:deamat:card:2"),
        (_at(), "release", "0123"),
        (_at(), "synthetic", "no"),
        (_at(), "colour", "red"),
        (_at("campaigns", 0), "licence", None),
        (_at("properties", 0), "key", "stiffness"),
        (_at("properties", 0), "unit", "kPa"),
        (_at("properties", 0), "value", "158.8 kPa"),
        (_at("properties", 0), "standard_uncertainty", -1.0),
        (_at("properties", 0), "n", 0),
        (_at("properties", 0), "n", 2.5),
        (_at("properties", 0), "ci95", [1.0]),
        (_at("properties", 0), "flags", ["no detail"]),
        (_at("properties", 0, "conditions"), "temperature", 300.0),
        (_at("properties", 0, "conditions"), "window", [0.0]),
        (_at("properties", 0, "conditions"), "age", None),
        (_at("properties", 1, "budget", 0), "shared", 1),
        (_at("properties", 0, "origins", 0), "sha256", "1234"),
        (_at("properties", 0, "origins", 0), "first_line", 0),
        (_at("properties", 0, "diagnostics"), "fine", True),
        (_at("laws", 0), "coefficients", []),
        (_at("laws", 0), "valid", [0.0, None]),
        (_at("refused", 0), "reason", ""),
    ],
)
def test_the_schema_refuses(place: Callable[[Any], Any], field: str, value: object) -> None:
    found = document()
    place(found)[field] = value
    with pytest.raises(jsonschema.ValidationError):
        _VALIDATOR.validate(found)


@pytest.mark.parametrize("place", [_at(), _at("properties", 0), _at("laws", 0), _at("refused", 0)])
def test_the_schema_misses_every_field_that_is_not_there(place: Callable[[Any], Any]) -> None:
    for name in place(document()):
        found = document()
        del place(found)[name]
        with pytest.raises(jsonschema.ValidationError, match=f"'{name}' is a required property"):
            _VALIDATOR.validate(found)
