"""`docs/performance.md`, written from what `benchmarks.end_to_end` measured."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from importlib import metadata
from pathlib import Path

from benchmarks.timing import Row
from deamat.core.atomic import write_atomically

PAGE = Path("docs/performance.md")
_PACKAGES = ("numpy", "pandas", "matplotlib", "h5py")
_HEAD = """\
# Performance from end to end

Written by `python -m benchmarks.end_to_end --docs`; the curves are SYNTHETIC. Compression files of
20 materials go from raw bytes to values with uncertainties, a database and a figure a material, all
of it cold, each contender in a process of its own on one core, in turn. A time is the processor
time of the whole process, imports among it, the least of the rounds.

`script` is what a user writes with pandas, `numpy.polyfit`, sqlite and matplotlib
(`benchmarks/end_to_end/script.py`); `before` is this project at an older commit. The error is the
root mean square over the materials; an interval of the script is its mean with 1.96 standard
errors, which knows nothing of the machine and the gauges.
"""


def write_page(rows: Sequence[Row], verdicts: Sequence[str], rounds: int) -> None:
    """Write the table and what of the targets was met."""
    packages = ", ".join(f"{name} {metadata.version(name)}" for name in _PACKAGES)
    versions = f"Python {platform.python_version()}, {packages}"
    lines = [
        _HEAD,
        f"{rows[0]['files']} files, {rounds} rounds, {versions}.",
        "",
        "| contender | CPU | per file | times deamat | peak memory | error | 95 % intervals hold |",
        "|---|---|---|---|---|---|---|",
        *map(_line, rows),
        "",
        "Against the targets:",
        "",
        *(f"- {verdict}" for verdict in verdicts),
        "",
    ]
    write_atomically(PAGE, "\n".join(lines).encode())


def _line(row: Row) -> str:
    error, inside = row["error"], row["95 % intervals hold"]
    right = (
        ("", "")
        if isinstance(error, str) or isinstance(inside, str)
        else (f"{100 * error:.2f} %", f"{100 * inside:.0f} %")
    )
    cells = (
        str(row["contender"]),
        f"{float(row['CPU [s]']):.2f} s",
        f"{float(row['ms per file']):.2f} ms",
        f"{float(row['times deamat']):.2f}",
        f"{float(row['peak [MB]']):.0f} MB",
        *right,
    )
    return f"| {' | '.join(cells)} |"
