"""What a chart shows."""

from __future__ import annotations

from typing import TypeVar

from deamat.core.chart import Chart, Curve, Curves, Line, Points, Window

Kind = TypeVar("Kind", Curves, Line, Points, Window)


def marks(chart: Chart, kind: type[Kind]) -> list[Kind]:
    """Return the marks of one kind, in the order in which they are drawn."""
    return [mark for mark in chart.marks if isinstance(mark, kind)]


def curves(chart: Chart) -> list[Curve]:
    """Return the curves of all specimens on the left axis."""
    return [curve for mark in marks(chart, Curves) if not mark.right for curve in mark.curves]


def windows(chart: Chart) -> list[tuple[float, float]]:
    """Return the shaded ranges of x."""
    return [(mark.low, mark.high) for mark in marks(chart, Window)]
