"""The figure of a material: printed lines over time, run by run."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from deamat.core.chart import Axis, Chart, Mark, Points, Shape, Window
from deamat.core.chart import Line as Stroke
from deamat.core.present import said_of
from deamat.core.records import Measurement, Summary
from deamat.core.units import from_si
from deamat.techniques.handling.config import KEY
from deamat.techniques.handling.runs import Line, Run, runs_of

_ROW_px = 34.0


def figure(measurements: Sequence[Measurement[Line]], summary: Summary) -> Chart:
    """Show every printed line at its time, run by run, and where the first defect began."""
    runs = runs_of(m.result for m in measurements if m.result is not None)
    marks: list[Mark] = []
    for record in (r for r in summary.records if r.key == KEY):
        low, high = (from_si(end, "h") for end in record.ci95)
        if math.isfinite(high):
            marks.append(Window(low, high, "first defect lies in here"))
    marks += [_clean_stretch(run, at) for at, run in enumerate(runs)]
    kinds: tuple[tuple[Shape, str, int | None, list[tuple[float, int]]], ...] = (
        ("dot", "clean", 2, _points(runs, lambda line: not line.defective)),
        ("cross", "defective", 1, _points(runs, lambda line: line.defective)),
        ("stroke", "equipment limit", None, _points(runs, lambda line: line.limited)),
    )
    for shape, said, series, points in kinds:
        if points:
            x, y = np.array(points, np.float64).T
            marks.append(Points(x, y, said, shape, series=series))
    names = tuple((float(at), run.name or "lines") for at, run in enumerate(runs))
    upright = Axis("run", limits=(-0.6, max(len(runs), 1) - 0.4), ticks=names, downwards=True)
    return Chart(
        Axis("time since mixing [h]"), upright, tuple(marks),
        says=said_of(summary.records), height_px=max(90.0, _ROW_px * len(runs)),
    )  # fmt: skip


def _points(runs: Sequence[Run], chosen: Callable[[Line], bool]) -> list[tuple[float, int]]:
    return [
        (from_si(line.time_s, "h"), at)
        for at, run in enumerate(runs)
        for line in run.lines
        if chosen(line)
    ]


def _clean_stretch(run: Run, at: int) -> Stroke:
    """A stroke from mixing to the last time at which every line was clean."""
    end = from_si(run.clean_until_s, "h")
    ends = [0.0, end] if math.isfinite(end) else []
    return Stroke(np.array(ends), np.full(len(ends), float(at)), "all lines clean", heavy=True)
