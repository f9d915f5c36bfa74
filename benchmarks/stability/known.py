"""Cells that are silently wrong and known to be: why nothing in the sample could tell.

Everything here is a limit that a user must know; the pages in docs/methods print them.
"""

from __future__ import annotations

from benchmarks.stability.cells import Cell

_KNOWN: dict[tuple[str, str], str] = {}


def reason_for(cell: Cell) -> str | None:
    """Give the reason why a cell may be silently wrong, or None if it may not."""
    return _KNOWN.get((cell.estimator, cell.failure))
