"""All compositions side by side: which film on which passive layer, and what one buys with what.

Source: Sikulskyi et al. 2022, Figure 11 (one composition throughout, or mixed ones).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from deamat.actuator.declared import Designs
from deamat.actuator.design import Bound, Request, allowed_for, choose_voltage
from deamat.actuator.ingredients import Ingredients, gather, strip_of
from deamat.actuator.strip import (
    Allowed,
    Floats,
    Strip,
    best_passive,
    blocked_force,
    curvature,
    highest_voltage,
    pull_in_limit,
    true_field,
)
from deamat.core.errors import MissingProperty, OutOfRange, PipelineError
from deamat.core.units import to_si
from deamat.materials.card import MaterialCard

_RATIOS = np.geomspace(0.02, 3.0, 61)  # passive thickness over that of the film
_PARETO_RATIOS = np.geomspace(0.1, 3.0, 16)
_VOLTAGES = 20

Cards = Mapping[str, MaterialCard]


@dataclass(frozen=True, slots=True, eq=False)
class Composition:
    """One film on one passive layer.

    Parameters
    ----------
    voltage_V, bound, true_field_V_m : what drives it, and what sets the voltage
    passive_thickness_m, curvature_per_m : the curve of Figure 11, shape (n,) each
    best_passive_thickness_m, best_curvature_per_m : its top
    without_electrodes_per_m : the top if electrodes had no stiffness
    """

    de: str
    passive: str
    synthetic: bool
    voltage_V: float
    bound: Bound
    true_field_V_m: float
    passive_thickness_m: Floats
    curvature_per_m: Floats
    best_passive_thickness_m: float
    best_curvature_per_m: float
    without_electrodes_per_m: float


@dataclass(frozen=True, slots=True)
class Refused:
    """A pair that cannot be compared, and why."""

    de: str
    passive: str
    reason: str


@dataclass(frozen=True, slots=True)
class Trade:
    """One design that no other one beats in curvature, voltage and blocked force at once."""

    de: str
    passive: str
    passive_thickness_m: float
    voltage_V: float
    curvature_per_m: float
    blocked_force_N: float


@dataclass(frozen=True, slots=True)
class _Pair:
    found: Ingredients
    strip: Strip
    allowed: Allowed


def compare(
    cards: Cards, declared: Designs, request: Request
) -> tuple[tuple[Composition, ...], tuple[Refused, ...]]:
    """Compare all films, each on itself and on the passive layer asked for (Figures 11A and B).

    Parameters
    ----------
    cards : all materials
    declared : `config/designs.toml`
    request : its film thickness, electrode, voltage and passive material hold for all

    Returns
    -------
    what can be compared, most curvature first, and what cannot, with the reason
    """
    answered: list[Composition] = []
    refused: list[Refused] = []
    pairs = [(m, m) for m in cards] + [(m, request.passive) for m in cards]
    for de, passive in dict.fromkeys(pairs):
        try:
            answered.append(_composition(cards, declared, replace(request, de=de, passive=passive)))
        except PipelineError as error:
            refused.append(Refused(de, passive, str(error)))
    answered.sort(key=lambda c: -c.best_curvature_per_m)
    return tuple(answered), tuple(refused)


def pareto(cards: Cards, declared: Designs, request: Request) -> tuple[Trade, ...]:
    """Give the designs that are best in curvature, voltage or blocked force, or in between.

    All films on all passive layers, 16 thicknesses of the passive layer from 0.1 to 3 of that of
    the film, at least 20 voltages up to what breakdown and pull-in (or the
    voltage asked for) allow.

    Parameters
    ----------
    cards, declared, request : as for `compare`

    Returns
    -------
    least voltage first

    Raises
    ------
    MissingProperty : no pair can be driven; the first reason is told
    """
    tops: list[tuple[_Pair, float]] = []
    reason = "the database is empty"
    for de, passive in ((a, b) for a in cards for b in cards):
        try:
            pair = _pair(cards, declared, replace(request, de=de, passive=passive))
            tops.append((pair, _top(pair, request)))
        except PipelineError as error:
            reason = str(error)
    if not tops:
        raise MissingProperty(f"no pair of materials can be driven: {reason}")
    highest = [top for _, top in tops]
    # Where a film ends it is at its best, so that the end of each is a voltage for all
    grid = np.unique([*highest, *(max(highest) * np.arange(1, _VOLTAGES) / _VOLTAGES)])
    size = declared.geometry
    length_m, width_m = to_si(size.length_mm, "mm"), to_si(size.width_mm, "mm")
    candidates: list[Trade] = []
    for pair, top in tops:
        candidates += _trades(pair, grid[grid <= top], length_m, width_m)
    return tuple(_unbeaten(candidates))


def _pair(cards: Cards, declared: Designs, request: Request) -> _Pair:
    electrode = declared.electrode(request.electrode)
    found = gather(cards[request.de], cards[request.passive], declared, request.where)
    thickness = request.de_thickness_m
    strip = strip_of(found, declared, electrode, thickness, thickness)
    return _Pair(found, strip, allowed_for(declared, request, found))


def _composition(cards: Cards, declared: Designs, request: Request) -> Composition:
    pair = _pair(cards, declared, request)
    strip = pair.strip
    voltage, bound = choose_voltage(strip, pair.allowed, request, pair.found)
    passive = _RATIOS * request.de_thickness_m
    bare = replace(strip, electrode_thickness_m=0.0)
    best = float(best_passive(strip, voltage))
    most = curvature(replace(strip, passive_thickness_m=best), voltage)
    most_bare = curvature(
        replace(bare, passive_thickness_m=float(best_passive(bare, voltage))), voltage
    )
    return Composition(
        request.de,
        request.passive,
        bool(pair.found.synthetic),
        voltage,
        bound,
        float(true_field(strip, voltage)),
        passive,
        np.asarray(curvature(replace(strip, passive_thickness_m=passive), voltage)),
        best,
        float(most),
        float(most_bare),
    )


def _top(pair: _Pair, request: Request) -> float:
    if pair.found.strength is not None:
        top = float(highest_voltage(pair.strip, pair.allowed))
    elif request.voltage_V is None:
        raise MissingProperty(
            f"the breakdown limit of {pair.found.film_modulus.material} is unknown "
            f"({pair.found.unknown}); test its breakdown, or give a voltage"
        )
    else:
        top = float(pull_in_limit(pair.strip, pair.allowed))
    return top if request.voltage_V is None else min(top, request.voltage_V)


def _trades(pair: _Pair, voltages: Floats, length_m: float, width_m: float) -> Iterator[Trade]:
    if not voltages.size:
        return
    passive, voltage = (
        a.ravel()
        for a in np.meshgrid(_PARETO_RATIOS * pair.strip.film_thickness_m, voltages, indexing="ij")
    )
    strip = replace(pair.strip, passive_thickness_m=passive)
    bent = np.asarray(curvature(strip, voltage))
    force = np.asarray(blocked_force(strip, voltage, length_m, width_m))
    de, below = pair.found.film_modulus.material, pair.found.passive_modulus.material
    for row in zip(passive.tolist(), voltage.tolist(), bent.tolist(), force.tolist(), strict=True):
        yield Trade(de, below, *row)


def _unbeaten(candidates: list[Trade]) -> list[Trade]:
    ordered = sorted(
        candidates, key=lambda t: (t.voltage_V, -t.curvature_per_m, -t.blocked_force_N)
    )
    kept: list[Trade] = []
    front = np.empty((0, 2))
    for trade in ordered:
        here = np.array([trade.curvature_per_m, trade.blocked_force_N])
        if (front >= here).all(axis=1).any():
            continue
        kept.append(trade)
        # What lies below it is beaten only at higher voltages: it stays in `kept`, not in `front`
        front = np.vstack([front[~(front <= here).all(axis=1)], here])
    if not kept:
        raise OutOfRange("no candidate can be driven")
    return kept
