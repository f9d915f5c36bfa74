"""Flow curves: viscosity against rate at one time, as a power law where the data support one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.properties import property_key
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import Condition, Flag, MeasuredValue, Recording, Specimen
from deamat.estimators.least_squares.linear import LinearFit, fit_linear
from deamat.estimators.selection import choose
from deamat.formats.flow_samples import SEPARATOR
from deamat.formats.viscometer import lines_text
from deamat.techniques.viscosity.config import CONSISTENCY, INDEX, VISCOSITY

_MIN_READINGS = 5
_TEMPERATURE_SPREAD_K = 1.0
# Root mean square of residual over law beyond which a power law is flagged, and refused.
_CURVED, _NO_LAW = 0.05, 0.5
NEWTONIAN, POWER_LAW = "Newtonian", "power law"


@dataclass(frozen=True, slots=True)
class FlowReadings:
    """Viscosity against shear rate, shape (n,) each."""

    shear_rate_per_s: FloatArray
    viscosity_Pas: FloatArray

    @property
    def columns(self) -> dict[str, FloatArray]:
        """Rate and viscosity."""
        return {
            "shear_rate_per_s": self.shear_rate_per_s,
            "viscosity_Pas": self.viscosity_Pas,
        }


@dataclass(frozen=True, slots=True)
class FlowCurve:
    """What the readings support.

    Parameters
    ----------
    law : `NEWTONIAN` or `POWER_LAW`
    consistency : K `[Pa.s^n]`; the viscosity itself `[Pa.s]` of a Newtonian liquid
    index : n; 1 for a Newtonian liquid
    u_consistency, u_index : from the scatter about the law
    relative_error : root mean square of residual over law
    """

    law: str
    consistency: float
    index: float
    u_consistency: float
    u_index: float
    relative_error: float
    rates: tuple[float, float]
    reason: str
    diagnostics: dict[str, float | int | str]


def fit_flow_curve(rate_per_s: FloatArray, viscosity_Pas: FloatArray) -> FlowCurve:
    r"""Fit $\ln \mu = \ln K + (n - 1) \ln \dot\gamma$, and $\ln \mu$ = constant.

    The constant is taken where it is enough. Least squares on the logarithms, as the errors of a
    rheometer are about a constant fraction of the reading.

    Parameters
    ----------
    rate_per_s, viscosity_Pas : positive, shape (n,)

    Raises
    ------
    FitRefused : too few readings, one rate only, or a scatter that no power law explains
    """
    if len(rate_per_s) < _MIN_READINGS:
        raise FitRefused(
            f"a flow curve needs at least {_MIN_READINGS} readings, not {len(rate_per_s)}"
        )
    if rate_per_s.max() <= 1.01 * rate_per_s.min():
        raise FitRefused(
            f"all readings are at {rate_per_s[0]:g} 1/s: one rate tells nothing of a flow curve"
        )
    y, ones = np.log(viscosity_Pas), np.ones_like(rate_per_s)
    design = np.stack([ones, np.log(rate_per_s)], axis=1)
    choice = choose(
        [
            (NEWTONIAN, lambda: fit_linear(ones[:, None], y)),
            (POWER_LAW, lambda: fit_linear(design, y)),
        ]
    )
    fit: LinearFit = choice.fit
    relative = float(np.sqrt(np.mean(np.square(np.expm1(fit.residuals)))))
    if relative > _NO_LAW:
        raise FitRefused(
            f"the readings scatter by {relative:.0%} about the best power law, more than "
            f"{_NO_LAW:.0%}: this is no power-law fluid at one state",
            {"relative_error": relative},
        )
    k = float(np.exp(fit.parameters[0]))
    slope, u_slope = (
        (float(fit.parameters[1]), float(fit.standard_errors[1]))
        if choice.name == POWER_LAW
        else (0.0, 0.0)
    )
    said = {f"aicc {t.name}": t.aicc for t in choice.tried if t.aicc is not None}
    return FlowCurve(
        law=choice.name,
        consistency=k,
        index=1.0 + slope,
        u_consistency=k * float(fit.standard_errors[0]),
        u_index=u_slope,
        relative_error=relative,
        rates=(float(rate_per_s.min()), float(rate_per_s.max())),
        reason=choice.reason,
        diagnostics={"readings": len(y), "relative_error": relative, **said},
    )


def flow_curve_values(
    specimen: Specimen, recording: Recording
) -> tuple[tuple[MeasuredValue, ...], FlowReadings]:
    """Reduce a file of shear rates to K and n, or to a Newtonian viscosity, and the curve itself.

    Raises
    ------
    FitRefused : no viscosity, a sample that is not named, a temperature that changes, no law
    """
    chosen = _sample(specimen, recording)
    columns = {name: values[chosen] for name, values in recording.columns.items()}
    if "viscosity_Pas" not in columns:
        raise FitRefused("the file has shear rates and no viscosity")
    _one_temperature(columns)
    first = recording.source.first_line
    lines = columns["line"] if "line" in columns else first + np.flatnonzero(chosen)
    rate, viscosity = columns["shear_rate_per_s"], columns["viscosity_Pas"]
    good = (rate > 0) & (viscosity > 0)
    flags: tuple[Flag, ...] = ()
    if not good.all():
        bad = lines_text(lines[~good])
        flags = (Flag("not-positive", f"rate or viscosity of zero or less: lines {bad} left out"),)
    curve = fit_flow_curve(rate[good], viscosity[good])
    if curve.relative_error > _CURVED:
        flags += (
            Flag(
                "curved",
                f"the readings leave the {curve.law} by {curve.relative_error:.1%} (root mean "
                "square): it describes the range and is not the law of this fluid",
            ),
        )
    span = (int(lines.min()), int(lines.max()))
    values = tuple(
        _value(key, v, u, curve, span, flags)
        for key, v, u in (
            ((VISCOSITY, curve.consistency, curve.u_consistency),)
            if curve.law == NEWTONIAN
            else (
                (CONSISTENCY, curve.consistency, curve.u_consistency),
                (INDEX, curve.index, curve.u_index),
            )
        )
    )
    return values, FlowReadings(rate[good], viscosity[good])


def _value(
    key: str,
    value: float,
    u: float,
    curve: FlowCurve,
    lines: tuple[int, int],
    flags: tuple[Flag, ...],
) -> MeasuredValue:
    budget = (Contribution("scatter about the flow curve", u, shared=False),)
    conditions: dict[str, Condition] = {"rate_per_s": curve.rates}
    return MeasuredValue(
        key,
        Quantity.from_budget(value, property_key(key).unit, budget),
        budget,
        f"{curve.law} by least squares on ln viscosity against ln rate, errors a constant "
        f"fraction of the reading; {curve.reason}",
        conditions,
        lines,
        diagnostics=curve.diagnostics,
        flags=flags,
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


def _one_temperature(columns: dict[str, FloatArray]) -> None:
    if "temperature_K" not in columns:
        return
    spread = float(np.ptp(columns["temperature_K"]))
    if spread > _TEMPERATURE_SPREAD_K:
        raise FitRefused(
            f"the temperature changes by {spread:.3g} K within the file: this is a temperature "
            "sweep, not a flow curve"
        )
