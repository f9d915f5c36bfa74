"""The figure of a material: curves up to the break with window and fitted lines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from deamat.core.records import Measurement, Summary
from deamat.techniques.shared.curve_figure import draw_curves
from deamat.techniques.tension.config import MODULUS


def figure(axes: Any, measurements: Sequence[Measurement], _summary: Summary) -> None:
    """Draw the curves up to the break, the window and its fitted lines."""
    draw_curves(axes, measurements, MODULUS)
