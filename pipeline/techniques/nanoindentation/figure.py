"""The figure of a material: load over depth with the fitted laws."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from deamat.core.records import Measurement, Summary
from deamat.core.units import from_si
from deamat.techniques.nanoindentation.result import Indent

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def figure(axes: Axes, measurements: Sequence[Measurement[Indent]], _: Summary) -> None:
    """Draw load over depth from contact with the fitted laws; a refused indent as it was read."""
    drawn = [(m, m.result) for m in measurements if m.result is not None]
    deepest = max((float(indent.depth_m.max()) for _, indent in drawn), default=0.0)
    unit = "um" if deepest >= 1e-6 else "nm"
    for measurement, indent in drawn:
        axes.plot(
            from_si(1.0, unit) * indent.depth_m,
            from_si(1.0, "uN") * indent.force_N,
            linewidth=2.0,
            alpha=0.6,
            label=measurement.specimen.id + ("" if measurement.values else ", refused: as read"),
        )
        if indent.law is not None:
            depth = np.linspace(0.0, float(indent.depth_m.max()), 100)
            axes.plot(
                from_si(1.0, unit) * depth,
                from_si(1.0, "uN") * indent.law.stiffness * depth**indent.law.exponent,
                color="black",
                linestyle="-",
                linewidth=0.7,
            )
    axes.set_xlabel(f"depth from contact [{unit}]")
    axes.set_ylabel("load [uN]")
