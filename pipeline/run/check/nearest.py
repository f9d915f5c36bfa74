"""Which form an unread file comes nearest to, and the first thing that differs."""

from __future__ import annotations

from collections.abc import Iterator

from deamat.core.errors import RawFileError
from deamat.formats import FORMATS
from deamat.formats.blocks import NAMES, block_in
from deamat.formats.rawfile import Head, RawFile
from deamat.formats.structure import SEPARATORS

_ABOVE = 12  # lines that a laboratory may have put above an export


def nearest_form(file: RawFile) -> str:
    """Name the form that would recognise a file but for one thing, and that thing.

    Empty where there is none.
    """
    try:
        lines = list(file.head)
    except RawFileError:
        return ""
    for words, head in _altered(lines):
        for form in FORMATS:
            if form.delimiter in "".join(head) and form.recognises(head):
                return f"{form.name} ({form.title}), but {words}"
    return ""


def _altered(lines: list[str]) -> Iterator[tuple[str, Head]]:
    """Give a head with one thing changed, and what was changed."""
    text = "\n".join(lines)
    if not text.strip():
        return
    for found in SEPARATORS:
        for wanted in SEPARATORS:
            if found != wanted and found in text and wanted not in text:
                words = f"its fields are separated by {NAMES[found]} instead of {NAMES[wanted]}"
                yield words, Head([line.replace(found, wanted) for line in lines])
    for above in range(1, min(_ABOVE, len(lines))):
        plural = "line stands" if above == 1 else "lines stand"
        yield f"{above} {plural} above it", Head(lines[above:])
    yield "it has blank lines", Head([line for line in lines if line.strip()])
    yield "its fields are in quotes", Head([line.replace('"', "") for line in lines])


def table_found(file: RawFile) -> str:
    """Say where rows of numbers stand in a text and what is above them; empty without any."""
    try:
        lines = file.body.decode().replace("\r\n", "\n").split("\n")
    except RawFileError:
        return ""
    block = block_in(lines)
    if block is None:
        return "it holds no rows of numbers"
    said = (
        f"rows of {block.columns} numbers from line {block.first + 1} to {block.last + 1}, "
        f"separated by {NAMES[block.separator]}"
    )
    if not block.labels:
        return f"{said}; no row of labels above them"
    return f"{said}; line {block.labels_line + 1} above them reads {', '.join(block.labels)}"
