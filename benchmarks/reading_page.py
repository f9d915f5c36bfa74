"""`docs/reading-speed.md`, written from what `benchmarks.read_and_fit` measured."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from importlib import metadata
from pathlib import Path

from benchmarks.families.family import number
from benchmarks.timing import Row
from deamat.core.atomic import write_atomically

PAGE = Path("docs/reading-speed.md")
_PACKAGES = ("numpy", "pandas", "openpyxl", "lmfit", "pysimdjson", "python-calamine")
_HEAD = """\
# Speed of reading and fitting whole files

Written by `make docs` from one run of `python -m benchmarks.read_and_fit --docs`; the curves are
SYNTHETIC. Every contender reads the same files from the disk and fits the slope of 0-5 % strain
with its standard error, on one core, part by part in turn. A time is the least of the rounds for
each file, which other users of the machine disturb least; that of the median round stands beside
it. The errors are equal: all fit the same line, and ours alone allows for residuals that follow
each other.

"ours" answers what its rivals answer, with all strictness of the readers; "hashed" adds the SHA-256
that every origin of a number needs, "whole technique" budgets, toe and flags.
"""
_COLUMNS = (
    "| form | contender | time of a file | median round | times ours | times read and hash | "
    "worst error |"
)


def write_reading_page(rows: Sequence[Row], verdicts: Sequence[str], page: Path = PAGE) -> None:
    """Write what was measured of every contender, and what of the targets was met."""
    packages = ", ".join(f"{name} {metadata.version(name)}" for name in _PACKAGES)
    versions = f"Run with Python {platform.python_version()}, {packages}"
    lines = [
        _HEAD,
        f"{versions}; {rows[0]['files']} files of each form, {rows[0]['rounds']} rounds.",
        "",
        _COLUMNS,
        "|---|---|---|---|---|---|---|",
        *map(_line, rows),
        "",
        "Against the targets:",
        "",
        *(f"- {verdict}" for verdict in verdicts),
        "",
    ]
    write_atomically(page, "\n".join(lines).encode())


def _line(row: Row) -> str:
    error = number(row, "worst error")
    fitted = f"{100 * error:.2g} %" if error else ""  # who only reads has none
    return (
        f"| {row['form']} | {row['contender']} | {1e3 * number(row, 'ms per file'):.0f} us | "
        f"{1e3 * number(row, 'median round'):.0f} us | {number(row, 'times ours'):.3g} | "
        f"{number(row, 'times read and hash'):.3g} | {fitted} |"
    )
