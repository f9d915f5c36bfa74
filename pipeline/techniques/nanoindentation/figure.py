"""The figure of a material: load over depth with the fitted laws."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from deamat.core.records import Measurement, Summary
from deamat.core.units import from_si


def figure(axes: Any, measurements: Sequence[Measurement], _summary: Summary) -> None:
    """Draw load over depth from contact with the fitted laws; a refused indent as it was read."""
    drawn = [m for m in measurements if {"depth_m", "force_N"} <= m.curve.keys()]
    deepest = max((float(m.curve["depth_m"].max()) for m in drawn), default=0.0)
    unit = "um" if deepest >= 1e-6 else "nm"
    for measurement in drawn:
        depth, force = measurement.curve["depth_m"], measurement.curve["force_N"]
        axes.plot(
            from_si(1.0, unit) * depth,
            from_si(1.0, "uN") * force,
            linewidth=2.0,
            alpha=0.6,
            label=measurement.specimen.id + ("" if measurement.values else ", refused: as read"),
        )
        for value in measurement.values:
            if "stiffness" in value.diagnostics:
                stiffness, exponent = (
                    float(value.diagnostics[name]) for name in ("stiffness", "exponent")
                )
                law = np.linspace(0.0, float(depth.max()), 100)
                axes.plot(
                    from_si(1.0, unit) * law,
                    from_si(1.0, "uN") * stiffness * law**exponent,
                    color="black",
                    linestyle="-",
                    linewidth=0.7,
                )
    axes.set_xlabel(f"depth from contact [{unit}]")
    axes.set_ylabel("load [uN]")
