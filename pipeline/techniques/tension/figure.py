"""The figure of a material: curves up to the break with window and fitted lines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from deamat.core.records import Measurement, Summary
from deamat.techniques.shared.curve_figure import draw_curves
from deamat.techniques.shared.modulus import LoadingCurve

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def figure(axes: Axes, measurements: Sequence[Measurement[LoadingCurve]], _: Summary) -> None:
    """Draw the curves up to the break, the window and its fitted lines."""
    draw_curves(axes, measurements)
