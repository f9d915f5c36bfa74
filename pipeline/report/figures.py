"""The figures of a campaign: one for each material and technique, and one of all moduli."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from matplotlib.axes import Axes

from deamat.report.bars import draw_moduli, height_for
from deamat.report.moduli import ModulusBar
from deamat.report.style import figure_style, new_figure, place_legend, save_figure, set_title


def technique_title(material: str, technique: str, n: int) -> str:
    """Say what a technique's figure shows: the material, the technique and how many specimens."""
    return f"{material}: {technique}, n = {n}"


def technique_figure(
    out_dir: Path, name: str, title: str, draw: Callable[[Axes], None], synthetic: bool
) -> tuple[Path, Path]:
    """Write the figure of one material under one technique as NAME.svg and NAME.png.

    The same input gives the same bytes. Curves that the technique draws without choosing their
    look are told apart by colour and dash.

    Parameters
    ----------
    title : see `technique_title`
    draw : draws into the axes it is given, names both axes with their units and labels what the
        legend shall hold: `Technique.figure` with its measurements and summary bound
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


def moduli_figure(
    out_dir: Path, name: str, title: str, bars: Sequence[ModulusBar], synthetic: bool
) -> tuple[Path, Path]:
    """Write the moduli of the materials of one campaign as NAME.svg and NAME.png.

    One bar for each property and condition of a material, with its 95 % confidence interval, its
    value and its n; a refused one keeps its slot and says so. Where the moduli span more than
    1:20 the axis is logarithmic. The figure is as high as its bars ask for.

    Parameters
    ----------
    bars : see `deamat.report.moduli.modulus_bars`
    synthetic : the data are simulated

    Returns
    -------
    the paths of the SVG and of the PNG

    Raises
    ------
    ValueError : there are no bars
    ConfigError : `name` is not the name of a file in `out_dir`

    Source: the form of Figure 9B of Sikulskyi et al. 2022, Front. Robot. AI 9:1034914.
    """
    if not bars:
        raise ValueError(f"figure {name!r}: there is no modulus to draw")
    with figure_style(name):
        figure, axes = new_figure(height_for(bars))
        draw_moduli(axes, bars)
        set_title(figure, title)
        place_legend(figure, axes)
        return save_figure(figure, axes, out_dir, name, title, synthetic)
