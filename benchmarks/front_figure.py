"""Chart of one family: time against error, the front, the default, and why it is the default."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogFormatter, LogLocator, NullFormatter, ScalarFormatter
from matplotlib.transforms import ScaledTranslation

from benchmarks.families.family import Family, number
from benchmarks.timing import Row
from deamat.report.style import (
    COLOURS,
    PAGE_WIDTH_in,
    figure_style,
    plain,
    save_figure,
    set_title,
)

_KINDS = {
    "default": (COLOURS[1], "D", "default"),
    "batch": (COLOURS[3], "^", "default, batched"),
    "own rival": (COLOURS[0], "o", "rival of our own"),
    "outside": (COLOURS[2], "s", "other package"),
}
_SIZE = 11.0  # of a marker, in points
# Where a marker may go that lies on another one, in points: first nowhere, then ever farther.
_BESIDE = (
    (0.0, 0.0),
    *(
        (far * math.cos(turn), far * math.sin(turn))
        for far in (14.0, 20.0, 28.0, 36.0, 46.0, 56.0)
        for turn in (math.pi / 2, math.pi / 4, 0.75 * math.pi, 0.0, math.pi)
    ),
)
_LINE_in = 0.16
_CHARACTERS = 116


def draw_front(family: Family, rows: Sequence[Row], folder: Path) -> tuple[Path, Path]:
    """Draw a family's chart and write it as SVG and PNG.

    Parameters
    ----------
    family : title, axis and the text under the chart
    rows : as `with_front` gives them
    """
    name = f"chart_{family.key}"
    under = textwrap.wrap(family.why(rows).replace(" %", "\N{NO-BREAK SPACE}%"), _CHARACTERS)
    foot_in = _LINE_in * len(under) + 0.12
    with figure_style(name):
        height_in = 3.7 + foot_in
        figure = Figure(figsize=(PAGE_WIDTH_in, height_in))
        FigureCanvasAgg(figure)
        bottom, tall = (foot_in + 0.45) / height_in, 2.5 / height_in
        axes = figure.add_axes((0.1, bottom, 0.46, tall))
        side = figure.add_axes((0.6, bottom, 0.39, tall))
        _points(figure, axes, family, rows)
        _key(side, family, rows)
        set_title(figure, family.title)
        text = figure.text(0.008, 0.06 / figure.get_figheight(), "\n".join(under), va="bottom")
        plain(text).set(fontsize=7.5, linespacing=1.35)
        return save_figure(figure, axes, folder, name, family.title, synthetic=True)


def _points(figure: Figure, axes: Axes, family: Family, rows: Sequence[Row]) -> None:
    axes.set(xscale="log", yscale="log", xlabel="processor time of a fit [µs]", ylabel=family.axis)
    axes.yaxis.label.set_fontsize(8.0)
    chosen = [row for row in rows if row["front"] == "yes"]
    chosen.sort(key=lambda row: number(row, "us per fit"))
    times = [number(row, "us per fit") for row in chosen]
    errors = [number(row, family.error) for row in chosen]
    every = [number(row, "us per fit") for row in rows]
    worst = max(e for row in rows if (e := number(row, family.error)) == e)
    # nobody is faster than the first, and nobody better than the last
    x, y = [times[0], *times, 3.0 * max(every)], [3.0 * worst, *errors, errors[-1]]
    axes.step(x, y, where="post", color="#666666", linewidth=1.0, linestyle=(0, (4, 2)), zorder=1)
    low = min(e for row in rows if (e := number(row, family.error)) == e)
    margin = (worst / low) ** 0.08 * 1.15
    axes.set_ylim(low / margin, worst * margin)
    axes.set_xlim(min(every) / 1.8, 1.8 * max(every))
    _markers(figure, axes, family, rows)
    if worst < 1e3 * low:
        axes.yaxis.set_major_formatter(ScalarFormatter())
        axes.yaxis.set_minor_formatter(LogFormatter(minor_thresholds=(2, 0.7)))
    if max(every) < 1e2 * min(every):
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.xaxis.set_major_formatter(ScalarFormatter())
        axes.xaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(axis="both", which="minor", labelsize=7.0)
    handles = [
        Line2D([], [], color=c, marker=m, linestyle="", markersize=6, label=label)
        for kind, (c, m, label) in _KINDS.items()
        if any(row["kind"] == kind for row in rows)
    ]
    handles.append(Line2D([], [], color="#666666", linestyle=(0, (4, 2)), label="Pareto front"))
    axes.legend(
        handles=handles,
        loc="lower left",
        bbox_to_anchor=(-0.2, 1.1),
        ncols=5,
        columnspacing=1.0,
        handletextpad=0.3,
        borderpad=0.0,
    )


def _markers(figure: Figure, axes: Axes, family: Family, rows: Sequence[Row]) -> None:
    """Draw numbered markers; one that would lie on another is moved beside it, with a leader."""
    taken: list[tuple[float, float]] = []
    to_points = 72.0 / figure.dpi
    for i, row in enumerate(rows, 1):
        colour, marker, _ = _KINDS[str(row["kind"])]
        place = (number(row, "us per fit"), number(row, family.error))
        if not np.isfinite(place).all():
            continue
        x, y = axes.transData.transform(place) * to_points
        dx, dy = next(
            (dx, dy)
            for dx, dy in _BESIDE
            if all(math.hypot(x + dx - a, y + dy - b) > _SIZE for a, b in taken)
        )
        taken.append((x + dx, y + dy))
        on_front = row["front"] == "yes"
        moved: dict[str, Any] = {"xy": place, "xytext": (dx, dy), "textcoords": "offset points"}
        if dx or dy:
            leader: dict[str, Any] = {"arrowstyle": "-", "color": colour, "linewidth": 0.8}
            axes.annotate("", arrowprops=leader, zorder=2, **moved)
        shift = ScaledTranslation(dx / 72.0, dy / 72.0, figure.dpi_scale_trans)
        face = colour if on_front else "white"
        style: dict[str, Any] = {
            "color": colour,
            "markerfacecolor": face,
            "markersize": 10.5,
            "zorder": 3,
        }
        axes.plot(*place, marker, transform=axes.transData + shift, **style)
        ink = "white" if on_front else colour
        weight: dict[str, Any] = {"fontsize": 6.5, "fontweight": "bold", "color": ink, "zorder": 4}
        axes.annotate(str(i), ha="center", va="center_baseline", **moved, **weight)


def _key(axes: Axes, family: Family, rows: Sequence[Row]) -> None:
    """Name the numbered points, with their time and error."""
    axes.set_axis_off()
    height = 1.0 / (len(rows) + 1)
    for x, head in ((0.80, "time"), (1.0, "error")):
        axes.text(
            x, 1.0 - 0.4 * height, head, ha="right", va="center", fontsize=7.0, color="#555555"
        )
    for i, row in enumerate(rows, 1):
        y = 1.0 - (i + 0.4) * height
        colour, _, _ = _KINDS[str(row["kind"])]
        weight = "bold" if row["front"] == "yes" else "normal"
        wrapped = textwrap.fill(str(row["contender"]), 25)
        axes.text(0.03, y, str(i), ha="right", va="center", fontsize=7, color=colour, weight="bold")
        style: dict[str, Any] = {"fontsize": 6.6, "fontweight": weight, "va": "center"}
        plain(axes.text(0.06, y, wrapped, linespacing=0.95, **style))
        axes.text(0.80, y, _time(number(row, "us per fit")), ha="right", **style)
        axes.text(1.0, y, _error(number(row, family.error)), ha="right", **style)
    axes.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0))


def _error(value: float) -> str:
    return f"{value:.0f}" if value >= 10.0 else f"{value:.2g}"


def _time(us: float) -> str:
    return f"{us / 1e3:.2g} ms" if us >= 1e3 else f"{us:.2g} µs" if us < 100 else f"{us:.0f} µs"
