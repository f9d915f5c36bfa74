"""What is recorded of a law: viscosity at stated times, how fast it grows, K and n."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange
from deamat.core.properties import property_key
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import Condition, Flag, MeasuredValue
from deamat.estimators.mean import coverage_factor
from deamat.estimators.selection import NORMAL
from deamat.techniques.viscosity.config import (
    AT_PRINTING_RATE,
    CONSISTENCY,
    CONSISTENCY_WIDE_CUP,
    DOUBLING,
    INDEX,
    LIMIT,
    VISCOSITY,
    ViscosityConfig,
)
from deamat.techniques.viscosity.fitted import Fitted, OfLaw, OfReadings
from deamat.techniques.viscosity.printing import decades_beyond, extrapolation
from deamat.techniques.viscosity.temperature import temperature_at_K
from deamat.techniques.viscosity.time_law import TimeLaw
from deamat.techniques.viscosity.window import Windowed

_TWICE = 2.0
_SCATTER = "scatter about the law"


@dataclass(frozen=True, slots=True)
class Asked:
    """One value that is asked of a run: its key, conditions, what it means, how to get it.

    Parameters
    ----------
    of_law : from a law
    of_readings : from the readings, where a law misses them; None where only a law tells it
    at_minimum : start `[s]` that is the least reading of a run, and as uncertain as one reading
    """

    key: str
    conditions: Mapping[str, Condition]
    meaning: str
    of_law: OfLaw
    of_readings: OfReadings | None = None
    at_minimum: float | None = None


def asked_of(law: TimeLaw, window: Windowed, config: ViscosityConfig) -> list[Asked]:
    """List everything to be recorded of one run."""
    start = window.start_s if window.whole else law.valid[0]
    rate = law.usual_rate
    at_rate: dict[str, Condition] = {} if rate is None else {"rate_per_s": _round(rate)}
    of_rate = "" if rate is None else f" at the nominal shear rate {rate:.3g} 1/s"
    times = config.stated_times_s if window.whole else (start,)
    asked = [
        Asked(VISCOSITY, {"time_s": t, **at_rate}, f"viscosity{of_rate}", *_at(t)) for t in times
    ]
    if drifts(window):
        return [_at_its_temperature(one, window) for one in asked]
    asked.append(
        Asked(
            DOUBLING,
            {"time_s": start, **at_rate},
            f"time since mixing at which viscosity{of_rate} is twice that at `time_s`",
            lambda law: law.time_of(_TWICE, start),
            lambda direct: direct.time_of(_TWICE, start),
            None if window.whole else start,
        )
    )
    limit = config.limit_viscosity_Pas
    if limit is not None:
        asked.append(
            Asked(
                LIMIT,
                at_rate,
                f"time since mixing at which viscosity{of_rate} reaches {limit:g} Pa.s",
                lambda law: law.time_at(limit),
                lambda direct: direct.time_at(limit),
            )
        )
    if rate is not None:
        # the refusals of viscosity tell what the law does not reach; K and n need not say it again
        low, high = law.valid
        for t in times:
            if low <= t <= high:
                asked += _fluid(t)
                asked += _printing(law, t, config)
    if window.probe is None:
        return asked
    steady = {"temperature_K": window.probe.mean_K}
    return [replace(one, conditions={**one.conditions, **steady}) for one in asked]


def drifts(window: Windowed) -> bool:
    """Whether the temperature moved and nothing corrects it."""
    return window.probe is not None and window.probe.drifts


def drifting(window: Windowed) -> FitRefused:
    """Say why nothing that needs one temperature is given."""
    told = [flag.detail for flag in window.readings.flags if flag.name == "temperature-drift"]
    return FitRefused("; ".join(told) or "the temperature of the liquid drifts")


def _at_its_temperature(asked: Asked, window: Windowed) -> Asked:
    kelvin = temperature_at_K(window.readings, float(str(asked.conditions["time_s"])))
    return replace(asked, conditions={**asked.conditions, "temperature_K": kelvin})


def _at(time_s: float) -> tuple[OfLaw, OfReadings]:
    return lambda law: law.at(time_s), lambda direct: direct.viscosity(time_s)


def _printing(law: TimeLaw, time_s: float, config: ViscosityConfig) -> list[Asked]:
    """Viscosity at the shear rate of printing, where the rates measured may be left so far."""
    rate = config.printing_rate_per_s
    if rate is None or law.rates is None or decades_beyond(law.rates, rate) > _limit(config):
        return []
    return [
        Asked(
            AT_PRINTING_RATE,
            {"time_s": time_s, "rate_per_s": rate},
            f"viscosity at {rate:g} 1/s ({config.printing_rate_source})",
            lambda law: law.at_rate(time_s, rate),
        )
    ]


def _limit(config: ViscosityConfig) -> float:
    return config.extrapolation_decades


def _fluid(time_s: float) -> list[Asked]:
    meanings = {
        CONSISTENCY: "K of mu_app = K rate^(n-1) at the nominal shear rate, as for a Newtonian "
        "liquid",
        INDEX: "n of mu_app = K rate^(n-1)",
        CONSISTENCY_WIDE_CUP: "K n^n: K at the shear rate 2 omega / n of a power-law fluid in a "
        "wide cup",
    }
    return [
        Asked(key, {"time_s": time_s}, meaning, _part(key, time_s))
        for key, meaning in meanings.items()
    ]


def _part(key: str, time_s: float) -> OfLaw:
    return lambda law: fluid_part(law, key, time_s)


def fluid_part(law: TimeLaw, key: str, time_s: float) -> tuple[float, FloatArray]:
    r"""Return K, n or $K_w = K n^n$ at a time, with derivatives by the coefficients of the law.

    The rate at a spindle in a wide cup is $2 \omega / n$; with $2 \omega$ in its place n comes out
    right and K too large by $n^{-n}$.

    Raises
    ------
    OutOfRange : a time outside the law
    """
    law.at(time_s)  # refuses a time outside
    k_count, n_count = law.parts
    powers = np.power(time_s, np.arange(max(k_count, n_count), dtype=np.float64))
    k = float(powers[:k_count] @ law.coefficients[:k_count])
    n = float(powers[:n_count] @ law.coefficients[k_count:])
    k_slopes = np.concatenate([powers[:k_count], np.zeros(n_count)])
    n_slopes = np.concatenate([np.zeros(k_count), powers[:n_count]])
    if key == CONSISTENCY:
        return k, k_slopes
    if key == INDEX:
        return n, n_slopes
    if n <= 0:
        raise FitRefused(f"n is {n:.3g}, and a power law in a wide cup needs a positive one")
    return k * n**n, n**n * (k_slopes + k * (np.log(n) + 1.0) * n_slopes)


def measured(
    asked: Asked,
    fitted: Fitted,
    config: ViscosityConfig,
    method: str,
    flags: tuple[Flag, ...],
    lines: tuple[int, int],
    shared: Contribution,
) -> MeasuredValue:
    """Answer with a budget: scatter about the laws, and the calibration that all runs share.

    Parameters
    ----------
    shared : the error of the viscometer, of whatever size

    Raises
    ------
    FitRefused : the law does not give this value
    """
    law = fitted.law
    try:
        found = fitted.answer(asked.of_law, asked.of_readings)
        budget = [Contribution(_SCATTER, found.scatter * _normal(found.dof), shared=False)]
        if asked.at_minimum is not None and fitted.direct is None:
            start = law.at(asked.at_minimum)[0]
            u = _TWICE * law.relative_error * start / law.rise(min(found.value, law.valid[1]))
            budget.append(Contribution("reading at the minimum", u, shared=False))
    except OutOfRange as error:
        raise FitRefused(str(error)) from error
    if found.calibration > 0:
        own = replace(shared, u=found.calibration)
        if property_key(asked.key).unit == "s":  # a time may go either way: another error
            own = replace(own, source=f"{own.source}, of a time", calibration=None)
        budget.append(own)
    if found.thermal > 0:
        budget.append(Contribution("correction of temperature", found.thermal, shared=True))
    rate = law.rate_per_rpm_per_s
    if asked.key == AT_PRINTING_RATE and law.rates is not None:
        line, flag = extrapolation(law.rates, found.value, config)
        budget += line
        flags += flag
    return MeasuredValue(
        key=asked.key,
        quantity=Quantity.from_budget(found.value, property_key(asked.key).unit, tuple(budget)),
        budget=tuple(budget),
        method=f"{asked.meaning}; {method}",
        conditions=asked.conditions,
        lines=lines,
        diagnostics={
            "law": law.name,
            "relative_error": law.relative_error,
            "degrees_of_freedom": law.dof,
            **({} if rate is None else {"rate_per_rpm_per_s": rate}),
            **law.diagnostics,
        },
        flags=flags,
    )


def _normal(dof: float) -> float:
    """Widen a standard uncertainty of few degrees of freedom to what 1.96 of it stand for."""
    return coverage_factor(dof) / NORMAL


def _round(value: float) -> float:
    return float(f"{value:.6g}")
