"""One law of a material from all its runs: each run has its own level, the law is their mean."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.special import stdtridf

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.laws import FORMS, POLYNOMIAL, POWER_LAW_FLUID
from deamat.core.properties import property_key
from deamat.core.recording import Specimen
from deamat.core.records import Law, Origin
from deamat.estimators.mean import coverage_factor
from deamat.techniques.viscosity.config import CONSISTENCY, INDEX, VISCOSITY, ViscosityConfig
from deamat.techniques.viscosity.fitted import Fitted
from deamat.techniques.viscosity.fluid import fit_fluid, is_swept
from deamat.techniques.viscosity.newtonian import fit_newtonian
from deamat.techniques.viscosity.time_law import TimeLaw, growth
from deamat.techniques.viscosity.window import Windowed

_CHECKED_TIMES = 5
# Batches of one mixture never differ by so much; Pa.s and mPa.s differ by a thousand.
_ANOTHER_UNIT = 100.0


def fit_law(windows: Sequence[Windowed], config: ViscosityConfig) -> Fitted:
    """Fit a power-law fluid where speeds were swept and show one, else a Newtonian law.

    Raises
    ------
    FitRefused : no law describes the readings
    """
    if all(is_swept(w.readings, config) for w in windows):
        fluid = fit_fluid(windows, config)
        if fluid is not None:
            return Fitted(fluid, ((1.0, fluid),))
    return fit_newtonian(windows, config)


def fit_runs(windows: Sequence[Windowed], config: ViscosityConfig) -> tuple[TimeLaw, FloatArray]:
    """Fit one law to several runs, each multiplied by a level of its own.

    Returns
    -------
    law, levels : the levels, shape (runs,), have the mean 1, so that the law is that of the mean

    Raises
    ------
    FitRefused : as in `fit_law`
    """
    law = fit_law(windows, config).law
    if len(windows) == 1:
        return law, np.ones(1)
    levels = np.array([_level(law, window) for window in windows])
    levels /= levels.mean()
    scaled = [_scaled(w, f) for w, f in zip(windows, levels, strict=True)]
    return fit_law(scaled, config).law, levels


def refuse_mixed_units(windows: Mapping[str, Windowed]) -> None:
    """Refuse runs of one material that lie so far apart that one of them is in another unit.

    Parameters
    ----------
    windows : specimen to its readings

    Raises
    ------
    FitRefused : one run lies more than 100 times above another
    """
    middles = {name: float(np.median(w.readings.viscosity_Pas)) for name, w in windows.items()}
    low, high = (choose(middles, key=middles.__getitem__) for choose in (min, max))
    if middles[high] > _ANOTHER_UNIT * middles[low]:
        raise FitRefused(
            f"{high} lies {middles[high] / middles[low]:.3g} times above {low}, as when Pa.s and "
            "mPa.s are mixed; correct the unit over the column of the one that is wrong"
        )


def _scaled(window: Windowed, level: float) -> Windowed:
    r = window.readings
    return replace(
        window,
        readings=replace(
            r,
            viscosity_Pas=r.viscosity_Pas / level,
            noise_Pas=r.noise_Pas / level,
            calibration_Pas=r.calibration_Pas / level,
            thermal_Pas=r.thermal_Pas / level,
        ),
    )


def _level(law: TimeLaw, window: Windowed) -> float:
    """Weighted ratio of a run to the law, over the times and rates that the law was fitted to."""
    r = window.readings
    inside = (r.time_s >= law.valid[0]) & (r.time_s <= law.valid[1])
    rates = None
    if law.rate_per_rpm_per_s is not None:
        rates = law.rate_per_rpm_per_s * r.speed_rpm[inside]
    model, _ = FORMS[law.kind](law.coefficients, r.time_s[inside], rates, law.parts)
    weight = 1.0 / np.square(r.noise_Pas[inside])
    return float(np.sum(weight * r.viscosity_Pas[inside] * model) / np.sum(weight * model**2))


def laws_of(
    law: TimeLaw,
    levels: FloatArray,
    specimen: Specimen,
    method: str,
    origins: tuple[Origin, ...],
    temperature_K: float | None,
) -> tuple[Law, ...]:
    """Make the laws of a card: viscosity, and K and n of a power-law fluid each by itself.

    The covariance has the scatter about the law, the scatter of the levels of the runs over the
    root of their number, and the calibration; its degrees of freedom are the fewest anywhere in
    the range. A level multiplies viscosity, so it says nothing of n: the index has those of the
    scatter alone.
    """
    covariance, dof = _whole_covariance(law, levels)
    whole = Law(
        key=VISCOSITY,
        material=specimen.material,
        campaign=specimen.campaign,
        kind=law.kind,
        unit=property_key(VISCOSITY).unit,
        argument="time since mixing",
        argument_unit="s",
        coefficients=tuple(law.coefficients.tolist()),
        covariance=_nested(covariance),
        valid=law.valid,
        conditions=specimen.conditions,
        method=f"{law.name} of {_runs(len(levels))}; {method}; {law.reason}",
        origins=origins,
        flags=law.flags,
        relative_scatter=law.relative_error,
        diagnostics={
            "relative_error": law.relative_error,
            "runs": len(levels),
            **{f"level_of_run_{i}": float(f) for i, f in enumerate(levels, start=1)},
            **law.diagnostics,
        },
        parts=law.parts,
        rates=law.rates,
        degrees_of_freedom=dof,
        temperature_K=temperature_K,
        rate_per_rpm_per_s=law.rate_per_rpm_per_s,
    )
    if law.kind != POWER_LAW_FLUID:
        return (whole,)
    split = law.parts[0]
    return (
        whole,
        _part(whole, CONSISTENCY, covariance, slice(0, split), dof),
        _part(whole, INDEX, covariance, slice(split, None), float(law.dof)),
    )


def _part(whole: Law, key: str, covariance: FloatArray, part: slice, dof: float) -> Law:
    """Take K or n out of a power-law fluid as a polynomial in time."""
    return replace(
        whole,
        key=key,
        kind=POLYNOMIAL,
        unit=property_key(key).unit,
        coefficients=whole.coefficients[part],
        covariance=_nested(covariance[part, part]),
        diagnostics={},
        parts=(),
        rates=None,
        relative_scatter=None,
        degrees_of_freedom=dof,
    )


def _whole_covariance(law: TimeLaw, levels: FloatArray) -> tuple[FloatArray, float]:
    """Covariance with every error, and its degrees of freedom."""
    drift = np.outer(law.drift, law.drift) + np.outer(law.thermal, law.thermal)
    n = len(levels)
    if n == 1:
        return law.covariance + drift, float(law.dof)
    upwards = growth(law)
    level = float(np.var(levels, ddof=1)) / n * np.outer(upwards, upwards)
    factors = []
    for time_s in np.linspace(*law.valid, _CHECKED_TIMES).tolist():
        _, slopes = law.at(time_s)
        scatter_u2, level_u2, drift_u2 = (
            max(float(slopes @ c @ slopes), 0.0) for c in (law.covariance, level, drift)
        )
        factors.append(_factor(scatter_u2, level_u2, drift_u2, law.dof, n))
    dof = float(stdtridf(0.975, max(factors)))
    return law.covariance + level + drift, min(dof, 1e6)


def _factor(scatter_u2: float, level_u2: float, drift_u2: float, dof: int, n: int) -> float:
    """Half width of the 95 % interval in combined standard uncertainties.

    Welch-Satterthwaite, but no narrower than what the levels alone would ask for: as in
    `estimators.mean`, further errors cannot make a mean better known.
    """
    whole = scatter_u2 + level_u2 + drift_u2
    terms = level_u2**2 / (n - 1) + scatter_u2**2 / dof
    welch = coverage_factor(whole**2 / terms) if terms > 0 else coverage_factor(math.inf)
    alone = coverage_factor(n - 1.0) * math.sqrt(level_u2 / whole) if whole > 0 else 0.0
    return max(welch, alone)


def _nested(matrix: FloatArray) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in matrix.tolist())


def _runs(n: int) -> str:
    return "one run: the scatter between runs is not seen" if n == 1 else f"{n} runs"
