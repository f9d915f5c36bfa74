"""`docs/registers/`, made of the declared techniques: `python -m deamat.run.register_schemas`."""

from __future__ import annotations

import sys
from pathlib import Path

from deamat.core.atomic import write_atomically
from deamat.core.register_template import register_schema, schema_text, template_columns
from deamat.core.technique import AnyTechnique
from deamat.techniques import TECHNIQUES


def header_of(technique: AnyTechnique) -> tuple[str, ...]:
    """Return the columns of an empty register of a technique."""
    return template_columns(technique.required, technique.optional, technique.register)


def schema_of(technique: AnyTechnique) -> str:
    """Return the text of the JSON Schema of a row of a technique's register."""
    return schema_text(
        register_schema(technique.key, technique.required, technique.optional, technique.register)
    )


def write_schemas(folder: Path) -> None:
    """Write the schema of every register into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for technique in TECHNIQUES.values():
        path = folder / f"{technique.key}.schema.json"
        write_atomically(path, schema_of(technique).encode())


if __name__ == "__main__":
    write_schemas(Path(sys.argv[1]))
