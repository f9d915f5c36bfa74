"""The figure of a material: printed lines over time, run by run."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from deamat.core.records import Measurement, Summary
from deamat.core.units import from_si
from deamat.techniques.handling.config import KEY
from deamat.techniques.handling.runs import Line, runs_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def figure(axes: Axes, measurements: Sequence[Measurement[Line]], summary: Summary) -> None:
    """Draw every printed line at its time, run by run, and where the first defect began."""
    runs = runs_of(m.result for m in measurements if m.result is not None)
    for mark, said, chosen in (
        ("o", "clean", lambda line: not line.defective),
        ("x", "defective", lambda line: line.defective),
        ("|", "equipment limit", lambda line: line.limited),
    ):
        points = [
            (from_si(line.time_s, "h"), at)
            for at, run in enumerate(runs)
            for line in run.lines
            if chosen(line)
        ]
        if points:
            axes.plot(*zip(*points, strict=True), linestyle="none", marker=mark, label=said)
    for record in (r for r in summary.records if r.key == KEY):
        low, high = (from_si(end, "h") for end in record.ci95)
        if math.isfinite(high):
            axes.axvspan(low, high, alpha=0.15, color="0.5", linewidth=0)
    axes.set_yticks(range(len(runs)), [run.name or "lines" for run in runs])
    axes.set_xlabel("time since mixing [h]")
    axes.set_ylabel("run")
