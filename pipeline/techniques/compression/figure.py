"""The figure of a material: loading curves with their window and fitted lines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from deamat.core.records import Measurement, Summary
from deamat.techniques.compression.config import MODULUS
from deamat.techniques.shared.curve_figure import draw_curves


def figure(axes: Any, measurements: Sequence[Measurement], _summary: Summary) -> None:
    """Draw the loading curves, the window and its fitted lines."""
    draw_curves(axes, measurements, MODULUS)
