"""How figures look, how they are marked, and how the same figure becomes the same bytes.

The object API is used throughout: pyplot keeps global state and is slow to import. Matplotlib's
settings are global, so figures are made in parallel by processes and never by threads.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib
from cycler import cycler
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.text import Text
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from deamat.core.atomic import write_atomically
from deamat.core.errors import ConfigError

MARK = "SYNTHETIC DATA"
MARK_MEANING = f"{MARK}: simulated, not measured"

PAGE_WIDTH_in = 6.3  # the text of an A4 page between margins of 25 mm
AXES_HEIGHT_in = 3.9
_PIXELS_PER_INCH = 200
_LEGEND_INSIDE = 6  # so many entries may stand among the data, if the technique puts them there
_LABEL_CHARACTERS = 80
_LEFT = 0.008  # of the figure's width: where titles begin
_MARK_COLOUR = "#B00000"

# Okabe and Ito without yellow, which is lost on white, and with wine for black, so that fits and
# other lines that stand for all specimens may be black.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#882255", "#CC79A7", "#E69F00", "#56B4E9")
# Colours of one lightness are one grey, so the dashes tell neighbours apart as well. Seven and
# four have no common factor: 28 curves go by before a pair of colour and dash comes back.
_DASHES = ("-", (0, (5, 1.5)), (0, (6, 1.5, 1, 1.5)), (0, (1.5, 1)))
_CYCLE = len(COLOURS) * len(_DASHES)

_STYLE = {
    "axes.axisbelow": True,
    "axes.grid": True,
    "axes.labelsize": 9.0,
    "axes.prop_cycle": cycler(
        color=[COLOURS[i % len(COLOURS)] for i in range(_CYCLE)],
        linestyle=[_DASHES[i % len(_DASHES)] for i in range(_CYCLE)],
    ),
    "axes.spines.right": False,
    "axes.spines.top": False,
    "figure.titlesize": 9.5,
    "figure.titleweight": "bold",
    "figure.dpi": 72.0,  # the SVG writer's: a text must be as wide when measured as when written
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],  # comes with matplotlib, so it is the same everywhere
    "font.size": 9.0,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.5,
    "hatch.linewidth": 0.6,
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "legend.handlelength": 2.6,
    "lines.linewidth": 1.1,
    "lines.markersize": 4.0,
    "svg.fonttype": "none",  # text stays text: it can be searched, copied and read aloud
    "text.hinting": "none",
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
}


@contextmanager
def figure_style(name: str) -> Iterator[None]:
    """Set matplotlib's defaults and our style, whatever the user's own matplotlibrc says.

    Parameters
    ----------
    name : of the figure; it salts the ids inside the SVG, so that several fit on one page
    """
    settings: dict[Any, Any] = {
        k: v for k, v in matplotlib.rcParamsDefault.items() if k != "backend"
    }
    settings |= _STYLE | {"svg.hashsalt": f"deamat {name}"}
    with matplotlib.rc_context(settings):
        yield


def new_figure(height_in: float = AXES_HEIGHT_in) -> tuple[Figure, Axes]:
    """An empty figure of a page's width with one pair of axes; call within `figure_style`."""
    figure = Figure(figsize=(PAGE_WIDTH_in, height_in), layout="constrained")
    FigureCanvasAgg(figure)
    return figure, figure.add_subplot()


def set_title(figure: Figure, title: str) -> None:
    """Put a title over the figure, broken into as many lines as its width asks for."""
    text = plain(figure.suptitle("", x=_LEFT, ha="left"))
    for characters in range(100, 8, -4):
        text.set_text(textwrap.fill(title, characters))
        if text.get_window_extent().width <= (1 - 2 * _LEFT) * figure.bbox.width:
            return


