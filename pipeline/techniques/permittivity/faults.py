"""What in a sweep no material makes: drift, outlying points, steps, polarised electrodes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution
from deamat.core.records import Flag
from deamat.estimators.dielectric.low_frequency import Rise, conducted, polarisation, steepening
from deamat.estimators.dielectric.repeats import drift_between, same_frequency, spread
from deamat.estimators.dielectric.smoothness import NONE, Jumps, jumps
from deamat.techniques.permittivity.config import PermittivityConfig
from deamat.techniques.permittivity.spectrum import Spectrum

_LIMIT_TO_SIGMA = math.sqrt(3.0)
_FLOOR = (0.003, 0.01)  # of ln C: the meter's limit within these
_LOSS_SCALE = 0.01  # losses below it count as they are, above it by their logarithm
_LOSS_FLOOR = (0.05, 0.5)
_LOSS_BY_CONDUCTION = 0.01  # losses below it are of no interest
_NAMED = 4


@dataclass(frozen=True, slots=True)
class Found:
    """Faults of one kind: what they add to the budgets, and what is said of them.

    Parameters
    ----------
    permittivity : relative lines of the budget `[1]`
    loss : lines of the budget of the loss `[1]`
    flags : of both values
    """

    permittivity: tuple[Contribution, ...] = ()
    loss: tuple[Contribution, ...] = ()
    flags: tuple[Flag, ...] = ()

    def __add__(self, other: Found) -> Found:
        return Found(
            self.permittivity + other.permittivity,
            self.loss + other.loss,
            self.flags + other.flags,
        )


def first_sweep(
    spectrum: Spectrum, target_Hz: float, config: PermittivityConfig
) -> tuple[Spectrum, Found]:
    """Separate several sweeps or repeated readings, which are one only if they agree.

    Returns
    -------
    all points if repeated readings agree within the tolerance, else those of the first sweep, with
    the drift in the budgets

    Raises
    ------
    FitRefused : they are farther apart than is allowed
    """
    group = same_frequency(spectrum.frequency_Hz)
    once = int(group[-1]) + 1 == group.size
    if once and not spectrum.sweep.any():
        return spectrum, Found()
    c, d = spectrum.capacitance_F.real, spectrum.loss
    if once:
        f, sweep = spectrum.frequency_Hz, spectrum.sweep
        drift = float(np.median(drift_between(f, np.log(c), sweep)))
        drift_of_loss = float(np.median(drift_between(f, d, sweep)))
    else:
        near = group == group[np.abs(np.log(spectrum.frequency_Hz / target_Hz)).argmin()]
        drift = max(float(np.median(spread(np.log(c), group))), float(np.ptp(np.log(c[near]))))
        drift_of_loss = max(float(np.median(spread(d, group))), float(np.ptp(d[near])))
    if drift <= config.repeat_tolerance:
        return spectrum, Found()
    several = int(spectrum.sweep.max()) + 1
    what = f"{several} sweeps in one file" if several > 1 else "frequencies measured several times"
    told = (
        f"{what} differ by {100 * drift:.2g} % in capacitance (other temperatures, up and down, "
        "or a film that changes)"
    )
    if drift > config.max_drift:
        raise FitRefused(
            f"{told}, where {100 * config.max_drift:g} % are allowed (max_drift of [permittivity] "
            "in config/methods.toml); log each sweep to a file of its own and register it with "
            "its temperature",
            {"sweeps": several, "drift": drift},
        )
    name = "several-sweeps" if several > 1 else "drifting-repeats"
    found = Found(
        (Contribution("drift between repeated readings", drift / _LIMIT_TO_SIGMA, shared=True),),
        (
            Contribution(
                "drift between repeated readings", drift_of_loss / _LIMIT_TO_SIGMA, shared=True
            ),
        ),
        (Flag(name, f"{told}; the value is that of the first, the drift is in its uncertainty"),),
    )
    return spectrum.of(spectrum.sweep == 0), found


@dataclass(frozen=True, slots=True)
class Smooth:
    """A spectrum without its outlying points, and the steps that are left in it.

    Parameters
    ----------
    below_Hz, above_Hz : frequencies on both sides of each step, shape (k,) each
    heights : rise of ln C over each step towards higher frequency, shape (k,)
    flags : of outlying points and steps
    dropped_Hz : frequencies of the outlying points
    loss_step : why there is no loss, empty if there is
    """

    spectrum: Spectrum
    below_Hz: tuple[float, ...] = ()
    above_Hz: tuple[float, ...] = ()
    heights: tuple[float, ...] = ()
    flags: tuple[Flag, ...] = ()
    dropped_Hz: tuple[float, ...] = ()
    loss_step: str = ""

    def other_sides(self, frequency_Hz: float) -> float:
        """Return ln of what C would be if each step were an error of this frequency's side."""
        return math.fsum(
            height if frequency_Hz < edge else -height
            for edge, height in zip(self.above_Hz, self.heights, strict=True)
        )


