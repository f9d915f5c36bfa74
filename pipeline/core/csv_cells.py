"""Cells of CSV files that this program writes: no spreadsheet program may run one as a formula."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable

from deamat.core.number_grammar import is_number

_STARTS = ("=", "+", "-", "@", "\t", "\r")
_MARK = "'"  # what spreadsheet programs take for: text follows


def neutral(text: str) -> str:
    """Put a mark before a text that would run as a formula; numbers stay as they are."""
    return _MARK + text if text.startswith(_STARTS) and not is_number(text) else text


def restored(cell: str) -> str:
    """Return the text of a cell that `neutral` may have marked."""
    bare = cell.removeprefix(_MARK)
    return bare if bare.startswith(_STARTS) else cell


def csv_text(rows: Iterable[Iterable[str]], separator: str = ",", end: str = "\n") -> str:
    """Write rows of cells, each of them neutral."""
    text = io.StringIO()
    writer = csv.writer(text, delimiter=separator, lineterminator=end)
    writer.writerows([neutral(cell) for cell in row] for row in rows)
    return text.getvalue()
