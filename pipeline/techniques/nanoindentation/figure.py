"""The figure of a material: load over depth with the fitted laws."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deamat.core.chart import Axis, Chart, Curve, Curves, Line
from deamat.core.present import said_of
from deamat.core.records import Measurement, Summary
from deamat.core.units import from_si
from deamat.techniques.nanoindentation.result import Indent

_POINTS = 60


def figure(measurements: Sequence[Measurement[Indent]], summary: Summary) -> Chart:
    """Show load over depth from contact with the fitted laws; a refused indent as it was read."""
    drawn = [(m, m.result) for m in measurements if m.result is not None]
    deepest = max((float(indent.depth_m.max()) for _, indent in drawn), default=0.0)
    name, unit = ("µm", "um") if deepest >= 1e-6 else ("nm", "nm")
    along, load = from_si(1.0, unit), from_si(1.0, "uN")
    indents = tuple(
        Curve(
            m.specimen.id + ("" if m.values else ", refused: as read"),
            along * indent.depth_m,
            load * indent.force_N,
        )
        for m, indent in drawn
    )
    laws = [_law(indent, along, load) for _, indent in drawn]
    return Chart(
        Axis(f"depth from contact [{name}]"), Axis("load [µN]"),
        (Curves(indents, "indent"), *(law for law in laws if law is not None)),
        says=said_of(summary.records),
    )  # fmt: skip


def _law(indent: Indent, along: float, load: float) -> Line | None:
    if indent.law is None:
        return None
    depth = np.linspace(0.0, float(indent.depth_m.max()), _POINTS)
    force = indent.law.stiffness * depth**indent.law.exponent
    return Line(along * depth, load * force, "law of contact", dashed=True)