def smooth(spectrum: Spectrum, target_Hz: float, config: PermittivityConfig) -> Smooth:
    """Drop outlying points and find the steps of the meter.

    Raises
    ------
    FitRefused : the steps together are higher than is allowed
    """
    group = same_frequency(spectrum.frequency_Hz)
    f, c, d = (
        _means(v, group)
        for v in (spectrum.frequency_Hz, spectrum.capacitance_F.real, spectrum.loss)
    )
    limit = float(spectrum.limit[np.abs(np.log(spectrum.frequency_Hz / target_Hz)).argmin()])
    x = np.log(f)
    of_c = jumps(x, np.log(c), _within(limit, _FLOOR))
    of_d = jumps(x, np.arcsinh(d / _LOSS_SCALE), _within(limit / _LOSS_SCALE, _LOSS_FLOOR))
    if of_c == NONE and of_d == NONE:
        return Smooth(spectrum)
    dropped = sorted({*of_c.outlying, *of_d.outlying})
    steps = of_c.steps
    heights = tuple(of_c.heights)
    total = math.fsum(map(abs, heights))
    flags = _outlying_flags(f, d, of_c, of_d) + _step_flags(f, of_c)
    if total > config.max_step:
        raise FitRefused(
            f"{flags[-1].detail}; neither side is known to be right, and {100 * total:.2g} % are "
            f"more than the {100 * config.max_step:g} % of max_step of [permittivity] in "
            "config/methods.toml: hold the meter in one range, or check it against a capacitor",
            {"step": total},
        )
    loss_step = ""
    if of_d.steps:
        at = of_d.steps[0]
        loss_step = (
            f"the loss steps from {d[at]:.2g} at {f[at]:g} Hz to {d[at + 1]:.2g} at "
            f"{f[at + 1]:g} Hz, as no material does: the meter changed its range or had not settled"
        )
    kept = ~np.isin(group, dropped)
    return Smooth(
        spectrum.of(kept),
        tuple(float(f[i]) for i in steps),
        tuple(float(f[i + 1]) for i in steps),
        heights,
        flags,
        tuple(float(f[i]) for i in dropped),
        loss_step,
    )


def _within(value: float, bounds: tuple[float, float]) -> float:
    return min(max(value, bounds[0]), bounds[1])


def _means(values: FloatArray, group: np.ndarray[tuple[int], np.dtype[np.intp]]) -> FloatArray:
    """Average the values of each group, shape (groups,)."""
    if int(group[-1]) + 1 == group.size:
        return values
    result: FloatArray = np.bincount(group, values) / np.bincount(group)
    return result


def _outlying_flags(f: FloatArray, d: FloatArray, of_c: Jumps, of_d: Jumps) -> tuple[Flag, ...]:
    """Name the points that stand off their neighbours."""
    said = [
        f"C at {f[i]:g} Hz by {100 * math.expm1(departure):+.2g} %"
        for i, departure in zip(of_c.outlying, of_c.departures, strict=True)
    ] + [f"D at {f[i]:g} Hz with {d[i]:.2g}" for i in of_d.outlying]
    if not said:
        return ()
    more = f" and {len(said) - _NAMED} more" if len(said) > _NAMED else ""
    why = "the meter had not settled, or was disturbed"
    rises = 0 in of_c.outlying and of_c.departures[of_c.outlying.index(0)] > 0.0
    if rises and d[0] > d[1:].max():
        why += "; the loss is highest there too, so that electrode polarisation looks the same"
    return (
        Flag(
            "outlying-point",
            f"off its neighbours, {', '.join(said[:_NAMED])}{more} ({why}); not used, the "
            "neighbours tell what belongs there",
        ),
    )


