"""The Weibull probability plot, drawn on axes that the report hands in."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.records import Measurement, Summary
from deamat.core.units import from_si
from deamat.estimators.weibull.fit import fit, quantile
from deamat.estimators.weibull.plot import confidence_band, plotting_positions, weibull_axis
from deamat.techniques.breakdown.result import FilmTest
from deamat.techniques.breakdown.sample import Sample, samples

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_PERCENT = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 80.0, 95.0, 99.0)
_FOOT = float(weibull_axis(0.01))
_TOP = float(weibull_axis(0.995))
_STEPS = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0)  # of the ticks in a decade


def figure(axes: Axes, measurements: Sequence[Measurement[FilmTest]], _: Summary) -> None:
    """Draw ln(-ln(1 - F)) over the field: specimens, fitted line, 95 % band of its quantiles.

    Specimens that did not break have no place of their own on the upright axis: they are marked at
    its foot, at the field that they bore.

    Parameters
    ----------
    measurements : of one material; each electrode area and rate of rise has its own line
    """
    ends: list[float] = []
    groups = list(samples(measurements))
    for group in groups:
        named = "" if len(groups) == 1 else f", {_conditions(group)}"
        ends += [float(x) for x in from_si(1.0, "V/um") * group.field_V_per_m]
        _censored(axes, group, named)
        try:
            _fitted(axes, group, named)
        except FitRefused:  # the summary says why
            continue
    axes.set_xscale("log")
    if ends and min(ends) > 0.0:
        low, high = 0.7 * min(ends), 1.25 * max(ends)
        ticks = _ticks(low, high)
        axes.set_xlim(low, high)
        axes.set_xticks(ticks, [f"{x:g}" for x in ticks])
        axes.set_xticks([], minor=True)
    axes.set_ylim(_FOOT - 0.25, _TOP)
    upright = [float(weibull_axis(p / 100.0)) for p in _PERCENT]
    axes.set_yticks(upright, [f"{p:g}" for p in _PERCENT])
    axes.set_xlabel("electric field [V/um]")
    axes.set_ylabel("broken [%], as ln(-ln(1 - F))")


def _fitted(axes: Axes, group: Sample, named: str) -> None:
    x, censored = from_si(1.0, "V/um") * group.field_V_per_m, group.censored
    best = fit(x, censored)
    points = plotting_positions(x, censored)
    upright = np.linspace(_FOOT, _TOP, 40)
    fractions = -np.expm1(-np.exp(upright))
    low, high = confidence_band(x, fractions, censored)
    line = [quantile(best.scale, best.shape, float(p)) for p in fractions]
    axes.fill_betweenx(
        upright, low, high, alpha=0.18, linewidth=0, color="0.4", label=f"95 % band{named}"
    )
    axes.plot(
        line, upright, color="black", linewidth=1.2,
        label=f"fit: {best.scale:.4g} V/um, shape {best.shape:.3g}{named}",
    )  # fmt: skip
    axes.plot(
        points.value, weibull_axis(points.fraction), "o", markersize=4.0,
        label=f"broken (n = {best.failures}){named}",
    )  # fmt: skip


def _censored(axes: Axes, group: Sample, named: str) -> None:
    unbroken: FloatArray = from_si(1.0, "V/um") * group.field_V_per_m[group.censored]
    if unbroken.size:
        axes.plot(
            unbroken, np.full(unbroken.size, _FOOT - 0.1), ">", markersize=5.0, fillstyle="none",
            label=f"not broken at this field (n = {unbroken.size}){named}",
        )  # fmt: skip


def _conditions(group: Sample) -> str:
    return ", ".join(f"{key} {value}" for key, value in group.conditions.items())


def _ticks(low: float, high: float) -> list[float]:
    """Round fields between two ends."""
    decades = range(int(np.floor(np.log10(low))), int(np.floor(np.log10(high))) + 1)
    return [s * 10.0**d for d in decades for s in _STEPS if low <= s * 10.0**d <= high]
