"""The figure of the room: readings and laws over time, or a flow curve."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from deamat.core.chart import Axis, Band, Chart, Curve, Curves, Line, Mark, Window
from deamat.core.present import said_of
from deamat.core.records import Law, Measurement, Summary
from deamat.core.units import from_si
from deamat.estimators.mean import coverage_factor
from deamat.techniques.viscosity.config import VISCOSITY
from deamat.techniques.viscosity.flow_fit import FlowReadings
from deamat.techniques.viscosity.readings import Readings
from deamat.techniques.viscosity.result import Run

_POINTS = 100
_HOURS_FROM_S = 7200.0
_DECADES = 100.0
_LABEL = "viscosity [Pa·s]"


def figure(measurements: Sequence[Measurement[Run]], summary: Summary) -> Chart:
    """Show the readings of every run, also those not fitted, and the law over its range.

    A cure that spans decades is shown on a logarithmic axis, for its law ends where the curve takes
    off.
    """
    says = said_of(summary.records)
    flow = [(m.specimen.id, m.result) for m in measurements if isinstance(m.result, FlowReadings)]
    if flow:
        curves = tuple(Curve(n, f.shear_rate_per_s, f.viscosity_Pas) for n, f in flow)
        return Chart(
            Axis("shear rate [1/s]", "log"), Axis(_LABEL, "log"),
            (Curves(curves, "flow curve", points=True),), says=says,
        )  # fmt: skip
    runs = [
        (m.specimen.id, m.result)
        for m in measurements
        if isinstance(m.result, Readings) and m.result.time_s.size
    ]
    longest = max((float(r.time_s.max()) for _, r in runs), default=0.0)
    unit = "h" if longest >= _HOURS_FROM_S else "s"
    spans = [r.viscosity_Pas[r.viscosity_Pas > 0] for _, r in runs]
    wide = any(v.size and v.max() > _DECADES * v.min() for v in spans)
    marks: list[Mark] = []
    for law in (law for law in summary.laws if law.key == VISCOSITY):
        marks += _law(law, unit)
    readings = Curves(tuple(_shown(name, r, unit) for name, r in runs), "run", points=True)
    return Chart(
        Axis(f"time since mixing [{unit}]"), Axis(_LABEL, "log" if wide else "linear"),
        (*marks, readings), says=says,
    )  # fmt: skip


def _shown(name: str, readings: Readings, unit: str) -> Curve:
    good = readings.viscosity_Pas > 0
    return Curve(name, from_si(1.0, unit) * readings.time_s[good], readings.viscosity_Pas[good])


def _law(law: Law, unit: str) -> Iterator[Mark]:
    low, high = law.valid
    yield Window(from_si(low, unit), from_si(high, unit), "range of the law")
    times = np.linspace(low, high, _POINTS)
    shown = from_si(1.0, unit) * times
    dof = np.inf if law.degrees_of_freedom is None else law.degrees_of_freedom
    k = coverage_factor(float(dof))
    for rate in law.rates or (None,):
        said = "" if rate is None else f" at {rate:.3g} 1/s"
        answers = [law(float(t), rate) for t in times]
        value = np.array([answer.value for answer in answers])
        half = k * np.array([answer.standard_uncertainty for answer in answers])
        yield Band(shown, value - half, value + half, f"95 % interval of the law{said}")
        yield Line(shown, value, f"law{said}")
