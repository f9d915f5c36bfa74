"""The figure of the room: readings and laws over time, or a flow curve."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.records import Law, Measurement, Summary
from deamat.core.units import from_si
from deamat.techniques.viscosity.config import VISCOSITY

_POINTS = 200
_HOURS_FROM_S = 7200.0
_DECADES = 100.0


def figure(axes: Any, measurements: Sequence[Measurement], summary: Summary) -> None:
    """Draw the readings of every run, also those not fitted, and the law over its range.

    A cure that spans decades is drawn in logarithms, for its law ends where the curve takes off.
    """
    for measurement in measurements:
        if "shear_rate_per_s" in measurement.curve:
            _flow_curve(axes, measurement)
            return
    longest = max((float(m.curve["time_s"].max()) for m in measurements if m.curve), default=0.0)
    unit = "h" if longest >= _HOURS_FROM_S else "s"
    spans = [m.curve["viscosity_Pas"] for m in measurements if m.curve]
    spans = [v[v > 0] for v in spans]
    wide = any(v.size and v.max() > _DECADES * v.min() for v in spans)
    scaled = np.log10 if wide else np.asarray
    for measurement in measurements:
        if measurement.curve:
            shown = measurement.curve["viscosity_Pas"] > 0
            axes.plot(
                from_si(1.0, unit) * measurement.curve["time_s"][shown],
                scaled(measurement.curve["viscosity_Pas"][shown]),
                linestyle="none",
                marker=".",
                markersize=3,
                label=measurement.specimen.id,
            )
    for law in summary.laws:
        if law.key == VISCOSITY:
            _law(axes, law, unit, scaled)
    axes.set_xlabel(f"time since mixing [{unit}]")
    axes.set_ylabel("log10 of viscosity [Pa.s]" if wide else "viscosity [Pa.s]")


def _law(axes: Any, law: Law, unit: str, scaled: Callable[[FloatArray], FloatArray]) -> None:
    times = np.linspace(*law.valid, _POINTS)
    for rate in law.rates or (None,):
        values = np.array([law(float(t), rate).value for t in times])
        label = "law" if rate is None else f"law at {rate:.3g} 1/s"
        axes.plot(
            from_si(1.0, unit) * times, scaled(values), color="black", linewidth=1.2, label=label
        )
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
