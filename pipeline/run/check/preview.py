"""A curve as characters."""

from __future__ import annotations

import math
from collections.abc import Sequence

from deamat.run.check.found import Axis, Curve

_WIDTH, _HEIGHT = 60, 12


def preview(curve: Curve, width: int = _WIDTH, height: int = _HEIGHT) -> list[str]:
    """Draw a curve as lines of text with the ends of its axes; empty for fewer than two points."""
    points = [
        (x, y) for x, y in zip(curve.x, curve.y, strict=True) if math.isfinite(x + y)
    ]  # fmt: skip
    if len(points) < 2:
        return []
    across = _places([x for x, _ in points], curve.x_axis, width)
    up = _places([y for _, y in points], curve.y_axis, height)
    canvas = [[" "] * width for _ in range(height)]
    for column, row in zip(across, up, strict=True):
        canvas[height - 1 - row][column] = "*"
    xs, ys = [x for x, _ in points], [y for _, y in points]
    top, bottom = _number(max(ys)), _number(min(ys))
    margin = max(len(top), len(bottom))
    left = [top, *[""] * (height - 2), bottom]
    low, high = _number(min(xs)), _number(max(xs))
    lines = [f"{'':>{margin}}  {curve.y_axis.label}{_by_log(curve.y_axis)}"]
    lines += [
        f"{mark:>{margin}} |{''.join(cells).rstrip()}"
        for mark, cells in zip(left, canvas, strict=True)
    ]
    name = f"{curve.x_axis.label}{_by_log(curve.x_axis)}"
    lines.append(f"{'':>{margin}} +{'-' * width}")
    between = width - len(low) - len(high)
    lines.append(f"{'':>{margin}}  {low}{name:^{max(between, len(name) + 2)}}{high}")
    return lines


def _places(values: Sequence[float], axis: Axis, cells: int) -> list[int]:
    scaled = [math.log10(value) if axis.log else value for value in values]
    low, high = min(scaled), max(scaled)
    if not high > low:
        return [cells // 2] * len(scaled)
    return [min(int((value - low) / (high - low) * cells), cells - 1) for value in scaled]


def _number(value: float) -> str:
    return f"{value:.4g}"


def _by_log(axis: Axis) -> str:
    return ", log" if axis.log else ""
