"""A chart as an SVG file: complete, marked where it must be, harmless with any name."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deamat.core.chart import (
    Axis,
    Band,
    Chart,
    Curve,
    Curves,
    Line,
    Mark,
    Note,
    Points,
    Spacing,
    Window,
)  # fmt: skip
from deamat.report.chart.page import MARK, MARK_MEANING, WIDTH_px, picture
from deamat.report.chart.text import width_of

SVG = "{http://www.w3.org/2000/svg}"
STRAIN = np.linspace(0.0, 12.0, 40)
X, Y = Axis("nominal strain [%]"), Axis("nominal stress [kPa]")


def specimens(n: int, name: str = "specimen {}") -> Curves:
    curves = (Curve(name.format(i + 1), STRAIN, (1 + 0.01 * i) * STRAIN**2) for i in range(n))
    return Curves(tuple(curves))


def chart(*marks: Mark) -> Chart:
    return Chart(X, Y, marks, says=("compressive modulus 158.8 ± 1.1 kPa, n = 3",))


def drawn(
    shown: Chart, title: str = "gel: compression", synthetic: bool = False
) -> ElementTree.Element:
    return ElementTree.fromstring(picture(shown, title, synthetic))


def texts(root: ElementTree.Element) -> list[str]:
    return ["".join(one.itertext()) for one in root.iter(f"{SVG}text")]


def every_mark() -> Chart:
    some = np.array([2.0, 4.0])
    marks: tuple[Mark, ...] = (
        Window(0.0, 5.0, "window"), specimens(2), Band(STRAIN, 0.9 * STRAIN, 1.1 * STRAIN, "band"),
        Band(some, some - 1, some + 1, "sideways", sideways=True), Line(some, some, "law", True, True),
        Points(some, some, "value", low=some - 1, high=some + 1, names=("a", "b")),
        Points(some, some, "aside", "cross", some - 1, some + 1, sideways=True, series=1),
        *(Points(some, some, shape, shape) for shape in ("ring", "stroke", "triangle")),
        Note(4.0, 4.0, "a note"), Curves((Curve("loss", some, some),), right=True),
    )  # fmt: skip
    return Chart(X, Y, marks, right=Axis("loss [1]"), inset=(0.0, 2.0))


def test_the_same_chart_becomes_the_same_bytes() -> None:
    assert picture(every_mark(), "all", True) == picture(every_mark(), "all", True)


def test_title_values_axes_and_legend_are_text() -> None:
    found = texts(drawn(chart(Window(0.0, 5.0, "window, 0-5 %"), specimens(3))))
    assert found[:2] == ["gel: compression", "compressive modulus 158.8 ± 1.1 kPa, n = 3"]
    wanted = {X.label, Y.label, "window, 0-5 %", "specimen 1", "specimen 2", "specimen 3"}
    assert wanted <= set(found)


def test_every_kind_of_mark_is_drawn_and_named() -> None:
    root = drawn(every_mark())
    named = {"window", "band", "sideways", "law", "value", "aside", "ring", "a note", "loss [1]"}
    assert named <= set(texts(root))
    classes = {one.get("class") for one in root.iter()}
    assert {"window", "band", "law", "curve", "whisker", "open", "note", "frame"} <= classes
    titles = {"".join(one.itertext()) for one in root.iter(f"{SVG}title")}
    assert {"specimen 1", "a", "b", "loss"} <= titles


def test_many_specimens_are_one_entry_and_each_tells_its_name_where_one_points() -> None:
    root = drawn(chart(specimens(50)))
    assert "50 specimens" in texts(root)
    assert "specimen 17" not in texts(root)
    titles = ["".join(one.itertext()) for one in root.iter(f"{SVG}title")]
    assert {f"specimen {i + 1}" for i in range(50)} <= set(titles)


def test_a_gap_in_a_curve_is_a_gap_in_its_path() -> None:
    x = np.array([0.0, 1.0, np.nan, 3.0, 4.0])
    root = drawn(chart(Line(x, np.array([0.0, 1.0, 1.0, 0.0, 1.0]), "line")))
    (path,) = (one for one in root.iter(f"{SVG}path") if one.get("class") == "law"
               and "H" not in (one.get("d") or ""))  # fmt: skip
    assert (path.get("d") or "").count("M") == 2


@pytest.mark.parametrize("empty", [Curve("a", STRAIN[:0], STRAIN[:0]),
                                   Curve("a", STRAIN[:1], STRAIN[:1] * np.nan)])  # fmt: skip
def test_a_curve_without_samples_leaves_the_others_as_they_are(empty: Curve) -> None:
    both = Curves((empty, Curve("b", STRAIN, STRAIN)))
    paths = [one for one in drawn(chart(both)).iter(f"{SVG}path") if one.get("class") == "curve"]
    assert len(paths) == 3  # one curve and two entries of the legend


def test_synthetic_data_say_so_above_and_across_and_in_the_description() -> None:
    root = drawn(chart(specimens(2)), synthetic=True)
    assert texts(root).count(MARK_MEANING) == 1
    assert texts(root).count(MARK) == 1
    assert root.findtext(f"{SVG}desc") == MARK_MEANING
    tall = Chart(X, Y, (specimens(2),), height_px=2000.0)
    assert texts(drawn(tall, synthetic=True)).count(MARK) == 4


def test_measured_data_bear_no_mark() -> None:
    assert b"SYNTHETIC" not in picture(chart(specimens(2)), "gel", False)


def test_names_with_markup_and_odd_characters_are_written_as_they_are() -> None:
    odd = 'a$_$b & <script>alert(1)</script> "x"'
    root = drawn(chart(specimens(1, odd), Note(1.0, 1.0, odd)), odd)
    assert texts(root).count(odd) >= 2
    assert not list(root.iter(f"{SVG}script"))
    assert "\N{REPLACEMENT CHARACTER}" in "".join(texts(drawn(chart(), "bell \x07")))


def test_long_names_are_shortened_in_the_legend_and_no_text_leaves_the_page() -> None:
    long = "a-material-of-the-laboratory-with-an-unusually-long-name-60to1-plus-15-percent-" * 2
    root = drawn(chart(specimens(3, long + "{}")), long)
    for one in root.iter(f"{SVG}text"):
        if one.get("transform") is None and one.get("text-anchor") is None:
            text, size = "".join(one.itertext()), 14.0 if one.get("class") == "title" else 12.0
            width = width_of(text, size, bold=one.get("class") == "title")
            assert float(one.get("x") or 0.0) + width <= WIDTH_px + 1.0, text


def test_nothing_in_a_picture_is_loaded_from_elsewhere() -> None:
    text = picture(every_mark(), "all", True).decode()
    assert re.findall(r"https?://[^\"]*", text) == ["http://www.w3.org/2000/svg"]


SAMPLES = st.lists(
    st.floats(-1e60, 1e60) | st.just(float("nan")) | st.sampled_from([0.0, 1e-60, 1e9]), max_size=20
)


@given(SAMPLES, SAMPLES, st.sampled_from(["linear", "log"]), st.sampled_from(["linear", "log"]))
def test_any_numbers_make_a_picture(
    xs: list[float], ys: list[float], along: Spacing, upright: Spacing
) -> None:
    n = min(len(xs), len(ys))
    x, y = np.array(xs[:n]), np.array(ys[:n])
    marks: list[Mark] = [
        Curves((Curve("a", x, y),)), Curves((Curve("b", x, y),), points=True), Line(x, y),
        Points(x, y, low=y - 1.0, high=y + 1.0), Band(x, y, y + 1.0),
    ]  # fmt: skip
    shown = Chart(Axis("x", along), Axis("y", upright), tuple(marks))
    root = drawn(shown)
    for path in root.iter(f"{SVG}path"):
        assert "nan" not in (path.get("d") or "")
        assert "inf" not in (path.get("d") or "")
