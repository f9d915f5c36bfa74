"""Where in a sweep the value of the card is read, and what the sweep's faults do to it there."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution
from deamat.core.records import Flag
from deamat.estimators.dielectric.sweep import Position, beyond_end, position
from deamat.techniques.permittivity.config import PermittivityConfig
from deamat.techniques.permittivity.faults import (
    Found,
    Smooth,
    first_sweep,
    polarisation_told,
    polarised,
    rise_flags,
    smooth,
)
from deamat.techniques.permittivity.spectrum import Spectrum

_LIMIT_TO_SIGMA = math.sqrt(3.0)
_SETTING = "card_frequency_Hz of [permittivity] in config/methods.toml"


@dataclass(frozen=True, slots=True)
class CardPoint:
    """The value of the card in a sweep.

    Parameters
    ----------
    spectrum : the sound points of the first sweep, or of all that agree
    frequency_Hz : the one asked for, or the nearest sound one
    where : in the spectrum
    factor : on the permittivity, half-way over the steps of the meter `[1]`
    found : what the faults of the sweep add
    not_at : why there is no value at the frequency asked for; empty if there is
    no_loss : why there is no loss; empty if there is
    """

    spectrum: Spectrum
    frequency_Hz: float
    where: Position
    factor: float
    found: Found
    not_at: str
    no_loss: str


def card_point(spectrum: Spectrum, config: PermittivityConfig) -> CardPoint:
    """Find the card's frequency among the sound points of a sweep.

    Raises
    ------
    FitRefused : over-range at that frequency, or nothing that is sound near it
    """
    target, flags = _asked_for(spectrum, config)
    spectrum, found = first_sweep(spectrum, target, config)
    frequencies = int(np.count_nonzero(np.diff(spectrum.frequency_Hz))) + 1
    if frequencies < config.min_points:
        raise FitRefused(
            f"a sweep over {frequencies} frequencies, {config.min_points} are needed (min_points "
            "of [permittivity] in config/methods.toml)",
            {"points": frequencies, "points_needed": config.min_points},
        )
    smoothed = smooth(spectrum, target, config)
    spectrum = smoothed.spectrum
    where, target, aside = _among_sound(smoothed, target, config)
    found = Found(flags=flags) + found + aside
    target, moved, not_at = _free_of_polarisation(spectrum, target, config)
    if not_at:
        where = position(
            spectrum.frequency_Hz, target, config.frequency_tolerance, config.widest_gap_decades
        )
    found += moved
    across = smoothed.other_sides(target)
    if smoothed.heights:
        half = 0.5 * math.fsum(map(abs, smoothed.heights))
        found += Found((Contribution("step of the meter's range", half, shared=True),))
    return CardPoint(
        spectrum, target, where, math.exp(0.5 * across), found, not_at, smoothed.loss_step
    )


def _free_of_polarisation(
    spectrum: Spectrum, target_Hz: float, config: PermittivityConfig
) -> tuple[float, Found, str]:
    """Move to the lowest stated frequency that polarised electrodes do not distort.

    Returns
    -------
    the frequency, what polarisation adds there, and why it is not the one asked for (empty if it
    is)

    Raises
    ------
    FitRefused : it is too strong, and no stated frequency of the sweep is free of it
    """
    rise = polarised(spectrum, target_Hz, config)
    if rise is None:
        return target_Hz, Found(flags=rise_flags(spectrum, target_Hz, config)), ""
    told, at, not_at = polarisation_told(rise), target_Hz, ""
    if rise.height > config.max_polarisation:
        top = float(spectrum.frequency_Hz[-1]) * (1.0 + config.frequency_tolerance)
        stated = [f for f in config.stated_frequencies_Hz if target_Hz < f <= top]
        free = [f for f in stated if rise.at(f) < config.polarisation_over]
        if not free:
            raise FitRefused(
                f"{told}; no stated frequency of the sweep is free of it: measure to higher "
                f"frequencies, or clean the film of ions ({_SETTING} says what is asked for)",
                {"rise": rise.height},
            )
        at = free[0]
        told = not_at = (
            f"{told}; the value is that at {at:g} Hz, where it is less than "
            f"{100 * config.polarisation_over:g} % ({_SETTING} says what is asked for)"
        )
    line = Contribution("electrode polarisation", rise.at(at) / _LIMIT_TO_SIGMA, shared=True)
    return at, Found((line,), flags=(Flag("electrode-polarisation", told),)), not_at


def _asked_for(spectrum: Spectrum, config: PermittivityConfig) -> tuple[float, tuple[Flag, ...]]:
    """Return the card's frequency, or the nearest measured one with a flag.

    A point that was over-range there is not replaced by its neighbours.
    """
    card, tolerance, f = config.card_frequency_Hz, config.frequency_tolerance, spectrum.frequency_Hz
    lost = spectrum.lost_Hz[np.abs(spectrum.lost_Hz / card - 1.0) <= tolerance]
    if lost.size and np.abs(f / card - 1.0).min() > tolerance:
        raise FitRefused(
            f"the point at {lost[0]:g} Hz is marked over-range by the meter; choose a range "
            "that holds the film's impedance there, or a larger film",
            {"points": int(f.size)},
        )
    try:
        position(f, card, tolerance, config.widest_gap_decades)
    except FitRefused as error:
        nearest = _round(float(f[np.abs(np.log(f / card)).argmin()]))
        return nearest, (_other_frequency(error.reason, nearest),)
    return card, ()


def _round(frequency_Hz: float) -> float:
    """Keep four digits, so that films measured with one setting share one condition."""
    return float(f"{frequency_Hz:.4g}")


def _other_frequency(reason: str, frequency_Hz: float) -> Flag:
    return Flag(
        "other-frequency",
        f"{reason}; this is the value at {frequency_Hz:g} Hz, the nearest that was measured "
        f"({_SETTING} says which one is asked for)",
    )


def _among_sound(
    smoothed: Smooth, target_Hz: float, config: PermittivityConfig
) -> tuple[Position, float, Found]:
    """Find a frequency among the points that are left, and what their distance adds."""
    found = Found(flags=smoothed.flags)
    spectrum, tolerance = smoothed.spectrum, config.frequency_tolerance
    f = spectrum.frequency_Hz
    lost = any(abs(d / target_Hz - 1.0) <= tolerance for d in smoothed.dropped_Hz)
    try:
        where = position(f, target_Hz, tolerance, config.widest_gap_decades)
    except FitRefused as error:
        beyond = beyond_end(f, target_Hz, config.widest_extrapolation_decades)
        if beyond is None:
            nearest = _round(float(f[np.abs(np.log(f / target_Hz)).argmin()]))
            where = position(f, nearest, tolerance, config.widest_gap_decades)
            return where, nearest, found + Found(flags=(_other_frequency(error.reason, nearest),))
        where = beyond
    if not (lost or where.extrapolated):
        return where, target_Hz, found
    return (
        where,
        target_Hz,
        found
        + Found(
            (_from_neighbours(where, spectrum.capacitance_F.real, relative=True),),
            (_from_neighbours(where, spectrum.loss, relative=False),),
        ),
    )


def _from_neighbours(where: Position, values: FloatArray, *, relative: bool) -> Contribution:
    """Count the distance to the nearest of the neighbours as a limit of error."""
    value = where.of(values)
    scale = value if relative else 1.0
    off = float(np.abs(values[where.indices] - value).min() if where.extrapolated
                else np.abs(values[where.indices] - value).max())  # fmt: skip
    return Contribution("read from the neighbours", off / scale / _LIMIT_TO_SIGMA, shared=False)
