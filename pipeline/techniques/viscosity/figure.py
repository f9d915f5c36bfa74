"""The figure of the room: readings and laws over time, or a flow curve."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from pipeline.core.records import Law, Measurement, Summary
from pipeline.core.units import from_si
from pipeline.techniques.viscosity.values import VISCOSITY

_POINTS = 200
_HOURS_FROM_S = 7200.0


def draw(axes: Any, measurements: Sequence[Measurement], summary: Summary) -> None:
    """Draw the readings of every run, also those not fitted, and the law over its range."""
    for measurement in measurements:
        if "shear_rate_per_s" in measurement.curve:
            _flow_curve(axes, measurement)
            return
    longest = max((float(m.curve["time_s"].max()) for m in measurements if m.curve), default=0.0)
    unit = "h" if longest >= _HOURS_FROM_S else "s"
    for measurement in measurements:
        if measurement.curve:
            axes.plot(
                from_si(1.0, unit) * measurement.curve["time_s"],
                measurement.curve["viscosity_Pas"],
                linestyle="none",
                marker=".",
                markersize=3,
                label=measurement.specimen.id,
            )
    for law in summary.laws:
        if law.key == VISCOSITY:
            _law(axes, law, unit)
    axes.set_xlabel(f"time since mixing [{unit}]")
    axes.set_ylabel("viscosity [Pa.s]")


def _law(axes: Any, law: Law, unit: str) -> None:
    times = np.linspace(*law.valid, _POINTS)
    for rate in law.rates or (None,):
        values = [law(float(t), rate).value for t in times]
        axes.plot(from_si(1.0, unit) * times, values, color="black", linewidth=1.2)
    low, high = law.valid
    axes.axvspan(from_si(low, unit), from_si(high, unit), alpha=0.15, color="0.5", linewidth=0)


def _flow_curve(axes: Any, measurement: Measurement) -> None:
    curve = measurement.curve
    axes.plot(
        np.log10(curve["shear_rate_per_s"]),
        np.log10(curve["viscosity_Pas"]),
        linestyle="none",
        marker=".",
        label=measurement.specimen.id,
    )
    axes.set_xlabel("log10 of shear rate [1/s]")
    axes.set_ylabel("log10 of viscosity [Pa.s]")
