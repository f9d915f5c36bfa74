"""What was drawn into axes."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from deamat.core.arrays import FloatArray

Line = tuple[FloatArray, FloatArray]


def blank() -> Axes:
    return Figure().add_subplot()


def lines(axes: Axes) -> list[Line]:
    return [(np.asarray(line.get_xdata()), np.asarray(line.get_ydata())) for line in axes.lines]


def by_label(axes: Axes) -> dict[str, Line]:
    names = (str(line.get_label()) for line in axes.lines)
    return dict(zip(names, lines(axes), strict=True))


def spans(axes: Axes) -> list[tuple[float, float]]:
    """Shaded ranges of x."""
    boxes = [patch for patch in axes.patches if isinstance(patch, Rectangle)]
    return [(box.get_x(), box.get_x() + box.get_width()) for box in boxes]
