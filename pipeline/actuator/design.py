"""From cards to a strip: the best passive layer, how far it bends, how surely, and what to test."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from deamat.actuator.case import Bound, Cards, Case, Drive, choose_drive, design_case
from deamat.actuator.declared import Designs
from deamat.actuator.inputs import Input, inputs_of
from deamat.actuator.model import actuate, blocked_force, respond, respond_by_failing
from deamat.actuator.next_test import TestValue, next_tests, plan
from deamat.actuator.request import Request
from deamat.actuator.strip import Strip
from deamat.actuator.uncertainty import (
    Bar,
    FirstOrder,
    MonteCarlo,
    first_order,
    first_orders,
    monte_carlo,
    tornado,
)

_POINTS = 60  # of the curves against voltage: the part that breaks down is steep
_DRAWS = 20_000
_PLANNED = 10  # specimens


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
    case : the request with all that the answer rests on: values of cards, limits of the voltage
    drive : voltage of the answer, what sets it, and the passive layer that bends most
    strip, inputs : what was predicted, and its uncertain numbers
    prediction, draws : curvature with uncertainty, to first order and by Monte Carlo `[1/m]`
    failure_probability : at the values; `failure_interval95` by Monte Carlo; None if unknown
    blocked_force_N : at the tip
    tornado, next_tests : what dominates, and which test narrows the curvature most
    plan : on what the next ten specimens are best spent, one after the other
    points : curvature against voltage up to `voltage_V`
    """

    case: Case
    drive: Drive
    strip: Strip
    inputs: tuple[Input, ...]
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
    def voltage_V(self) -> float:
        """Voltage of the answer `[V]`."""
        return self.drive.voltage_V

    @property
    def bound(self) -> Bound:
        """What sets the voltage of the answer."""
        return self.drive.bound

    @property
    def synthetic(self) -> tuple[str, ...]:
        """Materials whose card is simulated; whoever shows the design must say so."""
        return self.case.values.synthetic


def design(cards: Cards, declared: Designs, request: Request) -> Design:
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
    case = design_case(cards, declared, request)
    drive = choose_drive(case)
    strip = case.strip
    if request.passive_thickness_m is None:
        strip = replace(strip, passive_thickness_m=drive.best_passive_thickness_m)
    known = inputs_of(case.values, declared, case.electrode, strip)
    at_voltage = tuple(x for x in known if not x.concerns_breakdown)
    # A film that is driven to its breakdown limit bends as uncertainly as it breaks down
    inputs = known if drive.bound == "breakdown" else at_voltage
    response = respond(strip, drive.voltage_V if drive.bound == "given" else case.limits.allowed)
    prediction = first_order(inputs, response)
    draws = monte_carlo(inputs, response, _DRAWS)
    bars = tornado(inputs, prediction, response)
    answer = actuate(strip, drive.voltage_V)
    chance, interval = None, None
    if case.limits.breakdown_V is not None:
        chance = float(answer.failure_probability())
        failing = respond_by_failing(strip, drive.voltage_V)
        interval = monte_carlo(known, failing, _DRAWS, seed=1).interval95
    return Design(
        case, drive, strip, inputs, prediction, draws, chance, interval,
        float(blocked_force(answer, declared.geometry)), bars, next_tests(inputs, prediction),
        plan(inputs, prediction, _PLANNED), _points(case, strip, at_voltage, drive.voltage_V),
        _notes(case, prediction),
    )  # fmt: skip


def _points(
    case: Case, strip: Strip, inputs: Sequence[Input], highest_V: float
) -> tuple[Point, ...]:
    voltages = np.linspace(0.0, highest_V, _POINTS + 1)[1:]
    bent = first_orders(inputs, respond(strip, voltages[:, None]), _POINTS)
    points = []
    for voltage, there in zip(voltages.tolist(), bent, strict=True):
        actuated = actuate(strip, voltage)
        known = case.limits.breakdown_V is not None
        points.append(
            Point(
                voltage,
                there.value,
                there.u if there.holds else math.nan,
                float(actuated.true_field_V_m),
                float(actuated.failure_probability()) if known else None,
            )
        )
    return tuple(points)


def _notes(case: Case, prediction: FirstOrder) -> tuple[str, ...]:
    values, electrode, model = case.values, case.electrode, case.declared.model
    probability = case.limits.allowed.breakdown_probability
    notes = list(values.notes)
    if values.strength is None:
        notes.append(f"the breakdown limit is unknown: {values.unknown}")
    elif probability * values.strength.n < 1:
        notes.append(
            f"{100 * probability:g} % of broken films is extrapolated from "
            f"{values.strength.n} tests by the Weibull law"
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
        f"Young's modulus is the {model.modulus}; "
        f"in-plane rule {model.in_plane}; curvature without weight"
    )
    return tuple(notes)
