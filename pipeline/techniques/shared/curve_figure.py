"""The figure of the rooms of stress-strain curves, drawn on axes that the report hands in."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from deamat.core.records import Measurement
from deamat.core.units import from_si
from deamat.techniques.shared.modulus import LoadingCurve, WindowLine

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MPA_FROM = 1e6  # from this stress on, MPa reads better than kPa


def draw_curves(axes: Axes, measurements: Sequence[Measurement[LoadingCurve]]) -> None:
    """Draw nominal stress over nominal strain of each specimen, with window and fitted line."""
    drawn = [(m.specimen.id, m.result) for m in measurements if m.result is not None]
    greatest = max((float(c.nominal_stress_Pa.max()) for _, c in drawn), default=0.0)
    unit = "MPa" if greatest >= _MPA_FROM else "kPa"
    for name, curve in drawn:
        axes.plot(
            100.0 * curve.nominal_strain,
            from_si(1.0, unit) * curve.nominal_stress_Pa,
            linewidth=0.8,
            label=name,
        )
        if curve.line is not None:
            _draw_line(axes, curve.line, unit)
    for low, high in sorted({c.line.window for _, c in drawn if c.line is not None}):
        axes.axvspan(100.0 * low, 100.0 * high, alpha=0.15, color="0.5", linewidth=0)
    axes.set_xlabel("nominal strain [%]")
    axes.set_ylabel(f"nominal stress [{unit}]")


def _draw_line(axes: Axes, line: WindowLine, unit: str) -> None:
    strain = np.array(line.window)
    stress = line.intercept_Pa + line.slope_Pa * strain
    axes.plot(100.0 * strain, from_si(1.0, unit) * stress, color="black", linewidth=1.2)
