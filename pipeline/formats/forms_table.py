"""What `docs/formats.md` says of forms and labels, made from what the code declares."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path
from textwrap import wrap

from deamat.formats.detect import EVERY_FORM
from deamat.formats.format import Format
from deamat.formats.vocabulary import vocabulary

_KNOWN = "Labels of these programs are known: "
_NOBODY = "tables of laboratories"
_WIDTH = 105
_HEADER = "| name | form | known by | written from |\n|---|---|---|---|\n"


def table_of(forms: Iterable[Format]) -> str:
    """Return the rows of the table, one for each form, under their header."""
    return _HEADER + "".join(
        f"| `{form.name}` | {form.title} | {form.looks} | {form.seen} |\n" for form in forms
    )


def programs() -> str:
    """Return the sentence that names every program whose labels the vocabulary has."""
    seen = {
        one.partition(":")[2].strip()
        for words in vocabulary().values()
        for where in words.seen
        for one in where.split(";")
    }
    sentence = _KNOWN + ", ".join(sorted(seen - {_NOBODY}, key=str.casefold)) + "."
    return "\n".join(wrap(sentence, _WIDTH, break_long_words=False, break_on_hyphens=False)) + "\n"


def with_table(page: str) -> str:
    """Return a page with what the code makes in the place of its own.

    Raises
    ------
    ValueError : the page has no such table or no such sentence
    """
    for first, made in ((_HEADER, table_of(EVERY_FORM)), (_KNOWN, programs())):
        start = page.index(first)
        end = page.index("\n\n", start) + 1
        page = page[:start] + made + page[end:]
    return page


if __name__ == "__main__":
    path = Path(sys.argv[1])
    path.write_text(with_table(path.read_text(encoding="utf-8")), encoding="utf-8")
