"""One figure drawn by matplotlib: those of the article, whose axes are drawn upon freely."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from matplotlib.axes import Axes

from deamat.report.style import figure_style, new_figure, place_legend, save_figure, set_title


def axes_figure(
    out_dir: Path, name: str, title: str, draw: Callable[[Axes], None], synthetic: bool
) -> tuple[Path, Path]:
    """Write a figure of one pair of axes as NAME.svg and NAME.png.

    The same input gives the same bytes. Curves drawn without a look of their own are told apart by
    colour and dash.

    Parameters
    ----------
    draw : draws into the axes it is given, names both axes with their units and labels what the
        legend shall hold
    synthetic : the data are simulated

    Returns
    -------
    the paths of the SVG and of the PNG; neither is touched if `draw` fails

    Raises
    ------
    ValueError : `draw` left an axis without its name
    ConfigError : `name` is not the name of a file in `out_dir`
    """
    with figure_style(name):
        figure, axes = new_figure()
        draw(axes)
        if not (axes.get_xlabel() and axes.get_ylabel()):
            raise ValueError(
                f"figure {name!r}: both axes must say what they show and in which unit"
            )
        set_title(figure, title)
        place_legend(figure, axes)
        return save_figure(figure, axes, out_dir, name, title, synthetic)
