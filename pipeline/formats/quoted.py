"""Numbers in double quotes with thousands commas inside, made plain without looking at cells."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_QUOTE, _COMMA, _LINE = b'",\n'
_MARGIN = b"\n" * 5  # so that no look to the left or right leaves the text


def _table(characters: bytes) -> NDArray[np.bool_]:
    table = np.zeros(256, dtype=np.bool_)
    table[list(characters)] = True
    return table


_DIGIT = _table(b"0123456789")
_EDGE = _table(b"\t\n")
_START = _table(b'",+-')  # what may stand before the digits of a group


def unquote(block: bytes) -> bytes | None:
    """Turn comma-separated, partly quoted rows into tab-separated plain ones.

    Parameters
    ----------
    block : rows without their last line end

    Returns
    -------
    the same rows, or None unless every quote opens and closes a whole field and every comma
    inside quotes parts whole groups of three digits
    """
    if b"\t" in block:
        return None
    text = np.frombuffer(_MARGIN + block + _MARGIN, dtype=np.uint8).copy()
    quote = text == _QUOTE
    inside = np.logical_xor.accumulate(quote)  # from an opening quote on
    if inside[-1] or inside[np.flatnonzero(text == _LINE)].any():
        return None
    comma = text == _COMMA
    grouping = np.flatnonzero(comma & inside)
    text[comma & ~inside] = ord("\t")
    quotes = np.flatnonzero(quote)
    opens, closes = quotes[::2], quotes[1::2]
    if not (_EDGE[text[opens - 1]].all() and _EDGE[text[closes + 1]].all()):
        return None
    if grouping.size:
        if b"e" in block or b"E" in block:
            return None  # a sign before a group could belong to an exponent
        if not _groups_of_three(text, grouping):
            return None
    text[grouping] = _QUOTE
    return text[len(_MARGIN) : -len(_MARGIN)].tobytes().translate(None, b'"')


def _groups_of_three(text: NDArray[np.uint8], at: NDArray[np.intp]) -> bool:
    """Say whether every comma stands between one to three digits and exactly three."""
    one, two, three = (_DIGIT[text[at - step]] for step in (1, 2, 3))
    ahead = one & (
        _START[text[at - 2]] | (two & (_START[text[at - 3]] | (three & _START[text[at - 4]])))
    )
    behind = _DIGIT[text[at + 1]] & _DIGIT[text[at + 2]] & _DIGIT[text[at + 3]]
    return bool((ahead & behind & ~_DIGIT[text[at + 4]]).all())
