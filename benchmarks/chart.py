"""Accuracy against speed of every estimator and its rivals, on the same simulated data in one run.

`python -m benchmarks.chart` measures seven families (slope, slack, means with limits, polynomial,
power law, Weibull points and intervals) and the ladder of actuator models, prints a table for each,
and writes tables as CSV and JSON and charts as SVG and PNG to `processed/benchmarks/`; `--docs`
also writes `docs/benchmarks.md` and the pictures in `docs/methods/img/`. All data are simulated;
nothing of it is a measurement.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from pathlib import Path

from benchmarks import ladder
from benchmarks.docs_page import copy_picture, write_page
from benchmarks.families import censored_mean, polynomial, power_law, slack, slope, weibull
from benchmarks.families.family import Family, with_front
from benchmarks.front_figure import draw_front
from benchmarks.measure import is_there
from benchmarks.timing import RESULTS, Row, stay_on_one_core, table, write_results

FAMILIES = (
    slope.FAMILY,
    slack.FAMILY,
    censored_mean.FAMILY,
    polynomial.FAMILY,
    power_law.FAMILY,
    weibull.POINTS,
    weibull.INTERVALS,
)


def measure(family: Family, scale: float) -> list[Row]:
    """Measure one family and find its front."""
    return with_front(family.rows(scale), family.error)


def verdict(family: Family, rows: Sequence[Row]) -> str:
    """Say whether the default is on the front."""
    on_front = any(row["kind"] == "default" and row["front"] == "yes" for row in rows)
    if on_front:
        return f"{family.key}: the default is on the front"
    return f"{family.key}: the default is NOT on the front"


def main() -> None:
    """Measure, print, write and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scale", type=float, default=1.0, help="part of the usual samples")
    parser.add_argument("--docs", action="store_true", help="write docs/ as well")
    asked = parser.parse_args()
    stay_on_one_core()
    packages = ["numpy", "scipy"] + ["lmfit"] * is_there("lmfit")
    start = time.perf_counter()
    found: list[tuple[Family, list[Row]]] = []
    for family in FAMILIES:
        rows = measure(family, asked.scale)
        found.append((family, rows))
        print(f"\n{family.title} (simulated)\n{table(rows)}\n{verdict(family, rows)}")
        print(family.why(rows))
        write_results(f"chart_{family.key}", rows, packages)
        svg, png = draw_front(family, rows, RESULTS)
        if asked.docs:
            copy_picture(png)
        print(f"{svg}, {png.name}")
    print("\nLadder of actuator models (simulated)")
    rungs, limits, pictures = ladder.measure_and_draw(max(int(ladder.DESIGNS * asked.scale), 200))
    if asked.docs:
        for picture in pictures:
            copy_picture(picture)
        write_page(found, rungs, limits, Path("docs/benchmarks.md"))
    print(f"\n{time.perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
