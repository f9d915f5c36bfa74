"""The figure of the rooms of stress-strain curves, drawn on axes that the report hands in."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from deamat.core.records import Detail, MeasuredValue, Measurement
from deamat.core.units import from_si

_MPA_FROM = 1e6  # from this stress on, MPa reads better than kPa


def draw_curves(axes: Any, measurements: Sequence[Measurement], modulus_key: str) -> None:
    """Draw nominal stress over nominal strain of each specimen, with window and fitted lines.

    Parameters
    ----------
    axes : matplotlib axes
    measurements : those with a curve are drawn
    modulus_key : the value whose window is shaded and whose line is drawn
    """
    drawn = [m for m in measurements if m.curve]
    greatest = max((float(m.curve["nominal_stress_Pa"].max()) for m in drawn), default=0.0)
    unit = "MPa" if greatest >= _MPA_FROM else "kPa"
    shaded: set[tuple[float, float]] = set()
    for measurement in drawn:
        strain, stress = measurement.curve["nominal_strain"], measurement.curve["nominal_stress_Pa"]
        axes.plot(
            100.0 * strain,
            from_si(1.0, unit) * stress,
            linewidth=0.8,
            label=measurement.specimen.id,
        )
        for value in measurement.values:
            if value.key == modulus_key:
                shaded.add(_window(value))
                _line(axes, value, unit)
    for low, high in sorted(shaded):
        axes.axvspan(100.0 * low, 100.0 * high, alpha=0.15, color="0.5", linewidth=0)
    axes.set_xlabel("nominal strain [%]")
    axes.set_ylabel(f"nominal stress [{unit}]")


def _window(value: MeasuredValue) -> tuple[float, float]:
    window = value.conditions["window"]
    if not isinstance(window, tuple):
        raise TypeError(f"the window of {value.key} is {window!r}, not two strains")
    return window


def _line(axes: Any, value: MeasuredValue, unit: str) -> None:
    low, high = _window(value)
    intercept: Detail = value.diagnostics["intercept_Pa"]
    strain = np.array((low, high))
    stress = float(intercept) + value.quantity.value * strain
    axes.plot(100.0 * strain, from_si(1.0, unit) * stress, color="black", linewidth=1.2)
