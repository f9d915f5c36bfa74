"""The figure of the room: readings and laws over time, or a flow curve."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.records import Law, Measurement, Summary
from deamat.core.units import from_si
from deamat.techniques.viscosity.config import VISCOSITY
from deamat.techniques.viscosity.flow_fit import FlowReadings
from deamat.techniques.viscosity.readings import Readings
from deamat.techniques.viscosity.result import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_POINTS = 200
_HOURS_FROM_S = 7200.0
_DECADES = 100.0


def figure(axes: Axes, measurements: Sequence[Measurement[Run]], summary: Summary) -> None:
    """Draw the readings of every run, also those not fitted, and the law over its range.

    A cure that spans decades is drawn in logarithms, for its law ends where the curve takes off.
    """
    runs: list[tuple[str, Readings]] = []
    for measurement in measurements:
        if isinstance(measurement.result, FlowReadings):
            _flow_curve(axes, measurement.specimen.id, measurement.result)
            return
        if measurement.result is not None and measurement.result.time_s.size:
            runs.append((measurement.specimen.id, measurement.result))
    longest = max((float(r.time_s.max()) for _, r in runs), default=0.0)
    unit = "h" if longest >= _HOURS_FROM_S else "s"
    spans = [r.viscosity_Pas[r.viscosity_Pas > 0] for _, r in runs]
    wide = any(v.size and v.max() > _DECADES * v.min() for v in spans)
    scaled = np.log10 if wide else np.asarray
    for name, readings in runs:
        shown = readings.viscosity_Pas > 0
        axes.plot(
            from_si(1.0, unit) * readings.time_s[shown],
            scaled(readings.viscosity_Pas[shown]),
            linestyle="none",
            marker=".",
            markersize=3,
            label=name,
        )
    for law in summary.laws:
        if law.key == VISCOSITY:
            _law(axes, law, unit, scaled)
    axes.set_xlabel(f"time since mixing [{unit}]")
    axes.set_ylabel("log10 of viscosity [Pa.s]" if wide else "viscosity [Pa.s]")


def _law(axes: Axes, law: Law, unit: str, scaled: Callable[[FloatArray], FloatArray]) -> None:
    times = np.linspace(*law.valid, _POINTS)
    for rate in law.rates or (None,):
        values = np.array([law(float(t), rate).value for t in times])
        label = "law" if rate is None else f"law at {rate:.3g} 1/s"
        axes.plot(
            from_si(1.0, unit) * times, scaled(values), color="black", linewidth=1.2, label=label
        )
    low, high = law.valid
    axes.axvspan(from_si(low, unit), from_si(high, unit), alpha=0.15, color="0.5", linewidth=0)


def _flow_curve(axes: Axes, name: str, curve: FlowReadings) -> None:
    axes.plot(
        np.log10(curve.shear_rate_per_s),
        np.log10(curve.viscosity_Pas),
        linestyle="none",
        marker=".",
        label=name,
    )
    axes.set_xlabel("log10 of shear rate [1/s]")
    axes.set_ylabel("log10 of viscosity [Pa.s]")
