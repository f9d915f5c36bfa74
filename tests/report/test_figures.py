"""Figures: the same bytes every time, marked where they must be, legible with any names."""

from __future__ import annotations

import re
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
from PIL import Image

from deamat.core.errors import ConfigError
from deamat.report.figures import axes_figure
from deamat.report.style import COLOURS, figure_style, new_figure, place_legend

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
        axes_figure(folder, "curves", "curves", curves(3), synthetic)
    first, second = ({p.name: p.read_bytes() for p in folder.iterdir()} for folder in folders)
    assert sorted(first) == ["curves.png", "curves.svg"]
    assert first == second


def test_a_figure_leaves_the_settings_of_matplotlib_as_they_were(tmp_path: Path) -> None:
    before = matplotlib.rcParams["svg.fonttype"], matplotlib.rcParams["font.size"]
    axes_figure(tmp_path, "curves", "curves", curves(1), False)
    assert (matplotlib.rcParams["svg.fonttype"], matplotlib.rcParams["font.size"]) == before


def test_the_font_comes_with_matplotlib() -> None:
    with figure_style("x"):
        font = Path(findfont(FontProperties()))
    assert font.is_relative_to(matplotlib.get_data_path())
    assert font.name == "DejaVuSans.ttf"


def test_no_file_holds_a_date_or_a_version(tmp_path: Path) -> None:
    svg, png = axes_figure(tmp_path, "curves", "curves", curves(1), False)
    text = svg.read_text("utf-8")
    assert "dc:date" not in text
    assert not re.search(r"\b20[0-9]{2}-[01][0-9]-", text)
    assert matplotlib.__version__ not in text
    with Image.open(png) as picture:
        assert picture.info["Software"] == "deamat"


def test_synthetic_data_say_so_in_the_picture_and_in_its_metadata(tmp_path: Path) -> None:
    svg, png = axes_figure(tmp_path, "curves", "curves", curves(2), True)
    texts = svg_texts(svg)
    assert texts.count("SYNTHETIC DATA") == 1
    assert texts.count("SYNTHETIC DATA: simulated, not measured") == 1
    assert "<dc:description>SYNTHETIC DATA: simulated" in svg.read_text("utf-8")
    with Image.open(png) as picture:
        assert picture.info["Description"] == "SYNTHETIC DATA: simulated, not measured"


def test_measured_data_bear_no_mark(tmp_path: Path) -> None:
    svg, png = axes_figure(tmp_path, "curves", "curves", curves(2), False)
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

    _, plain = axes_figure(tmp_path, "unmarked", "curves", hiding, False)
    svg, marked = axes_figure(tmp_path, "marked", "curves", hiding, True)
    assert "SYNTHETIC DATA" in svg_texts(svg)
    assert red_part(plain) == 0.0
    assert red_part(marked) > 0.03


def red_part(png: Path) -> float:
    with Image.open(png) as picture:
        red, green, blue = np.moveaxis(np.asarray(picture.convert("RGB"), dtype=float), 2, 0)
    return float(((red > green + 20) & (red > blue + 20)).mean())


@pytest.mark.parametrize("n", [1, 50])
def test_any_number_of_specimens_leaves_the_data_their_room(tmp_path: Path, n: int) -> None:
    title = f"ef50-0t: compression, n = {n}"
    svg, png = axes_figure(tmp_path, "curves", title, curves(n), False)
    texts = svg_texts(svg)
    assert title in texts
    assert {f"specimen {i + 1}" for i in range(n)} <= set(texts)
    width, height = size_in(png)
    assert width == 6.3
    assert height >= 3.9


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
    axes_figure(tmp_path, "curves", "curves", curves(2), False)
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir()}

    def failing(axes: Axes) -> None:
        curves(3)(axes)
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        axes_figure(tmp_path, "curves", "curves", failing, False)
    with pytest.raises(ZeroDivisionError):
        axes_figure(tmp_path / "new", "curves", "curves", failing, False)
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == before


def test_an_axis_without_a_name_is_an_error(tmp_path: Path) -> None:
    def nameless(axes: Axes) -> None:
        axes.plot([0.0, 1.0])
        axes.set_xlabel("nominal strain [%]")

    message = "figure 'curves': both axes must say what they show and in which unit"
    with pytest.raises(ValueError, match=f"^{message}$"):
        axes_figure(tmp_path, "curves", "curves", nameless, False)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["", "..", "../escape", "folder/figure"])
def test_a_name_that_leaves_the_folder_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(ConfigError, match="must be a plain file name"):
        axes_figure(tmp_path / "figures", name, "curves", curves(1), False)
    assert list(tmp_path.iterdir()) == []


def test_names_with_a_dollar_or_markup_are_written_as_they_are(tmp_path: Path) -> None:
    odd = "a$_$b & <c>"
    svg, _ = axes_figure(tmp_path, "curves", odd, curves(1, label=odd), False)
    assert svg_texts(svg).count(odd) == 2


@pytest.mark.parametrize(("entries", "inside"), [(2, True), (20, False)])
def test_a_legend_among_the_data_stays_only_if_it_is_small(entries: int, inside: bool) -> None:
    with figure_style("x"):
        figure, axes = new_figure()
        curves(entries)(axes)
        axes.legend(loc="upper left")
        place_legend(figure, axes)
        assert (axes.get_legend() is not None) is inside
        assert (len(figure.legends) == 0) is inside


def test_a_users_own_settings_change_nothing(tmp_path: Path) -> None:
    axes_figure(tmp_path / "here", "curves", "curves", curves(3), True)
    with matplotlib.rc_context({"font.size": 20, "lines.linewidth": 9, "svg.fonttype": "path"}):
        axes_figure(tmp_path / "there", "curves", "curves", curves(3), True)
    for kind in ("svg", "png"):
        here, there = (tmp_path / place / f"curves.{kind}" for place in ("here", "there"))
        assert here.read_bytes() == there.read_bytes()
