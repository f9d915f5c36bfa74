"""Maps of where each estimator holds, flags, refuses, or is silently wrong.

`python -m benchmarks.stability` simulates a grid of ways to fail for every estimator, prints how
many cells are silently wrong and which, and writes the cells as CSV and JSON and one map for each
question as SVG and PNG to `processed/benchmarks/`; `--docs` also copies the maps that the pages in
`docs/methods/` show. All data are simulated; nothing of it is a measurement.
"""

from __future__ import annotations

import argparse
import time
from concurrent.futures import ProcessPoolExecutor

from benchmarks.docs_page import copy_picture
from benchmarks.stability.cells import Cell, cells_of
from benchmarks.stability.estimators import ESTIMATORS
from benchmarks.stability.figure import draw_map
from benchmarks.stability.known import reason_for
from benchmarks.timing import RESULTS, Row, table, write_results


def summary(cells: list[Cell]) -> list[Row]:
    """Count the cells of each verdict by estimator and question."""
    rows: list[Row] = []
    for key, question in dict.fromkeys((c.estimator, c.question) for c in cells):
        verdicts = [c.verdict for c in cells if (c.estimator, c.question) == (key, question)]
        unknown = [
            c
            for c in cells
            if (c.estimator, c.question) == (key, question)
            and c.verdict == "SILENTLY WRONG"
            and reason_for(c) is None
        ]
        row: dict[str, str | float | int] = {"estimator": key, "question": question}
        row |= {"cells": len(verdicts)}
        row |= {v: verdicts.count(v) for v in ("within", "flagged", "refused", "SILENTLY WRONG")}
        rows.append({**row, "without a reason": len(unknown)})
    return rows


def _cells(number: int, failure: int, samples: int) -> list[Cell]:
    """Simulate one failure of one estimator: by number, for functions do not travel."""
    estimator = ESTIMATORS[number]
    return cells_of(estimator, samples, failures=estimator.failures[failure : failure + 1])


def main() -> None:
    """Simulate, print, write and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=0, help="for each cell")
    parser.add_argument("--docs", action="store_true", help="copy the maps to docs/ as well")
    asked = parser.parse_args()
    start = time.perf_counter()
    with ProcessPoolExecutor(max_workers=2) as pool:
        jobs = [
            pool.submit(_cells, i, k, asked.samples)
            for i, estimator in enumerate(ESTIMATORS)
            for k in range(len(estimator.failures))
        ]
        cells = [cell for job in jobs for cell in job.result()]
    for cell in cells:
        if cell.verdict == "SILENTLY WRONG":
            print(
                f"silently wrong in {100 * cell.silent:.0f} %: {cell.estimator}, {cell.question}: "
                f"{cell.failure} {cell.setting}, n = {cell.n}: {reason_for(cell) or 'NO REASON'}"
            )
    counts = summary(cells)
    print(f"\nof simulated cells:\n{table(counts)}")
    write_results("stability_summary", counts, ["numpy", "scipy"])
    write_results("stability", [cell.row() for cell in cells], ["numpy", "scipy"])
    for estimator in ESTIMATORS:
        for question in estimator.questions:
            _, png = draw_map(estimator, question, cells, RESULTS)
            if asked.docs:
                copy_picture(png)
    print(f"\n{time.perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
