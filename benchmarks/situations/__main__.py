"""Runs the study: every situation at every severity, severity 0 (the same without a fault) first.

`python -m benchmarks.situations [NAME ...] [--count N] [--docs]`
"""

from __future__ import annotations

import argparse
from concurrent.futures import ProcessPoolExecutor

from benchmarks.situations.judge import ROOT, cell
from benchmarks.situations.page import page, row
from benchmarks.timing import write_results
from deamat.twin.situations import SITUATIONS

FIRST_SEED = 500_000


def main() -> None:
    """Run the study and print its table as it comes."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.situations", description=__doc__)
    parser.add_argument("names", nargs="*", help="beginnings of names [default: all]")
    parser.add_argument("--count", type=int, default=300, help="materials in each cell")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--docs", action="store_true", help="write docs/situations.md")
    options = parser.parse_args()
    names = [n for n in SITUATIONS if n.startswith(tuple(options.names) or "")]
    tasks = [(name, s) for name in names for s in (0.0, *SITUATIONS[name].severities)]
    work = [(*task, FIRST_SEED, options.count) for task in tasks]
    cells = {}
    with ProcessPoolExecutor(options.workers) as pool:
        for task, judged in zip(tasks, pool.map(cell, work), strict=True):
            cells[task] = judged
            print("  ".join(f"{k} {v}" for k, v in row(task, judged).items()), flush=True)
    write_results("situations", [row(*one) for one in cells.items()], ("numpy", "scipy"))
    if options.docs:
        (ROOT / "docs" / "situations.md").write_text(page(cells), "utf-8")


if __name__ == "__main__":
    main()
