"""The moduli of a campaign as points with intervals, grouped by material."""

from __future__ import annotations

import pytest

from deamat.core.chart import Chart, Note, Points
from deamat.report.moduli import ModulusBar
from deamat.report.moduli_chart import moduli_chart
from tests.techniques.shown import marks


def bar(
    material: str, y_kPa: float, u_kPa: float, n: int = 3, series: str = "compressive modulus"
) -> ModulusBar:
    interval = (1e3 * (y_kPa - u_kPa), 1e3 * (y_kPa + u_kPa))
    return ModulusBar(material, series, n, 1e3 * y_kPa, interval)


def refused(material: str, series: str = "tensile modulus") -> ModulusBar:
    return ModulusBar(material, series, 0, None, None)


# Plain 0-5 % slopes of ecoflex-phantom-2026 with intervals from the published scatter.
PHANTOMS = [
    bar(name, y, u, n=10)
    for name, y, u in (("ef50-0t", 159.6, 2.2), ("ef30-25t", 49.2, 1.1), ("ef10-50t", 15.9, 0.3))
]
# Compressive moduli of Table 4 of Sikulskyi et al. 2022, a span of 1:40; the intervals are invented.
SYLGARDS = [bar(name, y, 0.1 * y) for name, y in (("a", 1150.0), ("b", 272.0), ("c", 26.5))]


def notes(chart: Chart) -> list[str]:
    return [mark.text for mark in chart.marks if isinstance(mark, Note)]


def test_values_are_written_with_their_n_to_the_second_figure_of_the_interval() -> None:
    chart = moduli_chart(PHANTOMS)
    assert notes(chart) == ["159.6 (n = 10)", "49.2 (n = 10)", "15.90 (n = 10)"]
    assert chart.x.label == "modulus [kPa]; whiskers: 95 % confidence interval"
    (points,) = marks(chart, Points)
    assert points.x.tolist() == pytest.approx([159.6, 49.2, 15.9])
    assert points.low is not None
    assert points.low.tolist() == pytest.approx([157.4, 48.1, 15.6])
    assert points.sideways


def test_a_refused_modulus_keeps_its_row() -> None:
    chart = moduli_chart([bar("a", 100.0, 1.0), refused("a")])
    assert notes(chart) == ["100.0 (n = 3)", "refused"]
    assert [mark.label for mark in marks(chart, Points)] == [
        "compressive modulus",
        "tensile modulus",
    ]
    both = moduli_chart([bar("a", 100.0, 1.0), bar("a", 90.0, 1.0, series="tensile modulus")])
    assert chart.height_px == both.height_px
    nothing = moduli_chart([refused("a"), refused("b")])
    assert notes(nothing) == ["refused", "refused"]
    assert nothing.x.ticks == ()


@pytest.mark.parametrize(("bars", "spacing"), [(PHANTOMS, "linear"), (SYLGARDS, "log")])
def test_the_axis_follows_the_span(bars: list[ModulusBar], spacing: str) -> None:
    axis = moduli_chart(bars).x
    assert axis.spacing == spacing
    assert axis.limits is not None
    low, high = axis.limits
    assert (low == 0.0) == (spacing == "linear")
    ends = [end / 1e3 for b in bars for end in b.ci95_Pa or ()]
    assert low < min(ends)
    assert max(ends) < high


def test_materials_stand_at_the_middle_of_their_rows() -> None:
    chart = moduli_chart([*PHANTOMS, bar("ef50-0t", 150.0, 2.0, series="tensile modulus")])
    assert chart.y.ticks is not None
    assert [text for _, text in chart.y.ticks] == ["ef50-0t", "ef30-25t", "ef10-50t"]
    assert [place for place, _ in chart.y.ticks] == pytest.approx([0.5, 2.7, 4.4])
    assert chart.y.downwards


@pytest.mark.parametrize(("lowest_kPa", "unit"), [(159.6, "kPa"), (999.0, "kPa"), (1200.0, "MPa")])
def test_the_unit_suits_the_softest_material(lowest_kPa: float, unit: str) -> None:
    chart = moduli_chart([bar("soft", lowest_kPa, 10.0), bar("stiff", 3000.0, 100.0)])
    assert chart.x.label == f"modulus [{unit}]; whiskers: 95 % confidence interval"
    assert ("3000 (n = 3)" if unit == "kPa" else "3.00 (n = 3)") in notes(chart)


def test_no_moduli_are_an_error() -> None:
    with pytest.raises(ValueError, match=r"^there is no modulus to show$"):
        moduli_chart([])
