"""All compositions side by side: which film on which passive layer, and what one buys with what.

Source: Sikulskyi et al. 2022, Figure 11 (one composition throughout, or mixed ones).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from deamat.actuator.case import Bound, Cards, Case, choose_drive, design_case, highest_voltage
from deamat.actuator.declared import Designs
from deamat.actuator.model import actuate, best_passive, blocked_force
from deamat.actuator.request import Request
from deamat.core.arrays import FloatArray
from deamat.core.errors import MissingProperty, OutOfRange, PipelineError

_RATIOS = np.geomspace(0.02, 3.0, 61)  # passive thickness over that of the film
_PARETO_RATIOS = np.geomspace(0.1, 3.0, 16)
_VOLTAGES = 20


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
    passive_thickness_m: FloatArray
    curvature_per_m: FloatArray
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
    """Return the designs that are best in curvature, voltage or blocked force, or in between.

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
    MissingProperty : no pair can be driven; the last reason is named
    """
    tops: list[tuple[Case, float]] = []
    reason = "the database is empty"
    for de, passive in ((a, b) for a in cards for b in cards):
        try:
            case = design_case(cards, declared, replace(request, de=de, passive=passive))
            tops.append((case, _highest_voltage(case)))
        except PipelineError as error:
            reason = str(error)
    if not tops:
        raise MissingProperty(f"no pair of materials can be driven: {reason}")
    highest = [top for _, top in tops]
    # Where a film ends it is at its best, so that the end of each is a voltage for all
    grid = np.unique([*highest, *(max(highest) * np.arange(1, _VOLTAGES) / _VOLTAGES)])
    candidates: list[Trade] = []
    for case, top in tops:
        candidates += _trades(case, grid[grid <= top])
    return tuple(_unbeaten(candidates))


def _composition(cards: Cards, declared: Designs, request: Request) -> Composition:
    case = design_case(cards, declared, request)
    drive = choose_drive(case)
    strip, voltage = case.strip, drive.voltage_V
    bare = replace(strip, electrode_thickness_m=0.0)
    best, best_bare = drive.best_passive_thickness_m, float(best_passive(bare, voltage))
    passive = _RATIOS * request.de_thickness_m
    curve = actuate(replace(strip, passive_thickness_m=passive), voltage)
    top = actuate(replace(strip, passive_thickness_m=best), voltage)
    top_bare = actuate(replace(bare, passive_thickness_m=best_bare), voltage)
    return Composition(
        request.de,
        request.passive,
        bool(case.values.synthetic),
        voltage,
        drive.bound,
        float(top.true_field_V_m),
        passive,
        np.asarray(curve.curvature_per_m),
        best,
        float(top.curvature_per_m),
        float(top_bare.curvature_per_m),
    )


def _highest_voltage(case: Case) -> float:
    """Return how far a pair may be driven, or the voltage asked for if that is less `[V]`."""
    asked, limits = case.request.voltage_V, case.limits
    if asked is None:
        return highest_voltage(case)[0]
    allowed = limits.pull_in_V if limits.breakdown_V is None else limits.highest_V
    return min(float(allowed), asked)


def _trades(case: Case, voltages: FloatArray) -> Iterator[Trade]:
    if not voltages.size:
        return
    request = case.request
    passive, voltage = (
        a.ravel()
        for a in np.meshgrid(_PARETO_RATIOS * request.de_thickness_m, voltages, indexing="ij")
    )
    bent = actuate(replace(case.strip, passive_thickness_m=passive), voltage)
    force = np.asarray(blocked_force(bent, case.declared.geometry))
    columns = (passive, voltage, np.asarray(bent.curvature_per_m), force)
    for row in zip(*(column.tolist() for column in columns), strict=True):
        yield Trade(request.de, request.passive, *row)


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
