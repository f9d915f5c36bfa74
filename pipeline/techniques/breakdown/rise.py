"""Says how the voltage rose to its end: how steadily, or in steps that were held."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.techniques.breakdown.signals import deviation, median, voltage_noise

_FEWEST = 5  # samples with voltage on them, below which there is no ramp to speak of
_PARTS = 8  # of the ramp, whose rates of rise are compared
_FEWEST_IN_PART = 4
_JUMP = 0.05  # of the greatest voltage: the step to the voltage from which the slow rise starts
_JUMP_STEPS = 10.0  # and so many usual steps
_FOOT = 0.02  # of the greatest voltage: below it the ramp has not begun, and all is noise
_NOISY = 5e-4  # noise over voltage, from which one sample does not tell the start
_NOISE = 8.0  # standard deviations of the monitor that are no step
_FEWEST_LEVELS = 3
_STEP_NOISE = 5.0  # standard deviations of a difference: more is a step
_LEAST_STEP = 0.015  # of the greatest voltage: a monitor of eight bits has steps of 1 % too
_SHARE = 0.8  # of the rise lies in steps
_FLAT = 0.3  # of the time lies in holds, where two samples lie in each
_NEAR = 0.2  # of a step short of the next one: it is reached
_BLOCK_s = 1.0  # samples closer than this are averaged before steps are looked for


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
    u_part : standard uncertainty of a part's relative slope by the noise of the monitor
    """

    start_V: float
    duration_s: float
    rate_V_per_s: float
    slowest: float
    fastest: float
    u_part: float = 0.0


@dataclass(frozen=True, slots=True)
class Steps:
    """A voltage raised in steps, each held for a while.

    Parameters
    ----------
    step_V, hold_s : the usual step, and how long the usual one was held
    level_V : of the step at which it ended
    held_V : of the last step that was held to its end, 0 where it ended at the first one
    levels : how many steps there were
    first_V : of the first step
    duration_s : from the first step to the end
    u_V : standard uncertainty of `level_V` by the noise of the monitor
    """

    step_V: float
    hold_s: float
    level_V: float
    held_V: float
    levels: int
    first_V: float
    duration_s: float
    u_V: float


def audit_rise(time_s: FloatArray, voltage_V: FloatArray, peak: int, dip: float) -> Rise:
    """Measure how the voltage rose up to sample `peak`, the samples of flashovers left out.

    Parameters
    ----------
    time_s, voltage_V : shape (n,) each
    dip : fraction of the voltage whose loss is a flashover

    Raises
    ------
    FitRefused : fewer than 5 samples of rising voltage
    """
    t, v = time_s[: peak + 1], voltage_V[: peak + 1]
    noise_V = voltage_noise(v)
    first = _start(v, noise_V)
    greatest = np.maximum.accumulate(v)
    held = v >= greatest - np.maximum(0.5 * dip * greatest, _NOISE * noise_V)
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
    part = t[: int(edges[1])]
    u_part = noise_V / (rate * float(np.linalg.norm(part - part.mean())))
    noisy = noise_V > _NOISY * float(v[-1])
    start_V = float(np.median(v[:_FEWEST]) if noisy else v[0])
    return Rise(start_V, float(t[-1] - t[0]), rate, min(slopes), max(slopes), u_part)


def find_steps(
    time_s: FloatArray, voltage_V: FloatArray, last: int, least_hold_s: float
) -> Steps | None:
    """Tell a voltage that rose in steps which were held from a ramp.

    Parameters
    ----------
    time_s, voltage_V : shape (n,) each
    last : last sample before the end
    least_hold_s : shorter holds are no step-by-step test

    Returns
    -------
    None where the rise is no staircase
    """
    t, v = time_s[: last + 1], voltage_V[: last + 1]
    if v.size < 2 * _FEWEST_LEVELS or median(v[1:] - v[:-1]) > 0.5 * float(v[-1] - v[0]) / v.size:
        return None  # most samples rise as all do: a ramp
    t, v = _blocks(t, v)
    begun = np.flatnonzero(v >= _FOOT * v.max(initial=0.0))
    if begun.size < 2 * _FEWEST_LEVELS:
        return None
    t, v = t[begun[0] :], v[begun[0] :]
    change, top = np.diff(v), float(v.max())
    usual, noise_V = median(change), deviation(change)
    up = change - usual > max(_STEP_NOISE * noise_V, 0.5 * _LEAST_STEP * top)
    if not _FEWEST_LEVELS - 1 <= np.count_nonzero(up) <= 0.5 * up.size:
        return None
    held = _runs(up)
    holds = np.diff(t[[a for a, _ in held]])  # the last one ended with the test
    values = [float(np.median(v[a : b + 1])) for a, b in held]
    step_V = float(np.median(np.diff(values))) if len(held) >= _FEWEST_LEVELS else 0.0
    flat_s = math.fsum(float(t[b] - t[a]) for a, b in held)
    if (
        step_V < _LEAST_STEP * top
        or float(np.median(holds)) < least_hold_s
        or flat_s < _FLAT * float(t[-1] - t[0])
        or float(change[up].sum()) < _SHARE * float(v[-1] - v[0])
    ):
        return None
    size = held[-1][1] - held[-1][0] + 1
    if up[-1] and v[-1] - values[-1] > (1.0 - _NEAR) * step_V:  # it broke as the step was reached
        values.append(float(v[-1]))
        size = 1
    return Steps(
        step_V, float(np.median(holds)), values[-1], values[-2], len(values), values[0],
        float(t[-1] - t[0]), noise_V / (2.0 * size) ** 0.5,
    )  # fmt: skip


def _runs(up: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and last sample of each stretch of two samples or more without a step up."""
    edges = np.flatnonzero(np.diff(np.concatenate([[1], up, [1]])))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _blocks(t: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Medians of samples that lie closer together than a second; the last block is whole."""
    interval = float(np.median(np.diff(t))) if t.size > 1 else _BLOCK_s
    size = int(_BLOCK_s / interval)
    if size < 2:
        return t, v
    cut = t.size % size
    return (
        np.asarray(np.median(t[cut:].reshape(-1, size), axis=1)),
        np.asarray(np.median(v[cut:].reshape(-1, size), axis=1)),
    )


def _start(rising_V: FloatArray, noise_V: float) -> int:
    """First sample of the slow rise: after the last jump, else where there is voltage at all."""
    steps = rising_V[1:] - rising_V[:-1]
    top = float(rising_V[-1])
    usual = median(steps) if steps.size else 0.0
    up = np.flatnonzero(steps > max(_JUMP * top, _JUMP_STEPS * usual, _NOISE * noise_V))
    low = np.flatnonzero(rising_V < _FOOT * top)
    # a jump back up after a flashover is no start: only one from below everything before counts
    greatest = np.maximum.accumulate(rising_V)
    jumps = [int(i) + 1 for i in up if rising_V[i] >= 0.99 * greatest[i] - _FOOT * top]
    return max(jumps[-1] if jumps else 0, int(low[-1]) + 1 if low.size else 0)


def _slope(t: FloatArray, v: FloatArray) -> float:
    centred = t - t.mean()
    return float(centred @ v / (centred @ centred))
