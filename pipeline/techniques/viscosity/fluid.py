r"""A power-law fluid whose consistency and index change with time: one surface, and two stages.

$\mu_\mathrm{app}(t, \dot\gamma) = K(t)\, \dot\gamma^{\,n(t) - 1}$ at the nominal shear rate. As
full scale times rate is one stress for all speeds of a rotor, errors of a constant fraction of full
scale are equal errors of the stress $\tau = \mu \dot\gamma = K \dot\gamma^n$, and that is fitted,
weighted where a run goes on with another rotor.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.laws import FORMS, POWER_LAW_FLUID
from deamat.core.records import Detail, Flag
from deamat.estimators.least_squares.lack_of_fit import outlying_points, residual_runs
from deamat.estimators.least_squares.linear import fit_linear
from deamat.estimators.least_squares.polynomial import PolynomialFit, fit_polynomial
from deamat.estimators.least_squares.power_law import PowerLawFit, fit_power_law
from deamat.estimators.mean import coverage_factor
from deamat.estimators.selection import DECISIVE, aicc, choose
from deamat.formats.viscometer import lines_text
from deamat.techniques.viscosity.config import RateFactor, ViscosityConfig
from deamat.techniques.viscosity.misfit import with_relative_u
from deamat.techniques.viscosity.readings import Readings
from deamat.techniques.viscosity.time_law import TimeLaw, drift_of, relative_error
from deamat.techniques.viscosity.window import Windowed, combined, common_range

_MAX_DEGREE = {"K": 4, "n": 2}
_CHECKED_TIMES = 200
_FALSE_ALARMS = 0.002  # how often residuals of a surface that is right seem to follow each other
_ROUNDS, _MOST_OFF = 3, 0.2


@dataclass(frozen=True, slots=True)
class Sweep:
    """Readings at several speeds, taken together.

    Parameters
    ----------
    first, last : index of the first reading and one past the last
    speeds : lowest and highest of them `[rpm]`
    """

    first: int
    last: int
    speeds: tuple[float, float]


def sweeps(readings: Readings, gap_s: float) -> list[Sweep]:
    """Part a run into sweeps: a speed that comes again, a rotor or a pause begins another one."""
    found = []
    first, seen = 0, set[float]()
    for i in range(len(readings) + 1):
        ends = i == len(readings) or (
            i > first
            and (
                readings.speed_rpm[i] in seen
                or readings.rotor[i] != readings.rotor[i - 1]
                or readings.time_s[i] - readings.time_s[i - 1] > gap_s
            )
        )
        if ends:
            if len(seen) > 1:
                found.append(Sweep(first, i, (min(seen), max(seen))))
            first, seen = i, set()
        if i < len(readings):
            seen.add(float(readings.speed_rpm[i]))
    return found


def is_swept(readings: Readings, config: ViscosityConfig) -> bool:
    """Say whether a run has enough sweeps over speeds to tell a power law from a Newtonian one."""
    if not readings.of_full_scale:
        return False
    return len(sweeps(readings, config.sweep_gap_s)) >= config.min_sweeps


def rate_factor(readings: Readings, config: ViscosityConfig) -> RateFactor:
    """Find the declared shear rate per speed of the rotors that were used.

    Raises
    ------
    FitRefused : none is declared for a rotor, or another one than for the other rotor
    """
    rotors = sorted({f"{r:g}" for r in readings.rotor.tolist()})
    for rotor in rotors:
        if rotor not in config.rate_factors:
            known = ", ".join(sorted(config.rate_factors))
            raise FitRefused(
                f"no shear rate is declared for rotor {rotor} (there is one for: {known}); declare "
                "[viscosity.rate_factors] with its source"
            )
    factors = {rotor: config.rate_factors[rotor] for rotor in rotors}
    if len({factor.per_s_per_rpm for factor in factors.values()}) > 1:
        said = " and ".join(f"{f.per_s_per_rpm:g} 1/s per rpm ({r})" for r, f in factors.items())
        raise FitRefused(
            f"a power law needs rotors of one shear rate, and those declared are {said}; log each "
            "rotor's run to a file of its own"
        )
    return factors[rotors[0]]


def fit_fluid(windows: Sequence[Windowed], config: ViscosityConfig) -> TimeLaw | None:
    """Fit K(t) and n(t) as one surface, with the degrees that the two stages support.

    Readings far off the surface, as bubbles make them, are left out by line, up to a fifth.

    Returns
    -------
    the law, or None where a Newtonian liquid explains the readings as well

    Raises
    ------
    FitRefused : too few sweeps, no two speeds common to all of them, or no declared shear rate
    """
    kept = list(windows)
    for _ in range(_ROUNDS):
        found = _fit_surface(kept, config)
        if found is None:
            return None
        law, off, cut = found
        if not off.size or off.size > _MOST_OFF * sum(len(w.readings) for w in cut):
            break
        kept = _without(cut, off)
    given, left = (np.concatenate([w.readings.line for w in ws]) for ws in (windows, kept))
    if len(left) == len(given) or len(windows) > 1:
        return law
    lines = given[(given >= left.min()) & (given <= left.max()) & ~np.isin(given, left)]
    flag = Flag(
        "outlying-readings",
        f"{len(lines)} readings lie far off the surface, as with bubbles at the rotor: lines "
        f"{lines_text(lines)} left out",
    )
    return replace(law, flags=(*law.flags, flag)) if len(lines) else law


def _without(windows: Sequence[Windowed], off: NDArray[np.intp]) -> list[Windowed]:
    """Leave out readings, counted through all windows."""
    good = np.ones(sum(len(w.readings) for w in windows), dtype=bool)
    good[off] = False
    ends = np.cumsum([len(w.readings) for w in windows])
    return [
        replace(w, readings=w.readings.where(chosen))
        for w, chosen in zip(windows, np.split(good, ends[:-1]), strict=True)
    ]


def _fit_surface(
    windows: Sequence[Windowed], config: ViscosityConfig
) -> tuple[TimeLaw, NDArray[np.intp], list[Windowed]] | None:
    """Fit the surface once: the law, the readings far off it, and the windows cut to sweeps."""
    swept = [_swept(window, config) for window in windows]
    readings = combined([window for window, _ in swept])
    factor = rate_factor(readings, config)
    times, rates = readings.time_s, factor.per_s_per_rpm * readings.speed_rpm
    stages = two_stages(swept, factor.per_s_per_rpm)
    degrees = stages.factor.degree, stages.index.degree
    stress = readings.viscosity_Pas * rates
    sigma = readings.noise_Pas * rates
    surface = fit_power_law(times, rates, stress, *degrees, "of full scale", sigma)
    score = _scores(surface, times, rates, stress, sigma)
    if score["Newtonian"] <= score["power law"] + DECISIVE:
        return None
    coefficients = np.concatenate([surface.factor, surface.exponent])
    parts = (len(surface.factor), len(surface.exponent))
    law, slopes = FORMS[POWER_LAW_FLUID](coefficients, times, rates, parts)

    def moved_by(shift_Pas: FloatArray) -> FloatArray:
        return drift_of(
            surface.covariance,
            surface.fit.error_variance,
            slopes * rates[:, None],
            sigma,
            shift_Pas * rates,
        )

    choice = f"power law AICc {score['power law']:.1f}, Newtonian {score['Newtonian']:.1f}"
    fitted = TimeLaw(
        kind=POWER_LAW_FLUID,
        coefficients=coefficients,
        parts=parts,
        covariance=surface.covariance,
        drift=moved_by(readings.calibration_Pas),
        thermal=moved_by(readings.thermal_Pas),
        valid=common_range([window.valid for window, _ in swept]),
        rates=_common_rates([s for _, found in swept for s in found], factor.per_s_per_rpm),
        relative_error=relative_error(readings.viscosity_Pas, law),
        dof=surface.fit.dof,
        name=f"{POWER_LAW_FLUID}, K of degree {degrees[0]} and n of degree {degrees[1]}",
        reason=f"{stages.reason}; {choice}",
        diagnostics={
            "choice": choice,
            "aicc power law": score["power law"],
            "aicc Newtonian": score["Newtonian"],
            **stages.diagnostics,
            "rate_source": factor.source,
        },
        rate_per_rpm_per_s=factor.per_s_per_rpm,
    )
    fitted = _compared(fitted, stages)
    runs = residual_runs(times, surface.fit, _FALSE_ALARMS)
    if runs.found:
        missed = _greatest_of_sweep(swept, readings.viscosity_Pas / law - 1.0)
        flag = Flag(
            "systematic-misfit",
            f"residuals of the surface follow each other (von Neumann ratio {runs.ratio:.2f} where "
            f"noise has 2): it misses a sweep by up to {missed:.1%}, and its interval is as wide",
        )
        wider = with_relative_u(fitted, missed / coverage_factor(fitted.dof))
        fitted = replace(wider, flags=(*fitted.flags, flag))
    return fitted, outlying_points(surface.fit), [window for window, _ in swept]


def _greatest_of_sweep(swept: Sequence[tuple[Windowed, Sequence[Sweep]]], off: FloatArray) -> float:
    """By how much the middle of a sweep leaves the surface at most, relative."""
    first, greatest = 0, 0.0
    for window, found in swept:
        greatest = max(
            [greatest, *(abs(float(off[first + s.first : first + s.last].mean())) for s in found)]
        )
        first += len(window.readings)
    return greatest


def _swept(window: Windowed, config: ViscosityConfig) -> tuple[Windowed, list[Sweep]]:
    """Cut a run to its sweeps; the range of the window shrinks where the sweeps end early."""
    found = sweeps(window.readings, config.sweep_gap_s)
    if len(found) < config.min_sweeps:
        raise FitRefused(
            f"{len(found)} sweeps over two speeds or more, and a power law needs "
            f"{config.min_sweeps}; sweep the speeds more often",
            {"sweeps": len(found), "sweeps_needed": config.min_sweeps},
        )
    first, last = found[0].first, found[-1].last
    times = window.readings.time_s
    # the window may cut the sweep at its edge: one that lies within a sweep's pause is reached
    pause = float(np.median(np.diff([times[s.first] for s in found])))
    low, high = float(times[first]), float(times[last - 1])
    valid = (
        window.valid[0] if low - window.valid[0] <= pause else low,
        window.valid[1] if window.valid[1] - high <= pause else high,
    )
    moved = [replace(s, first=s.first - first, last=s.last - first) for s in found]
    cut = replace(window, readings=window.readings.where(slice(first, last)), valid=valid)
    return cut, moved


def _common_rates(found: Sequence[Sweep], per_s_per_rpm: float) -> tuple[float, float]:
    """Range of the shear rates that every sweep spans `[1/s]`."""
    slow, fast = max(s.speeds[0] for s in found), min(s.speeds[1] for s in found)
    if not slow < fast:
        raise FitRefused(
            f"no two speeds are common to all sweeps: one begins at {slow:g} rpm, another ends at "
            f"{fast:g} rpm; sweep the same speeds throughout"
        )
    return per_s_per_rpm * slow, per_s_per_rpm * fast


@dataclass(frozen=True, slots=True)
class Stages:
    """K and n of each sweep, and a polynomial through each, as the paper did it.

    Parameters
    ----------
    factor, index : polynomials K(t) and n(t)
    """

    factor: PolynomialFit
    index: PolynomialFit
    reason: str
    diagnostics: dict[str, Detail]


def two_stages(swept: Sequence[tuple[Windowed, Sequence[Sweep]]], per_s_per_rpm: float) -> Stages:
    """Fit ln mu against ln rate in each sweep, then K and n against time.

    Weights are those of the error model: a constant fraction of full scale is an error of ln mu in
    inverse proportion to the torque.
    """
    times, ks, ns, u_ks, u_ns = [], [], [], [], []
    for window, found in swept:
        for sweep in found:
            part = window.readings.where(slice(sweep.first, sweep.last))
            logs = np.log(per_s_per_rpm * part.speed_rpm)
            fit = fit_linear(
                np.stack([np.ones_like(logs), logs], axis=1),
                np.log(part.viscosity_Pas),
                part.noise_Pas / part.viscosity_Pas,
                "known",
            )
            k = math.exp(fit.parameters[0])
            times.append(float(part.time_s.mean()))
            ks.append(k)
            ns.append(1.0 + float(fit.parameters[1]))
            u_ks.append(k * float(fit.standard_errors[0]))
            u_ns.append(float(fit.standard_errors[1]))
    factor = _chosen("K", times, ks, u_ks)
    index = _chosen("n", times, ns, u_ns)
    said: dict[str, Detail] = {"two_stage_sweeps": len(times)}
    for name, (fit_, _) in (("K", factor), ("n", index)):
        for power, (c, u) in enumerate(zip(fit_.coefficients, fit_.standard_errors, strict=True)):
            said[f"two_stage_{name}_{power}"] = float(c)
            said[f"two_stage_u_{name}_{power}"] = float(u)
    reason = f"K is a {factor[1]}; n is a {index[1]}"
    return Stages(factor[0], index[0], reason, said)


def _chosen(
    name: str, times: Sequence[float], values: Sequence[float], u: Sequence[float]
) -> tuple[PolynomialFit, str]:
    def fit(degree: int) -> Callable[[], PolynomialFit]:
        return lambda: fit_polynomial(times, values, degree, u)

    choice = choose([(f"polynomial of degree {d}", fit(d)) for d in range(_MAX_DEGREE[name] + 1)])
    return choice.fit, choice.reason


def _scores(
    surface: PowerLawFit,
    times: FloatArray,
    rates: FloatArray,
    stress: FloatArray,
    sigma: FloatArray,
) -> dict[str, float]:
    """AICc of the surface and of a Newtonian liquid whose viscosity is a polynomial like K."""
    scale = float(times.max())
    newtonian = fit_linear(
        np.stack([rates * (times / scale) ** k for k in range(len(surface.factor))], axis=1),
        stress,
        sigma,
    )
    return {"Newtonian": aicc(newtonian), "power law": aicc(surface.fit)}


def _compared(law: TimeLaw, stages: Stages) -> TimeLaw:
    """Say how far the two ways of fitting differ, and where the surface falls with time."""
    rate = law.usual_rate
    if rate is None:
        return law
    times = np.linspace(stages.factor.low, stages.factor.high, _CHECKED_TIMES)
    times = times[(times >= law.valid[0]) & (times <= law.valid[1])]
    surface = np.array([law.at(float(t))[0] for t in times])
    staged = stages.factor(times)[0] * rate ** (stages.index(times)[0] - 1.0)
    apart = float(np.max(np.abs(staged / surface - 1.0)))
    said = {**law.diagnostics, "two_stage_largest_difference": apart}
    flags = law.flags
    drop = 1.0 - surface / np.maximum.accumulate(surface)
    if drop.max() > 0:
        at = int(np.argmax(drop))
        flags += (
            Flag(
                "falls",
                f"viscosity at {rate:.3g} 1/s falls by up to {drop[at]:.2%}, at "
                f"{times[at] / 3600:.3g} h: K and n are free, and only their product is measured",
            ),
        )
    return replace(law, diagnostics=said, flags=flags)
