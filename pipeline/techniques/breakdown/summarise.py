"""All specimens of one material: the Weibull fit, its intervals, and what weakens them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from deamat.core.card_lists import JointFit
from deamat.core.errors import FitRefused
from deamat.core.properties import property_key
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import Detail, Flag, Measurement, PropertyRecord, Refusal, Summary
from deamat.core.technique import Context
from deamat.core.units import from_si
from deamat.estimators.weibull.fit import fit
from deamat.estimators.weibull.intervals import P_SCALE, Inference, Interval, infer
from deamat.estimators.weibull.joint import SCALE as SCALE_GRADIENT
from deamat.estimators.weibull.joint import SHAPE as SHAPE_GRADIENT
from deamat.estimators.weibull.joint import correlations, of_quantile
from deamat.estimators.weibull.sample import MIN_DISTINCT, MIN_SPREAD
from deamat.estimators.weibull.shape import unbiased_shape
from deamat.techniques.breakdown.config import (
    B1,
    B10,
    SHAPE,
    STRENGTH,
    UNBIASED,
    YIELDS,
    BreakdownConfig,
)
from deamat.techniques.breakdown.form import (
    could_not_see,
    freed_of_thickness,
    judge,
    unseen_details,
    unseen_flags,
)
from deamat.techniques.breakdown.result import FilmTest
from deamat.techniques.breakdown.sample import Sample, methods, samples, shared_lines
from deamat.techniques.breakdown.statements import as_flags, diagnostics, flags_of
from deamat.techniques.shared.mean import origin_of

_ONE_SIGMA = math.erf(1.0 / math.sqrt(2.0))  # level of the interval whose half width is u
_NORMAL_95 = 1.959963984540054


def summarise(
    measurements: Sequence[Measurement[FilmTest]], context: Context[BreakdownConfig]
) -> Summary:
    r"""Fit a two-parameter Weibull distribution, $F = 1 - \exp(-(E/E_b)^\beta)$, by its likelihood.

    Specimens that did not break are right-censored. Where the log of some does not tell whether
    they broke, or their strength seems to follow their thickness, the intervals hold those of both
    readings. They are Lawless' exact conditional
    ones. Those of fields are widened by what all specimens have in common (voltage calibration,
    thickness gauge): on the logarithmic scale, on either side, half width and 1.96 times the
    shared relative uncertainty are added in quadrature. The shape does not change with the scale
    of the fields, so nothing is added to it.

    Parameters
    ----------
    measurements : of one material in one campaign; their order does not matter

    Source: IEC 62539; Lawless, Statistical Models and Methods for Lifetime Data, chapter 5.
    """
    records: list[PropertyRecord] = []
    fits: list[JointFit] = []
    refusals = [r for m in measurements for r in m.refusals]
    lost = sorted(m.specimen.id for m in measurements if not m.values)
    for sample in samples(measurements):
        try:
            records += _records(sample, lost, context.config)
            fits.append(_joint(sample))
        except FitRefused as error:
            refusals += _refused(sample, error)
    return Summary(tuple(records), refusals=tuple(refusals), fits=tuple(fits))


def _joint(sample: Sample) -> JointFit:
    """Say how the estimates of a sample's fit err together."""
    estimates = {
        STRENGTH: SCALE_GRADIENT,
        SHAPE: SHAPE_GRADIENT,
        UNBIASED: SHAPE_GRADIENT,
        B10: of_quantile(0.1),
        B1: of_quantile(0.01),
    }
    fitted = fit(sample.field_V_per_m, sample.censored)
    matrix = correlations(fitted, sample.field_V_per_m, list(estimates.values()))
    return JointFit(
        keys=tuple(estimates),
        campaign=sample.pairs[0][0].specimen.campaign,
        conditions=sample.conditions,
        correlations=tuple(tuple(float(f"{r:.6g}") for r in row) for row in matrix),
        why=f"one Weibull fit of {fitted.n} specimens, {fitted.failures} of which failed",
    )


