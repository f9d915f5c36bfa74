"""Texts of a chart: how wide they will be, broken into lines, written so that SVG takes them."""

from __future__ import annotations

from collections.abc import Sequence
from xml.sax.saxutils import escape, quoteattr

_NARROW, _WIDE = frozenset("iljtfI.,:;|!'()[] -/"), frozenset("mwMW@%ABCDEFGHKNOPQRSUVXYZ±")
_EM = {True: 1.14, False: 1.0}  # bold letters are wider


def width_of(text: str, size_px: float, bold: bool = False) -> float:
    """Estimate how wide a text is in a common sans-serif face, rather too wide `[px]`."""
    narrow = sum(c in _NARROW for c in text)
    wide = sum(c in _WIDE for c in text)
    far = sum(ord(c) > 0x2E7F for c in text)  # Chinese, Japanese, Korean
    plain = len(text) - narrow - wide - far
    return size_px * _EM[bold] * (0.34 * narrow + 0.63 * plain + 0.8 * wide + 1.0 * far)


def broken(text: str, width_px: float, size_px: float, bold: bool = False) -> list[str]:
    """Break a text into lines that are no wider than this, at spaces, or anywhere if it must."""
    lines: list[str] = []
    line = ""
    for word in text.split(" "):
        longer = f"{line} {word}" if line else word
        if width_of(longer, size_px, bold) <= width_px:
            line = longer
            continue
        if line:
            lines.append(line)
        while width_of(word, size_px, bold) > width_px and len(word) > 1:
            fits = next(
                n for n in range(len(word), 0, -1)
                if n == 1 or width_of(word[:n], size_px, bold) <= width_px
            )  # fmt: skip
            lines.append(word[:fits])
            word = word[fits:]
        line = word
    return [*lines, line]


def shortened(text: str, characters: int) -> str:
    """Shorten a text in its middle."""
    if len(text) <= characters:
        return text
    half = (characters - 1) // 2
    return f"{text[:half]}…{text[-half:]}"


def tag(name: str, body: str = "", **attributes: object) -> str:
    """Write an element; `class_` and `font_size` become `class` and `font-size`."""
    told = "".join(
        f" {key.rstrip('_').replace('_', '-')}={quoteattr(_written(value))}"
        for key, value in attributes.items()
    )
    return f"<{name}{told}>{body}</{name}>" if body else f"<{name}{told}/>"


def words(text: str, x: float, y: float, **attributes: object) -> str:
    """Write a text at a place."""
    return tag("text", clean(text), x=x, y=y, **attributes)


def titled(text: str) -> str:
    """Return the text that is shown where one points at an element."""
    return tag("title", clean(text)) if text else ""


def clean(text: str) -> str:
    """Escape a text, without characters that XML cannot hold."""
    return escape("".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text))


def _written(value: object) -> str:
    return f"{round(value, 2) + 0.0:g}" if isinstance(value, float) else str(value)


def path_of(xs: Sequence[int], ys: Sequence[int]) -> str:
    """Write a path through places in tenths of a pixel."""
    return "M" + " ".join([f"{x} {y}" for x, y in zip(xs, ys, strict=True)])
