"""The chart of all moduli of a campaign: a point with its interval for each."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from deamat.core.chart import Axis, Chart, Mark, Note, Points
from deamat.core.units import from_si
from deamat.report.moduli import ModulusBar

_LOGARITHMIC_FROM = 20.0  # largest over smallest modulus
_ROOM_FOR_VALUES = 0.24  # of the axis, to the right of the longest interval
_GAP = 0.7  # between materials, in rows
_ROW_px = 19.0

_Slot = tuple[ModulusBar, float]  # a modulus and its row


def moduli_chart(bars: Sequence[ModulusBar]) -> Chart:
    """Show the moduli grouped by material, in the order of their appearance.

    A refused one keeps its row and says so. Where the moduli span more than 1:20 the axis is
    logarithmic. The chart is as high as its rows ask for.

    Raises
    ------
    ValueError : there are no bars

    Source: the content of Figure 9B of Sikulskyi et al. 2022, Front. Robot. AI 9:1034914.
    """
    if not bars:
        raise ValueError("there is no modulus to show")
    unit = _unit(bars)
    series = list(dict.fromkeys(bar.series for bar in bars))
    slots: list[_Slot] = []
    ticks: list[tuple[float, str]] = []
    top = 0.0
    for material in dict.fromkeys(bar.material for bar in bars):
        mine = [b for name in series for b in bars if (b.material, b.series) == (material, name)]
        slots += [(bar, top + i) for i, bar in enumerate(mine)]
        ticks.append((top + (len(mine) - 1) / 2, material))
        top += len(mine) + _GAP
    axis = _axis(bars, unit)
    marks: list[Mark] = []
    for number, name in enumerate(series):
        marks.append(_points([s for s in slots if s[0].series == name], unit, number))
    marks += _notes(slots, unit, axis)
    upright = Axis("material", limits=(-0.8, top - _GAP - 0.2), ticks=tuple(ticks), downwards=True)
    return Chart(axis, upright, tuple(marks), height_px=max(80.0, _ROW_px * top))


def _unit(bars: Sequence[ModulusBar]) -> str:
    values = [abs(bar.value_Pa) for bar in bars if bar.value_Pa is not None]
    return "MPa" if values and min(values) >= 1e6 else "kPa"


def _ends(bar: ModulusBar, unit: str) -> list[float]:
    known = [bar.value_Pa, *(bar.ci95_Pa or ())]
    return [from_si(x, unit) for x in known if x is not None]


def _axis(bars: Sequence[ModulusBar], unit: str) -> Axis:
    label = f"modulus [{unit}]; whiskers: 95 % confidence interval"
    values = [from_si(bar.value_Pa, unit) for bar in bars if bar.value_Pa is not None]
    if not values:  # everything was refused: an axis without numbers
        return Axis(label, limits=(0.0, 1.0), ticks=())
    ends = [end for bar in bars for end in _ends(bar, unit)]
    low, high = min(0.0, *ends), max(0.0, *ends)
    if min(values) <= 0 or max(values) / min(values) < _LOGARITHMIC_FROM:
        return Axis(label, limits=(low, low + (high - low) / (1 - _ROOM_FOR_VALUES)))
    start = min(end for end in ends if end > 0) / 1.3
    return Axis(
        label, "log", limits=(start, start * (high / start) ** (1 / (1 - _ROOM_FOR_VALUES)))
    )


def _points(slots: Sequence[_Slot], unit: str, number: int) -> Points:
    given = [(bar, y, from_si(bar.value_Pa, unit)) for bar, y in slots if bar.value_Pa is not None]
    ends = [
        (value, value) if bar.ci95_Pa is None else tuple(from_si(e, unit) for e in bar.ci95_Pa)
        for bar, _, value in given
    ]
    low, high = np.array(ends, np.float64).reshape(-1, 2).T
    return Points(
        np.array([value for _, _, value in given]), np.array([y for _, y, _ in given]),
        slots[0][0].series, low=low, high=high, sideways=True, series=number,
    )  # fmt: skip


def _notes(slots: Sequence[_Slot], unit: str, axis: Axis) -> Iterator[Note]:
    start = axis.limits[0] if axis.limits else 0.0
    for bar, y in slots:
        if bar.value_Pa is None:
            yield Note(start, y, "refused", aside=True)
        else:
            yield Note(max(_ends(bar, unit)), y, f"{_rounded(bar, unit)} (n = {bar.n})")


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
