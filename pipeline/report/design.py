"""The figures of a design: curvature against voltage, tornado, compositions, what costs what."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.lines import Line2D

from deamat.actuator.compositions import Composition, Trade
from deamat.actuator.design import Design
from deamat.actuator.uncertainty import Bar
from deamat.core.errors import MissingProperty
from deamat.core.units import from_si
from deamat.report.style import (
    COLOURS,
    AXES_HEIGHT_in,
    figure_style,
    new_figure,
    place_legend,
    plain,
    plain_numbers,
    save_figure,
    set_title,
)

_BAR_in = 0.32
_MARGINS_in = 1.0
_MARKERS = ("o", "s", "^", "D", "v", "P", "X")
_NOTHING_per_m = 1e-6  # what a thickness at its optimum leaves after rounding
_FEW = 7  # as many colours and markers as there are

Pictures = tuple[Path, Path]


def curvature_figure(out_dir: Path, name: str, design: Design) -> Pictures:
    """Draw curvature against voltage with its 95 % band, and the breakdown probability.

    Parameters
    ----------
    out_dir, name : NAME.svg and NAME.png are written there
    design : an answered request; a synthetic one is marked
    """

    def draw(axes: Axes) -> None:
        points = design.points
        kilovolts = [0.0, *(from_si(p.voltage_V, "kV") for p in points)]
        bent = [0.0, *(p.curvature_per_m for p in points)]
        # 95 % of a normal distribution; where first order does not hold there is no band
        half = [0.0, *(1.96 * p.u_per_m for p in points)]
        axes.plot(kilovolts, bent, color="black", label="curvature")
        axes.fill_between(
            kilovolts,
            [b - h for b, h in zip(bent, half, strict=True)],
            [b + h for b, h in zip(bent, half, strict=True)],
            color=COLOURS[6], alpha=0.5, lw=0, label="95 % (first order)",
        )  # fmt: skip
        axes.set(xlabel="voltage [kV]", ylabel="curvature [1/m]", xlim=(0, kilovolts[-1]))
        axes.set_ylim(bottom=0)
        chances = [p.failure_probability for p in points]
        if all(c is not None for c in chances):
            _draw_chance(axes, kilovolts[1:], [100.0 * (c or 0.0) for c in chances])

    return _save(out_dir, name, _title(design), draw, bool(design.synthetic))


def tornado_figure(out_dir: Path, name: str, design: Design) -> Pictures:
    """Draw how far each input moves the curvature by one standard uncertainty, widest on top."""

    def draw(axes: Axes) -> None:
        bars = design.tornado
        middle = design.prediction.value
        for row, bar in enumerate(bars):
            for end, colour in ((bar.low, COLOURS[0]), (bar.high, COLOURS[1])):
                if math.isfinite(end):
                    axes.barh(row, end - middle, 0.62, left=middle, color=colour)
        reach = max(abs(e - middle) for b in bars for e in (b.low, b.high) if math.isfinite(e))
        axes.set_xlim(middle - 1.6 * reach, middle + 1.6 * reach)
        for row, bar in enumerate(bars):
            _label_bar(axes, row, bar, middle, reach)
        axes.axvline(middle, color="black", lw=0.8)
        axes.set_yticks(range(len(bars)), [plain_name(bar.name) for bar in bars])
        axes.set(xlabel="curvature [1/m]", ylim=(len(bars) - 0.4, -0.6))
        axes.grid(visible=False, axis="y")
        axes.set_ylabel("one standard uncertainty of")
        for i, which in ((0, "down"), (1, "up")):
            axes.barh(math.nan, math.nan, color=COLOURS[i], label=f"input {which}")

    height = _MARGINS_in + _BAR_in * len(design.tornado)
    return _save(out_dir, name, _title(design), draw, bool(design.synthetic), height)


def compositions_figure(
    out_dir: Path, name: str, title: str, compositions: Sequence[Composition]
) -> Pictures:
    """Draw curvature against the passive thickness, one line for each pair of materials.

    Raises
    ------
    MissingProperty : there is nothing to draw

    Source: the form of Figure 11 of Sikulskyi et al. 2022, Front. Robot. AI 9:1034914.
    """
    if not compositions:
        raise MissingProperty("no composition can be compared: see why each was refused")

    def draw(axes: Axes) -> None:
        films = list(dict.fromkeys(c.de for c in compositions))
        for c in compositions:
            alone = c.de == c.passive
            micrometres = [from_si(t, "um") for t in c.passive_thickness_m.tolist()]
            below = "on itself" if alone else f"on {c.passive}"
            axes.plot(
                micrometres, c.curvature_per_m, color=COLOURS[films.index(c.de) % len(COLOURS)],
                ls="--" if alone else "-",
                label=f"{c.de} {below}, {from_si(c.voltage_V, 'kV'):.3g} kV",
            )  # fmt: skip
            best_um = from_si(c.best_passive_thickness_m, "um")
            axes.plot(best_um, c.best_curvature_per_m, "o", color="black", ms=3)
        axes.plot(math.nan, math.nan, "o", color="black", ms=3, label="optimum", ls="")
        axes.set(xlabel="thickness of the passive layer [um]", ylabel="curvature [1/m]")
        axes.set_xscale("log")
        plain_numbers(axes.xaxis)
        axes.set_ylim(bottom=0)

    return _save(out_dir, name, title, draw, any(c.synthetic for c in compositions))


def pareto_figure(
    out_dir: Path, name: str, title: str, trades: Sequence[Trade], synthetic: bool
) -> Pictures:
    """Draw the designs that no other beats: curvature against voltage, blocked force as colour.

    Raises
    ------
    MissingProperty : there is nothing to draw
    """
    if not trades:
        raise MissingProperty("no design can be driven: there is no Pareto front")

    def draw(axes: Axes) -> None:
        films = list(dict.fromkeys(t.de for t in trades))
        forces = [from_si(t.blocked_force_N, "uN") for t in trades]
        norm = Normalize(min(forces), max(forces))
        for i, film in enumerate(films):
            mine = [(t, f) for t, f in zip(trades, forces, strict=True) if t.de == film]
            axes.scatter(
                [from_si(t.voltage_V, "kV") for t, _ in mine],
                [t.curvature_per_m for t, _ in mine],
                c=[f for _, f in mine], norm=norm, cmap="viridis", s=16,
                marker=_MARKERS[i % _FEW], lw=0,
            )  # fmt: skip
            handle = Line2D([], [], ls="", marker=_MARKERS[i % _FEW], color="#555555", label=film)
            axes.add_line(handle)
        axes.set(xlabel="voltage [kV]", ylabel="curvature [1/m]")
        axes.autoscale_view()
        figure = axes.get_figure(root=True)
        if figure is not None:
            figure.colorbar(ScalarMappable(norm, "viridis"), ax=axes, label="blocked force [uN]")

    return _save(out_dir, name, title, draw, synthetic)


def plain_name(name: str) -> str:
    """Write the name of an input for people: no underscores, its owner in a second line."""
    what, of, owner = name.replace("_", " ").partition(" of ")
    return f"{what}\n{of.strip()} {owner}" if of else what


def _draw_chance(axes: Axes, kilovolts: Sequence[float], percent: Sequence[float]) -> None:
    right = axes.twinx()
    right.plot(kilovolts, percent, color=COLOURS[1], ls="--")
    axes.plot(math.nan, math.nan, color=COLOURS[1], ls="--", label="films that break down (right)")
    right.set_ylabel("films that break down [%]", color=COLOURS[1])
    right.set_ylim(bottom=0)
    right.grid(visible=False)
    right.spines["right"].set_visible(True)


def _label_bar(axes: Axes, row: int, bar: Bar, middle: float, reach: float) -> None:
    u_per_m = bar.u if bar.u > _NOTHING_per_m else 0.0
    text = f"± {u_per_m:.2g}" if bar.declared else "no uncertainty declared"
    ends = [end for end in (bar.low, bar.high, middle) if math.isfinite(end)]
    style = "normal" if bar.declared else "italic"
    axes.text(max(ends) + 0.03 * reach, row, text, va="center", fontsize=7.5, fontstyle=style)


def _title(design: Design) -> str:
    r, strip = design.case.request, design.strip
    passive_um, film_um = (
        from_si(float(t), "um") for t in (strip.passive_thickness_m, strip.film_thickness_m)
    )
    voltage = f"{from_si(design.voltage_V, 'kV'):.3g} kV"
    return f"{r.de} ({film_um:.4g} um) on {r.passive} ({passive_um:.4g} um), {voltage}"


def _save(
    out_dir: Path,
    name: str,
    title: str,
    draw: Callable[[Axes], None],
    synthetic: bool,
    height_in: float = AXES_HEIGHT_in,
) -> Pictures:
    with figure_style(name):
        figure, axes = new_figure(height_in)
        draw(axes)
        for label in axes.get_yticklabels():
            plain(label)
        set_title(figure, title)
        place_legend(figure, axes)
        return save_figure(figure, axes, out_dir, name, title, synthetic)