def _step_flags(f: FloatArray, found: Jumps) -> tuple[Flag, ...]:
    if not found.steps:
        return ()
    said = ", ".join(
        f"{100 * math.expm1(height):+.2g} % between {f[i]:g} and {f[i + 1]:g} Hz"
        for i, height in list(zip(found.steps, found.heights, strict=True))[:_NAMED]
    )
    return (
        Flag(
            "range-step",
            f"the capacitance steps by {said}, as no material does: the meter changed its range; "
            "the value lies between what both sides say, its uncertainty holds both",
        ),
    )


def polarised(spectrum: Spectrum, target_Hz: float, config: PermittivityConfig) -> Rise | None:
    """Find a rise by electrode polarisation that neither meter nor a relaxation could feign.

    Three standard uncertainties of the meter are asked for, and more of a rise as f^-s with s below
    1, by s^-2: broad relaxations fall off as slowly.
    """
    f, c = spectrum.frequency_Hz, spectrum.capacitance_F.real
    rise = polarisation(f, c, spectrum.loss, target_Hz)
    if rise is None:
        return None
    least = _told_from_meter(spectrum, target_Hz, config)
    return rise if rise.height > least / min(rise.exponent, 1.0) ** 2 else None


def _told_from_meter(spectrum: Spectrum, target_Hz: float, config: PermittivityConfig) -> float:
    """Least rise towards a frequency that the meter's limit of error cannot feign `[1]`."""
    limit = float(spectrum.limit[np.abs(np.log(spectrum.frequency_Hz / target_Hz)).argmin()])
    return max(config.polarisation_flag, 3.0 * limit / _LIMIT_TO_SIGMA)


def rise_flags(spectrum: Spectrum, at_Hz: float, config: PermittivityConfig) -> tuple[Flag, ...]:
    """Flag a rise towards low frequency that is too slow to be told from a relaxation."""
    first, second = steepening(
        spectrum.frequency_Hz, spectrum.capacitance_F.real, spectrum.loss, at_Hz
    )
    if first <= _told_from_meter(spectrum, at_Hz, config):
        return ()
    return (
        Flag(
            "low-frequency-rise",
            f"capacitance and loss rise together towards low frequency, by {100 * first:.2g} % "
            f"over the decade above {at_Hz:g} Hz and by {100 * second:.2g} % over the next: "
            "electrode polarisation, or a relaxation below the sweep; the value is what was "
            "measured, both included",
        ),
    )


def polarisation_told(rise: Rise) -> str:
    """Say what electrode polarisation does to the capacitance."""
    return (
        f"capacitance and loss rise together towards low frequency, as f^-{rise.exponent:.2g}: "
        f"{100 * rise.height:.2g} % of the film's at {rise.reference_Hz:g} Hz. Electrodes polarise "
        "(ions in the film), or a relaxation lies below the sweep"
    )


def conduction_flags(spectrum: Spectrum, target_Hz: float, u_loss: float) -> tuple[Flag, ...]:
    """Flag a loss that is that of a current through the film, told from the meter's own error.

    Parameters
    ----------
    u_loss : standard uncertainty of the loss by the meter `[1]`
    """
    part = conducted(spectrum.frequency_Hz, spectrum.loss, target_Hz)
    if part < max(_LOSS_BY_CONDUCTION, 3.0 * u_loss):
        return ()
    return (
        Flag(
            "conduction",
            f"{part:.2g} of the loss falls as 1/f from {target_Hz:g} Hz on: it is that of a "
            "current through the film or along its surface, not of its polarisation",
        ),
    )
