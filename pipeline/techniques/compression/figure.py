"""The figure of a material: loading curves with their window and fitted lines."""

from __future__ import annotations

from collections.abc import Sequence

from deamat.core.chart import Chart
from deamat.core.records import Measurement, Summary
from deamat.techniques.shared.curve_figure import curve_chart
from deamat.techniques.shared.modulus import LoadingCurve


def figure(measurements: Sequence[Measurement[LoadingCurve]], summary: Summary) -> Chart:
    """Show the loading curves, the window and its fitted lines."""
    return curve_chart(measurements, summary)
