r"""Viscosity at the shear rate of printing, which viscometers hardly reach.

Beyond the shear rates measured a power law may bend: its index is uncertain by `u_index_beyond`
more, so that $u(\ln \mu) = u_n \ln(q / q_\mathrm{measured})$, and further than
`extrapolation_decades` it is not trusted at all.
"""

from __future__ import annotations

import math

from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution
from deamat.core.records import Flag
from deamat.techniques.viscosity.config import ViscosityConfig


def decades_beyond(rates: tuple[float, float], rate_per_s: float) -> float:
    """How far a shear rate lies outside a range, in powers of ten; 0 inside."""
    low, high = rates
    return max(math.log10(rate_per_s / high), math.log10(low / rate_per_s), 0.0)


def extrapolation(
    rates: tuple[float, float], viscosity_Pas: float, config: ViscosityConfig
) -> tuple[list[Contribution], tuple[Flag, ...]]:
    """Give the budget line and the flag of a viscosity outside the shear rates measured."""
    rate = config.printing_rate_per_s
    if rate is None or not (beyond := decades_beyond(rates, rate)):
        return [], ()
    u = config.u_index_beyond * beyond * math.log(10.0) * viscosity_Pas
    flag = Flag(
        "extrapolated",
        f"shear rates from {rates[0]:.3g} to {rates[1]:.3g} 1/s were measured; {rate:g} 1/s lies "
        f"{beyond:.2g} powers of ten beyond, and n may be another there (by "
        f"{config.u_index_beyond:g}, one standard uncertainty)",
    )
    return [Contribution("n beyond the shear rates measured", u, shared=True)], (flag,)


def too_far(rates: tuple[float, float], config: ViscosityConfig) -> FitRefused | None:
    """Refuse a printing rate beyond the limit of extrapolation; None within it."""
    rate = config.printing_rate_per_s
    if rate is None or decades_beyond(rates, rate) <= config.extrapolation_decades:
        return None
    return FitRefused(
        f"shear rates from {rates[0]:.3g} to {rates[1]:.3g} 1/s were measured, and {rate:g} 1/s "
        f"lies {decades_beyond(rates, rate):.2g} powers of ten beyond, more than "
        f"`extrapolation_decades` = {config.extrapolation_decades:g}; measure a flow curve"
    )


def one_rate(config: ViscosityConfig) -> FitRefused | None:
    """Refuse the printing rate to a law of readings at one speed; None where none is asked for."""
    if config.printing_rate_per_s is None:
        return None
    return FitRefused(
        "the law knows the shear rate of its readings alone, so nothing tells what viscosity is at "
        f"{config.printing_rate_per_s:g} 1/s; sweep the speeds, or measure a flow curve"
    )
