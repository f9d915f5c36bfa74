"""How each kind of mark is drawn, and what the legend says of it."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.chart import Band, Chart, Curve, Curves, Line, Mark, Note, Points, Window
from deamat.report.chart.scale import Scale
from deamat.report.chart.text import path_of, tag, titled, words
from deamat.report.chart.thin import thin

# Okabe and Ito without yellow, which is lost on white, and with wine for black, which fits have.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#882255", "#CC79A7", "#E69F00", "#56B4E9")
_DASHES = ("", "8 2", "8 2 2 2", "2 2")  # colours of one lightness are one grey: dashes tell them
FEW = 7  # curves that a legend names one by one
_MANY = "#4477AA"
_TENTHS = 10.0  # paths are written in tenths of a pixel, as whole numbers


@dataclass(frozen=True, slots=True)
class Place:
    """The scales of a plotting area."""

    x: Scale
    y: Scale
    right: Scale | None

    def upright(self, right: bool) -> Scale:
        """Return the scale of one of both sides."""
        return self.right if right and self.right is not None else self.y


@dataclass(frozen=True, slots=True)
class Entry:
    """One entry of a legend: its swatch, drawn around the origin, and its text."""

    swatch: str
    text: str


def drawn(chart: Chart, place: Place) -> str:
    """Draw all marks of a chart."""
    return "".join(_draw(mark, place) for mark in chart.marks)


def entries(chart: Chart) -> list[Entry]:
    """List what the legend says, each text once."""
    found = {entry.text: entry for mark in chart.marks for entry in _entries(mark) if entry.text}
    return list(found.values())


def extents(chart: Chart) -> tuple[list[FloatArray], list[FloatArray], list[FloatArray]]:
    """Return all numbers along x, along the left and along the right axis."""
    x: list[FloatArray] = []
    sides: dict[bool, list[FloatArray]] = {False: [], True: []}
    for mark in chart.marks:
        match mark:
            case Curves():
                x += [curve.x for curve in mark.curves]
                sides[mark.right] += [curve.y for curve in mark.curves]
            case Line():
                x.append(mark.x)
                sides[False].append(mark.y)
            case Band():
                across = x if mark.sideways else sides[False]
                (sides[False] if mark.sideways else x).append(mark.along)
                across += [mark.low, mark.high]
            case Points():
                ends = [end for end in (mark.low, mark.high) if end is not None]
                x += [mark.x, *(ends if mark.sideways else [])]
                sides[mark.right] += [mark.y, *([] if mark.sideways else ends)]
            case Window() | Note():
                pass
    return x, sides[False], sides[True]


def _draw(mark: Mark, place: Place) -> str:
    match mark:
        case Curves():
            return "".join(_curves(mark, place))
        case Line():
            (path,) = _paths([Curve("", mark.x, mark.y)], place.x, place.y)
            return _law(mark, path)
        case Band():
            return _band(mark, place)
        case Points():
            return "".join(_points(mark, place))
        case Window():
            low, high = sorted((place.x.at(mark.low), place.x.at(mark.high)))
            low, high = max(low, place.x.start), min(high, place.x.end)
            top, height = min(place.y.start, place.y.end), abs(place.y.end - place.y.start)
            return tag("rect", class_="window", x=low, y=top, width=max(high - low, 0.0),
                       height=height)  # fmt: skip
        case Note():
            kind = "note aside" if mark.aside else "note"
            return words(mark.text, place.x.at(mark.x) + 7, place.y.at(mark.y) + 3.5, class_=kind)


def _entries(mark: Mark) -> Iterator[Entry]:
    line = "M-110 0H110"
    match mark:
        case Curves() if mark.right:
            return
        case Curves() if len(mark.curves) > FEW:
            style = _look(0, many=True)
            swatch = _dot(0.0, 0.0, _MANY) if mark.points else _stroke(line, style)
            yield Entry(swatch, f"{len(mark.curves)} {mark.label}s")
        case Curves():
            for i, curve in enumerate(mark.curves):
                swatch = _stroke(line, _look(i))
                yield Entry(_dot(0.0, 0.0, _colour(i)) if mark.points else swatch, curve.name)
        case Line():
            yield Entry(_law(mark, line), mark.label)
        case Band() | Window():
            kind = "band" if isinstance(mark, Band) else "window"
            yield Entry(tag("rect", class_=kind, x=-11, y=-5, width=22, height=10), mark.label)
        case Points():
            yield Entry(_shape(mark, 0.0, 0.0, ""), mark.label)
        case Note():
            return


def _stroke(d: str, look: Mapping[str, object], title: str = "") -> str:
    """Write a path whose places are tenths of a pixel."""
    return tag("path", title, d=d, transform="scale(.1)", **look) if d else ""


def _law(mark: Line, d: str) -> str:
    dashes = {"stroke_dasharray": "60 30"} if mark.dashed else {}
    return _stroke(d, {"class_": "law", "stroke_width": 22 if mark.heavy else 13, **dashes})


def _curves(mark: Curves, place: Place) -> Iterator[str]:
    many = len(mark.curves) > FEW
    shown = [c for c in mark.curves if c.x.size]
    if mark.points:
        for i, curve in enumerate(shown):
            colour = _MANY if many else _colour(i)
            places = zip(place.x(curve.x), place.upright(mark.right)(curve.y), strict=True)
            dots = "".join(_dot(x, y, colour) for x, y in places if np.isfinite(x + y))
            yield tag("g", titled(curve.name) + dots)
        return
    paths = _paths(shown, place.x, place.upright(mark.right)) if shown else []
    for i, (path, curve) in enumerate(zip(paths, shown, strict=True)):
        style = _look(i, many)
        if mark.right:
            style |= {"stroke_dasharray": "15 20", "stroke_width": 9}
        yield _stroke(path, style, titled(curve.name))


def _paths(curves: Sequence[Curve], x: Scale, y: Scale) -> list[str]:
    """Write the paths of curves, thinned; where a sample is missing, a path begins anew."""
    xs, ys = x(np.concatenate([c.x for c in curves])), y(np.concatenate([c.y for c in curves]))
    ends = np.cumsum([c.x.size for c in curves])
    good = np.isfinite(xs) & np.isfinite(ys)
    begins = good & ~np.append(False, good[:-1])  # after a gap
    begins[[end for end in ends.tolist()[:-1] if end < xs.size]] = True
    begins, xs, ys = (begins & good)[good], xs[good], ys[good]
    ends = np.append(0, np.cumsum(good))[ends]
    if not xs.size:
        return [""] * len(curves)
    kept = thin(xs, ys, np.flatnonzero(begins))
    tx, ty = _in_tenths(xs[kept]), _in_tenths(ys[kept])
    starts = [*np.flatnonzero(begins[kept]).tolist(), kept.size]
    pieces = [path_of(tx[a:b], ty[a:b]) for a, b in itertools.pairwise(starts)]
    counts = np.searchsorted(np.flatnonzero(begins), ends).tolist()
    return ["".join(pieces[a:b]) for a, b in itertools.pairwise([0, *counts])]


def _in_tenths(places: FloatArray) -> list[int]:
    return [int(place) for place in np.rint(_TENTHS * np.clip(places, -9e3, 9e3)).tolist()]


def _band(mark: Band, place: Place) -> str:
    if mark.sideways:
        along, ends = place.y(mark.along), [place.x(mark.low), place.x(mark.high)]
    else:
        along, ends = place.x(mark.along), [place.y(mark.low), place.y(mark.high)]
    good = np.isfinite(along) & np.isfinite(ends[0]) & np.isfinite(ends[1])
    if not good.any():
        return ""
    around = np.concatenate([along[good], along[good][::-1]])
    across = np.concatenate([ends[0][good], ends[1][good][::-1]])
    xs, ys = (across, around) if mark.sideways else (around, across)
    return _stroke(path_of(_in_tenths(xs), _in_tenths(ys)) + "Z", {"class_": "band"})


def _points(mark: Points, place: Place) -> Iterator[str]:
    upright = place.upright(mark.right)
    xs, ys = place.x(mark.x), upright(mark.y)
    if mark.low is not None and mark.high is not None:
        along = place.x if mark.sideways else upright
        edges = [along.start, along.end]
        lows, highs = (
            np.clip(np.nan_to_num(along(end), nan=along.start), min(edges), max(edges))
            for end in (mark.low, mark.high)
        )
        for x, y, low, high in zip(xs, ys, lows, highs, strict=True):
            if not np.isfinite(x + y):
                continue
            if mark.sideways:
                d = f"M{low:.1f} {y - 3:.1f}v6m0-3H{high:.1f}m0-3v6"
            else:
                d = f"M{x - 3:.1f} {low:.1f}h6m-3 0V{high:.1f}m-3 0h6"
            yield tag("path", d=d, class_="whisker", stroke=_of(mark))
    names = mark.names or ("",) * len(xs)
    for x, y, name in zip(xs, ys, names, strict=True):
        if np.isfinite(x + y):
            yield _shape(mark, float(x), float(y), name)


def _of(mark: Points) -> str:
    return "currentColor" if mark.series is None else _colour(mark.series)


def _shape(mark: Points, x: float, y: float, name: str) -> str:
    colour, title = _of(mark), titled(name)
    match mark.shape:
        case "dot":
            return tag("circle", title, cx=x, cy=y, r=3.2, fill=colour)
        case "ring":
            return tag("circle", title, cx=x, cy=y, r=3.2, class_="open", stroke=colour)
        case "cross":
            d = f"M{x - 3:.1f} {y - 3:.1f}l6 6m-6 0l6-6"
        case "stroke":
            d = f"M{x:.1f} {y - 5:.1f}v10"
        case "triangle":
            d = f"M{x - 3:.1f} {y - 3.5:.1f}l7 3.5l-7 3.5z"
    return tag("path", title, d=d, class_="open", stroke=colour)


def _dot(x: float, y: float, colour: str) -> str:
    return tag("circle", cx=float(x), cy=float(y), r=1.8, fill=colour)


def _colour(i: int) -> str:
    return COLOURS[i % len(COLOURS)]


def _look(i: int, many: bool = False) -> dict[str, object]:
    if many:
        return {"class_": "curve", "stroke": _MANY, "stroke_width": 7, "stroke_opacity": 0.45}
    dash = _DASHES[i % len(_DASHES)]
    look: dict[str, object] = {"class_": "curve", "stroke": _colour(i), "stroke_width": 11}
    return look | ({"stroke_dasharray": " ".join(f"{d}0" for d in dash.split())} if dash else {})
