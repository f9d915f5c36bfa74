"""From cards to a strip: the best passive layer, how far it bends, how surely, and what to test."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, TypeAlias

import numpy as np

from deamat.actuator.declared import Designs, Electrode, Wanted
from deamat.actuator.ingredients import Ingredients, Where, gather, inputs_of, strip_of
from deamat.actuator.next_test import TestValue, next_tests, plan
from deamat.actuator.ranges import Reals, check, within
from deamat.actuator.strip import (
    Allowed,
    Floats,
    Strip,
    best_passive,
    blocked_force,
    breakdown_voltage,
    curvature,
    curvature_or_nan,
    failure_probability,
    highest_voltage,
    pull_in_limit,
    true_field,
)
from deamat.actuator.uncertainty import (
    Bar,
    FirstOrder,
    Input,
    MonteCarlo,
    Response,
    first_order,
    monte_carlo,
    sample,
    tornado,
)
from deamat.core.errors import MissingProperty
from deamat.core.units import to_si
from deamat.materials.card import MaterialCard

Bound: TypeAlias = Literal["given", "breakdown", "pull-in"]

_POINTS = 60  # of the curves against voltage: the part that breaks down is steep
_DRAWS = 20_000
_PLANNED = 10  # specimens


@dataclass(frozen=True, slots=True)
class Request:
    """What a designer asks for.

    Parameters
    ----------
    de, passive, electrode : material ids of the database, key of a declared electrode
    de_thickness_m : of the film as made `[m]`
    passive_thickness_m : None takes the one that bends most
    voltage_V : None takes the highest allowed one
    breakdown_probability : None takes the declared one
    where : conditions of the records, see `ingredients.gather`
    """

    de: str
    passive: str
    electrode: str
    de_thickness_m: float
    passive_thickness_m: float | None = None
    voltage_V: float | None = None
    breakdown_probability: float | None = None
    where: Where = field(default_factory=dict)

    def __post_init__(self) -> None:
        check("thickness_m", self.de_thickness_m, "the de layer")
        if self.passive_thickness_m is not None:
            check("thickness_m", self.passive_thickness_m, "the passive layer")
        if self.voltage_V is not None:
            check("voltage_V", self.voltage_V, "the de layer")
            if self.voltage_V == 0.0:
                within("voltage_V", 0.0, 1e-3, 1e6, "V", "a film without voltage does not bend")

    @classmethod
    def of(cls, wanted: Wanted) -> Request:
        """Take a design of `config/designs.toml`."""
        passive, voltage = wanted.passive_thickness_um, wanted.voltage_kV
        return cls(
            wanted.de,
            wanted.passive,
            wanted.electrode,
            to_si(wanted.de_thickness_um, "um"),
            None if passive is None else to_si(passive, "um"),
            None if voltage is None else to_si(voltage, "kV"),
        )


@dataclass(frozen=True, slots=True)
class Point:
    """One point of curvature against voltage; `u` to first order, NaN where it does not hold."""

    voltage_V: float
    curvature_per_m: float
    u_per_m: float
    true_field_V_m: float
    failure_probability: float | None


@dataclass(frozen=True, slots=True, eq=False)
class Design:
    """An answered request.

    Parameters
    ----------
    ingredients, electrode, strip, inputs : what it rests on
    best_passive_thickness_m : the one that bends most at this voltage `[m]`
    voltage_V, bound : of the answer, and what sets it
    allowed : limits of the voltage
    pull_in_limit_V : the allowed part of the pull-in voltage `[V]`
    breakdown_voltage_V : of the allowed probability; infinite if the film pulls in before, None
        if the breakdown is not known
    prediction, draws : curvature with uncertainty, to first order and by Monte Carlo `[1/m]`
    failure_probability : at the values; `failure_interval95` by Monte Carlo; None if unknown
    blocked_force_N : at the tip
    tornado, next_tests : what dominates, and which test narrows the curvature most
    plan : on what the next ten specimens are best spent, one after the other
    points : curvature against voltage up to `voltage_V`
    """

    request: Request
    ingredients: Ingredients
    electrode: Electrode
    strip: Strip
    inputs: tuple[Input, ...]
    best_passive_thickness_m: float
    voltage_V: float
    bound: Bound
    allowed: Allowed
    pull_in_limit_V: float
    breakdown_voltage_V: float | None
    prediction: FirstOrder
    draws: MonteCarlo
    failure_probability: float | None
    failure_interval95: tuple[float, float] | None
    blocked_force_N: float
    tornado: tuple[Bar, ...]
    next_tests: tuple[TestValue, ...]
    plan: tuple[TestValue, ...]
    points: tuple[Point, ...]
    notes: tuple[str, ...]

    @property
    def synthetic(self) -> tuple[str, ...]:
        """Materials whose card is simulated; whoever shows the design must say so."""
        return self.ingredients.synthetic


def design(cards: Mapping[str, MaterialCard], declared: Designs, request: Request) -> Design:
    """Answer a request from cards and declared facts.

    Parameters
    ----------
    cards : a database of `open_database`, or any mapping of material id to card
    declared : `config/designs.toml`
    request : what is wanted

    Raises
    ------
    MissingProperty : a card lacks a property, or no voltage is given and the breakdown is unknown
    MixedConditions : cards in two states of cure or age
    OutOfRange : a length or voltage outside its range, above pull-in, or above the voltage of the
        allowed breakdown probability
    ConfigError : an electrode that is not declared
    """
    electrode = declared.electrode(request.electrode)
    found = gather(cards[request.de], cards[request.passive], declared, request.where)
    allowed = allowed_for(declared, request, found)
    # The best passive layer depends on the voltage through the thinning alone, and not the other
    # way round: any passive thickness serves to find the voltage.
    trial = strip_of(found, declared, electrode, request.de_thickness_m, request.de_thickness_m)
    voltage, bound = choose_voltage(trial, allowed, request, found)
    best = float(best_passive(trial, voltage))
    passive = best if request.passive_thickness_m is None else request.passive_thickness_m
    strip = replace(trial, passive_thickness_m=passive)
    known = found.strength is not None
    inputs = inputs_of(found, strip, declared, electrode, breakdown=bound == "breakdown")
    response = respond(strip, voltage if bound == "given" else allowed)
    prediction = first_order(inputs, response)
    chance, interval = _failure(strip, found, declared, electrode, voltage, allowed)
    size = declared.geometry
    force = blocked_force(strip, voltage, to_si(size.length_mm, "mm"), to_si(size.width_mm, "mm"))
    return Design(
        request, found, electrode, strip, inputs, best, voltage, bound, allowed,
        float(pull_in_limit(strip, allowed)),
        float(breakdown_voltage(strip, allowed)) if known else None,
        prediction, monte_carlo(inputs, response, _DRAWS), chance, interval, float(force),
        tornado(inputs, response), next_tests(inputs, prediction),
        plan(inputs, prediction, _PLANNED),
        _points(strip, found, declared, electrode, voltage, allowed),
        _notes(found, declared, electrode, prediction, allowed),
    )  # fmt: skip


def allowed_for(declared: Designs, request: Request, found: Ingredients) -> Allowed:
    """Give the limits of the voltage: the declared ones, where the request says nothing else."""
    asked = request.breakdown_probability
    limits = declared.limits
    return Allowed(
        limits.breakdown_probability if asked is None else asked,
        limits.pull_in_fraction,
        found.area_ratio,
    )


def choose_voltage(
    strip: Strip, allowed: Allowed, request: Request, found: Ingredients
) -> tuple[float, Bound]:
    """Take the voltage asked for if it is allowed, or the highest allowed one.

    Raises
    ------
    MissingProperty : none is asked for and the breakdown is unknown
    OutOfRange : above pull-in, or above the voltage of the allowed breakdown probability
    """
    given = request.voltage_V
    if given is None:
        if found.strength is None:
            raise MissingProperty(
                f"the breakdown limit of {request.de} is unknown ({found.unknown}): no range of "
                "voltage can be given; test its breakdown, or give a voltage"
            )
        limited = breakdown_voltage(strip, allowed) <= pull_in_limit(strip, allowed)
        return float(highest_voltage(strip, allowed)), "breakdown" if limited else "pull-in"
    curvature(strip, given)  # refuses a voltage above pull-in
    if found.strength is not None:
        within(
            "voltage_V",
            given,
            0.0,
            float(breakdown_voltage(strip, allowed)),
            "V",
            f"above it more than {100 * allowed.breakdown_probability:g} % of the films break "
            "down: lower the voltage, or allow another probability",
            "the de layer",
        )
    return given, "given"


def respond(strip: Strip, at: float | Allowed) -> Response:
    """Give the curvature by the inputs, at a voltage or at the highest allowed one."""

    def response(values: Mapping[str, Floats]) -> Reals:
        moved = strip.moved(values)
        voltage = highest_voltage(moved, at) if isinstance(at, Allowed) else at
        return curvature_or_nan(moved, voltage)

    if isinstance(at, Allowed) and strip.breakdown_strength_V_m is None:
        raise MissingProperty("the breakdown limit is unknown: give a voltage")
    return response


def _failure(
    strip: Strip,
    found: Ingredients,
    declared: Designs,
    electrode: Electrode,
    voltage_V: float,
    allowed: Allowed,
) -> tuple[float | None, tuple[float, float] | None]:
    if found.strength is None:
        return None, None
    inputs = inputs_of(found, strip, declared, electrode, breakdown=True)
    drawn = strip.moved(sample(inputs, _DRAWS, seed=1))
    chances = failure_probability(drawn, voltage_V, allowed.area_ratio)
    low, high = np.quantile(chances, (0.025, 0.975))
    return float(failure_probability(strip, voltage_V, allowed.area_ratio)), (
        float(low),
        float(high),
    )


def _points(
    strip: Strip,
    found: Ingredients,
    declared: Designs,
    electrode: Electrode,
    highest_V: float,
    allowed: Allowed,
) -> tuple[Point, ...]:
    inputs = inputs_of(found, strip, declared, electrode, breakdown=False)
    points = []
    for voltage in np.linspace(0.0, highest_V, _POINTS + 1)[1:].tolist():
        there = first_order(inputs, respond(strip, voltage))
        chance = None
        if found.strength is not None:
            chance = float(failure_probability(strip, voltage, allowed.area_ratio))
        points.append(
            Point(
                voltage,
                there.value,
                there.u if there.holds else math.nan,
                float(true_field(strip, voltage)),
                chance,
            )
        )
    return tuple(points)


def _notes(
    found: Ingredients,
    declared: Designs,
    electrode: Electrode,
    prediction: FirstOrder,
    allowed: Allowed,
) -> tuple[str, ...]:
    notes = list(found.notes)
    if found.strength is None:
        notes.append(f"the breakdown limit is unknown: {found.unknown}")
    elif allowed.breakdown_probability * found.strength.n < 1:
        notes.append(
            f"{100 * allowed.breakdown_probability:g} % of broken films is extrapolated from "
            f"{found.strength.n} tests by the Weibull law"
        )
    if electrode.u_youngs_modulus_MPa is None:
        notes.append(f"no uncertainty is declared of the modulus of {electrode.name}: not counted")
    notes.append("no uncertainty is declared of Poisson's ratio: not counted")
    if not prediction.holds:
        notes.append(
            "the model bends too much within its uncertainties for first order: take the interval "
            "by Monte Carlo"
        )
    notes.append(
        f"Young's modulus is the {declared.model.modulus}; "
        f"in-plane rule {declared.model.in_plane}; curvature without weight"
    )
    return tuple(notes)
