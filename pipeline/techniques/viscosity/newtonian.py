"""Laws of a Newtonian liquid that thickens: polynomials, an exponential, a power law to the gel."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.laws import EXPONENTIAL, FORMS, POLYNOMIAL, POWER_LAW_TO_GEL, evaluate
from deamat.core.records import Detail
from deamat.estimators.least_squares.fit import Fit
from deamat.estimators.least_squares.linear import fit_linear
from deamat.estimators.least_squares.monotone import fit_non_decreasing
from deamat.estimators.least_squares.nonlinear import fit_nonlinear
from deamat.estimators.selection import Choice, akaike_weights, choose, choose_for
from deamat.techniques.viscosity.calibration import settled
from deamat.techniques.viscosity.config import ViscosityConfig
from deamat.techniques.viscosity.fitted import Fitted, supported_of
from deamat.techniques.viscosity.misfit import (
    held_by,
    misfit_of,
    outlying_flags,
    widened_by_choice,
    widened_by_misfit,
)
from deamat.techniques.viscosity.readings import Readings
from deamat.techniques.viscosity.time_law import TimeLaw, drift_of, relative_error
from deamat.techniques.viscosity.window import Windowed, combined, common_range

# A law of another form must be exp(3 / 2) times better supported than a polynomial to weigh as
# much: with few coefficients it comes near a polynomial of many, and its interval lacks its bias.
_ANOTHER_FAMILY = 3.0
_GEL_TIMES = np.geomspace(1.02, 8.0, 10)  # over the last time: where to start looking for the gel


@dataclass(frozen=True, slots=True, kw_only=True)
class LawFit(Fit):
    """One law fitted to the readings.

    Parameters
    ----------
    kind, coefficients : as `core.laws.FORMS` takes them
    covariance : of the coefficients, shape (p, p)
    held : by how much holding it to its shape raises the weighted squares, over their variance
    """

    kind: str
    coefficients: FloatArray
    covariance: FloatArray
    held: float = 0.0


def fit_newtonian(windows: Sequence[Windowed], config: ViscosityConfig) -> Fitted:
    """Choose the smallest law that the readings support and say what it is worth.

    Polynomials are kept positive and from falling; candidates are compared by AICc (see
    `estimators.selection`); a tolerance in the configuration takes a cheaper one where that answers
    as well as asked. Answers are those of all laws that the data do not tell apart, or of the
    readings where the law misses these (see `misfit`). What changes of rotor or speed show of the
    calibration error is taken off first (see `calibration`).

    Raises
    ------
    FitRefused : no candidate could be fitted, or the best leaves too large a relative error
    """
    steps = settled(combined(windows), config.max_degree)
    readings = steps.readings
    choice = _chosen(readings, config)

    def law_of(name: str, fit: LawFit) -> TimeLaw:
        return _time_law(name, fit, readings, windows)

    law = replace(
        law_of(choice.name, choice.fit),
        reason=choice.reason,
        diagnostics={
            "calibration_shift": steps.shift,
            "calibration_left": steps.left,
            **scores(choice),
        },
        flags=steps.flags,
    )
    if law.relative_error > config.max_relative_error:
        raise FitRefused(
            f"the best law, {choice.name}, misses the readings by {law.relative_error:.1%} (root "
            f"mean square), more than {config.max_relative_error:.0%}: none of the laws on offer "
            "describes this run",
            {"relative_error": law.relative_error, **scores(choice)},
        )
    missed = misfit_of(law, choice.fit, choice.fit.held, readings)
    if missed is not None:
        return Fitted(widened_by_misfit(law, missed), ((1.0, law),), missed.direct)
    if len(windows) == 1:  # of several runs each has said so already, with the lines of its file
        law = replace(law, flags=(*law.flags, *outlying_flags(law, choice.fit, readings)))
    handicaps = [0.0 if f.kind == POLYNOMIAL else _ANOTHER_FAMILY for _, f in choice.scored]
    weights = akaike_weights([f for _, f in choice.scored], handicaps)
    possible = supported_of(weights, choice.scored)
    richest = max((f for _, (_, f) in possible), key=lambda f: f.parameter_count)
    supported = tuple((w, _with_noise_of(richest, law_of(n, f), f)) for w, (n, f) in possible)
    asked_for = config.answer_within is not None
    return widened_by_choice(Fitted(law, supported, asked_for=asked_for))


def _time_law(name: str, fit: LawFit, readings: Readings, windows: Sequence[Windowed]) -> TimeLaw:
    values, slopes = FORMS[fit.kind](fit.coefficients, readings.time_s, None, ())

    def moved_by(shift: FloatArray) -> FloatArray:
        return drift_of(fit.covariance, fit.error_variance, slopes, readings.noise_Pas, shift)

    return TimeLaw(
        kind=fit.kind,
        coefficients=fit.coefficients,
        parts=(),
        covariance=fit.covariance,
        drift=moved_by(readings.calibration_Pas),
        thermal=moved_by(readings.thermal_Pas),
        valid=_valid(fit, windows),
        rates=None,
        relative_error=relative_error(readings.viscosity_Pas, values),
        dof=fit.dof,
        name=name,
        reason="",
        diagnostics={},
    )


def _with_noise_of(richest: LawFit, law: TimeLaw, fit: LawFit) -> TimeLaw:
    """Take the scatter of readings from the residuals of one law for all.

    A law weighs more where its own residuals happen to be small, so that intervals from these come
    out too narrow; those of the richest law on offer were not chosen for their size.
    """
    if not (richest.residual_sd > 0 and fit.residual_sd > 0):
        return law
    ratio = richest.residual_sd / fit.residual_sd
    return replace(law, covariance=ratio**2 * law.covariance, dof=richest.dof)


def _chosen(readings: Readings, config: ViscosityConfig) -> Choice[LawFit]:
    """Take the law that the data support, or the cheapest that answers at all stated times."""
    offers = [(name, cost, cache(fit)) for cost, name, fit in _offers(readings, config)]
    if config.answer_within is None:
        return choose([(name, fit) for name, _, fit in offers])
    first, last = float(readings.time_s[0]), float(readings.time_s[-1])
    times = [t for t in config.stated_times_s if first <= t <= last] or [first, last]
    tolerance_Pas = config.answer_within * float(readings.viscosity_Pas.max())
    answers = [choose_for(offers, partial(_answer, time_s=t), tolerance_Pas) for t in times]
    names = [name for name, _, _ in offers]
    costliest = max(answers, key=lambda a: (names.index(a.name), a.error))
    return replace(
        costliest.supported,
        name=costliest.name,
        fit=costliest.fit,
        reason=f"{costliest.reason}; the data support {costliest.supported.name}",
    )


def _answer(fit: LawFit, time_s: float) -> tuple[float, float]:
    """Viscosity at a time and its standard uncertainty `[Pa.s]`."""
    value, slopes = FORMS[fit.kind](fit.coefficients, np.array([time_s]), None, ())
    return float(value[0]), math.sqrt(max(float(slopes[0] @ fit.covariance @ slopes[0]), 0.0))


def _offers(
    readings: Readings, config: ViscosityConfig
) -> list[tuple[int, str, Callable[[], LawFit]]]:
    """All laws on offer, the one with fewest coefficients first."""
    offers: list[tuple[int, str, Callable[[], LawFit]]] = []
    if POLYNOMIAL in config.laws:
        offers += [
            (degree + 1, f"{POLYNOMIAL} of degree {degree}", partial(_polynomial, readings, degree))
            for degree in range(config.max_degree + 1)
        ]
    if EXPONENTIAL in config.laws:
        offers.append((2, EXPONENTIAL, partial(_exponential, readings)))
    if POWER_LAW_TO_GEL in config.laws:
        offers.append((3, POWER_LAW_TO_GEL, partial(_power_law_to_gel, readings)))
    return sorted(offers, key=lambda offer: offer[0])


def _polynomial(readings: Readings, degree: int) -> LawFit:
    found = fit_non_decreasing(
        readings.time_s, readings.viscosity_Pas, degree, 0.0, readings.noise_Pas
    )
    fit = found.fit
    made = _law_fit(POLYNOMIAL, fit, fit.coefficients, fit.covariance)
    return replace(made, held=held_by(found)) if found.active else made


def _exponential(readings: Readings) -> LawFit:
    t, y, weight = _logarithms(readings)
    line = fit_linear(np.stack([np.ones_like(t), t], axis=1), y, weight).parameters
    if not line[1] > 0:
        raise FitRefused(f"the logarithm of viscosity falls, by {-line[1]:.3g} per s")
    return _nonlinear(EXPONENTIAL, readings, np.array([np.exp(line[0]), line[1]]))


def _power_law_to_gel(readings: Readings) -> LawFit:
    """Start from the gel time, of many, whose straight line in logarithms fits best."""
    t, y, weight = _logarithms(readings)
    best: tuple[float, FloatArray] | None = None
    for gel in float(t.max()) * _GEL_TIMES:
        design = np.stack([np.ones_like(t), -np.log(1.0 - t / gel)], axis=1)
        fit = fit_linear(design, y, weight)
        if best is None or fit.residual_sd < best[0]:
            best = fit.residual_sd, np.array([np.exp(fit.parameters[0]), gel, fit.parameters[1]])
    if best is None or not best[1][2] > 0:
        raise FitRefused("viscosity does not grow towards a gel point")
    end = float(t.max()) * (1.0 + 1e-6)
    return _nonlinear(POWER_LAW_TO_GEL, readings, best[1], np.array([-np.inf, end, -np.inf]))


def _logarithms(readings: Readings) -> tuple[FloatArray, FloatArray, FloatArray]:
    y = readings.viscosity_Pas
    if not np.all(y > 0):
        raise FitRefused("a viscosity of zero or less has no logarithm")
    return readings.time_s, np.log(y), readings.noise_Pas / y


def _nonlinear(
    kind: str, readings: Readings, start: FloatArray, lower: FloatArray | None = None
) -> LawFit:
    """Fit a form with coefficients scaled to about 1, as its search likes them."""
    form, times = FORMS[kind], readings.time_s

    def model(b: FloatArray) -> FloatArray:
        return form(b * start, times, None, ())[0]

    def jacobian(b: FloatArray) -> FloatArray:
        return form(b * start, times, None, ())[1] * start

    with np.errstate(over="ignore", invalid="ignore"):
        fit = fit_nonlinear(
            model,
            jacobian,
            np.ones(len(start)),
            readings.viscosity_Pas,
            readings.noise_Pas,
            lower=None if lower is None else lower / start,
        )
    return _law_fit(kind, fit, fit.parameters * start, fit.covariance * np.outer(start, start))


def _law_fit(kind: str, fit: Fit, coefficients: FloatArray, covariance: FloatArray) -> LawFit:
    return LawFit(
        kind=kind,
        coefficients=coefficients,
        covariance=covariance,
        y=fit.y,
        sigma=fit.sigma,
        residuals=fit.residuals,
        leverages=fit.leverages,
        residual_sd=fit.residual_sd,
        dof=fit.dof,
        condition_number=fit.condition_number,
        error_scale=fit.error_scale,
    )


def _valid(fit: LawFit, windows: Sequence[Windowed]) -> tuple[float, float]:
    """Reach to the edges of the window where the law goes on rising, else to the last readings."""
    outer = common_range([w.valid for w in windows])
    inner = common_range(
        [(float(w.readings.time_s[0]), float(w.readings.time_s[-1])) for w in windows]
    )
    if fit.kind == POWER_LAW_TO_GEL and outer[1] >= fit.coefficients[1]:
        return inner
    low, first, last, high = (
        evaluate(fit.kind, fit.coefficients, (), t)[0] for t in (outer[0], *inner, outer[1])
    )
    return (
        outer[0] if 0 < low <= first else inner[0],
        outer[1] if high >= last else inner[1],
    )


def scores(choice: Choice[LawFit]) -> dict[str, Detail]:
    """Keep what every candidate scored, or why it has no score."""
    said: dict[str, Detail] = {"choice": choice.reason}
    for tried in choice.tried:
        if tried.aicc is None:
            said[f"refused {tried.name}"] = tried.refusal
            continue
        said[f"aicc {tried.name}"] = tried.aicc
        if tried.leave_one_out_sd is not None:
            said[f"leave-one-out {tried.name}"] = tried.leave_one_out_sd
    return said