def place_legend(figure: Figure, axes: Axes) -> None:
    """Put the legend under the axes and let the figure grow by it, so that it never hides data.

    A technique that has drawn a legend of its own among the data keeps it if it is a small one.
    Labels are plain text: specimens may have any name.
    """
    handles, labels = axes.get_legend_handles_labels()
    own = axes.get_legend()
    if own is not None and len(handles) <= _LEGEND_INSIDE:
        _plain_labels(own)
        return
    if own is not None:
        own.remove()
    if not handles:
        return
    labels = [textwrap.fill(label, _LABEL_CHARACTERS) for label in labels]
    trial = _legend_below(figure, handles, labels, columns=1)
    most = max(1, int(0.98 * figure.bbox.width / trial.get_window_extent().width))
    trial.remove()
    rows = math.ceil(len(labels) / most)
    legend = _legend_below(figure, handles, labels, columns=math.ceil(len(labels) / rows))
    height_in = legend.get_window_extent().height / figure.dpi
    figure.set_figheight(figure.get_figheight() + height_in)


def _legend_below(figure: Figure, handles: list[Artist], labels: list[str], columns: int) -> Legend:
    legend = figure.legend(handles, labels, loc="outside lower center", ncols=columns)
    _plain_labels(legend)
    return legend


def _plain_labels(legend: Legend) -> None:
    for text in legend.get_texts():
        plain(text)


def save_figure(
    figure: Figure, axes: Axes, out_dir: Path, name: str, title: str, synthetic: bool
) -> tuple[Path, Path]:
    """Mark a figure, render it and write NAME.svg and NAME.png; call within `figure_style`.

    Nothing is written before both have been rendered.

    Parameters
    ----------
    synthetic : the data are simulated: the figure says so across its face and in its metadata

    Raises
    ------
    ConfigError : `name` is not the name of a file in `out_dir`
    """
    if name in {"", ".", ".."} or Path(name).name != name:
        raise ConfigError(f"a figure cannot be called {name!r}: it must be a plain file name")
    if synthetic:
        _mark(figure, axes)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # both pictures share one layout, and it is worked out once
    description = MARK_MEANING if synthetic else "measured data"
    about: dict[str, str | None] = {"Title": title, "Description": description}
    pictures = {
        "svg": _rendered(figure, "svg", {**about, "Creator": "deamat", "Date": None}),
        "png": _rendered(figure, "png", {**about, "Software": "deamat"}),
    }
    svg, png = (out_dir / f"{name}.{kind}" for kind in pictures)
    write_atomically(svg, pictures["svg"])
    write_atomically(png, pictures["png"])
    return svg, png


def _mark(figure: Figure, axes: Axes) -> None:
    # Twice: a line with room of its own, and letters over the data, which no crop takes away.
    line = axes.set_title(MARK_MEANING, loc="left")
    line.set(color=_MARK_COLOUR, fontweight="bold", fontsize=9.0)
    times = max(1, round(figure.get_figheight() / AXES_HEIGHT_in))
    for i in range(times):
        across = figure.text(0.5, (i + 0.5) / times, MARK, ha="center", va="center", zorder=1000)
        across.set(color=_MARK_COLOUR, alpha=0.16, fontsize=38, fontweight="bold", rotation=20)
        across.set_in_layout(False)


def _rendered(figure: Figure, kind: str, metadata: dict[str, str | None]) -> bytes:
    buffer = BytesIO()
    figure.savefig(buffer, format=kind, dpi=_PIXELS_PER_INCH, metadata=metadata)
    return buffer.getvalue()


def plain(text: Text) -> Text:
    """Take a text as it is written, with no mathematics in it."""
    text.set_parse_math(False)
    return text


def plain_numbers(axis: Axis) -> None:
    """Write the ticks of an axis as `0.5`, `20`, `1e+06`, not as powers of ten."""
    axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))


def decade_ticks(axis: Axis, subs: tuple[float, ...] = (1.0, 2.0, 5.0)) -> None:
    """Put ticks with plain numbers at these multiples of each power of ten, and no others."""
    axis.set_major_locator(LogLocator(subs=subs))
    plain_numbers(axis)
    axis.set_minor_formatter(NullFormatter())
