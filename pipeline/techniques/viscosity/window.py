"""Which readings of a run a law is fitted to, and for which times it may then answer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from deamat.core.errors import FitRefused
from deamat.core.recording import Specimen
from deamat.core.records import Flag
from deamat.techniques.viscosity.config import ViscosityConfig
from deamat.techniques.viscosity.readings import Readings, joined, speeds_alternate
from deamat.techniques.viscosity.temperature import Probe, at_one_temperature
from deamat.techniques.viscosity.trusted import until_fall, without_isolated

_INTERVAL_CHANGE = 2.0  # a sampling interval that grows by more than this is another method


@dataclass(frozen=True, slots=True)
class Windowed:
    """The readings to fit, and the rule that chose them.

    Parameters
    ----------
    valid : range of times for which readings speak `[s]`: the window as far as it is bracketed
    rule : in words
    start_s : where stated times and doubling count from `[s]`
    whole : the configured window was used, not the rule for short runs
    probe : temperature of the liquid; None where no probe was read
    """

    readings: Readings
    valid: tuple[float, float]
    rule: str
    start_s: float
    whole: bool
    probe: Probe | None = None


def windowed(
    readings: Readings, config: ViscosityConfig, stated_K: float | None = None
) -> Windowed:
    """Cut a run to the configured window, and to readings that the liquid caused.

    A run that ends before the window begins is taken from its minimum on. Readings far off their
    neighbours are left out, a fall to the end of the run is cut off, and a temperature that moved
    is corrected where it can be.

    Parameters
    ----------
    stated_K : temperature of the run as the register states it; None where it does not

    Raises
    ------
    FitRefused : fewer than `min_readings` are left
    """
    window = _cut(readings, config)
    steady = not speeds_alternate(window.readings)  # else neighbours are of other shear rates
    sound = without_isolated(window.readings) if steady else window.readings
    one, probe = at_one_temperature(sound, config, stated_K)
    kept, fall_s = until_fall(one) if steady else (one, None)
    _enough(kept, config, window.rule)
    low, high = window.valid
    end = high if fall_s is None else min(high, fall_s)
    return replace(window, readings=kept, probe=probe, valid=(low, end))


def stated_temperature_K(specimen: Specimen) -> float | None:
    """Temperature of a run as its register states it `[K]`; None where it does not."""
    stated = specimen.numbers.get(_TEMPERATURE)
    condition = specimen.conditions.get(_TEMPERATURE)
    if stated is not None:
        return stated.value
    return condition if isinstance(condition, float) else None


_TEMPERATURE = "temperature_K"


def _cut(readings: Readings, config: ViscosityConfig) -> Windowed:
    if len(readings) == 0:
        raise FitRefused(
            "no reading is left: none is within the torque window; change rotor or speed"
        )
    low, high = config.window_s
    if readings.time_s[-1] > low:
        inside = (readings.time_s >= low) & (readings.time_s <= high)
        chosen = readings.where(inside)
        rule = f"readings from {low / 3600:g} h to {high / 3600:g} h after mixing"
        _enough(chosen, config, rule)
        first, last = float(chosen.time_s[0]), float(chosen.time_s[-1])
        valid = (
            low if readings.time_s[0] < low else first,
            high if readings.time_s[-1] > high else last,
        )
        return Windowed(chosen, valid, rule, low, True)
    return _short(readings, config)


def _short(readings: Readings, config: ViscosityConfig) -> Windowed:
    """From the minimum to the end, or to where the measuring method changes."""
    one_method, flags = _first_method(readings)
    lowest = int(np.argmin(one_method.viscosity_Pas))
    chosen = one_method.where(slice(lowest, None))
    rule = (
        f"the run ends {readings.time_s[-1]:g} s after mixing, before the window begins: readings "
        "from the minimum on"
    )
    _enough(chosen, config, rule)
    valid = (float(chosen.time_s[0]), float(chosen.time_s[-1]))
    chosen = replace(chosen, flags=(*chosen.flags, *flags))
    return Windowed(chosen, valid, rule, valid[0], False)


def _first_method(readings: Readings) -> tuple[Readings, tuple[Flag, ...]]:
    """Cut a run that does not state its settings where its sampling slows down for good."""
    steps = np.diff(readings.time_s)
    if readings.of_full_scale or len(steps) < 3:
        return readings, ()
    slower = np.flatnonzero(steps[1:] > _INTERVAL_CHANGE * steps[:-1]) + 1
    lasting = [i for i in slower if steps[i:].min() > _INTERVAL_CHANGE * steps[i - 1]]
    if not lasting:
        return readings, ()
    at = int(lasting[0])
    flag = Flag(
        "method-changed",
        f"sampling goes from {steps[at - 1]:g} s to {steps[at]:g} s after line "
        f"{int(readings.line[at])} ({readings.time_s[at]:g} s): the {len(readings) - at - 1} "
        "readings after it are of another method and were not fitted",
    )
    return readings.where(slice(0, at + 1)), (flag,)


def _enough(chosen: Readings, config: ViscosityConfig, rule: str) -> None:
    if len(chosen) < config.min_readings:
        raise FitRefused(
            f"{len(chosen)} readings are left ({rule}), and a law needs {config.min_readings}; "
            "measure longer or more often, within the torque window",
            {"readings": len(chosen), "readings_needed": config.min_readings},
        )


def combined(windows: Sequence[Windowed]) -> Readings:
    """Put the readings of several runs behind each other."""
    return joined([w.readings for w in windows])


def common_range(ranges: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Return the times that all ranges have in common `[s]`.

    Raises
    ------
    FitRefused : there are none
    """
    low, high = max(r[0] for r in ranges), min(r[1] for r in ranges)
    if not low < high:
        raise FitRefused(
            f"the runs have no time in common: one begins at {low:g} s, another ends at {high:g} s"
        )
    return low, high
