"""The figures of curves and of viscosity show what they say."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.chart import Band, Curves, Line
from deamat.core.records import Summary
from deamat.techniques import compression, tension, viscosity
from deamat.techniques.compression.figure import figure as compression_figure
from deamat.techniques.tension.figure import figure as tension_figure
from deamat.techniques.viscosity.figure import figure as viscosity_figure
from tests.techniques.curves import CYLINDER, STRIP, reduce
from tests.techniques.shown import curves, marks, windows
from tests.techniques.viscosity import runs

STRAIN = np.arange(0.0, 0.3, 5e-4)


def test_curve_window_and_fitted_line_with_units() -> None:
    columns = {"displacement_m": 0.03 * STRAIN, "force_N": np.pi * 0.025**2 * 1e5 * STRAIN}
    measured = reduce(compression.TECHNIQUE, CYLINDER, columns)
    chart = compression_figure([measured], Summary(()))
    (curve,) = curves(chart)
    (fitted,) = marks(chart, Line)
    assert curve.x[-1] == pytest.approx(100 * STRAIN[-1])
    assert curve.y[-1] == pytest.approx(0.1e3 * STRAIN[-1])
    assert fitted.x[:2] == pytest.approx([0.0, 5.0])
    assert fitted.y[:2] == pytest.approx([0.0, 5.0], abs=1e-9)
    assert fitted.label == "line fitted in the window"
    assert windows(chart) == [(0.0, 5.0)]
    assert (chart.x.label, chart.y.label) == ("nominal strain [%]", "nominal stress [kPa]")


def test_many_specimens_have_their_mean_and_its_band_as_far_as_all_of_them_reach() -> None:
    measured = []
    for i in range(8):
        strain = STRAIN[: STRAIN.size - 10 * i]
        force = np.pi * 0.025**2 * (1e5 + 1e3 * i) * strain
        columns = {"displacement_m": 0.03 * strain, "force_N": force}
        measured.append(reduce(compression.TECHNIQUE, CYLINDER, columns))
    chart = compression_figure(measured, Summary(()))
    mean = next(mark for mark in marks(chart, Line) if mark.label == "mean")
    (band,) = (mark for mark in chart.marks if isinstance(mark, Band))
    assert mean.x[-1] == pytest.approx(100 * (STRAIN[-1] - 70 * 5e-4))
    assert mean.y[-1] == pytest.approx(1e-5 * (1e5 + 3.5e3) * mean.x[-1])
    scatter = np.std(1e3 * np.arange(8), ddof=1)
    assert band.high[-1] - mean.y[-1] == pytest.approx(1e-5 * scatter * mean.x[-1])
    few = compression_figure(measured[:7], Summary(()))
    assert [mark.label for mark in marks(few, Line)] == ["line fitted in the window"]


def test_the_narrow_window_of_tension_is_shown_again_larger() -> None:
    strain = np.arange(0.0, 2.0, 1e-4)
    columns = {"displacement_m": 0.033 * strain, "force_N": 18e-6 * 1e6 * strain}
    chart = tension_figure([reduce(tension.TECHNIQUE, STRIP, columns)], Summary(()))
    assert windows(chart) == [(0.0, 1.0)]
    assert chart.inset == (0.0, 2.0)


def test_stiff_curves_are_shown_in_megapascal_and_refused_ones_without_a_line() -> None:
    strain = np.arange(0.05, 5.0, 0.02)
    columns = {"displacement_m": 0.033 * strain, "force_N": 18e-6 * 1e6 * strain}
    chart = tension_figure([reduce(tension.TECHNIQUE, STRIP, columns)], Summary(()))
    assert len(curves(chart)) == 1
    assert marks(chart, Line) == []
    assert windows(chart) == []
    assert chart.y.label == "nominal stress [MPa]"


def test_viscosity_shows_every_reading_and_the_law_over_its_range_with_its_interval() -> None:
    hours = np.arange(0.25, 13.01, 0.25)
    measured = runs.reduce(runs.newtonian(4.0 + 0.19 * hours, hours * runs.HOUR, seed=None))
    summary = viscosity.TECHNIQUE.summarise([measured], runs.CONTEXT)
    chart = viscosity_figure([measured], summary)
    (readings,) = marks(chart, Curves)
    (law,) = marks(chart, Line)
    (band,) = (mark for mark in chart.marks if isinstance(mark, Band))
    assert readings.points
    assert readings.curves[0].x == pytest.approx(hours)
    assert (law.x[0], law.x[-1]) == (1.0, 12.0)
    assert law.y == pytest.approx(4.0 + 0.19 * law.x)
    assert bool(np.all((band.low < law.y) & (law.y < band.high)))
    assert windows(chart) == [(1.0, 12.0)]
    assert (chart.x.label, chart.y.label) == ("time since mixing [h]", "viscosity [Pa·s]")
    assert chart.y.spacing == "linear"


def test_a_cure_over_decades_is_shown_on_a_logarithmic_axis_with_its_law() -> None:
    hours = np.arange(0.25, 13.01, 0.25)
    cure = 0.5 * np.exp(hours / 2.0)
    measured = runs.reduce({"time_s": hours * runs.HOUR, "viscosity_Pas": cure})
    chart = viscosity_figure([measured], viscosity.TECHNIQUE.summarise([measured], runs.CONTEXT))
    (readings,) = curves(chart)
    (law,) = marks(chart, Line)
    assert readings.y == pytest.approx(cure)
    assert np.log10(law.y) == pytest.approx(np.log10(0.5 * np.exp(law.x / 2.0)), abs=1e-3)
    assert chart.y.spacing == "log"
