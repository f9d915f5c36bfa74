"""The figure of a material: permittivity and loss of every film over frequency."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deamat.core.chart import Axis, Chart, Curve, Curves, Mark, Points
from deamat.core.present import said_of
from deamat.core.records import Measurement, PropertyRecord, Summary
from deamat.techniques.permittivity.config import LOSS, PERMITTIVITY
from deamat.techniques.permittivity.result import FilmSpectrum


def figure(measurements: Sequence[Measurement[FilmSpectrum]], summary: Summary) -> Chart:
    """Show permittivity (left, lines) and loss (right, dotted) over log f, and the card's values.

    Parameters
    ----------
    measurements : those with a curve are shown
    summary : its values are black points with their 95 % intervals, those of the loss are rings
    """
    films = [(m.specimen.id, m.result) for m in measurements if m.result is not None]
    marks: list[Mark] = [
        Curves(tuple(Curve(n, f.frequency_Hz, f.relative_permittivity) for n, f in films), "film"),
        Curves(tuple(Curve(n, f.frequency_Hz, f.loss_tangent) for n, f in films), right=True),
    ]
    marks += [_value(r) for r in summary.records if r.key in (PERMITTIVITY, LOSS)]
    return Chart(
        Axis("frequency [Hz]", "log"), Axis("relative permittivity [1]"), tuple(marks),
        says=said_of(summary.records), right=Axis("loss tangent [1] (dotted)"),
    )  # fmt: skip


def _value(record: PropertyRecord) -> Points:
    frequency = float(str(record.conditions["frequency_Hz"]))
    of_loss = record.key == LOSS
    return Points(
        np.array([frequency]), np.array([record.quantity.value]),
        f"{'loss' if of_loss else 'permittivity'}, mean of {record.n} at {frequency:g} Hz",
        shape="ring" if of_loss else "dot",
        low=np.array([record.ci95[0]]), high=np.array([record.ci95[1]]), right=of_loss,
        series=3 if of_loss else None,
    )  # fmt: skip
