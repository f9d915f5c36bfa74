"""A chart as a value: what a figure shows, in the units that its axes name; the report draws it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from deamat.core.arrays import FloatArray

Spacing = Literal["linear", "log"]
Shape = Literal["dot", "ring", "cross", "stroke", "triangle"]


@dataclass(frozen=True, slots=True)
class Axis:
    """One axis.

    Parameters
    ----------
    label : what it shows, with its unit: `nominal strain [%]`
    limits : None fits the data
    ticks : values and their texts; None chooses round numbers
    downwards : of an upright axis: its numbers grow from the top, as one reads
    """

    label: str
    spacing: Spacing = "linear"
    limits: tuple[float, float] | None = None
    ticks: tuple[tuple[float, str], ...] | None = None
    downwards: bool = False


@dataclass(frozen=True, slots=True)
class Curve:
    """The samples of one specimen, shape (n,) each."""

    name: str
    x: FloatArray
    y: FloatArray


@dataclass(frozen=True, slots=True)
class Curves:
    """The curves of a sample: few are told apart by colour and name, many are one collection.

    Parameters
    ----------
    label : what one of them is: `specimen`
    right : they belong to the axis on the right, and are dotted
    points : samples are marked one by one, not joined
    """

    curves: tuple[Curve, ...]
    label: str = "specimen"
    right: bool = False
    points: bool = False


@dataclass(frozen=True, slots=True)
class Line:
    """A line that stands for all specimens: a law, a mean, a fit; an empty label has no entry."""

    x: FloatArray
    y: FloatArray
    label: str = ""
    dashed: bool = False
    heavy: bool = False


@dataclass(frozen=True, slots=True)
class Band:
    """The range between two lines: in y over `along` = x, or (`sideways`) in x over `along` = y."""

    along: FloatArray
    low: FloatArray
    high: FloatArray
    label: str = ""
    sideways: bool = False


@dataclass(frozen=True, slots=True)
class Points:
    """Single values, with their intervals where there are any.

    Parameters
    ----------
    x, y : shape (n,) each
    low, high : ends of the interval of each, shape (n,) each; None for none
    sideways : the intervals lie along x
    names : what each point is, shown where one points at it
    series : chooses the colour; None is black
    right : they belong to the axis on the right
    """

    x: FloatArray
    y: FloatArray
    label: str = ""
    shape: Shape = "dot"
    low: FloatArray | None = None
    high: FloatArray | None = None
    sideways: bool = False
    names: tuple[str, ...] = ()
    series: int | None = None
    right: bool = False


@dataclass(frozen=True, slots=True)
class Window:
    """The range of x that a value was taken from."""

    low: float
    high: float
    label: str = ""


@dataclass(frozen=True, slots=True)
class Note:
    """A text to the right of a place in the data."""

    x: float
    y: float
    text: str
    aside: bool = False  # what is missing: in grey


Mark = Curves | Line | Band | Points | Window | Note


@dataclass(frozen=True, slots=True)
class Chart:
    """What one figure shows.

    Parameters
    ----------
    marks : drawn in this order
    says : lines under the title: values with n and interval
    right : a second upright axis
    inset : the range of x that a small picture in the corner shows again, larger; None for none
    height_px : of the plotting area
    """

    x: Axis
    y: Axis
    marks: tuple[Mark, ...]
    says: tuple[str, ...] = ()
    right: Axis | None = None
    inset: tuple[float, float] | None = None
    height_px: float = 330.0
