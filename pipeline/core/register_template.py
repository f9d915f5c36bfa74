"""The columns of a technique's register: as a header to fill in, and as JSON Schema of a row."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from deamat.core.register import REGISTER_FILE, RegisterForm
from deamat.core.register_bounds import possible
from deamat.core.register_columns import (
    CONDITION_COLUMNS,
    columns_of,
    split_unit,
    usual_column,
)
from deamat.core.slug import LONGEST_ID, LONGEST_LABEL
from deamat.core.units import from_si

# Columns of every register of specimens, behind those of its technique.
CIRCUMSTANCES = (
    "age", "cure", "cured_on", "tested_on", "temperature_C", "humidity_percent", "operator",
    "instrument", "comment",
)  # fmt: skip
_WORDS = {
    "specimen": "Names the row, once in its register.",
    "material": "Id of the material.",
    "file": "Data file, relative to the folder of the register; `file.xlsx#Sheet` names a sheet.",
    "age": "Makes separate records: `after cure`, `2 months`.",
    "cure": "Makes separate records: `2 h at 90 C`.",
    "electrode": "Material of the electrode; makes separate records.",
    "cured_on": "Day, 2022-01-31.",
    "tested_on": "Day, 2022-01-31.",
    "operator": "Who tested it.",
    "instrument": "Picks the machine in config/instruments.toml.",
    "comment": "A note.",
    "format": "Names a reader and skips detection.",
}
_ID = "^[a-z0-9][A-Za-z0-9._-]*$"
_DAY = r"^([0-9]{4}-[0-9]{2}-[0-9]{2}|[0-9]{1,2}\.[0-9]{1,2}\.[0-9]{4})"


def template_columns(
    required: Sequence[str], optional: Sequence[str], form: RegisterForm
) -> tuple[str, ...]:
    """Return the header of an empty register, required columns first.

    Parameters
    ----------
    required, optional : SI names of the columns that the technique reads (`diameter_m`)
    """
    file = ("file",) if form.file == REGISTER_FILE else ()
    numbers = map(usual_column, (*required, *optional))
    columns = (*form.text, *file, *numbers, *form.notes, *CIRCUMSTANCES)
    if any(key == "temperature_K" for key in form.conditions.values()):
        columns = tuple(column for column in columns if column != "temperature_C")
    return tuple(dict.fromkeys(columns))


def register_schema(
    key: str, required: Sequence[str], optional: Sequence[str], form: RegisterForm
) -> dict[str, Any]:
    """Describe a row of a technique's register as JSON Schema, draft 2020-12.

    Numbers are numbers, an empty cell is a column left out, any further column is a note.
    """
    columns = template_columns(required, optional, form)
    numbers = (*required, *optional)
    usual = {usual_column(name): name for name in numbers}
    properties: dict[str, Any] = {}
    for column in (*columns, "electrode", "format"):
        name = usual.get(column)
        properties[column] = _text(column) if name is None else _number(name, column)
    for column, unit in (("temperature_C", "C"), ("humidity_percent", "%")):
        if column in properties:
            properties[column] = {"type": "number", "description": f"Condition, in {unit}."}
    every = [{"anyOf": [{"required": [column]} for column in columns_of(n)]} for n in required]
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": f"A row of {key}/{form.file}",
        "type": "object",
        "required": [*form.text],
        "properties": properties,
        "patternProperties": _patterns(numbers),
        **({"allOf": every} if every else {}),
    }


def schema_text(schema: Mapping[str, Any]) -> str:
    """Return the text of a schema's file."""
    return json.dumps(schema, indent=2, ensure_ascii=False) + "\n"


def _text(column: str) -> dict[str, Any]:
    said = {"description": _WORDS[column]} if column in _WORDS else {}
    if column == "material":
        return {
            "type": "string",
            "pattern": "^[a-z0-9][A-Za-z0-9._-]*$",
            "maxLength": LONGEST_ID,
        } | said
    if column in ("cured_on", "tested_on"):
        return {"type": "string", "pattern": _DAY} | said
    if column in (*CONDITION_COLUMNS, "specimen"):
        return {"type": "string", "minLength": 1, "maxLength": LONGEST_LABEL} | said
    return {"type": ["string", "number"]} | said


def _number(name: str, column: str) -> dict[str, Any]:
    _, unit = split_unit(column)
    limits = possible(name)
    if limits is None or unit is None:
        return {"type": "number"}
    least, most = (float(f"{from_si(limit, unit):.6g}") for limit in limits)
    return {"type": "number", "minimum": least, "maximum": most}


def _patterns(numbers: Sequence[str]) -> dict[str, Any]:
    """The same quantities in other units, and their standard uncertainties."""
    found: dict[str, Any] = {}
    for name in numbers:
        stem = split_unit(usual_column(name))[0]
        units = [column.removeprefix(f"{stem}_") for column in columns_of(name)]
        found[f"^(u_)?{stem}_({'|'.join(units)})$"] = {"type": "number"}
    return found
