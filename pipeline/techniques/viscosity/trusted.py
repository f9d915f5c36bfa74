"""Readings that a liquid cannot have caused: bubbles at the rotor, and a fall after the maximum."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.records import Flag
from deamat.estimators.curves.local_line import isolated_points
from deamat.formats.viscometer import lines_text
from deamat.techniques.viscosity.readings import Readings

_MOST_DEGREE, _READINGS_PER_TERM = 5, 4
_WINDOW = 7
# Bubbles that do less than this to a reading do less than 1 % to a law of eight.
_SLIGHT = 0.03
_MOST_ISOLATED = 0.2
_ROUNDS = 5
_BESIDE = 3
# A fall is one if it is beyond this, and beyond so many standard deviations of a reading.
_LEAST_FALL, _FALL_SDS = 0.015, 6.0
_END = 3


def without_isolated(readings: Readings) -> Readings:
    """Leave out, by line, readings far off those before and after them, such as bubbles make.

    More than a fifth of such readings are no exception, and stay: the law is then held to account.
    """
    kept, left_out = readings, 0
    for _ in range(_ROUNDS):
        if len(kept) < _WINDOW + _READINGS_PER_TERM:
            break
        found = isolated_points(np.log(kept.viscosity_Pas) - _trend(kept), _SLIGHT, _WINDOW)
        found = found[_stands_out(kept.viscosity_Pas, found)]
        if not found.size:
            break
        left_out += found.size
        good = np.ones(len(kept), dtype=bool)
        good[found] = False
        kept = kept.where(good)
    if left_out > _MOST_ISOLATED * len(readings):
        return readings
    if not left_out:
        return readings
    lines = readings.line[~np.isin(readings.line, kept.line)]
    flag = Flag(
        "outlying-readings",
        f"{left_out} of {len(readings)} readings lie far off those before and after them, as with "
        f"bubbles at the rotor: lines {lines_text(lines)} left out",
    )
    return replace(kept, flags=(*kept.flags, flag))


def _stands_out(viscosity: FloatArray, found: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Whether readings lie above or below all of those beside them that are not found as well.

    On a steep rise a reading that lies between its neighbours is one of it.
    """
    others = np.setdiff1d(np.arange(len(viscosity)), found)
    stands = []
    for i in found.tolist():
        at = int(np.searchsorted(others, i))
        beside = viscosity[others[max(0, at - _BESIDE) : at + _BESIDE]]
        one_sided = at == 0 or at == len(others)
        stands.append(
            not one_sided and not float(beside.min()) <= viscosity[i] <= float(beside.max())
        )
    return np.array(stands, dtype=bool)


def _trend(readings: Readings) -> FloatArray:
    """Polynomial through the logarithms, flexible enough to leave noise and exceptions behind."""
    t = readings.time_s
    x = 2.0 * (t - t[0]) / (t[-1] - t[0]) - 1.0 if t[-1] > t[0] else np.zeros_like(t)
    degree = min(_MOST_DEGREE, len(t) // _READINGS_PER_TERM)
    terms = np.polynomial.chebyshev.chebvander(x, degree)
    y = np.log(readings.viscosity_Pas)
    return np.asarray(terms @ np.linalg.lstsq(terms, y, rcond=None)[0])


def until_fall(readings: Readings) -> tuple[Readings, float | None]:
    """End a run at its maximum if viscosity falls from there to the end: slip, or a rod climbed.

    Returns
    -------
    the readings up to the maximum, and its time `[s]`; all readings and None where nothing falls
    """
    y = readings.viscosity_Pas
    if len(y) < 2 * _WINDOW:
        return readings, None
    middles = np.median(np.lib.stride_tricks.sliding_window_view(y, 5), axis=1)
    top = int(middles.argmax()) + 2
    if len(y) - 1 - top < _END:
        return readings, None
    end = float(np.median(y[-_END:]))
    fall = 1.0 - end / float(middles.max())
    logs = np.log(y)
    second = np.diff(logs, 2)  # of noise alone it has six times the variance of a reading
    sd = 1.4826 * float(np.median(np.abs(second))) / np.sqrt(6.0)
    if fall <= max(_LEAST_FALL, _FALL_SDS * sd):
        return readings, None
    at_s = float(readings.time_s[top])
    flag = Flag(
        "falls",
        f"viscosity falls by {fall:.1%} from {at_s / 3600:.3g} h after mixing to the end of the "
        "run, which no curing liquid does: it slips on the rotor or climbs it; the law ends where "
        "the fall begins",
    )
    cut = readings.where(slice(0, top + 1))
    return replace(cut, flags=(*cut.flags, flag)), at_s
