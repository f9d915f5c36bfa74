"""Numbers in double quotes with thousands commas inside, made plain without looking at cells."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_QUOTE, _COMMA, _LINE = b'",\n'
_STARTS = np.frombuffer(b'",+-', dtype=np.uint8)  # what may stand before the digits of a group
_MARGIN = b"\n" * 5  # so that no look to the left or right leaves the text


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
    text = np.frombuffer(_MARGIN + block + _MARGIN, dtype=np.uint8)
    quote = text == _QUOTE
    inside = (np.cumsum(quote, dtype=np.uint8) & 1).astype(bool)  # from an opening quote on
    if inside[-1] or (inside & (text == _LINE)).any():
        return None
    comma = text == _COMMA
    opens, closes = np.flatnonzero(quote & inside), np.flatnonzero(quote & ~inside)
    before, after = opens - 1, closes + 1
    edges = (comma | (text == _LINE)) & ~inside
    if not (edges[before].all() and edges[after].all()):
        return None
    grouping = comma & inside
    if grouping.any() and not _groups_of_three(text, np.flatnonzero(grouping)):
        return None
    plain = text.copy()
    plain[comma & ~inside] = ord("\t")
    kept = plain[~(quote | grouping)][len(_MARGIN) : -len(_MARGIN)]
    return bytes(kept)


def _groups_of_three(text: NDArray[np.uint8], at: NDArray[np.intp]) -> bool:
    """Say whether every comma stands between one to three digits and exactly three."""
    if np.isin(text, np.frombuffer(b"eE", dtype=np.uint8)).any():
        return False  # a sign before a group could belong to an exponent
    digit = (text >= ord("0")) & (text <= ord("9"))
    start = np.isin(text, _STARTS)
    behind = digit[at + 1] & digit[at + 2] & digit[at + 3] & ~digit[at + 4]
    three = digit[at - 3] & start[at - 4]
    ahead = digit[at - 1] & (start[at - 2] | (digit[at - 2] & (start[at - 3] | three)))
    return bool((behind & ahead).all())
