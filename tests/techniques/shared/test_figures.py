"""The figure draws what it says on whatever axes it is handed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from deamat.core.records import Summary
from deamat.techniques import compression, tension, viscosity
from deamat.techniques.compression.figure import figure as compression_figure
from deamat.techniques.tension.figure import figure as tension_figure
from deamat.techniques.viscosity.figure import figure as viscosity_figure
from tests.techniques.curves import CYLINDER, STRIP, reduce
from tests.techniques.viscosity import runs

STRAIN = np.arange(0.0, 0.3, 5e-4)


class Axes:
    """Remembers what was drawn."""

    def __init__(self) -> None:
        self.lines: list[tuple[Any, Any]] = []
        self.spans: list[tuple[float, float]] = []
        self.labels: dict[str, str] = {}

    def plot(self, x: Any, y: Any, **style: object) -> None:
        self.lines.append((x, y))

    def axvspan(self, low: float, high: float, **style: object) -> None:
        self.spans.append((low, high))

    def set_xlabel(self, text: str) -> None:
        self.labels["x"] = text

    def set_ylabel(self, text: str) -> None:
        self.labels["y"] = text


def test_curve_window_and_fitted_line_with_units() -> None:
    columns = {"displacement_m": 0.03 * STRAIN, "force_N": np.pi * 0.025**2 * 1e5 * STRAIN}
    measured = reduce(compression.TECHNIQUE, CYLINDER, columns)
    axes = Axes()
    compression_figure(axes, [measured], Summary(()))
    curve, fitted = axes.lines
    assert curve[0][-1] == pytest.approx(100 * STRAIN[-1])
    assert curve[1][-1] == pytest.approx(0.1e3 * STRAIN[-1])
    assert fitted[0] == pytest.approx([0.0, 5.0])
    assert fitted[1] == pytest.approx([0.0, 5.0], abs=1e-9)
    assert axes.spans == [(0.0, 5.0)]
    assert axes.labels == {"x": "nominal strain [%]", "y": "nominal stress [kPa]"}


def test_stiff_curves_are_drawn_in_megapascal_and_refused_ones_without_a_line() -> None:
    strain = np.arange(0.05, 5.0, 0.02)
    columns = {"displacement_m": 0.033 * strain, "force_N": 18e-6 * 1e6 * strain}
    measured = reduce(tension.TECHNIQUE, STRIP, columns)
    axes = Axes()
    tension_figure(axes, [measured], Summary(()))
    assert len(axes.lines) == 1
    assert axes.spans == []
    assert axes.labels["y"] == "nominal stress [MPa]"


def test_viscosity_shows_every_reading_and_the_law_over_its_range() -> None:
    hours = np.arange(0.25, 13.01, 0.25)
    measured = runs.reduce(runs.newtonian(4.0 + 0.19 * hours, hours * runs.HOUR, seed=None))
    axes = Axes()
    viscosity_figure(axes, [measured], viscosity.TECHNIQUE.summarise([measured], runs.CONTEXT))
    readings, law = axes.lines
    assert readings[0] == pytest.approx(hours)
    assert (law[0][0], law[0][-1]) == (1.0, 12.0)
    assert law[1] == pytest.approx(4.0 + 0.19 * law[0])
    assert axes.spans == [(1.0, 12.0)]
    assert axes.labels == {"x": "time since mixing [h]", "y": "viscosity [Pa.s]"}


def test_a_cure_over_decades_is_drawn_in_logarithms_with_its_law() -> None:
    hours = np.arange(0.25, 13.01, 0.25)
    cure = 0.5 * np.exp(hours / 2.0)
    curve = {"time_s": hours * runs.HOUR, "viscosity_Pas": cure}
    measured = runs.reduce(curve)
    axes = Axes()
    viscosity_figure(axes, [measured], viscosity.TECHNIQUE.summarise([measured], runs.CONTEXT))
    readings, law = axes.lines
    assert readings[1] == pytest.approx(np.log10(cure))
    assert law[1] == pytest.approx(np.log10(0.5 * np.exp(law[0] / 2.0)), abs=1e-3)
    assert axes.labels["y"] == "log10 of viscosity [Pa.s]"
