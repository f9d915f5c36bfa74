"""The table of forms in `docs/formats.md`, made from what each form declares."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

from deamat.formats.detect import EVERY_FORM
from deamat.formats.format import Format

_HEADER = "| name | form | known by | written from |\n|---|---|---|---|\n"


def table_of(forms: Iterable[Format]) -> str:
    """Return the rows of the table, one for each form, under their header."""
    return _HEADER + "".join(
        f"| `{form.name}` | {form.title} | {form.looks} | {form.seen} |\n" for form in forms
    )


def with_table(page: str) -> str:
    """Return a page with the table that the code makes in the place of its own.

    Raises
    ------
    ValueError : the page has no such table
    """
    start = page.index(_HEADER)
    end = page.index("\n\n", start) + 1
    return page[:start] + table_of(EVERY_FORM) + page[end:]


if __name__ == "__main__":
    path = Path(sys.argv[1])
    path.write_text(with_table(path.read_text(encoding="utf-8")), encoding="utf-8")