def _records(sample: Sample, lost: list[str], config: BreakdownConfig) -> list[PropertyRecord]:
    x, censored = sample.field_V_per_m, sample.censored
    wide = infer(x, censored)
    narrow = replace(wide, level=_ONE_SIGMA)
    form = judge(sample, wide.fit, config)
    switched = _counted_otherwise(sample)
    others = tuple(i for i in (switched, freed_of_thickness(sample, form)) if i is not None)
    unbiased = unbiased_shape(x, censored)
    shape = wide.shape()
    shared = shared_lines(sample)
    limit = None if sample.area_m2 is None else config.area_ratio_limit
    details = diagnostics(sample, wide, form, config)
    flags = (*flags_of(sample, wide, form, lost, config), *_of_both(wide, switched))

    def record(
        key: str,
        value: float,
        ci95: tuple[float, float],
        u: float,
        method: str,
        more: tuple[Flag, ...] = (),
        beside: Mapping[str, Detail] | None = None,
    ) -> PropertyRecord:
        unit = property_key(key).unit
        systematic = shared if unit == "V/m" else ()
        budget = (
            Contribution("conditional distribution of the fit", u, False),
            *(c.scaled(value) for c in systematic),
        )
        specimen = sample.pairs[0][0].specimen
        return PropertyRecord(
            key=key,
            material=specimen.material,
            campaign=specimen.campaign,
            quantity=Quantity.from_budget(value, unit, budget),
            n=x.size,
            sd=None,  # of a Weibull sample the shape says it; a mean and sd would be read as normal
            ci95=ci95,
            conditions=sample.conditions,
            area_ratio_limit=limit if unit == "V/m" else None,
            method=f"{method}; {methods(sample)}; interval: {shape.method}",
            budget=budget,
            origins=tuple(origin_of(m, v, "breakdown") for m, v in sample.pairs),
            flags=(*flags, *more, *_implausible(key, value)),
            diagnostics={**details, **(beside or {})},
        )

    def of_field(key: str, p: float, what: str) -> PropertyRecord:
        estimate = wide.quantile(p)
        own = tuple(w for w in estimate.warnings if w not in wide.fit.warnings)
        low, high = _hull(narrow.quantile(p), others, lambda given: given.quantile(p))
        method = f"{what} of a two-parameter Weibull fit by maximum likelihood"
        both = _hull(estimate, others, lambda given: given.quantile(p))
        u_shared = math.sqrt(math.fsum(c.u**2 for c in shared))
        ci95 = widened(estimate.estimate, both, u_shared)
        more, beside = as_flags(own), None
        if p < P_SCALE:
            hidden = could_not_see(sample, p, config)
            more += unseen_flags(x.size, p, hidden, config)
            beside = unseen_details(hidden)
        return record(key, estimate.estimate, ci95, 0.5 * (high - low), method, more, beside)

    low, high = _hull(narrow.shape(), others, Inference.shape)
    u_shape = 0.5 * (high - low)
    between = _hull(shape, others, Inference.shape)
    return [
        of_field(STRENGTH, P_SCALE, "scale (63.2 % broken)"),
        record(
            SHAPE, shape.estimate, between, u_shape,
            "shape of a two-parameter Weibull fit by maximum likelihood, not corrected for its "
            "small-sample bias",
        ),
        record(
            UNBIASED, unbiased.value, between, u_shape,
            f"Weibull shape freed of its small-sample bias ({unbiased.method}); the interval is "
            "the exact one of the shape",
        ),
        of_field(B10, 0.1, "10 % quantile"),
        of_field(B1, 0.01, "1 % quantile"),
    ]  # fmt: skip


def widened(
    estimate: float, interval: tuple[float, float], u_relative: float
) -> tuple[float, float]:
    """Widen an interval of a positive value by a relative uncertainty common to all specimens.

    Parameters
    ----------
    estimate, interval : the interval is exact for independent errors
    u_relative : standard uncertainty of the logarithm of the common scale `[1]`
    """
    extra = _NORMAL_95 * u_relative
    below = math.hypot(math.log(estimate / interval[0]), extra)
    above = math.hypot(math.log(interval[1] / estimate), extra)
    return estimate * math.exp(-below), estimate * math.exp(above)


def _counted_otherwise(sample: Sample) -> Inference | None:
    """Count the specimens whose logs do not tell the other way, where that leaves a fit."""
    if sample.sure.all():
        return None
    try:
        return infer(sample.field_V_per_m, sample.censored ^ ~sample.sure)
    except FitRefused:
        return None


def _hull(
    given: Interval, others: tuple[Inference, ...], ask: Callable[[Inference], Interval]
) -> tuple[float, float]:
    """Interval that holds those of the other readings as well."""
    found = [given, *(ask(replace(other, level=given.level)) for other in others)]
    return min(i.low for i in found), max(i.high for i in found)


def _of_both(given: Inference, other: Inference | None) -> tuple[Flag, ...]:
    if other is None:
        return ()
    here, there = (from_si(i.fit.scale, "V/um") for i in (given, other))
    return (
        Flag(
            "counted-both-ways",
            f"the strength is {here:.4g} V/um as counted and would be {there:.4g} V/um with the "
            "specimens of unsure end counted the other way; the intervals hold both",
        ),
    )


def _implausible(key: str, value: float) -> tuple[Flag, ...]:
    low, high = property_key(key).plausible
    if low <= value <= high:
        return ()
    unit = property_key(key).unit
    return (Flag("implausible", f"{value:.5g} {unit}; expected {low:g} to {high:g} {unit}"),)


def _refused(sample: Sample, error: FitRefused) -> list[Refusal]:
    specimen = sample.pairs[0][0].specimen
    reason = error.reason + _hint(sample)
    return [
        Refusal(
            key, reason, specimen.material, specimen.campaign, None, sample.conditions,
            diagnostics=error.diagnostics,
        )
        for key in YIELDS
    ]  # fmt: skip


def _hint(sample: Sample) -> str:
    """Say what would help where the estimator's reason does not say it."""
    wrong = ~(sample.field_V_per_m > 0.0)
    failures = sample.field_V_per_m[~sample.censored]
    if wrong.any():
        who = sample.pairs[int(np.argmax(wrong))][0].specimen.id
        return f"; correct the register row of {who}, or leave it out for a stated reason"
    if failures.size == 0:
        return ": test thinner films, or with an amplifier that goes further"
    distinct = np.unique(failures)
    if distinct.size >= MIN_DISTINCT and np.ptp(distinct) < MIN_SPREAD * distinct[-1]:
        return ": read the instrument to more digits"
    return ""
