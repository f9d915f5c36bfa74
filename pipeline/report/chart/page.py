"""One chart as one SVG file: its title, axes, marks, inset and legend."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from deamat.core.chart import Axis, Chart, Curve, Curves, Line, Mark
from deamat.report.chart.marks import Entry, Place, drawn, entries, extents
from deamat.report.chart.scale import scale_of, ticks_of
from deamat.report.chart.text import broken, clean, shortened, tag, width_of, words

MARK = "SYNTHETIC DATA"
MARK_MEANING = f"{MARK}: simulated, not measured"

WIDTH_px = 680.0
_LEFT_px, _RIGHT_px, _RIGHT_AXIS_px = 66.0, 18.0, 62.0
_TITLE_px, _SAYS_px, _LEGEND_px = 14.0, 12.0, 11.0
_LINE = 1.45  # of the size of a text
_ENTRY_CHARACTERS = 80
_TICK_px, _CHARACTER_px = 11.0, 6.4

_STYLE = """
text{font-family:'DejaVu Sans',Verdana,Helvetica,Arial,sans-serif;fill:#1a1a1a}
.paper{fill:#fff}.frame{stroke:#1a1a1a;fill:none}.grid{stroke:#ddd;stroke-width:.6;fill:none}
.tick,.legend,.note{font-size:11px}.label{font-size:12px}.says{font-size:12px}.aside{fill:#555;font-style:italic}
.title{font-size:14px;font-weight:700}.curve{fill:none;stroke-linejoin:round}
.law{fill:none;stroke:#000;stroke-linejoin:round}.band{fill:#666;fill-opacity:.2}
.window{fill:#888;fill-opacity:.15}.whisker{fill:none;stroke-width:1.1}.open{fill:none;stroke-width:1.3}
.mark{fill:#b00000;font-weight:700}
""".replace("\n", "")


def picture(chart: Chart, title: str, synthetic: bool) -> bytes:
    """Draw a chart; the same chart becomes the same bytes.

    Parameters
    ----------
    synthetic : the data are simulated: the picture says so above and across its data
    """
    parts: list[str] = []
    top = 20.0
    for line in broken(title, WIDTH_px - 20.0, _TITLE_px, bold=True):
        parts.append(words(line, 10.0, top, class_="title"))
        top += _LINE * _TITLE_px
    if synthetic:
        parts.append(words(MARK_MEANING, 10.0, top, class_="mark says"))
        top += _LINE * _SAYS_px
    for said in chart.says:
        for line in broken(said, WIDTH_px - 20.0, _SAYS_px):
            parts.append(words(line, 10.0, top, class_="says"))
            top += _LINE * _SAYS_px
    area, bottom = _area(chart, top)
    parts.append(area)
    legend, height = _legend(entries(chart), bottom + 10.0)
    parts.append(legend)
    if synthetic:
        parts.append(_across(top, bottom))
    about = MARK_MEANING if synthetic else "measured data"
    head = f"<title>{clean(title)}</title><desc>{clean(about)}</desc><style>{_STYLE}</style>"
    body = head + tag("rect", width=WIDTH_px, height=height, class_="paper") + "".join(parts)
    whole = tag(
        "svg", body, xmlns="http://www.w3.org/2000/svg", width=WIDTH_px, height=height,
        viewBox=f"0 0 {WIDTH_px:g} {height:g}", role="img", font_size=11,
    )  # fmt: skip
    return f"{whole}\n".encode()


def _area(chart: Chart, top: float) -> tuple[str, float]:
    """Draw axes and marks below `top`; return where they end as well."""
    left = _left_of(chart)
    right = WIDTH_px - (_RIGHT_AXIS_px if chart.right else _RIGHT_px)
    place = _place(chart, left, right, top + 8.0, chart.height_px)
    parts = list(_axes(chart, place))
    box = (left, top + 8.0, right - left, chart.height_px)
    parts.append(_clipped("area", box, drawn(chart, place)))
    if chart.inset is not None:
        parts += _inset(chart, place)
    foot = box[1] + box[3]
    parts.append(words(
        chart.x.label, (left + right) / 2, foot + 34.0, class_="label", text_anchor="middle"
    ))  # fmt: skip
    middle = box[1] + box[3] / 2
    parts.append(_turned(chart.y.label, 16.0, middle))
    if chart.right is not None:
        parts.append(_turned(chart.right.label, WIDTH_px - 10.0, middle))
    return "".join(parts), foot + 38.0


def _left_of(chart: Chart) -> float:
    own = [text for _, text in chart.y.ticks or ()]
    return max([_LEFT_px, *(38.0 + width_of(shortened(t, 28), _TICK_px) for t in own)])


def _place(chart: Chart, left: float, right: float, top: float, height: float) -> Place:
    x, y, other = extents(chart)
    foot = top + height
    ends = (top, foot) if chart.y.downwards else (foot, top)
    return Place(
        scale_of(chart.x, x, left, right),
        scale_of(chart.y, y, *ends),
        None if chart.right is None else scale_of(chart.right, other, foot, top),
    )


def _axes(chart: Chart, place: Place) -> Iterator[str]:
    """Draw grid, frame and numbers."""
    left, right = place.x.start, place.x.end
    top, foot = sorted((place.y.start, place.y.end))
    most = max(2, int((right - left) / 62.0))
    for value, text in ticks_of(chart.x, place.x, most):
        x = place.x.at(value)
        yield tag("path", d=f"M{x:.1f} {foot:.1f}V{top:.1f}", class_="grid")
        yield words(text, x, foot + 15.0, class_="tick", text_anchor="middle")
    for value, text in ticks_of(chart.y, place.y, max(2, int((foot - top) / 38.0))):
        y = place.y.at(value)
        yield tag("path", d=f"M{left:.1f} {y:.1f}H{right:.1f}", class_="grid")
        yield words(shortened(text, 28), left - 6.0, y + 4.0, class_="tick", text_anchor="end")
    if chart.right is not None and place.right is not None:
        for value, text in ticks_of(chart.right, place.right, max(2, int((foot - top) / 38.0))):
            yield words(text, right + 6.0, place.right.at(value) + 4.0, class_="tick")
        yield tag("path", d=f"M{right:.1f} {top:.1f}V{foot:.1f}", class_="frame")
    yield tag("path", d=f"M{left:.1f} {top:.1f}V{foot:.1f}H{right:.1f}", class_="frame")


def _clipped(name: str, box: tuple[float, float, float, float], body: str) -> str:
    x, y, width, height = box
    clip = tag("clipPath", tag("rect", x=x, y=y, width=width, height=height), id=name)
    return clip + tag("g", body, clip_path=f"url(#{name})")


def _inset(chart: Chart, place: Place) -> Iterator[str]:
    """Show a range of x again, larger, in the corner above the data."""
    if chart.inset is None:
        return
    low, high = chart.inset
    near = [_within(mark, low, high) for mark in chart.marks]
    small = replace(
        chart, x=Axis("", limits=(low, high)), y=Axis(""), marks=tuple(near), inset=None, says=()
    )
    width, height = 0.36 * (place.x.end - place.x.start), 0.36 * abs(place.y.end - place.y.start)
    left, top = place.x.start + 44.0, min(place.y.start, place.y.end) + 8.0
    inner = _place(small, left, left + width, top, height)
    yield tag("rect", x=left - 40.0, y=top - 6.0, width=width + 52.0, height=height + 26.0,
              class_="paper", fill_opacity=0.85)  # fmt: skip
    yield from _axes(small, inner)
    yield _clipped("inset", (left, top, width, height), drawn(small, inner))


def _within(mark: Mark, low: float, high: float) -> Mark:
    """Keep of lines what lies in a range of x, so that the axis upright fits it."""
    if isinstance(mark, Curves):
        return replace(mark, curves=tuple(_cut(curve, low, high) for curve in mark.curves))
    if isinstance(mark, Line):
        cut = _cut(Curve("", mark.x, mark.y), low, high)
        return replace(mark, x=cut.x, y=cut.y)
    return mark


def _cut(curve: Curve, low: float, high: float) -> Curve:
    inside = np.flatnonzero((curve.x >= low) & (curve.x <= high))
    if not inside.size:
        return replace(curve, x=curve.x[:0], y=curve.y[:0])
    chosen = slice(int(inside[0]), int(inside[-1]) + 1)
    return replace(curve, x=curve.x[chosen], y=curve.y[chosen])


def _turned(text: str, x: float, y: float) -> str:
    return words(
        text, x, y, class_="label", text_anchor="middle", transform=f"rotate(-90 {x:g} {y:g})"
    )


def _legend(items: Sequence[Entry], top: float) -> tuple[str, float]:
    """Set entries side by side in rows; return where they end as well."""
    parts: list[str] = []
    x, y = 14.0, top + 8.0
    for entry in items:
        text = shortened(entry.text, _ENTRY_CHARACTERS)
        width = 34.0 + width_of(text, _LEGEND_px) + 14.0
        if x > 14.0 and x + width > WIDTH_px - 10.0:
            x, y = 14.0, y + 18.0
        swatch = tag("g", entry.swatch, transform=f"translate({x + 12:g} {y - 4:g})")
        parts.append(swatch + words(text, x + 30.0, y, class_="legend"))
        x += width
    return "".join(parts), (y + 14.0 if items else top)


def _across(top: float, bottom: float) -> str:
    """Letters over the data, which no crop takes away."""
    times = max(1, round((bottom - top) / 500.0))
    size = min(52.0, 0.3 * (bottom - top))
    parts = []
    for i in range(times):
        x, y = WIDTH_px / 2, top + (i + 0.5) / times * (bottom - top)
        parts.append(words(
            MARK, x, y, class_="mark", font_size=size, opacity=0.16, text_anchor="middle",
            transform=f"rotate(-20 {x:g} {y:g})", pointer_events="none",
        ))  # fmt: skip
    return "".join(parts)
