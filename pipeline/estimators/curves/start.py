"""Where a pull or a squeeze begins: the hold before it, the zero of position, the zero of load."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.curves.noise import noise_sd

Zero = Literal["at contact", "absolute"]

_MOVED = 0.5  # of a step of the moving machine: a displacement that changes by less holds still
_GRIPPED = 0.05  # of the greatest stress: a load that changes by more during a hold is a grip's
_EARLY = 0.1  # of the travel over which the first stiffness is judged
_FEWEST = 5
_AT_ONCE = 20
_UNLOADED = 0.2  # of the stress that a position would mean: below it the position is no strain
_STRAINED = 0.5  # above it the position is a strain
_NOTICED = 1e-3  # strain: less is the dead path of a machine and moves no modulus by a tenth


@dataclass(frozen=True, slots=True)
class Hold:
    """Samples before the machine moves.

    Parameters
    ----------
    last : index of the last sample before it moves
    load_change : greatest change of stress up to there, relative to the greatest stress `[1]`
    gripping : the load changed so much that the grips must have closed on the specimen
    """

    last: int
    load_change: float
    gripping: bool


def find_hold(strain: FloatArray, stress: FloatArray) -> Hold:
    """Find the samples that are recorded before the machine moves.

    Parameters
    ----------
    strain, stress : of the whole recording, loading positive, shape (n,) `[1]`, `[Pa]`
    """
    few = min(_AT_ONCE, strain.size - 1)
    if few > 0 and abs(strain[1] - strain[0]) > 0.25 * abs(strain[few] - strain[0]) / few > 0.0:
        return Hold(0, 0.0, False)  # it moves from the first sample on, as most records do
    steps = np.abs(np.diff(strain))
    steps = steps[steps > 0.0]
    step = float(np.quantile(steps, 0.25)) if steps.size else 0.0
    last = max(int((np.abs(strain - strain[0]) > _MOVED * step).argmax()) - 1, 0)
    greatest = float(np.abs(stress).max())
    change = float(np.ptp(stress[: last + 1])) / greatest if greatest > 0.0 else 0.0
    return Hold(last, change, change > _GRIPPED)


def zero_of_position(strain: FloatArray, stress: FloatArray) -> Zero:
    r"""Decide whether the first position is a strain or the place of the crosshead.

    A specimen at the strain $\varepsilon_1$ carries about $E \varepsilon_1$, with E the first
    stiffness of the record; a crosshead that merely stands somewhere carries nothing. A start
    below zero is an approach in air if the load stays away until zero is passed.

    Parameters
    ----------
    strain, stress : one loading, loading positive, from the first sample, shape (n,)

    Returns
    -------
    `at contact` where the strains count as they are, `absolute` where the first one is the zero

    Raises
    ------
    FitRefused : the load at the start fits neither
    """
    first = float(strain[0])
    if abs(first) <= _NOTICED:
        return "at contact"
    early, stiffness = _first_stiffness(strain, stress)
    if first < 0.0:
        return _zero_of_approach(strain, stress, stiffness)
    expected = stiffness * first
    noise = noise_sd(stress[:early])
    if expected <= 4.0 * noise:
        return "at contact"
    found = (float(stress[0])) / expected
    if found < _UNLOADED:
        return "absolute"
    if found >= _STRAINED:
        return "at contact"
    raise FitRefused(
        f"displacement starts at {100 * first:.3g} % of the length with {100 * found:.2g} % of the "
        "load that such a strain would need: neither the absolute position of an unloaded specimen "
        "nor a strain; zero displacement and load before the test",
        {"first_strain": first, "load_fraction": found},
    )


def _zero_of_approach(strain: FloatArray, stress: FloatArray, stiffness: float) -> Zero:
    crossed = int((strain >= 0.0).argmax())
    if strain[crossed] < 0.0:
        return "absolute"
    # what the specimen carries when the displacement passes zero, as a strain
    carried = float(stress[crossed] - stress[0]) / stiffness if stiffness > 0.0 else 0.0
    return "absolute" if carried > 0.5 * abs(float(strain[0])) else "at contact"


def _first_stiffness(strain: FloatArray, stress: FloatArray) -> tuple[int, float]:
    """Slope of the first tenth of the travel `[Pa]`, and how many samples that is."""
    travelled = strain - strain[0] <= _EARLY * float(np.ptp(strain))
    count = int(travelled.argmin()) if not travelled.all() else strain.size
    count = min(max(count, _FEWEST), strain.size)
    x, y = strain[:count], stress[:count]
    dx = x - x.mean()
    spread = float(dx @ dx)
    return count, float(dx @ y) / spread if spread > 0.0 else 0.0


@dataclass(frozen=True, slots=True)
class LoadZero:
    """The reading of the load cell without a load.

    Parameters
    ----------
    before : stress of the first samples, before the specimen is loaded `[Pa]`
    after : mean stress after the break; None where no break was recorded `[Pa]`
    zero_Pa, u_Pa : the zero and its standard uncertainty `[Pa]`
    """

    before: float
    after: float | None
    zero_Pa: float
    u_Pa: float


def zero_of_load(stress: FloatArray, hold: int, broken_at: int | None) -> LoadZero | None:
    """Find the load that the cell shows without a specimen, where it is not zero.

    After the break nothing hangs on the cell but the grip: what it shows then, and showed before
    the pull, is its zero. Without a break a load at the start may be the cell's zero or a preload:
    it is then no correction, but half of it, either way, is an uncertainty.

    Parameters
    ----------
    stress : loading positive, shape (n,) `[Pa]`
    hold : index of the last sample before the machine moves
    broken_at : index of the first sample after the break, None where none was recorded

    Returns
    -------
    None where the load starts at zero within its noise or 0.5 % of its greatest value
    """
    before = float(stress[0] if hold == 0 else np.median(stress[: hold + 1]))
    greatest = float(stress.max())
    if abs(before) <= 0.005 * greatest:
        return None
    limit = max(0.005 * greatest, 4.0 * noise_sd(stress[: max(hold + 1, 12)]))
    if abs(before) <= limit:
        return None
    after = None if broken_at is None else float(np.median(stress[broken_at:]))
    if after is not None and abs(after - before) <= max(0.3 * abs(before), limit):
        return LoadZero(before, after, 0.5 * (before + after), 0.5 * abs(after - before))
    return LoadZero(before, after, 0.0, abs(before) / math.sqrt(3.0))
