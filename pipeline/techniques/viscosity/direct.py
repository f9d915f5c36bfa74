"""Viscosity read from the readings themselves, where a law misses them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange
from deamat.estimators.curves.local_line import Local, local_line
from deamat.techniques.viscosity.readings import Readings
from deamat.techniques.viscosity.time_law import Estimate, TimeLaw

_LEAST_READINGS, _PART_OF_READINGS = 7, 5
_BISECTIONS = 60
_ALL_BUT_FEW = 0.975


@dataclass(frozen=True, slots=True)
class Direct:
    """A law times what its own readings say of it nearby.

    Parameters
    ----------
    law : it takes the steep part of the curve out, so that a line does for the rest
    readings : in the order of time
    ratio : readings over law, shape (n,)
    """

    law: TimeLaw
    readings: Readings
    ratio: FloatArray

    def ratio_at(self, time_s: float) -> Local:
        """Reading over law by the readings nearby."""
        n = len(self.ratio)
        count = min(n, max(_LEAST_READINGS, n // _PART_OF_READINGS))
        return local_line(self.readings.time_s, self.ratio, time_s, count)

    def viscosity(self, time_s: float) -> Estimate:
        """Viscosity at a time.

        Raises
        ------
        OutOfRange : a time outside the range of the law
        """
        law, near = self.law.at(time_s)[0], self.ratio_at(time_s)
        r = self.readings
        return Estimate(
            law * near.value,
            law * near.standard_uncertainty,
            abs(float(np.interp(time_s, r.time_s, r.calibration_Pas))),
            abs(float(np.interp(time_s, r.time_s, r.thermal_Pas))),
            near.dof,
        )

    def time_of(self, times: float, start_s: float) -> Estimate:
        """Time at which viscosity has grown by a factor since a start, which is one reading's.

        Raises
        ------
        FitRefused : it does not within the range of the law
        """
        start = self.viscosity(start_s)
        of_one = self.law.at(start_s)[0] * self.ratio_at(start_s).residual_sd
        found = self._reached(times * start.value, start_s)
        u_start = times * max(start.scatter, of_one)
        return self._time(
            found, u_start, times * start.calibration, times * start.thermal, start.dof
        )

    def time_at(self, viscosity_Pas: float) -> Estimate:
        """Time at which viscosity reaches a limit.

        Raises
        ------
        FitRefused : it does not within the range of the law
        """
        low = self.law.valid[0]
        if self.viscosity(low).value > viscosity_Pas:
            raise FitRefused(f"viscosity is above {viscosity_Pas:g} Pa.s from the start of the law")
        return self._time(self._reached(viscosity_Pas, low), 0.0, 0.0, 0.0, np.inf)

    def _reached(self, value: float, start_s: float) -> float:
        low, high = start_s, self.law.valid[1]
        times = self.readings.time_s
        inside: list[float] = times[(times > low) & (times < high)].tolist()
        for time_s in [*inside, high]:
            if self.viscosity(time_s).value >= value:
                high = time_s
                break
            low = time_s
        else:
            raise FitRefused(
                f"viscosity does not reach {value:.4g} Pa.s until {high / 3600:.4g} h after "
                "mixing, where the law ends; measure longer"
            )
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            if middle in (low, high):
                break
            low, high = (middle, high) if self.viscosity(middle).value < value else (low, middle)
        return high

    def _time(
        self, time_s: float, u_Pas: float, calibration: float, thermal: float, dof: float
    ) -> Estimate:
        """Turn errors of viscosity into those of a time; a log cannot tell it within its step."""
        times = self.readings.time_s
        low, high = self.law.valid
        step = float(np.median(np.diff(times)))
        before, after = max(low, time_s - step), min(high, time_s + step)
        rise = (self.viscosity(after).value - self.viscosity(before).value) / (after - before)
        if not rise > 0:
            raise FitRefused(
                f"viscosity does not rise at {time_s / 3600:.4g} h, so that the time at which it "
                "is reached is not determined"
            )
        there = self.viscosity(time_s)
        scatter = np.sqrt(there.scatter**2 + u_Pas**2) / rise
        return Estimate(
            time_s,
            float(np.hypot(scatter, step / np.sqrt(12.0))),
            abs(there.calibration - calibration) / rise,
            abs(there.thermal - thermal) / rise,
            min(there.dof, dof),
        )


def direct_of(law: TimeLaw, readings: Readings) -> Direct:
    """Put the readings of one run or several in the order of time, over the law."""
    ordered = readings.where(np.argsort(readings.time_s, kind="stable"))
    inside = (ordered.time_s >= law.valid[0]) & (ordered.time_s <= law.valid[1])
    kept = ordered.where(inside)
    values = np.array([law.at(t)[0] for t in kept.time_s.tolist()])
    return Direct(law, kept, kept.viscosity_Pas / values)


def greatest_miss(direct: Direct) -> tuple[float, float]:
    """How far the readings leave the law, as a fraction of it, and when most `[s]`.

    At most by their local lines, or as far as all but a fortieth of them do: a local line rounds a
    kink off.
    """
    try:
        off = [abs(direct.ratio_at(t).value - 1.0) for t in direct.readings.time_s.tolist()]
    except (OutOfRange, FitRefused):
        return 0.0, float(direct.readings.time_s[0])
    worst = int(np.argmax(off))
    all_but_few = float(np.quantile(np.abs(direct.ratio - 1.0), _ALL_BUT_FEW))
    return max(off[worst], all_but_few), float(direct.readings.time_s[worst])
