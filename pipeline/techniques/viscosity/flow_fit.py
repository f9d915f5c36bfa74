"""One flow curve: readings of rate and viscosity, and the power law through them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.records import MeasuredValue, Refusal
from deamat.estimators.least_squares.lack_of_fit import residual_runs
from deamat.estimators.least_squares.linear import LinearFit, fit_linear
from deamat.estimators.selection import choose
from deamat.techniques.viscosity.flow_sweeps import levels

_MIN_READINGS = 5
_FALSE_ALARMS = 0.002
_NO_LAW = 0.5  # root mean square of residual over law beyond which a power law is refused
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
    covariance : of ln K and n from the scatter about the law, shape (2, 2)
    readings : how many they are
    dof : degrees of freedom of the scatter
    relative_error : root mean square of residual over law
    drift : half the difference between the highest and the lowest sweep, relative
    misses : whether the residuals follow each other along the rate
    """

    law: str
    consistency: float
    index: float
    covariance: FloatArray
    readings: int
    dof: int
    relative_error: float
    drift: float
    misses: bool
    rates: tuple[float, float]
    reason: str
    diagnostics: dict[str, float | int | str]

    @property
    def u_index(self) -> float:
        """Standard uncertainty of n from the scatter."""
        return math.sqrt(self.covariance[1, 1])


@dataclass(frozen=True, slots=True)
class FlowResult:
    """Values and refusals of one file, and its readings."""

    values: tuple[MeasuredValue, ...]
    refusals: tuple[Refusal, ...]
    readings: FlowReadings


def fit_flow_curve(
    rate_per_s: FloatArray,
    viscosity_Pas: FloatArray,
    sweeps: Sequence[NDArray[np.intp]] = (),
    max_drift: float = math.inf,
) -> FlowCurve:
    r"""Fit $\ln \mu = \ln K + (n - 1) \ln \dot\gamma$, and $\ln \mu$ = constant.

    The constant is taken where it is enough. Least squares on the logarithms, as the errors of a
    rheometer are about a constant fraction of the reading. Each sweep has a level of its own, and
    the curve is that of their mean.

    Parameters
    ----------
    rate_per_s, viscosity_Pas : positive, shape (n,)
    sweeps : indices of each; one sweep if there are none
    max_drift : difference between sweeps beyond which they are no repeats

    Raises
    ------
    FitRefused : too few readings, one rate only, sweeps that differ, or a scatter that no power law
        explains
    """
    if len(rate_per_s) < _MIN_READINGS:
        raise FitRefused(
            f"a flow curve needs at least {_MIN_READINGS} readings, not {len(rate_per_s)}"
        )
    if rate_per_s.max() <= 1.01 * rate_per_s.min():
        raise FitRefused(
            f"all readings are at {rate_per_s[0]:g} 1/s: one rate tells nothing of a flow curve"
        )
    level = levels(sweeps, rate_per_s, viscosity_Pas)
    drift = math.expm1(float(np.ptp(level))) if len(sweeps) > 1 else 0.0
    if drift > max_drift:
        raise FitRefused(
            f"the file holds {len(sweeps)} sweeps over the same shear rates whose viscosities "
            f"differ by {drift:.0%}, more than `max_sweep_drift` = {max_drift:.0%}: several "
            "temperatures, or a liquid that changes; one law through all of them belongs to none, "
            "so export each to a file of its own, or with its temperature",
            {"sweeps": len(sweeps), "drift": drift},
        )
    y, ones = np.log(viscosity_Pas), np.ones_like(rate_per_s)
    for sweep, own in zip(sweeps, level.tolist(), strict=True):
        y[sweep] -= own
    logs = np.log(rate_per_s)
    design = np.stack([ones, logs], axis=1)
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
    covariance = np.zeros((2, 2))
    covariance[: fit.parameter_count, : fit.parameter_count] = fit.covariance
    said = {f"aicc {t.name}": t.aicc for t in choice.tried if t.aicc is not None}
    return FlowCurve(
        law=choice.name,
        consistency=float(np.exp(fit.parameters[0])),
        index=1.0 + (float(fit.parameters[1]) if choice.name == POWER_LAW else 0.0),
        covariance=covariance,
        readings=len(y),
        dof=fit.dof,
        relative_error=relative,
        drift=0.5 * drift,
        misses=residual_runs(logs, fit, _FALSE_ALARMS).found,
        rates=(float(rate_per_s.min()), float(rate_per_s.max())),
        reason=choice.reason,
        diagnostics={
            "readings": len(y),
            "sweeps": max(len(sweeps), 1),
            "relative_error": relative,
            **said,
        },
    )
