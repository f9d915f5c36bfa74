"""Figures: the same bytes every time, marked where they must be, legible with any names."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from xml.etree import ElementTree

import matplotlib
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.font_manager import FontProperties, findfont
from matplotlib.patches import Rectangle
from matplotlib.text import Text
from PIL import Image

from deamat.core.errors import ConfigError
from deamat.report.bars import draw_moduli, height_for
from deamat.report.figures import moduli_figure, technique_figure, technique_title
from deamat.report.moduli import ModulusBar
from deamat.report.style import COLOURS, figure_style, new_figure, place_legend, set_title

LONG = "a-material-of-the-laboratory-with-an-unusually-long-name-60to1-plus-15-percent-thinner"


def curves(n: int, label: str = "specimen {}") -> Callable[[Axes], None]:
    def draw(axes: Axes) -> None:
        strain = np.linspace(0.0, 12.0, 40)
        for i in range(n):
            axes.plot(strain, (1.0 + 0.01 * i) * strain, label=label.format(i + 1))
        axes.axvspan(0.0, 5.0, color="#eeeeee", zorder=0)
        axes.set_xlabel("nominal strain [%]")
        axes.set_ylabel("nominal stress [kPa]")

    return draw


def phantoms() -> list[ModulusBar]:
    # Plain 0-5 % slopes of ecoflex-phantom-2026 with intervals from the published scatter.
    known = (("ef50-0t", 159.6, 2.2), ("ef30-25t", 49.2, 1.1), ("ef10-50t", 15.9, 0.3))
    return [bar(name, y, u, n=10) for name, y, u in known]


def bar(
    material: str, y_kPa: float, u_kPa: float, n: int = 3, series: str = "compressive modulus"
) -> ModulusBar:
    interval = (1e3 * (y_kPa - u_kPa), 1e3 * (y_kPa + u_kPa))
    return ModulusBar(material, series, n, 1e3 * y_kPa, interval)


def refused(material: str, series: str = "tensile modulus") -> ModulusBar:
    return ModulusBar(material, series, 0, None, None)


def sylgards() -> list[ModulusBar]:
    # Table 4 of Sikulskyi et al. 2022, a span of 1:60; the intervals are invented.
    table = {
        "sylgard-184-10to1": (1150, 1090, 1250),
        "sylgard-186-10to1": (864, 860, 774),
        "sylgard-182-10to1": (957, 842, 1310),
        "sylgard-182-20to1": (272, 238, 634),
        "sylgard-182-30to1": (95, 120, 71.3),
        "sylgard-182-40to1": (26.5, 30, 21.7),
    }
    series = (
        "compressive modulus, after cure",
        "compressive modulus, 2 months",
        "tensile modulus, after cure",
    )
    return [
        bar(name, row[i], 0.1 * row[i], series=words)
        for i, words in enumerate(series)
        for name, row in table.items()
    ]


def svg_texts(path: Path) -> list[str]:
    root = ElementTree.fromstring(path.read_text("utf-8"))
    return ["".join(t.itertext()) for t in root.iter("{http://www.w3.org/2000/svg}text")]


def size_in(path: Path) -> tuple[float, float]:
    with Image.open(path) as picture:
        return picture.width / 200, picture.height / 200


@pytest.mark.parametrize("synthetic", [False, True])
def test_the_same_input_gives_the_same_bytes(tmp_path: Path, synthetic: bool) -> None:
    folders = (tmp_path / "first", tmp_path / "second")
    for folder in folders:
        technique_figure(folder, "curves", "curves", curves(3), synthetic)
        moduli_figure(folder, "moduli", "moduli", sylgards(), synthetic)
    first, second = ({p.name: p.read_bytes() for p in folder.iterdir()} for folder in folders)
    assert sorted(first) == ["curves.png", "curves.svg", "moduli.png", "moduli.svg"]
    assert first == second


def test_another_process_with_other_settings_gives_the_same_bytes(tmp_path: Path) -> None:
    here = tmp_path / "here"
    moduli_figure(here, "moduli", "moduli", phantoms(), True)
    program = """
