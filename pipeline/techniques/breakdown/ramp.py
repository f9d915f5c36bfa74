"""Finds the breakdown in a high-voltage ramp, by its current where that was recorded.

A film breaks where the current jumps and the voltage gives way: it may collapse at once, fall
slowly while the amplifier feeds the arc, stay at what the amplifier's current limit holds, or come
back because the film cleared itself. The first such event is the breakdown. Without a current a
loss of voltage is a breakdown (no current channel), a flashover (it comes back) or a voltage that
somebody turned down; where the log cannot tell, `sure` is False.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.techniques.breakdown.signals import (
    current_jumps,
    deviation,
    foot,
    level_at,
    median,
    steadied,
    voltage_noise,
)

End = Literal[
    "collapse",
    "slow collapse",
    "held by the current limit",
    "self-clearing",
    "collapse without current",
    "slow fall without current",
    "part lost without current",
    "amplifier limit",
    "turned down",
    "file ended",
]
After = Literal["first breakdown", "final collapse"]

BROKEN: tuple[End, ...] = (
    "collapse",
    "slow collapse",
    "held by the current limit",
    "self-clearing",
    "collapse without current",
    "slow fall without current",
    "part lost without current",
)
_LOST_NOISE = 10.0  # standard deviations: the greatest of many samples is itself 3 to 4 above
_DIP_NOISE = 6.0  # of one sample against the one before
_LEAST_DIP = 0.002  # of the voltage, where there is no noise
_LEAST_LOSS = 0.02  # of the greatest voltage: ripple of a monitor matters where the ramp begins
_LEAST_STEP = 0.005  # of the greatest voltage: a step down that is looked into without a current
_SUDDEN = 3.0  # times the rate of rise: a fall that nobody turns
_PLAIN = 5e-4  # noise over voltage, below which the greatest sample is taken as it is


@dataclass(frozen=True, slots=True)
class Criteria:
    """What counts as what; see `BreakdownConfig` for the meaning of each.

    Parameters
    ----------
    limit_V, limit_tolerance : amplifier limit and how near to it counts as reaching it
    dip, collapse : fractions of the voltage whose loss is noticed, and is a collapse
    collapse_steps : sampling steps within which a collapse happens
    spike_A, spike_noise : least current of a spike, and in standard deviations of what was before
    event_A : current that is a breakdown even where the voltage shows no dip
    arc_s : the current of a breakdown lasts at least so long
    after_clearing : which breakdown of a film that clears itself counts
    """

    limit_V: float
    limit_tolerance: float
    dip: float
    collapse: float
    collapse_steps: int
    spike_A: float
    spike_noise: float
    event_A: float
    arc_s: float
    after_clearing: After


@dataclass(frozen=True, slots=True)
class Event:
    """A jump of the current, or a loss of voltage.

    Parameters
    ----------
    last : last sample before the voltage gave way
    voltage_V : there
    current_A : greatest around it, None without a current channel
    lost : fraction of the voltage lost
    """

    last: int
    voltage_V: float
    current_A: float | None
    lost: float


@dataclass(frozen=True, slots=True)
class Breakdown:
    """What became of one ramp.

    Parameters
    ----------
    voltage_V : of breakdown, or borne unbroken; if noisy, of the line through the last samples
    u_V : standard uncertainty by the noise of the monitor, 0 where the greatest sample was taken
    broken : False where the specimen is right-censored at `voltage_V`
    sure : False where the log does not tell a film that broke from one that held
    end : what ended the ramp
    peak : sample of the greatest voltage before the end
    last : last sample before the end
    step_V : rise in the sampling step in which it broke: it may have broken so much higher
    spike_A : greatest current around the breakdown, None without a current channel or a breakdown
    clearings : breakdowns after which the voltage came back
    spikes : jumps of the current without a dip
    flashovers : voltages at which a part was lost without a current, and came back `[V]`
    noise_V : standard deviation of the voltage monitor
    greatest_V : of the whole file
    """

    voltage_V: float
    u_V: float
    broken: bool
    sure: bool
    end: End
    peak: int
    last: int
    step_V: float
    spike_A: float | None
    clearings: tuple[Event, ...]
    spikes: tuple[Event, ...]
    flashovers: tuple[float, ...]
    noise_V: float
    greatest_V: float


def find_breakdown(
    voltage_V: FloatArray, current_A: FloatArray | None, interval_s: float, criteria: Criteria
) -> Breakdown:
    """Find the first breakdown of the film, or what else ended the ramp.

    Parameters
    ----------
    voltage_V : positive, shape (n,)
    current_A : shape (n,), or None if it was not recorded
    interval_s : between samples
    """
    return _Search(voltage_V, current_A, interval_s, criteria).run()


class _Search:
    """Walks along one ramp from event to event."""

    def __init__(
        self, v: FloatArray, current_A: FloatArray | None, interval_s: float, criteria: Criteria
    ) -> None:
        self.v, self.current_A, self.criteria = v, current_A, criteria
        self.slow = interval_s > criteria.arc_s
        self.greatest = np.maximum.accumulate(v)
        self.noise_V = voltage_noise(v[: int(np.argmax(v)) + 1])
        allowed = np.maximum(
            criteria.dip * self.greatest[:-1],
            max(_LOST_NOISE * self.noise_V, _LEAST_LOSS * float(self.greatest[-1])),
        )
        lost = v[1:] < self.greatest[:-1] - allowed
        if current_A is None:
            lost |= _sudden(v, self.noise_V)
        self.losses = 1 + np.flatnonzero(lost)
        self.jumps = (
            np.zeros(0, dtype=np.intp)
            if current_A is None
            else current_jumps(current_A, v, criteria.spike_A, criteria.spike_noise)
        )
        self.clearings: list[Event] = []
        self.spikes: list[Event] = []
        self.flashovers: list[float] = []

    def run(self) -> Breakdown:
        """Go from event to event until one ends the ramp."""
        at, n = 1 + foot(self.v), self.v.size
        limit_V = (1.0 - self.criteria.limit_tolerance) * self.criteria.limit_V
        while at < n:
            loss, jump = (_next(places, at, n) for places in (self.losses, self.jumps))
            first = min(loss, jump)
            if first == n or float(self.greatest[first - 1]) >= limit_V:
                break
            near = jump < n and jump <= loss + self.criteria.collapse_steps
            ended, at = self._jumped(jump, loss) if near else self._lost(loss)
            if ended is not None:
                return self._first_of(ended)
        borne = np.flatnonzero(self.v >= limit_V)
        return self._first_of(
            self._ended("amplifier limit", int(borne[-1]))
            if borne.size
            else self._ended("file ended", n - 1)
        )

    def _jumped(self, jump: int, loss: int) -> tuple[Breakdown | None, int]:
        """Judge a jump of the current, and where to look on."""
        found = self._event(jump, min(loss, jump))
        weak = found.current_A is not None and found.current_A < self.criteria.event_A
        if weak and not found.lost:
            self.spikes.append(found)
            return None, jump + 1
        return self._broke(found, min(loss, jump))

    def _broke(self, found: Event, first: int) -> tuple[Breakdown | None, int]:
        back = self._back(first, found.voltage_V)
        if back is not None:
            self.clearings.append(found)
            return None, max(back + 1, first + 2)
        floor = (1.0 - self.criteria.collapse) * found.voltage_V
        rest = self.v[first:]
        early = self.v[first : found.last + 1 + self.criteria.collapse_steps]
        end: End = (
            "collapse"
            if (early < floor).any()
            else "slow collapse" if (rest < floor).any()
            else "held by the current limit"
        )  # fmt: skip
        return self._ended(end, found.last, spike_A=found.current_A), self.v.size

    def _lost(self, loss: int) -> tuple[Breakdown | None, int]:
        """Judge a loss of voltage with which no current jumps."""
        steps, before_V = self.criteria.collapse_steps, float(self.greatest[loss - 1])
        floor = (1.0 - self.criteria.collapse) * before_V
        found = self._event(loss, loss)
        if found.current_A is not None and found.current_A >= self._least_current(loss):
            return self._broke(found, loss)
        abrupt = bool((self.v[loss : loss + steps] < floor).any())
        if abrupt:
            if self.current_A is None:
                return self._ended("collapse", loss - 1), self.v.size
            end: End = "collapse without current" if self.slow else "turned down"
            return self._ended(end, loss - 1, sure=not self.slow), self.v.size
        back = self._back(loss, before_V)
        if back is not None:
            self.flashovers.append(before_V)
            return None, back + 1
        if self.current_A is not None:
            return self._ended("turned down", loss - 1), self.v.size
        under = np.flatnonzero(self.v[loss:] < floor)
        how: End = "part lost without current"
        if under.size:  # a film gives way far faster than a voltage is raised, and turned down
            rise = before_V / max(loss - foot(self.v), 1)
            sudden = 0.5 * before_V / float(under[0] + 1) > _SUDDEN * rise
            how = "slow fall without current" if sudden else "turned down"
        return self._ended(how, loss - 1, sure=False), self.v.size

    def _event(self, at: int, first: int) -> Event:
        """Describe what happens at a jump or loss: the voltage before it, and how much is lost."""
        steps, before_V = self.criteria.collapse_steps, float(self.greatest[max(first - 1, 0)])
        allowed = max(_DIP_NOISE * self.noise_V, _LEAST_DIP * before_V)
        risen_V = before_V + _last_step(self.v[:first])
        dipped = float(self.v[first]) < risen_V - allowed
        later = float(self.v[first : first + 2].min())
        lost = 1.0 - later / risen_V if later < risen_V - allowed else 0.0
        last = first - 1 if dipped or self._noisy(before_V) else first
        current = self.current_A
        spike = (
            None
            if current is None
            else float(np.abs(current[max(first - 1, 0) : at + steps]).max())
        )
        return Event(last, float(self.greatest[last]), spike, lost)

    def _least_current(self, at: int) -> float:
        """Least current around a loss of voltage that stands out from what was before."""
        if self.current_A is None:
            return np.inf
        before = self.current_A[: max(at - 1, 1)]
        stands_out = abs(median(before)) + self.criteria.spike_noise * deviation(before)
        return max(self.criteria.spike_A, stands_out)

    def _back(self, first: int, before_V: float) -> int | None:
        """Sample at which the voltage has come back, if it has."""
        loss = 0.5 * self.criteria.dip * before_V
        after = self.v[first:]
        if loss < _DIP_NOISE * self.noise_V:
            after = steadied(after)
        level = before_V - max(loss, 2.0 * self.noise_V)
        out = np.flatnonzero(after < level)
        start = int(out[0]) if out.size and out[0] <= self.criteria.collapse_steps else 0
        back = np.flatnonzero(after[start:] >= level)
        if not back.size or (back.size < 2 and start + int(back[0]) == after.size - 1):
            return None
        return first + start + int(back[0])

    def _noisy(self, voltage_V: float) -> bool:
        return self.noise_V > _PLAIN * voltage_V

    def _ended(
        self, how: End, last: int, *, sure: bool = True, spike_A: float | None = None
    ) -> Breakdown:
        peak = int(np.argmax(self.v[: last + 1]))
        value, u_V = float(self.v[peak]), 0.0
        if self._noisy(value):
            # of a voltage that was turned down or held, the ramp ends at its greatest sample
            value, u_V = level_at(self.v, last if how in BROKEN else peak, self.noise_V)
        return Breakdown(
            voltage_V=value,
            u_V=u_V,
            broken=how in BROKEN,
            sure=sure,
            end=how,
            peak=peak,
            last=last,
            step_V=_last_step(self.v[: peak + 1]),
            spike_A=spike_A,
            clearings=tuple(self.clearings),
            spikes=tuple(self.spikes),
            flashovers=tuple(self.flashovers),
            noise_V=self.noise_V,
            greatest_V=float(self.greatest[-1]),
        )

    def _first_of(self, ended: Breakdown) -> Breakdown:
        """Go back to the first breakdown of a film that cleared itself, if that is what counts."""
        if not self.clearings or self.criteria.after_clearing == "final collapse":
            return ended
        first = self.clearings[0]
        found = self._ended("self-clearing", first.last, spike_A=first.current_A)
        return replace(found, clearings=ended.clearings, spikes=ended.spikes)


def _sudden(v: FloatArray, noise_V: float) -> NDArray[np.bool_]:
    """Steps down that neither the noise nor the resolution of a monitor makes, shape (n - 1,)."""
    step = v[1:] - v[:-1]
    down = -step > max(_LEAST_STEP * float(v.max()), 2.0 * _DIP_NOISE * noise_V)
    if down.any():
        resolution = float(np.min(np.abs(step), where=step != 0.0, initial=np.inf))
        down &= -step > 1.5 * resolution
    return np.asarray(down)


def _next(places: NDArray[np.intp], at: int, none: int) -> int:
    later = int(np.searchsorted(places, at))
    return int(places[later]) if later < places.size else none


def _last_step(rising_V: FloatArray) -> float:
    """Rise in one sampling step just before the end: the median of the last ones."""
    last = rising_V[-11:]
    return max(median(last[1:] - last[:-1]), 0.0) if last.size > 1 else 0.0
