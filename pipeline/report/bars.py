"""Draws moduli as horizontal bars: names, values and intervals each have a line of their own."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence

from matplotlib.axes import Axes

from deamat.core.units import from_si
from deamat.report.moduli import ModulusBar
from deamat.report.style import COLOURS, decade_ticks, plain

_LOGARITHMIC_FROM = 20.0  # largest over smallest modulus
_ROOM_FOR_VALUES = 0.2  # part of the axis to the right of the longest interval
_NAME_CHARACTERS = 24
_LINE_OF_NAME = 0.75  # height of a line of a name, in bars
_GAP = 0.7  # between materials, in bars
_BAR_in = 0.19
_MARGINS_in = 0.75

# Neighbours differ in lightness and in hatch, so they differ in grey. Hatches of dots are left out:
# each dot is a path of its own, and a figure of them weighs ten times as much.
_LOOKS = (
    (COLOURS[0], ""),
    (COLOURS[6], "////"),
    ("#F0E442", "\\\\\\\\"),
    (COLOURS[2], "xxxx"),
    (COLOURS[4], "||||"),
    (COLOURS[1], "----"),
    ("#DDDDDD", "++++"),
)

_Slot = tuple[ModulusBar, float]  # a bar and where it stands


def height_for(bars: Sequence[ModulusBar]) -> float:
    """Return the height of the figure that these bars need, without legend `[in]`."""
    slots = math.fsum(_height_of(name, bars) + _GAP for name in _materials(bars))
    return _MARGINS_in + _BAR_in * max(slots, 3.0)


def draw_moduli(axes: Axes, bars: Sequence[ModulusBar]) -> None:
    """Draw the bars grouped by material, materials and series in the order of their appearance."""
    unit = _unit(bars)
    series = list(dict.fromkeys(bar.series for bar in bars))
    _scale(axes, bars, unit)
    slots: list[_Slot] = []
    ticks: dict[str, float] = {}
    top = 0.0
    for material in _materials(bars):
        mine = [b for name in series for b in bars if (b.material, b.series) == (material, name)]
        height = _height_of(material, bars)
        ticks[material] = middle = top + height / 2
        slots += [(bar, middle + i - (len(mine) - 1) / 2) for i, bar in enumerate(mine)]
        top += height + _GAP
    for i, name in enumerate(series):
        _draw_series(axes, [slot for slot in slots if slot[0].series == name], unit, i)
    axes.set_ylim(top - _GAP / 2, -_GAP / 2)  # downwards, as one reads
    axes.set_yticks(list(ticks.values()), [_broken(name) for name in ticks])
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False, axis="y")
    for label in axes.get_yticklabels():
        plain(label)


def _materials(bars: Sequence[ModulusBar]) -> list[str]:
    return list(dict.fromkeys(bar.material for bar in bars))


def _broken(name: str) -> str:
    return textwrap.fill(name, _NAME_CHARACTERS)


def _height_of(material: str, bars: Sequence[ModulusBar]) -> float:
    lines = _broken(material).count("\n") + 1
    return max(sum(bar.material == material for bar in bars), lines * _LINE_OF_NAME)


def _unit(bars: Sequence[ModulusBar]) -> str:
    values = [abs(bar.value_Pa) for bar in bars if bar.value_Pa is not None]
    return "MPa" if values and min(values) >= 1e6 else "kPa"


def _ends(bar: ModulusBar, unit: str) -> list[float]:
    known = [bar.value_Pa, *(bar.ci95_Pa or ())]
    return [from_si(x, unit) for x in known if x is not None]


def _scale(axes: Axes, bars: Sequence[ModulusBar], unit: str) -> None:
    axes.set_xlabel(f"modulus [{unit}]; whiskers: 95 % confidence interval")
    values = [from_si(bar.value_Pa, unit) for bar in bars if bar.value_Pa is not None]
    if not values:  # everything was refused: an axis without numbers
        axes.set_xlim(0.0, 1.0)
        axes.set_xticks([])
        return
    ends = [end for bar in bars for end in _ends(bar, unit)]
    low, high = min(0.0, *ends), max(0.0, *ends)
    if min(values) <= 0 or max(values) / min(values) < _LOGARITHMIC_FROM:
        axes.set_xlim(low, low + (high - low) / (1 - _ROOM_FOR_VALUES))
        return
    start = _round_below(min([end for end in ends if end > 0]) / 1.3)
    axes.set_xscale("log", nonpositive="clip")
    axes.set_xlim(start, start * (high / start) ** (1 / (1 - _ROOM_FOR_VALUES)))
    decade_ticks(axes.xaxis, (1.0, 2.0, 5.0) if high / start < 2e3 else (1.0,))


def _round_below(x: float) -> float:
    decade = 10.0 ** math.floor(math.log10(x))
    return max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= x)


def _draw_series(axes: Axes, slots: Sequence[_Slot], unit: str, i: int) -> None:
    start = max(0.0, axes.get_xlim()[0])
    given = [(bar, y, from_si(bar.value_Pa, unit)) for bar, y in slots if bar.value_Pa is not None]
    # The bar that is not a number makes an entry in the legend even if all others were refused.
    positions = [math.nan, *(y for _, y, _ in given)]
    widths = [math.nan, *(value - start for _, _, value in given)]
    colour, hatch = _LOOKS[i % len(_LOOKS)]
    axes.barh(
        positions, widths, 0.82, left=start, label=slots[0][0].series,
        color=colour, hatch=hatch, edgecolor="black", lw=0.5,
    )  # fmt: skip
    _draw_whiskers(axes, given, unit)
    for bar, y in slots:
        if bar.value_Pa is None:
            _write(axes, start, y, "refused", "#555555", "italic")
        else:
            text = f"{_rounded(bar, unit)} (n = {bar.n})"
            _write(axes, max(0.0, *_ends(bar, unit)), y, text, "black", "normal")


def _draw_whiskers(axes: Axes, given: Sequence[tuple[ModulusBar, float, float]], unit: str) -> None:
    known = [(y, value, *bar.ci95_Pa) for bar, y, value in given if bar.ci95_Pa is not None]
    if not known:
        return
    y, values, low, high = (list(column) for column in zip(*known, strict=True))
    below = [value - from_si(end, unit) for value, end in zip(values, low, strict=True)]
    above = [from_si(end, unit) - value for value, end in zip(values, high, strict=True)]
    # A white border keeps the whisker visible on a dark bar.
    for width, shade in ((2.6, "white"), (1.0, "black")):
        axes.errorbar(
            values, y, xerr=[below, above],
            fmt="none", ecolor=shade, elinewidth=width, capsize=2.5, capthick=width,
        )  # fmt: skip


def _write(axes: Axes, x: float, y: float, text: str, colour: str, style: str) -> None:
    axes.annotate(
        text, (x, y), (5, 0), textcoords="offset points",
        va="center", fontsize=7.5, color=colour, fontstyle=style,
    )  # fmt: skip


def _rounded(bar: ModulusBar, unit: str) -> str:
    """Write a value to the second figure of half its interval, with two to four figures."""
    value = from_si(bar.value_Pa or 0.0, unit)
    figures = 3
    if bar.ci95_Pa is not None and bar.ci95_Pa[1] > bar.ci95_Pa[0] and value != 0:
        half = from_si((bar.ci95_Pa[1] - bar.ci95_Pa[0]) / 2, unit)
        ratio = math.floor(math.log10(abs(value))) - math.floor(math.log10(half))
        figures = min(max(ratio + 2, 2), 4)
    decimals = figures - 1 - math.floor(math.log10(abs(value))) if value != 0 else 0
    return f"{round(value, decimals):.{max(decimals, 0)}f}"