import sys
from pathlib import Path
import matplotlib
matplotlib.rcParams.update({"font.size": 20, "lines.linewidth": 9, "svg.fonttype": "path"})
from deamat.report.figures import moduli_figure
from deamat.report.moduli import ModulusBar
rows = (("ef50-0t", 159.6, 2.2), ("ef30-25t", 49.2, 1.1), ("ef10-50t", 15.9, 0.3))
bars = [
    ModulusBar(m, "compressive modulus", 10, 1e3 * y, (1e3 * (y - u), 1e3 * (y + u)))
    for m, y, u in rows
]
moduli_figure(Path(sys.argv[1]), "moduli", "moduli", bars, True)
assert "matplotlib.pyplot" not in sys.modules, "pyplot was imported"
"""
    there = tmp_path / "there"
    environment = {"PYTHONHASHSEED": "7", "SOURCE_DATE_EPOCH": "0", "PYTHONPATH": "."}
    root = Path(__file__).resolve().parents[2]
    subprocess.run(
        [sys.executable, "-c", program, str(there)],
        check=True, cwd=root, env=environment | {"HOME": str(Path.home())},
    )  # fmt: skip
    for kind in ("svg", "png"):
        assert (here / f"moduli.{kind}").read_bytes() == (there / f"moduli.{kind}").read_bytes()


def test_a_figure_leaves_the_settings_of_matplotlib_as_they_were(tmp_path: Path) -> None:
    before = matplotlib.rcParams["svg.fonttype"], matplotlib.rcParams["font.size"]
    technique_figure(tmp_path, "curves", "curves", curves(1), False)
    assert (matplotlib.rcParams["svg.fonttype"], matplotlib.rcParams["font.size"]) == before


def test_the_font_comes_with_matplotlib() -> None:
    with figure_style("x"):
        font = Path(findfont(FontProperties()))
    assert font.is_relative_to(matplotlib.get_data_path())
    assert font.name == "DejaVuSans.ttf"


def test_no_file_holds_a_date_or_a_version(tmp_path: Path) -> None:
    svg, png = technique_figure(tmp_path, "curves", "curves", curves(1), False)
    text = svg.read_text("utf-8")
    assert "dc:date" not in text
    assert not re.search(r"\b20[0-9]{2}-[01][0-9]-", text)
    assert matplotlib.__version__ not in text
    with Image.open(png) as picture:
        assert picture.info["Software"] == "deamat"


def test_synthetic_data_say_so_in_the_picture_and_in_its_metadata(tmp_path: Path) -> None:
    made = [
        technique_figure(tmp_path, "curves", "curves", curves(2), True),
        moduli_figure(tmp_path, "moduli", "moduli", phantoms(), True),
    ]
    for svg, png in made:
        texts = svg_texts(svg)
        assert texts.count("SYNTHETIC DATA") == 1
        assert texts.count("SYNTHETIC DATA: simulated, not measured") == 1
        assert "<dc:description>SYNTHETIC DATA: simulated" in svg.read_text("utf-8")
        with Image.open(png) as picture:
            assert picture.info["Description"] == "SYNTHETIC DATA: simulated, not measured"


def test_measured_data_bear_no_mark(tmp_path: Path) -> None:
    svg, png = technique_figure(tmp_path, "curves", "curves", curves(2), False)
    assert "SYNTHETIC" not in svg.read_text("utf-8")
    with Image.open(png) as picture:
        assert picture.info["Description"] == "measured data"


def test_a_technique_cannot_hide_the_mark(tmp_path: Path) -> None:
    def hiding(axes: Axes) -> None:
        curves(1)(axes)
        axes.set_axis_off()
        axes.set_zorder(900)
        axes.set_title("my own title", loc="left")
        axes.axvspan(0.0, 12.0, color="white", zorder=900)

    _, plain = technique_figure(tmp_path, "unmarked", "curves", hiding, False)
    svg, marked = technique_figure(tmp_path, "marked", "curves", hiding, True)
    assert "SYNTHETIC DATA" in svg_texts(svg)
    assert red_part(plain) == 0.0
    assert red_part(marked) > 0.03


def red_part(png: Path) -> float:
    with Image.open(png) as picture:
        red, green, blue = np.moveaxis(np.asarray(picture.convert("RGB"), dtype=float), 2, 0)
    return float(((red > green + 20) & (red > blue + 20)).mean())


def test_a_tall_figure_is_marked_on_each_of_its_pages(tmp_path: Path) -> None:
    bars = [bar(f"silicone-{i}", 100.0 + i, 5.0) for i in range(50)]
    svg, _ = moduli_figure(tmp_path, "tall", "moduli", bars, True)
    texts = svg_texts(svg)
    assert texts.count("SYNTHETIC DATA") >= 3
    assert {f"silicone-{i}" for i in range(50)} <= set(texts)


@pytest.mark.parametrize("n", [1, 50])
def test_any_number_of_specimens_leaves_the_data_their_room(tmp_path: Path, n: int) -> None:
    title = technique_title("ef50-0t", "compression", n)
    svg, png = technique_figure(tmp_path, "curves", title, curves(n), False)
    texts = svg_texts(svg)
    assert f"ef50-0t: compression, n = {n}" in texts
    assert {f"specimen {i + 1}" for i in range(n)} <= set(texts)
    width, height = size_in(png)
    assert width == 6.3
    assert height >= 3.9


def test_one_material_can_be_drawn(tmp_path: Path) -> None:
    svg, _ = moduli_figure(tmp_path, "moduli", "moduli", phantoms()[:1], False)
    assert {"ef50-0t", "159.6 (n = 10)"} <= set(svg_texts(svg))


def test_curves_without_a_look_of_their_own_differ_in_colour_and_dash() -> None:
    with figure_style("x"):
        figure, axes = new_figure()
        curves(28)(axes)
        for line in axes.lines:
            line.set_gid("curve")
        drawn = BytesIO()
        figure.savefig(drawn, format="svg")
    styles = re.findall(r'<g id="curve">\s*<path [^>]*style="([^"]*)"', drawn.getvalue().decode())
    assert len(styles) == 28
    assert len(set(styles)) == 28


def test_no_colour_is_lost_on_white() -> None:
    for colour in COLOURS:
        channels = [
            c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(colour)
        ]
        luminance = float(np.dot([0.2126, 0.7152, 0.0722], channels))
        assert 1.05 / (luminance + 0.05) > 2.0, colour


def test_a_failing_technique_leaves_the_old_figure_and_no_half_of_a_new_one(tmp_path: Path) -> None:
    technique_figure(tmp_path, "curves", "curves", curves(2), False)
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir()}

    def failing(axes: Axes) -> None:
        curves(3)(axes)
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        technique_figure(tmp_path, "curves", "curves", failing, False)
    with pytest.raises(ZeroDivisionError):
        technique_figure(tmp_path / "new", "curves", "curves", failing, False)
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == before


def test_an_axis_without_a_name_is_an_error(tmp_path: Path) -> None:
    def nameless(axes: Axes) -> None:
        axes.plot([0.0, 1.0])
        axes.set_xlabel("nominal strain [%]")

    message = "figure 'curves': both axes must say what they show and in which unit"
    with pytest.raises(ValueError, match=f"^{message}$"):
        technique_figure(tmp_path, "curves", "curves", nameless, False)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["", "..", "../escape", "folder/figure"])
def test_a_name_that_leaves_the_folder_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(ConfigError, match="must be a plain file name"):
        technique_figure(tmp_path / "figures", name, "curves", curves(1), False)
    assert list(tmp_path.iterdir()) == []


def test_no_bars_are_an_error(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"^figure 'moduli': there is no modulus to draw$"):
        moduli_figure(tmp_path, "moduli", "moduli", [], False)


def test_names_with_a_dollar_or_markup_are_written_as_they_are(tmp_path: Path) -> None:
    odd = "a$_$b & <c>"
    svg, _ = technique_figure(tmp_path, "curves", odd, curves(1, label=odd), False)
    assert svg_texts(svg).count(odd) == 2
    svg, _ = moduli_figure(tmp_path, "moduli", odd, [bar(odd, 100.0, 1.0, series=odd)], False)
    assert svg_texts(svg).count(odd) == 3


def test_values_are_written_with_their_n_to_the_second_figure_of_the_interval(
    tmp_path: Path,
) -> None:
    svg, _ = moduli_figure(tmp_path, "moduli", "moduli", phantoms(), False)
    texts = svg_texts(svg)
    assert {"159.6 (n = 10)", "49.2 (n = 10)", "15.90 (n = 10)"} <= set(texts)
    assert "modulus [kPa]; whiskers: 95 % confidence interval" in texts


def test_a_refused_modulus_keeps_its_slot(tmp_path: Path) -> None:
    svg, png = moduli_figure(tmp_path, "one", "moduli", [bar("a", 100.0, 1.0), refused("a")], False)
    assert svg_texts(svg).count("refused") == 1
    assert "tensile modulus" in svg_texts(svg)
    all_refused, _ = moduli_figure(tmp_path, "all", "moduli", [refused("a"), refused("b")], False)
    assert svg_texts(all_refused).count("refused") == 2
    both = [bar("a", 100.0, 1.0), bar("a", 90.0, 1.0, series="tensile modulus")]
    _, full = moduli_figure(tmp_path, "both", "moduli", both, False)
    assert size_in(png) == size_in(full)


@pytest.mark.parametrize(("bars", "scale"), [(phantoms(), "linear"), (sylgards(), "log")])
def test_the_axis_follows_the_span(bars: list[ModulusBar], scale: str) -> None:
    with figure_style("x"):
        _, axes = new_figure(height_for(bars))
        draw_moduli(axes, bars)
        assert axes.get_xscale() == scale
        low, high = axes.get_xlim()
        assert (low == 0.0) == (scale == "linear")
        ends = [end / 1e3 for b in bars for end in b.ci95_Pa or ()]
        assert low < min(ends)
        assert max(ends) < high


def test_bars_are_as_long_as_the_moduli() -> None:
    with figure_style("x"):
        _, axes = new_figure()
        draw_moduli(axes, phantoms())
        widths = [bar.get_width() for bar in axes.patches if isinstance(bar, Rectangle)]
    assert widths[1:] == pytest.approx([159.6, 49.2, 15.9])


def overlap(a: Text, b: Text) -> bool:
    one, other = a.get_window_extent(), b.get_window_extent()
    # Half a pixel at 72 dpi is no collision.
    wide = min(one.x1, other.x1) - max(one.x0, other.x0)
    high = min(one.y1, other.y1) - max(one.y0, other.y0)
    return bool(wide > 0.5 and high > 0.5)


@pytest.mark.parametrize(
    "bars",
    [
        phantoms(),
        sylgards(),
        [
            bar(LONG, 210.0, 500.0, n=2),
            bar(LONG + "-again", 1234567.0, 1.0, n=1000),
            refused("short"),
            bar("other", 8.0, 9.0, series=f"tensile modulus, {LONG}, temperature_K 295.2"),
        ],
        [bar("W" * 60, 1.0, 0.1), refused("W" * 61)],
    ],
    ids=["phantoms", "sylgards", "long", "wide"],
)
def test_no_texts_collide_and_none_leaves_the_page(bars: list[ModulusBar]) -> None:
    with figure_style("x"):
        figure, axes = new_figure(height_for(bars))
        draw_moduli(axes, bars)
        set_title(figure, "moduli of " + LONG)
        place_legend(figure, axes)
        figure.draw_without_rendering()
        legend = figure.legends[0].get_texts()
        labels = [t for t in axes.get_yticklabels() if t.get_text()]
        numbers = [t for t in axes.get_xticklabels(which="both") if t.get_text()]
        low, high = axes.get_xlim()
        numbers = [t for t in numbers if low <= t.get_position()[0] <= high]
        texts = [*axes.texts, *labels, *numbers, *legend, axes.xaxis.label, *figure.texts]
        collisions = [
            (a.get_text(), b.get_text())
            for i, a in enumerate(texts)
            for b in texts[i + 1 :]
            if overlap(a, b)
        ]
        assert collisions == []
        for text in texts:
            box = text.get_window_extent()
            assert box.x0 >= -1, text.get_text()
            assert box.x1 <= figure.bbox.width + 1, text.get_text()
            assert box.y0 >= -1, text.get_text()
            assert box.y1 <= figure.bbox.height + 1, text.get_text()


@pytest.mark.parametrize(("entries", "inside"), [(2, True), (20, False)])
def test_a_legend_among_the_data_stays_only_if_it_is_small(entries: int, inside: bool) -> None:
    with figure_style("x"):
        figure, axes = new_figure()
        curves(entries)(axes)
        axes.legend(loc="upper left")
        place_legend(figure, axes)
        assert (axes.get_legend() is not None) is inside
        assert (len(figure.legends) == 0) is inside


@pytest.mark.parametrize(("lowest_kPa", "unit"), [(159.6, "kPa"), (999.0, "kPa"), (1200.0, "MPa")])
def test_the_unit_suits_the_softest_material(tmp_path: Path, lowest_kPa: float, unit: str) -> None:
    bars = [bar("soft", lowest_kPa, 10.0), bar("stiff", 3000.0, 100.0)]
    svg, _ = moduli_figure(tmp_path, "moduli", "moduli", bars, False)
    assert f"modulus [{unit}]; whiskers: 95 % confidence interval" in svg_texts(svg)
    assert ("3000 (n = 3)" if unit == "kPa" else "3.00 (n = 3)") in svg_texts(svg)
