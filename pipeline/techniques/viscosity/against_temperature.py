"""One liquid at three temperatures or more: an Arrhenius law of its viscosity."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deamat.core.errors import FitRefused
from deamat.core.laws import ARRHENIUS
from deamat.core.properties import property_key
from deamat.core.recording import Specimen
from deamat.core.records import Condition, Law, Origin, PropertyRecord
from deamat.estimators.least_squares.arrhenius import LEAST_TEMPERATURES, fit_arrhenius
from deamat.techniques.viscosity.config import (
    AGAINST_TEMPERATURE,
    CONSISTENCY,
    INDEX,
    VISCOSITY,
)

# A liquid that thickens by more than this between its first and last stated time is curing, and
# what it has cured until the first, faster in the warmth, is in its viscosity.
_CURES = 0.1


@dataclass(frozen=True, slots=True)
class _Point:
    """Viscosity at one temperature, K q^(n - 1), with n = 1 and any rate for a Newtonian liquid."""

    temperature_K: float
    consistency: float
    index: float
    rates: tuple[float, float]
    u_relative: float
    shared_relative: float
    origins: tuple[Origin, ...]


def temperature_laws(records: Sequence[PropertyRecord], specimen: Specimen) -> tuple[Law, ...]:
    """Fit one law to flow curves at three temperatures or more, else to runs that do not cure.

    Returns
    -------
    the law, or none where there are fewer temperatures

    Raises
    ------
    FitRefused : the liquid cures, the curves have no shear rate in common, or viscosity does not
        fall with temperature
    """
    own = {k: v for k, v in specimen.conditions.items() if k != "temperature_K"}
    points = _flow_curves(records)
    if len(points) >= LEAST_TEMPERATURES:
        low, high = max(p.rates[0] for p in points), min(p.rates[1] for p in points)
        if not low <= high:
            raise FitRefused(
                f"flow curves at {len(points)} temperatures have no shear rate in common: one "
                f"begins at {low:.4g} 1/s, another ends at {high:.4g} 1/s"
            )
        rate = float(f"{math.sqrt(low * high):.6g}")
        return (_law(points, rate, {**own, "rate_per_s": rate}, specimen),)
    points, time_s = _runs(records)
    if len(points) < LEAST_TEMPERATURES:
        return ()
    return (_law(points, 1.0, {**own, "time_s": time_s}, specimen),)


def _flow_curves(records: Sequence[PropertyRecord]) -> list[_Point]:
    """Take the flow curves with a temperature of their own, the coldest first."""
    curves = [r for r in records if "time_s" not in r.conditions]
    indices = {_kelvin(r): r.quantity.value for r in curves if r.key == INDEX}
    points: dict[float, _Point] = {}
    for record in curves:
        kelvin, rates = _kelvin(record), record.conditions.get("rate_per_s")
        if kelvin is None or not isinstance(rates, tuple):
            continue
        if record.key == VISCOSITY:
            points[kelvin] = _point(record, kelvin, 1.0, (float(rates[0]), float(rates[1])))
        elif record.key == CONSISTENCY and kelvin in indices:
            index = indices[kelvin]
            points[kelvin] = _point(record, kelvin, index, (float(rates[0]), float(rates[1])))
    return [points[kelvin] for kelvin in sorted(points)]


def _runs(records: Sequence[PropertyRecord]) -> tuple[list[_Point], float]:
    """Take runs over time at their first stated time, and that time `[s]`.

    Raises
    ------
    FitRefused : three temperatures or more of a liquid that cures
    """
    found: dict[float, dict[float, PropertyRecord]] = {}
    for record in records:
        kelvin, time_s = _kelvin(record), record.conditions.get("time_s")
        if record.key == VISCOSITY and kelvin is not None and isinstance(time_s, float):
            found.setdefault(kelvin, {})[time_s] = record
    common = set.intersection(*(set(runs) for runs in found.values())) if found else set()
    if len(found) < LEAST_TEMPERATURES or not common:
        return [], 0.0
    first_s, last_s = min(common), max(common)
    points = []
    for kelvin, runs in sorted(found.items()):
        early, late = runs[first_s].quantity.value, runs[last_s].quantity.value
        if late > (1.0 + _CURES) * early:
            raise FitRefused(
                f"the liquid cures: at {kelvin:.4g} K its viscosity grows {late / early:.3g} times "
                f"from {first_s / 3600:.3g} h to {last_s / 3600:.3g} h, and how far it cured by "
                "then depends on temperature too; measure flow curves before mixing"
            )
        points.append(_point(runs[first_s], kelvin, 1.0, (0.0, math.inf)))
    return points, first_s


def _point(
    record: PropertyRecord, kelvin: float, index: float, rates: tuple[float, float]
) -> _Point:
    value = record.quantity.value
    return _Point(
        kelvin, value, index, rates, record.quantity.u_independent / value,
        record.quantity.u_shared / value, record.origins,
    )  # fmt: skip


def _kelvin(record: PropertyRecord) -> float | None:
    kelvin = record.conditions.get("temperature_K")
    return kelvin if isinstance(kelvin, float) else None


def _law(
    points: Sequence[_Point], rate: float, conditions: dict[str, Condition], specimen: Specimen
) -> Law:
    """Fit the law; what all viscosities share moves a and leaves E."""
    kelvin = [p.temperature_K for p in points]
    viscosity = [p.consistency * rate ** (p.index - 1.0) for p in points]
    fit = fit_arrhenius(kelvin, viscosity, [p.u_relative for p in points])
    a, energy = fit.coefficients.tolist()
    moved = np.array([a * max(p.shared_relative for p in points), 0.0])
    covariance = fit.covariance + np.outer(moved, moved)
    u_energy = math.sqrt(fit.covariance[1, 1])
    return Law(
        key=AGAINST_TEMPERATURE,
        material=specimen.material,
        campaign=specimen.campaign,
        kind=ARRHENIUS,
        unit=property_key(AGAINST_TEMPERATURE).unit,
        argument="temperature",
        argument_unit="K",
        coefficients=(a, energy),
        covariance=tuple(tuple(row) for row in covariance.tolist()),
        valid=(kelvin[0], kelvin[-1]),
        conditions=conditions,
        method=f"least squares on ln viscosity against 1/T at {len(points)} temperatures: "
        f"activation energy {energy / 1e3:.4g} -+ {u_energy / 1e3:.2g} kJ/mol",
        degrees_of_freedom=None if math.isinf(fit.dof) else fit.dof,
        relative_scatter=fit.relative_scatter,
        diagnostics={
            "temperatures": len(points),
            "activation_energy_J_per_mol": energy,
            "u_activation_energy_J_per_mol": u_energy,
        },
        origins=tuple(o for p in points for o in p.origins),
    )
