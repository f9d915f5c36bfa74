"""A stability map: one row for each way to fail and sample size, one column for each setting."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from benchmarks.stability.cells import Cell, Estimator
from deamat.report.style import PAGE_WIDTH_in, figure_style, plain, save_figure, set_title

_FACES = {
    "within": "#CFE8DC",
    "flagged": "#F6D998",
    "refused": "#D3D3D3",
    "SILENTLY WRONG": "#A01020",
}
_MEANING = {
    "within": "within: misses at most {limit:.0f} %",
    "flagged": "flagged",
    "refused": "refused",
    "SILENTLY WRONG": "silently wrong: misses more, unflagged",
}
_ROW_in = 0.185
_COLUMNS = 5
_LABELS = 2.1  # columns' widths


def draw_map(
    estimator: Estimator, question: str, cells: Sequence[Cell], folder: Path
) -> tuple[Path, Path]:
    """Draw the map of one question and write it as SVG and PNG."""
    mine = [c for c in cells if (c.estimator, c.question) == (estimator.key, question)]
    title = f"{estimator.key[0].upper()}{estimator.key[1:]}: {question}"
    name = "map_" + re.sub(r"[^a-z0-9]+", "_", f"{estimator.key} {question}".lower())
    lines = _lines(mine)
    limit = 100.0 * max(c.limit for c in mine)  # of few samples chance may miss more
    with figure_style(name):
        height_in = _ROW_in * len(lines) + 0.9
        figure = Figure(figsize=(PAGE_WIDTH_in, height_in))
        FigureCanvasAgg(figure)
        axes = figure.add_axes((0.01, 0.32 / height_in, 0.98, _ROW_in * len(lines) / height_in))
        axes.set(xlim=(-_LABELS, _COLUMNS), ylim=(len(lines), 0))
        axes.set_axis_off()
        _draw_lines(axes, lines)
        handles = [
            Patch(facecolor=f, edgecolor="white", label=_MEANING[v].format(limit=limit))
            for v, f in _FACES.items()
        ]
        figure.legend(
            handles=handles, loc="lower left", ncols=4, columnspacing=1.2, handlelength=1.2
        )
        set_title(figure, f"{title} (number: % of samples silently missed)")
        return save_figure(figure, axes, folder, name, title, synthetic=True)


def _lines(cells: Sequence[Cell]) -> list[tuple[str, str, list[tuple[str, Cell]]]]:
    """Lay cells out as rows: failure (where it starts), sample size, and its labelled cells."""
    lines: list[tuple[str, str, list[tuple[str, Cell]]]] = []
    for failure in dict.fromkeys(c.failure for c in cells):
        block = [c for c in cells if c.failure == failure]
        if len({c.setting for c in block}) == 1:
            lines.append((failure, "", [(f"{c.n}", c) for c in block]))
            continue
        for i, n in enumerate(dict.fromkeys(c.n for c in block)):
            row = [(c.setting, c) for c in block if c.n == n]
            lines.append((failure if i == 0 else "", f"n = {n}", row))
    return lines


def _draw_lines(axes: Axes, lines: Sequence[tuple[str, str, list[tuple[str, Cell]]]]) -> None:
    for y, (failure, size, row) in enumerate(lines):
        if failure and y:
            axes.plot([-_LABELS, _COLUMNS], [y, y], color="#888888", linewidth=0.5, linestyle="-")
        plain(axes.text(-_LABELS, y + 0.5, failure, fontsize=7, fontweight="bold", va="center"))
        axes.text(-0.06, y + 0.5, size, fontsize=6.5, va="center", ha="right", color="#444444")
        width = _COLUMNS / len(row)
        for x, (label, cell) in enumerate(row):
            verdict = cell.verdict
            box = Rectangle((x * width, y + 0.05), width - 0.02, 0.9, facecolor=_FACES[verdict])
            axes.add_patch(box)
            ink = "white" if verdict == "SILENTLY WRONG" else "black"
            style: dict[str, Any] = {"fontsize": 6.3, "va": "center", "color": ink}
            plain(axes.text(x * width + 0.05, y + 0.52, label, **style))
            share = f"{100 * cell.silent:.0f}"
            axes.text((x + 1) * width - 0.07, y + 0.52, share, ha="right", **style)
