"""The curves of a file as pictures."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from deamat.core.slug import file_stem
from deamat.run.check.found import Checked, Curve

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw(checked: Checked, folder: Path) -> Iterator[Path]:
    """Draw each curve of a file into a folder; give the pictures' paths."""
    from deamat.report.figures import axes_figure

    curves = {reading.curve: reading.technique for reading in checked.readings if reading.curve}
    folder.mkdir(parents=True, exist_ok=True)
    for curve, technique in curves.items():
        name = file_stem(Path(checked.path).name, technique)
        title = f"{Path(checked.path).name}: {technique}"
        _, png = axes_figure(folder, name, title, partial(_draw, curve), synthetic=False)
        yield png


def _draw(curve: Curve, axes: Axes) -> None:
    axes.plot(curve.x, curve.y, linewidth=0.8)
    axes.set_xlabel(curve.x_axis.label)
    axes.set_ylabel(curve.y_axis.label)
    if curve.x_axis.log:
        axes.set_xscale("log")
    if curve.y_axis.log:
        axes.set_yscale("log")
