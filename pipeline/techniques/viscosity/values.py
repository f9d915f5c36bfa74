"""What is recorded of a law: viscosity at stated times, how fast it grows, K and n."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange
from deamat.core.properties import property_key
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import Condition, Flag, MeasuredValue
from deamat.techniques.viscosity.config import (
    CONSISTENCY,
    CONSISTENCY_WIDE_CUP,
    DOUBLING,
    INDEX,
    LIMIT,
    VISCOSITY,
    ViscosityConfig,
)
from deamat.techniques.viscosity.time_law import TimeLaw
from deamat.techniques.viscosity.window import Windowed

# A value and its derivatives by the coefficients of the law.
Answer = Callable[[], tuple[float, FloatArray]]


@dataclass(frozen=True, slots=True)
class Asked:
    """One value that is asked of a law: its key, conditions, what it means, how to get it."""

    key: str
    conditions: Mapping[str, Condition]
    meaning: str
    answer: Answer


def asked_of(law: TimeLaw, window: Windowed, config: ViscosityConfig) -> list[Asked]:
    """List everything to be recorded of one run."""
    start = window.start_s if window.whole else law.valid[0]
    rate = law.usual_rate
    at_rate: dict[str, Condition] = {} if rate is None else {"rate_per_s": _round(rate)}
    of_rate = "" if rate is None else f" at the nominal shear rate {rate:.3g} 1/s"
    times = config.stated_times_s if window.whole else (start,)
    asked = [
        Asked(VISCOSITY, {"time_s": t, **at_rate}, f"viscosity{of_rate}", _at(law, t))
        for t in times
    ]
    asked.append(
        Asked(
            DOUBLING,
            {"time_s": start, **at_rate},
            f"time since mixing at which viscosity{of_rate} is twice that at `time_s`",
            lambda: law.time_of(2.0, start),
        )
    )
    limit = config.limit_viscosity_Pas
    if limit is not None:
        asked.append(
            Asked(
                LIMIT,
                at_rate,
                f"time since mixing at which viscosity{of_rate} reaches {limit:g} Pa.s",
                lambda: law.time_at(limit),
            )
        )
    if rate is not None:
        # the refusals of viscosity tell what the law does not reach; K and n need not say it again
        low, high = law.valid
        for t in times:
            if low <= t <= high:
                asked += _fluid(law, t)
    return asked


def _at(law: TimeLaw, time_s: float) -> Answer:
    return lambda: law.at(time_s)


def _fluid(law: TimeLaw, time_s: float) -> list[Asked]:
    meanings = {
        CONSISTENCY: "K of mu_app = K rate^(n-1) at the nominal shear rate, as for a Newtonian "
        "liquid",
        INDEX: "n of mu_app = K rate^(n-1)",
        CONSISTENCY_WIDE_CUP: "K n^n: K at the shear rate 2 omega / n of a power-law fluid in a "
        "wide cup",
    }
    return [
        Asked(key, {"time_s": time_s}, meaning, _part(law, key, time_s))
        for key, meaning in meanings.items()
    ]


def _part(law: TimeLaw, key: str, time_s: float) -> Answer:
    return lambda: fluid_part(law, key, time_s)


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
    asked: Asked, law: TimeLaw, method: str, flags: tuple[Flag, ...], lines: tuple[int, int]
) -> MeasuredValue:
    """Answer with a budget: scatter about the law, and the calibration that all runs share.

    Raises
    ------
    FitRefused : the law does not give this value
    """
    try:
        value, slopes = asked.answer()
    except OutOfRange as error:
        raise FitRefused(str(error)) from error
    scatter, calibration = law.errors(slopes)
    budget: tuple[Contribution, ...] = (
        Contribution("scatter about the law", scatter, shared=False),
    )
    if calibration > 0:
        budget += (Contribution("viscometer calibration", calibration, shared=True),)
    rate = law.rate_per_rpm_per_s
    return MeasuredValue(
        key=asked.key,
        quantity=Quantity.from_budget(value, property_key(asked.key).unit, budget),
        budget=budget,
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


def _round(value: float) -> float:
    return float(f"{value:.6g}")
