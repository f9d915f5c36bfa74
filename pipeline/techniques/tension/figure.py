"""The figure of a material: curves up to the break with window and fitted lines."""

from __future__ import annotations

from collections.abc import Sequence

from deamat.core.chart import Chart
from deamat.core.records import Measurement, Summary
from deamat.techniques.shared.curve_figure import curve_chart
from deamat.techniques.shared.modulus import LoadingCurve


def figure(measurements: Sequence[Measurement[LoadingCurve]], summary: Summary) -> Chart:
    """Show the curves up to the break, the window, once more and larger, and its lines."""
    return curve_chart(measurements, summary, window_larger=True)
