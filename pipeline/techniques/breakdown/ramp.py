"""Finds the breakdown in a high-voltage ramp, and says how steadily the voltage rose to it.

Of a ramp only four things can become: the voltage collapses (a breakdown), it reaches the limit of
the amplifier, somebody turns it down, or the file ends. All but the first leave a specimen unbroken
at the greatest voltage that it has borne. A part of the voltage that is lost and comes back is a
flashover through the air around the film: it is counted, and the ramp goes on.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused

End = Literal["collapse", "amplifier limit", "turned down", "file ended", "flashover"]

_FEWEST = 5  # samples with voltage on them, below which there is no ramp to speak of
_PARTS = 8  # of the ramp, whose rates of rise are compared
_FEWEST_IN_PART = 4
_JUMP = 0.05  # of the greatest voltage: the step to the voltage from which the slow rise starts
_JUMP_STEPS = 10.0  # and so many usual steps
_FOOT = 0.02  # of the greatest voltage: below it the ramp has not begun, and all is noise


@dataclass(frozen=True, slots=True)
class Criteria:
    """What counts as what; see `BreakdownConfig` for the meaning of each.

    Parameters
    ----------
    limit_V, limit_tolerance : amplifier limit and how near to it counts as reaching it
    dip, collapse : parts of the voltage whose loss is noticed, and is a collapse
    collapse_steps : sampling steps within which a collapse happens
    spike_A, spike_noise : least current of a spike, and in standard deviations of what was before
    """

    limit_V: float
    limit_tolerance: float
    dip: float
    collapse: float
    collapse_steps: int
    spike_A: float
    spike_noise: float


@dataclass(frozen=True, slots=True)
class Breakdown:
    """What became of one ramp.

    Parameters
    ----------
    voltage_V : greatest voltage before the end: of breakdown, or borne unbroken
    broken : False where the specimen is right-censored at `voltage_V`
    end : what ended the ramp
    peak : sample at which `voltage_V` stands
    step_V : rise in the sampling step in which it broke: it may have broken so much higher
    spike_A : greatest current around the collapse, None without a current channel or a collapse
    flashovers : voltages at which a part was lost and came back `[V]`
    """

    voltage_V: float
    broken: bool
    end: End
    peak: int
    step_V: float
    spike_A: float | None
    flashovers: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Rise:
    """How the voltage rose.

    Parameters
    ----------
    start_V : voltage from which the ramp rose
    duration_s : from there to the greatest voltage
    rate_V_per_s : least-squares slope between the two
    slowest, fastest : of the slopes of its parts, relative to `rate_V_per_s`; both 1 where there
        are too few samples to tell
    """

    start_V: float
    duration_s: float
    rate_V_per_s: float
    slowest: float
    fastest: float


def find_breakdown(
    voltage_V: FloatArray, current_A: FloatArray | None, criteria: Criteria
) -> Breakdown:
    """Find the first collapse of the voltage, or what else ended the ramp.

    With a current channel a collapse is a breakdown only if the current spikes with it: an
    amplifier that is switched off lets the voltage fall too.

    Parameters
    ----------
    voltage_V : positive, shape (n,)
    current_A : shape (n,), or None if it was not recorded
    """
    greatest = np.maximum.accumulate(voltage_V)
    limit_V = (1.0 - criteria.limit_tolerance) * criteria.limit_V
    flashovers: list[float] = []
    at = 1 + int(np.argmax(greatest >= _FOOT * greatest[-1]))
    while at < voltage_V.size:
        lost = np.flatnonzero(voltage_V[at:] < (1.0 - criteria.dip) * greatest[at - 1 : -1])
        if not lost.size:
            break
        at += int(lost[0])
        before_V = float(greatest[at - 1])
        if before_V >= limit_V:
            break
        floor = (1.0 - criteria.collapse) * before_V
        early = voltage_V[at : at + criteria.collapse_steps]
        if (early < floor).any():
            spike = _spike(current_A, at, criteria)
            if spike is None or spike[1]:
                return _ended(voltage_V, at, "collapse", flashovers, spike and spike[0])
            return _ended(voltage_V, at, "turned down", flashovers)
        back = np.flatnonzero(voltage_V[at:] >= (1.0 - 0.5 * criteria.dip) * before_V)
        if not back.size:
            end: End = "turned down" if (voltage_V[at:] < floor).any() else "flashover"
            return _ended(voltage_V, at, end, flashovers)
        flashovers.append(before_V)
        at += int(back[0]) + 1
    end = "amplifier limit" if float(greatest[-1]) >= limit_V else "file ended"
    return _ended(voltage_V, voltage_V.size, end, flashovers)


def _spike(current_A: FloatArray | None, at: int, criteria: Criteria) -> tuple[float, bool] | None:
    """Give the greatest current around a collapse, and whether it stands out from before."""
    if current_A is None:
        return None
    steps = criteria.collapse_steps
    around = np.abs(current_A[max(at - 1, 0) : at + steps])
    before = current_A[: max(at - 1, 1)]
    usual = float(np.median(before))
    noise = 1.4826 * float(np.median(np.abs(before - usual)))
    least = max(criteria.spike_A, abs(usual) + criteria.spike_noise * noise)
    greatest = float(around.max())
    return greatest, greatest >= least


def _ended(
    voltage_V: FloatArray, end: int, how: End, flashovers: list[float], spike_A: float | None = None
) -> Breakdown:
    peak = int(np.argmax(voltage_V[:end]))
    return Breakdown(
        voltage_V=float(voltage_V[peak]),
        broken=how == "collapse",
        end=how,
        peak=peak,
        step_V=_last_step(voltage_V[: peak + 1]),
        spike_A=spike_A,
        flashovers=tuple(flashovers),
    )


def _last_step(rising_V: FloatArray) -> float:
    """Rise in one sampling step just before the end: the median of the last ones."""
    steps = np.diff(rising_V[-11:])
    return max(float(np.median(steps)), 0.0) if steps.size else 0.0


def audit_rise(time_s: FloatArray, voltage_V: FloatArray, peak: int, dip: float) -> Rise:
    """Measure how the voltage rose up to sample `peak`, the samples of flashovers left out.

    Parameters
    ----------
    time_s, voltage_V : shape (n,) each
    dip : part of the voltage whose loss is a flashover

    Raises
    ------
    FitRefused : fewer than 5 samples of rising voltage
    """
    t, v = time_s[: peak + 1], voltage_V[: peak + 1]
    first = _start(v)
    held = v >= (1.0 - 0.5 * dip) * np.maximum.accumulate(v)
    held[:first] = False
    t, v = t[held], v[held]
    if v.size < _FEWEST or not v[-1] > v[0]:
        raise FitRefused(
            f"{v.size} samples of a rising voltage; at least {_FEWEST} are needed to tell a ramp "
            "from a switch: sample faster, or raise the voltage more slowly",
            {"samples": v.size},
        )
    rate = _slope(t, v)
    parts = min(_PARTS, v.size // _FEWEST_IN_PART)
    edges = np.linspace(0, v.size, parts + 1).astype(int) if parts > 1 else np.array([0, v.size])
    slopes = [_slope(t[a:b], v[a:b]) / rate for a, b in pairwise(edges)]
    return Rise(float(v[0]), float(t[-1] - t[0]), rate, min(slopes), max(slopes))


def _start(rising_V: FloatArray) -> int:
    """First sample of the slow rise: after the last jump, else where there is voltage at all."""
    steps = np.diff(rising_V)
    top = float(rising_V[-1])
    usual = float(np.median(steps)) if steps.size else 0.0
    up = np.flatnonzero(steps > max(_JUMP * top, _JUMP_STEPS * usual))
    low = np.flatnonzero(rising_V < _FOOT * top)
    # a jump back up after a flashover is no start: only one from below everything before counts
    greatest = np.maximum.accumulate(rising_V)
    jumps = [int(i) + 1 for i in up if rising_V[i] >= 0.99 * greatest[i] - _FOOT * top]
    return max(jumps[-1] if jumps else 0, int(low[-1]) + 1 if low.size else 0)


def _slope(t: FloatArray, v: FloatArray) -> float:
    centred = t - t.mean()
    return float(centred @ v / (centred @ centred))
