"""`docs/card.schema.json`, made of the list of fields: `python -m deamat.materials.json_schema`."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from deamat.core.schema import Field, entry_of, fields_of
from deamat.materials.card import SCHEMA, MaterialCard
from deamat.materials.document import Document


def card_schema() -> Document:
    """Describe a card as JSON Schema, draft 2020-12."""
    card = _object(MaterialCard)
    said = "Identifier of this schema; another one means another shape."
    name = {"const": SCHEMA, "description": said}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": SCHEMA,
        "title": "Material card",
        **card,
        "required": ["schema", *card["required"]],
        "properties": {"schema": name, **card["properties"]},
        "$defs": dict(_definitions(MaterialCard)),
    }


def schema_text() -> str:
    """Return the text of `docs/card.schema.json`."""
    return json.dumps(card_schema(), indent=2, ensure_ascii=False) + "\n"


def _object(cls: Any) -> Document:
    said = {"description": entry_of(cls).text} if entry_of(cls).text else {}
    listed = fields_of(cls)
    return {
        **said,
        "type": "object",
        "additionalProperties": False,
        "required": [field.name for field in listed if not field.optional],
        "properties": {field.name: _described(field) for field in listed},
    }


def _described(field: Field) -> Document:
    said = {"description": field.text} if field.text else {}
    return {**field.kind.schema, **said}


def _definitions(cls: Any) -> Iterator[tuple[str, Any]]:
    """Return what the fields of a class refer to, by name; what is named twice is the same."""
    for field in fields_of(cls):
        yield from field.kind.definitions.items()
        below = field.kind.rows_of
        if below is not None and entry_of(below).as_text is None:
            yield entry_of(below).name, _object(below)
            yield from _definitions(below)


if __name__ == "__main__":
    print(schema_text(), end="")
