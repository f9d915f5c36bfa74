"""The figure of a material: its Weibull probability plot."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.chart import Axis, Band, Chart, Line, Mark, Points
from deamat.core.errors import FitRefused
from deamat.core.present import said_of
from deamat.core.records import Measurement, Summary
from deamat.core.units import from_si
from deamat.estimators.weibull.fit import fit, quantile
from deamat.estimators.weibull.plot import confidence_band, plotting_positions, weibull_axis
from deamat.techniques.breakdown.result import FilmTest
from deamat.techniques.breakdown.sample import Sample, samples

_PERCENT = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 80.0, 95.0, 99.0)
_FOOT = float(weibull_axis(0.01))
_TOP = float(weibull_axis(0.995))
_STEPS = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0)  # of the ticks in a decade


def figure(measurements: Sequence[Measurement[FilmTest]], summary: Summary) -> Chart:
    """Show ln(-ln(1 - F)) over the field: specimens, fitted line, 95 % band of its quantiles.

    Specimens that did not break have no place of their own on the upright axis: they are marked at
    its foot, at the field that they bore.

    Parameters
    ----------
    measurements : of one material; each electrode area and rate of rise has its own line
    """
    groups = list(samples(measurements))
    marks: list[Mark] = []
    for number, group in enumerate(groups):
        named = "" if len(groups) == 1 else f", {_conditions(group)}"
        marks += _censored(group, named, number)
        try:
            marks += _fitted(group, named, number)
        except FitRefused:  # the summary says why
            continue
    ends = [float(x) for group in groups for x in from_si(1.0, "V/um") * group.field_V_per_m]
    upright = tuple((float(weibull_axis(p / 100.0)), f"{p:g}") for p in _PERCENT)
    return Chart(
        _field(ends),
        Axis("broken [%], as ln(-ln(1 - F))", limits=(_FOOT - 0.25, _TOP), ticks=upright),
        tuple(marks), says=said_of(summary.records),
    )  # fmt: skip


def _field(ends: Sequence[float]) -> Axis:
    label = "electric field [V/µm]"
    if not ends or min(ends) <= 0.0:
        return Axis(label, "log")
    low, high = 0.7 * min(ends), 1.25 * max(ends)
    ticks = tuple((x, f"{x:g}") for x in _ticks(low, high))
    return Axis(label, "log", limits=(low, high), ticks=ticks)


def _fitted(group: Sample, named: str, number: int) -> Iterator[Mark]:
    x, censored = from_si(1.0, "V/um") * group.field_V_per_m, group.censored
    best = fit(x, censored)
    points = plotting_positions(x, censored)
    upright = np.linspace(_FOOT, _TOP, 40)
    fractions = -np.expm1(-np.exp(upright))
    low, high = confidence_band(x, fractions, censored)
    line = np.array([quantile(best.scale, best.shape, float(p)) for p in fractions])
    yield Band(upright, low, high, f"95 % band{named}", sideways=True)
    yield Line(line, upright, f"fit: {best.scale:.4g} V/µm, shape {best.shape:.3g}{named}")
    yield Points(
        points.value, weibull_axis(points.fraction), f"broken (n = {best.failures}){named}",
        series=number,
    )  # fmt: skip


def _censored(group: Sample, named: str, number: int) -> Iterator[Points]:
    unbroken: FloatArray = from_si(1.0, "V/um") * group.field_V_per_m[group.censored]
    if unbroken.size:
        yield Points(
            unbroken, np.full(unbroken.size, _FOOT - 0.1),
            f"not broken at this field (n = {unbroken.size}){named}", "triangle", series=number,
        )  # fmt: skip


def _conditions(group: Sample) -> str:
    return ", ".join(f"{key} {value}" for key, value in group.conditions.items())


def _ticks(low: float, high: float) -> list[float]:
    """Round fields between two ends."""
    decades = range(int(np.floor(np.log10(low))), int(np.floor(np.log10(high))) + 1)
    return [s * 10.0**d for d in decades for s in _STEPS if low <= s * 10.0**d <= high]
