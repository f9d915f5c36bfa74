"""The figure of the rooms of stress-strain curves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.chart import Axis, Band, Chart, Curve, Curves, Line, Mark, Window
from deamat.core.present import said_of
from deamat.core.records import Measurement, Summary
from deamat.core.units import from_si
from deamat.techniques.shared.modulus import LoadingCurve, WindowLine, percent

_MPA_FROM = 1e6  # from this stress on, MPa reads better than kPa
_MEAN_FROM = 8  # specimens; fewer are told apart one by one
_MEAN_POINTS = 100


def curve_chart(
    measurements: Sequence[Measurement[LoadingCurve]], summary: Summary, window_larger: bool = False
) -> Chart:
    """Show nominal stress over nominal strain of each specimen, with window and fitted lines.

    Parameters
    ----------
    window_larger : the window is too narrow to be seen among the curves: it is shown again, larger
    """
    drawn = [(m.specimen.id, m.result) for m in measurements if m.result is not None]
    greatest = max((float(c.nominal_stress_Pa.max()) for _, c in drawn), default=0.0)
    unit = "MPa" if greatest >= _MPA_FROM else "kPa"
    scale = from_si(1.0, unit)
    curves = tuple(
        Curve(n, 100.0 * c.nominal_strain, scale * c.nominal_stress_Pa) for n, c in drawn
    )
    fitted = [c.line for _, c in drawn if c.line is not None]
    windows = sorted({line.window for line in fitted})
    marks: list[Mark] = [
        Window(100.0 * low, 100.0 * high, f"window, {percent((low, high))}")
        for low, high in windows
    ]
    marks.append(Curves(curves))
    if len(curves) >= _MEAN_FROM:
        marks += _mean(curves)
    if fitted:
        marks.append(_lines(fitted, unit))
    inset = (0.0, 200.0 * windows[-1][1]) if windows and window_larger else None
    return Chart(
        Axis("nominal strain [%]"), Axis(f"nominal stress [{unit}]"), tuple(marks),
        says=said_of(summary.records), inset=inset,
    )  # fmt: skip


def _lines(fitted: Sequence[WindowLine], unit: str) -> Line:
    """Join the lines of all specimens into one mark, with a gap between them."""
    strain: FloatArray = np.array([[*line.window, np.nan] for line in fitted]).ravel()
    slope, intercept = (
        np.repeat([getattr(line, name) for line in fitted], 3)
        for name in ("slope_Pa", "intercept_Pa")
    )
    label = "line fitted in the window"
    return Line(100.0 * strain, from_si(1.0, unit) * (intercept + slope * strain), label)


def _mean(curves: Sequence[Curve]) -> tuple[Band, Line]:
    """Average the stress of all specimens as far as the shortest of their curves reaches."""
    ends = [(float(curve.x.min()), float(curve.x.max())) for curve in curves]
    strain = np.linspace(max(low for low, _ in ends), min(high for _, high in ends), _MEAN_POINTS)
    stress = np.array([np.interp(strain, curve.x, curve.y) for curve in curves])
    mean, scatter = stress.mean(axis=0), stress.std(axis=0, ddof=1)
    band = Band(strain, mean - scatter, mean + scatter, "mean ± standard deviation")
    return band, Line(strain, mean, "mean", heavy=True)
