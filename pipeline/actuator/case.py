"""A design case: everything that a request rests on, found once, read by all that follows.

The way of a design is `Request` -> `Case` (values of cards, strip, limits) -> `Drive` -> answer.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

from deamat.actuator.card_values import CardValues, gather
from deamat.actuator.declared import Designs, Electrode
from deamat.actuator.limits import Allowed, Limits, voltage_limits
from deamat.actuator.model import best_passive
from deamat.actuator.ranges import within
from deamat.actuator.request import Request
from deamat.actuator.strain import film_drive
from deamat.actuator.strip import Strip
from deamat.core.errors import MissingProperty
from deamat.core.units import to_si
from deamat.materials.card import MaterialCard

Bound: TypeAlias = Literal["given", "breakdown", "pull-in"]
Cards: TypeAlias = Mapping[str, MaterialCard]


@dataclass(frozen=True, slots=True, eq=False)
class Case:
    """What one request rests on.

    Parameters
    ----------
    request, declared, electrode : what is asked, and declared facts
    values : records of the cards
    strip : at these values; where the request leaves the passive thickness open it is that of the
        film, which moves no limit
    limits : of its voltage
    """

    request: Request
    declared: Designs
    electrode: Electrode
    values: CardValues
    strip: Strip
    limits: Limits


@dataclass(frozen=True, slots=True)
class Drive:
    """What drives a case.

    Parameters
    ----------
    voltage_V, bound : of the answer, and what sets it
    best_passive_thickness_m : the one that bends most at this voltage `[m]`
    """

    voltage_V: float
    bound: Bound
    best_passive_thickness_m: float


def design_case(cards: Cards, declared: Designs, request: Request) -> Case:
    """Find what a request rests on.

    Parameters
    ----------
    cards, declared, request : as for `design.design`

    Raises
    ------
    ConfigError : an electrode that is not declared
    MissingProperty : a card lacks a property
    MixedConditions : cards in two states of cure or age
    OutOfRange : a number outside its range
    """
    electrode = declared.electrode(request.electrode)
    values = gather(cards[request.de], cards[request.passive], declared, request.where)
    asked, limits = request.breakdown_probability, declared.limits
    allowed = Allowed(
        limits.breakdown_probability if asked is None else asked,
        limits.pull_in_fraction,
    )
    strip = Strip(
        film_modulus_Pa=values.film_modulus.quantity.value,
        relative_permittivity=values.permittivity.quantity.value,
        poisson_ratio=declared.elastomer.poisson_ratio,
        film_thickness_m=request.de_thickness_m,
        passive_modulus_Pa=values.passive_modulus.quantity.value,
        passive_thickness_m=request.passive_thickness_m or request.de_thickness_m,
        electrode_modulus_Pa=to_si(electrode.youngs_modulus_MPa, "MPa"),
        electrode_thickness_m=to_si(electrode.thickness_um, "um"),
        in_plane=declared.model.in_plane,
        breakdown_strength_V_m=values.strength.quantity.value if values.strength else None,
        weibull_shape=values.shape.quantity.value if values.shape else None,
        area_ratio=values.area_ratio,
    )
    return Case(request, declared, electrode, values, strip, voltage_limits(strip, allowed))


def choose_drive(case: Case) -> Drive:
    """Take the voltage asked for if it is allowed, or the highest allowed one.

    The best passive layer depends on the voltage through the thinning alone, and not the other
    way round.

    Raises
    ------
    MissingProperty : none is asked for and the breakdown is unknown
    OutOfRange : above pull-in, or above the voltage of the allowed breakdown probability
    """
    voltage, bound = _voltage(case)
    return Drive(voltage, bound, float(best_passive(case.strip, voltage)))


def highest_voltage(case: Case) -> tuple[float, Bound]:
    """Return the highest allowed voltage, and what sets it.

    Raises
    ------
    MissingProperty : the breakdown is not known
    """
    limits = case.limits
    if limits.breakdown_V is None:
        raise MissingProperty(
            f"the breakdown limit of {case.request.de} is unknown ({case.values.unknown}): no "
            "range of voltage can be given; test its breakdown, or give a voltage"
        )
    breaks_first = limits.breakdown_V <= limits.pull_in_V
    return float(limits.highest_V), "breakdown" if breaks_first else "pull-in"


def _voltage(case: Case) -> tuple[float, Bound]:
    given, limits, strip = case.request.voltage_V, case.limits, case.strip
    if given is None:
        return highest_voltage(case)
    film_drive(  # refuses a voltage above pull-in
        given,
        strip.film_thickness_m,
        strip.film_modulus_Pa,
        strip.relative_permittivity,
        "the de layer",
    )
    if limits.breakdown_V is not None:
        percent = 100 * limits.allowed.breakdown_probability
        within(
            "voltage_V",
            given,
            0.0,
            float(limits.breakdown_V),
            "V",
            f"above it more than {percent:g} % of the films break down: lower the voltage, or "
            "allow another probability",
            "the de layer",
        )
    return given, "given"
