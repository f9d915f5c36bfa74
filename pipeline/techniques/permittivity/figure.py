"""The figure of a material: permittivity and loss of every film over frequency."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from deamat.core.records import Measurement, Summary
from deamat.techniques.permittivity.config import PERMITTIVITY


def figure(axes: Any, measurements: Sequence[Measurement], summary: Summary) -> None:
    """Draw permittivity (left, lines) and loss (right, dotted) over log f, and the card's value.

    Parameters
    ----------
    axes : matplotlib axes
    measurements : those with a curve are drawn
    summary : its permittivities are drawn as black points with their 95 % intervals
    """
    right = axes.twinx()
    for measurement in (m for m in measurements if m.curve):
        f = measurement.curve["frequency_Hz"]
        (line,) = axes.plot(
            f, measurement.curve["relative_permittivity"], label=measurement.specimen.id
        )
        right.plot(
            f,
            measurement.curve["loss_tangent"],
            color=line.get_color(),
            linestyle=":",
            linewidth=0.8,
        )
    for record in summary.records:
        if record.key == PERMITTIVITY:
            value = record.quantity.value
            axes.errorbar(
                [record.conditions["frequency_Hz"]],
                [value],
                yerr=[[value - record.ci95[0]], [record.ci95[1] - value]],
                fmt="o",
                color="black",
                capsize=3,
                label=f"mean of {record.n} at {record.conditions['frequency_Hz']:g} Hz",
            )
    axes.set_xscale("log")
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel("relative permittivity [1]")
    right.set_ylabel("loss tangent [1] (dotted)")
    right.spines["right"].set_visible(True)
    right.grid(visible=False)
