"""Flow curves: viscosity against rate at one time, as a power law where the data support one.

Several sweeps in one file are parted: those at other temperatures are answered apart, repeats at
one temperature get a level each, and what the levels differ by is in the uncertainty.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.properties import property_key
from deamat.core.quantity import Contribution, Quantity
from deamat.core.recording import Recording, Specimen
from deamat.core.records import Condition, Flag, MeasuredValue, Refusal
from deamat.estimators.mean import coverage_factor
from deamat.estimators.selection import NORMAL
from deamat.formats.flow_samples import SEPARATOR
from deamat.formats.viscometer import lines_text
from deamat.techniques.shared.outcome import refusal
from deamat.techniques.viscosity.config import (
    AT_PRINTING_RATE,
    CONSISTENCY,
    INDEX,
    VISCOSITY,
    ViscosityConfig,
)
from deamat.techniques.viscosity.flow_fit import FlowCurve, FlowReadings, FlowResult, fit_flow_curve
from deamat.techniques.viscosity.flow_sweeps import parted
from deamat.techniques.viscosity.printing import extrapolation, too_far
from deamat.techniques.viscosity.readings import tenth_of_degree

# Sweeps differ if their levels do by more than this, and by so many of their standard errors.
_DRIFT, _DRIFT_SDS = 0.01, 4.0
_CURVED = 0.05  # root mean square of residual over law beyond which a power law is flagged
NEWTONIAN, POWER_LAW = "Newtonian", "power law"


def flow_curve_values(
    specimen: Specimen, recording: Recording, config: ViscosityConfig
) -> FlowResult:
    """Reduce a file of shear rates to K and n, or to a Newtonian viscosity, at each temperature.

    Raises
    ------
    FitRefused : no viscosity, a sample that is not named, or nothing at any temperature
    """
    chosen = _sample(specimen, recording)
    columns = {name: values[chosen] for name, values in recording.columns.items()}
    if "viscosity_Pas" not in columns:
        raise FitRefused("the file has shear rates and no viscosity")
    first = recording.source.first_line
    columns.setdefault("line", first + np.flatnonzero(chosen).astype(np.float64))
    good = (columns["shear_rate_per_s"] > 0) & (columns["viscosity_Pas"] > 0)
    flags: tuple[Flag, ...] = ()
    if not good.all():
        bad = lines_text(columns["line"][~good])
        flags = (Flag("not-positive", f"rate or viscosity of zero or less: lines {bad} left out"),)
    kept = {name: values[good] for name, values in columns.items()}
    _refuse_contradiction(kept, config.max_stress_contradiction)
    values: list[MeasuredValue] = []
    refusals: list[Refusal] = []
    groups = _at_each_temperature(kept, config)
    for kelvin, sweeps in groups:
        at: dict[str, Condition] = {} if kelvin is None else {"temperature_K": kelvin}
        try:
            values += _of_group(kept, sweeps, at, flags, config)
        except FitRefused as error:
            if len(groups) == 1:
                raise
            refusals.append(refusal(specimen, VISCOSITY, error, at))
    if not values:
        raise FitRefused("; ".join(r.reason for r in refusals[:1]) or "no reading is left")
    curves = {v.conditions.get("temperature_K"): v.conditions["rate_per_s"] for v in values}
    for measured in curves.values():
        unknown = too_far(_pair(measured), config)
        if unknown is not None:
            refusals.append(refusal(specimen, AT_PRINTING_RATE, unknown, {}))
            break
    readings = FlowReadings(kept["shear_rate_per_s"], kept["viscosity_Pas"])
    return FlowResult(tuple(values), tuple(refusals), readings)


def _refuse_contradiction(columns: Mapping[str, FloatArray], most: float) -> None:
    """Refuse a file whose stress, rate and viscosity are not in units that belong together.

    Raises
    ------
    FitRefused : stress over rate is another viscosity
    """
    stress = columns.get("shear_stress_Pa")
    if stress is None or not len(stress):
        return
    ratio = float(np.median(stress / columns["shear_rate_per_s"] / columns["viscosity_Pas"]))
    if abs(ratio - 1.0) > most:
        raise FitRefused(
            f"stress over shear rate is {ratio:.4g} times the viscosity beside it: one of the "
            "three is in another unit (a rate in 1/min is 60 times one in 1/s); correct the unit "
            "over the column",
            {"stress_over_rate_over_viscosity": ratio},
        )


def _pair(rates: Condition) -> tuple[float, float]:
    if isinstance(rates, tuple):
        return float(rates[0]), float(rates[1])
    return float(rates), float(rates)


def _at_each_temperature(
    columns: Mapping[str, FloatArray], config: ViscosityConfig
) -> list[tuple[float | None, list[NDArray[np.intp]]]]:
    """Sweeps at one temperature together; None where the file states no temperature.

    Raises
    ------
    FitRefused : a temperature that moves within a sweep
    """
    if not len(columns["shear_rate_per_s"]):
        raise FitRefused("no reading has a rate and a viscosity above zero")
    sweeps = parted(columns["shear_rate_per_s"])
    if "temperature_K" not in columns:
        return [(None, sweeps)]
    kelvin = columns["temperature_K"]
    groups: list[list[NDArray[np.intp]]] = []
    for sweep in sweeps:
        spread = float(np.ptp(kelvin[sweep]))
        if spread > config.temperature_tolerance_K:
            raise FitRefused(
                f"the temperature changes by {spread:.3g} K within "
                f"{'the file' if len(sweeps) == 1 else 'a sweep'}: this is a temperature sweep, "
                "not a flow curve"
            )
        near = [
            g
            for g in groups
            if abs(kelvin[g[0]].mean() - kelvin[sweep].mean()) <= config.temperature_tolerance_K
        ]
        if near:
            near[0].append(sweep)
        else:
            groups.append([sweep])
    return [(tenth_of_degree(float(kelvin[np.concatenate(g)].mean())), g) for g in groups]


def _of_group(
    columns: Mapping[str, FloatArray],
    sweeps: Sequence[NDArray[np.intp]],
    at: Mapping[str, Condition],
    flags: tuple[Flag, ...],
    config: ViscosityConfig,
) -> list[MeasuredValue]:
    """Fit the sweeps of one temperature and answer."""
    index = np.concatenate(sweeps)
    ends = np.cumsum([len(s) for s in sweeps])
    local = np.split(np.arange(len(index)), ends[:-1])
    rate, viscosity = columns["shear_rate_per_s"][index], columns["viscosity_Pas"][index]
    curve = fit_flow_curve(rate, viscosity, local, config.max_sweep_drift)
    lines = columns["line"][index]
    span = (int(lines.min()), int(lines.max()))
    told = (*flags, *_flags(curve, len(sweeps)))
    given = _Given(curve, {**at, "rate_per_s": curve.rates}, span, told, config)
    k, n = curve.consistency, curve.index
    if curve.law == NEWTONIAN:
        values = [_value(given, VISCOSITY, k, np.array([k, 0.0]), k)]
    else:
        values = [
            _value(given, CONSISTENCY, k, np.array([k, 0.0]), k),
            _value(given, INDEX, n, np.array([0.0, 1.0]), 0.0),
        ]
    printing = config.printing_rate_per_s
    if printing is not None and too_far(curve.rates, config) is None:
        mu = k * printing ** (n - 1.0)
        lines_, further = extrapolation(curve.rates, mu, config)
        there = _Given(curve, {**at, "rate_per_s": printing}, span, (*told, *further), config)
        slopes = mu * np.array([1.0, math.log(printing)])
        values.append(_value(there, AT_PRINTING_RATE, mu, slopes, mu, tuple(lines_)))
    return values


def _flags(curve: FlowCurve, sweeps: int) -> tuple[Flag, ...]:
    flags: tuple[Flag, ...] = ()
    apart = 2.0 * curve.drift
    each = curve.relative_error * math.sqrt(2.0 * sweeps / curve.readings)
    if apart > max(_DRIFT, _DRIFT_SDS * each):
        flags += (
            Flag(
                "several-sweeps",
                f"{sweeps} sweeps over the same shear rates differ by {apart:.1%}: the value is "
                "that of their mean, and its interval reaches to each of them",
            ),
        )
    if curve.relative_error > _CURVED:
        flags += (
            Flag(
                "curved",
                f"the readings leave the {curve.law} by {curve.relative_error:.1%} (root mean "
                "square): it describes the range and is not the law of this fluid",
            ),
        )
    if curve.misses:
        flags += (
            Flag(
                "systematic-misfit",
                f"residuals of the {curve.law} follow each other along the rate: what it misses "
                f"the readings by, {curve.relative_error:.1%} (root mean square), is in the "
                "uncertainty",
            ),
        )
    return flags


@dataclass(frozen=True, slots=True)
class _Given:
    """What all values of a curve have in common."""

    curve: FlowCurve
    conditions: Mapping[str, Condition]
    lines: tuple[int, int]
    flags: tuple[Flag, ...]
    config: ViscosityConfig


def _value(
    given: _Given,
    key: str,
    value: float,
    slopes: FloatArray,
    proportional: float,
    further: tuple[Contribution, ...] = (),
) -> MeasuredValue:
    """Make a value with its budget.

    Parameters
    ----------
    slopes : derivatives by ln K and n
    proportional : the value, where it grows with every reading; 0 for an index
    """
    curve, config = given.curve, given.config
    scatter = math.sqrt(max(float(slopes @ curve.covariance @ slopes), 0.0))
    scatter *= coverage_factor(curve.dof) / NORMAL
    budget = [Contribution("scatter about the flow curve", scatter, shared=False)]
    if curve.drift and proportional:
        u = proportional * curve.drift / math.sqrt(3.0)
        budget.append(Contribution("difference between sweeps", u, shared=False))
    if curve.misses:
        # over the range of ln rate a miss tilts the law by as much again
        tilt = curve.relative_error / max(math.log(curve.rates[1] / curve.rates[0]), 1.0)
        u = proportional * curve.relative_error if proportional else 2.0 * tilt
        budget.append(Contribution("law misses its readings", u, shared=False))
    if proportional and config.reading_calibration:
        u = proportional * config.reading_calibration
        budget.append(Contribution("rheometer calibration", u, shared=True))
    budget += further
    return MeasuredValue(
        key,
        Quantity.from_budget(value, property_key(key).unit, tuple(budget)),
        tuple(budget),
        f"{curve.law} by least squares on ln viscosity against ln rate, errors a constant fraction "
        f"of the reading; {curve.reason}",
        given.conditions,
        given.lines,
        diagnostics=curve.diagnostics,
        flags=given.flags,
    )


def _sample(specimen: Specimen, recording: Recording) -> NDArray[np.bool_]:
    """Mask of the readings of the sample that the register names."""
    if "sample" not in recording.columns:
        return np.ones(len(recording.columns["shear_rate_per_s"]), dtype=bool)
    names = recording.metadata["samples"].split(SEPARATOR)
    index = recording.columns["sample"]
    if len(names) == 1:
        return np.ones(len(index), dtype=bool)
    if specimen.notes.get("sample") not in names:
        raise FitRefused(
            f"the file holds {len(names)} samples; name one in the register's column `sample`: "
            f"{', '.join(names)}"
        )
    return np.asarray(index == names.index(specimen.notes["sample"]))
