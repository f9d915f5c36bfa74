"""The figure of a material: permittivity and loss of every film over frequency."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from deamat.core.records import Measurement, Summary
from deamat.techniques.permittivity.config import PERMITTIVITY
from deamat.techniques.permittivity.result import FilmSpectrum

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def figure(axes: Axes, measurements: Sequence[Measurement[FilmSpectrum]], summary: Summary) -> None:
    """Draw permittivity (left, lines) and loss (right, dotted) over log f, and the card's value.

    Parameters
    ----------
    measurements : those with a curve are drawn
    summary : its permittivities are drawn as black points with their 95 % intervals
    """
    right = axes.twinx()
    for name, film in ((m.specimen.id, m.result) for m in measurements if m.result is not None):
        (line,) = axes.plot(film.frequency_Hz, film.relative_permittivity, label=name)
        right.plot(
            film.frequency_Hz,
            film.loss_tangent,
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
