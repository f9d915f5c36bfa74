"""The figure draws what it says on whatever axes it is handed."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.records import Summary
from deamat.techniques import compression, tension, viscosity
from deamat.techniques.compression.figure import figure as compression_figure
from deamat.techniques.tension.figure import figure as tension_figure
from deamat.techniques.viscosity.figure import figure as viscosity_figure
from tests.techniques.curves import CYLINDER, STRIP, reduce
from tests.techniques.drawn import blank, lines, spans
from tests.techniques.viscosity import runs

STRAIN = np.arange(0.0, 0.3, 5e-4)


def test_curve_window_and_fitted_line_with_units() -> None:
    columns = {"displacement_m": 0.03 * STRAIN, "force_N": np.pi * 0.025**2 * 1e5 * STRAIN}
    measured = reduce(compression.TECHNIQUE, CYLINDER, columns)
    axes = blank()
    compression_figure(axes, [measured], Summary(()))
    curve, fitted = lines(axes)
    assert curve[0][-1] == pytest.approx(100 * STRAIN[-1])
    assert curve[1][-1] == pytest.approx(0.1e3 * STRAIN[-1])
    assert fitted[0] == pytest.approx([0.0, 5.0])
    assert fitted[1] == pytest.approx([0.0, 5.0], abs=1e-9)
    assert spans(axes) == [(0.0, 5.0)]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("nominal strain [%]", "nominal stress [kPa]")


def test_stiff_curves_are_drawn_in_megapascal_and_refused_ones_without_a_line() -> None:
    strain = np.arange(0.05, 5.0, 0.02)
    columns = {"displacement_m": 0.033 * strain, "force_N": 18e-6 * 1e6 * strain}
    measured = reduce(tension.TECHNIQUE, STRIP, columns)
    axes = blank()
    tension_figure(axes, [measured], Summary(()))
    assert len(lines(axes)) == 1
    assert spans(axes) == []
    assert axes.get_ylabel() == "nominal stress [MPa]"


def test_viscosity_shows_every_reading_and_the_law_over_its_range() -> None:
    hours = np.arange(0.25, 13.01, 0.25)
    measured = runs.reduce(runs.newtonian(4.0 + 0.19 * hours, hours * runs.HOUR, seed=None))
    axes = blank()
    viscosity_figure(axes, [measured], viscosity.TECHNIQUE.summarise([measured], runs.CONTEXT))
    readings, law = lines(axes)
    assert readings[0] == pytest.approx(hours)
    assert (law[0][0], law[0][-1]) == (1.0, 12.0)
    assert law[1] == pytest.approx(4.0 + 0.19 * law[0])
    assert spans(axes) == [(1.0, 12.0)]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time since mixing [h]", "viscosity [Pa.s]")


def test_a_cure_over_decades_is_drawn_in_logarithms_with_its_law() -> None:
    hours = np.arange(0.25, 13.01, 0.25)
    cure = 0.5 * np.exp(hours / 2.0)
    curve = {"time_s": hours * runs.HOUR, "viscosity_Pas": cure}
    measured = runs.reduce(curve)
    axes = blank()
    viscosity_figure(axes, [measured], viscosity.TECHNIQUE.summarise([measured], runs.CONTEXT))
    readings, law = lines(axes)
    assert readings[1] == pytest.approx(np.log10(cure))
    assert law[1] == pytest.approx(np.log10(0.5 * np.exp(law[0] / 2.0)), abs=1e-3)
    assert axes.get_ylabel() == "log10 of viscosity [Pa.s]"
