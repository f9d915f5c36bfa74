"""All specimens of one material: the Weibull fit, its intervals, and what weakens them."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.properties import property_key
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import (
    Condition,
    Detail,
    Flag,
    Measurement,
    PropertyRecord,
    Refusal,
    Summary,
)
from deamat.core.technique import Context
from deamat.core.units import from_si
from deamat.estimators.weibull.goodness import GoodnessOfFit, LowOutlier
from deamat.estimators.weibull.goodness import goodness_of_fit as test_of_form
from deamat.estimators.weibull.goodness import low_outlier as test_of_lowest
from deamat.estimators.weibull.intervals import Inference, Interval, infer
from deamat.estimators.weibull.sample import MIN_DISTINCT, MIN_SPREAD
from deamat.estimators.weibull.shape import unbiased_shape
from deamat.techniques.breakdown.config import (
    B1,
    B10,
    FIELD,
    SHAPE,
    STRENGTH,
    UNBIASED,
    YIELDS,
    BreakdownConfig,
)
from deamat.techniques.breakdown.result import FilmTest
from deamat.techniques.shared.mean import Pair, merged_flags, origin_of

_ONE_SIGMA = math.erf(1.0 / math.sqrt(2.0))  # level of the interval whose half width is u
_NORMAL_95 = 1.959963984540054


@dataclass(frozen=True, slots=True)
class Sample:
    """The films of one material under the same conditions, in register order.

    Parameters
    ----------
    field_V_per_m : of breakdown, or borne unbroken, shape (n,)
    censored : which of them did not break, shape (n,)
    """

    pairs: tuple[Pair, ...]
    films: tuple[FilmTest, ...]
    conditions: dict[str, Condition]
    field_V_per_m: FloatArray
    censored: NDArray[np.bool_]

    @property
    def area_m2(self) -> float | None:
        """Area under the electrodes, where the register declares it."""
        area_m2 = self.conditions.get("electrode_area_m2")
        return area_m2 if isinstance(area_m2, float) else None


def samples(measurements: Sequence[Measurement[FilmTest]]) -> Iterator[Sample]:
    """Part the specimens by electrode area and rate of rise; other conditions are one group's."""
    ordered = sorted(measurements, key=lambda m: (m.specimen.line, m.specimen.id))
    groups: dict[tuple[tuple[str, Condition], ...], list[tuple[Pair, FilmTest]]] = {}
    for m in ordered:
        for v in m.values:
            if v.key == FIELD and m.result is not None:
                conditions = {**m.specimen.conditions, **v.conditions}
                group = groups.setdefault(tuple(sorted(conditions.items())), [])
                group.append(((m, v), m.result))
    for conditions_of_group, members in groups.items():
        yield Sample(
            tuple(pair for pair, _ in members),
            tuple(film for _, film in members),
            dict(conditions_of_group),
            np.array([v.quantity.value for (_, v), _ in members]),
            np.array([film.censored for _, film in members]),
        )


def summarise(
    measurements: Sequence[Measurement[FilmTest]], context: Context[BreakdownConfig]
) -> Summary:
    r"""Fit a two-parameter Weibull distribution, $F = 1 - \exp(-(E/E_b)^\beta)$, by its likelihood.

    Specimens that did not break are right-censored. The intervals are Lawless' exact conditional
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
    refusals = [r for m in measurements for r in m.refusals]
    lost = sorted(m.specimen.id for m in measurements if not m.values)
    for sample in samples(measurements):
        try:
            records += _records(sample, lost, context.config)
        except FitRefused as error:
            refusals += _refused(sample, error)
    return Summary(tuple(records), refusals=tuple(refusals))


def _records(sample: Sample, lost: list[str], config: BreakdownConfig) -> list[PropertyRecord]:
    x, censored = sample.field_V_per_m, sample.censored
    wide = infer(x, censored)
    narrow = replace(wide, level=_ONE_SIGMA)
    form = test_of_form(x, censored)
    lowest = test_of_lowest(x, censored, config.low_outlier_level)
    unbiased = unbiased_shape(x, censored)
    shape = wide.shape()
    shared = _shared(sample)
    limit = None if sample.area_m2 is None else config.area_ratio_limit
    details = _diagnostics(sample, wide, form, lowest, config)
    flags = _flags(sample, wide, form, lowest, lost, config)

    def record(
        key: str, value: float, ci95: tuple[float, float], u: float, method: str, *more: Flag
    ) -> PropertyRecord:
        unit = property_key(key).unit
        systematic = shared if unit == "V/m" else ()
        budget = (
            Contribution("conditional distribution of the fit", u, False),
            *(Contribution(c.source, value * c.u, True) for c in systematic),
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
            method=f"{method}; {_methods(sample)}; interval: {shape.method}",
            budget=budget,
            origins=tuple(origin_of(m, v, "breakdown") for m, v in sample.pairs),
            flags=(*flags, *more, *_implausible(key, value)),
            diagnostics=details,
        )

    def of_field(key: str, estimate: Interval, one_sigma: Interval, what: str) -> PropertyRecord:
        own = tuple(w for w in estimate.warnings if w not in wide.fit.warnings)
        u = 0.5 * (one_sigma.high - one_sigma.low)
        method = f"{what} of a two-parameter Weibull fit by maximum likelihood"
        ci95 = widened(estimate, math.sqrt(math.fsum(c.u**2 for c in shared)))
        return record(key, estimate.estimate, ci95, u, method, *_as_flags(own))

    u_shape = 0.5 * (narrow.shape().high - narrow.shape().low)
    between = (shape.low, shape.high)
    return [
        of_field(STRENGTH, wide.scale(), narrow.scale(), "scale (63.2 % broken)"),
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
        of_field(B10, wide.quantile(0.1), narrow.quantile(0.1), "10 % quantile"),
        of_field(B1, wide.quantile(0.01), narrow.quantile(0.01), "1 % quantile"),
    ]  # fmt: skip


def widened(interval: Interval, u_relative: float) -> tuple[float, float]:
    """Widen an interval of a positive value by a relative uncertainty common to all specimens.

    Parameters
    ----------
    interval : exact for independent errors
    u_relative : standard uncertainty of the logarithm of the common scale `[1]`
    """
    extra = _NORMAL_95 * u_relative
    below = math.hypot(math.log(interval.estimate / interval.low), extra)
    above = math.hypot(math.log(interval.high / interval.estimate), extra)
    return interval.estimate * math.exp(-below), interval.estimate * math.exp(above)


def _shared(sample: Sample) -> tuple[Contribution, ...]:
    """Average each shared source over the specimens, relative to their fields: one error each."""
    totals: dict[str, float] = {}
    for _, value in sample.pairs:
        for line in value.budget:
            if line.shared:
                part = line.u / value.quantity.value / len(sample.pairs)
                totals[line.source] = totals.get(line.source, 0.0) + part
    return tuple(Contribution(source, u, True) for source, u in totals.items())


def _methods(sample: Sample) -> str:
    return ", or ".join(dict.fromkeys(v.method for _, v in sample.pairs))


def _diagnostics(
    sample: Sample,
    inference: Inference,
    form: GoodnessOfFit,
    lowest: LowOutlier,
    config: BreakdownConfig,
) -> dict[str, Detail]:
    fit = inference.fit
    ramps = [film.ramp for film in sample.films if film.ramp is not None]
    ends = Counter(ramp.end for ramp in ramps)
    details: dict[str, Detail] = {
        "failures": fit.failures,
        "censored": fit.n - fit.failures,
        "censoring": fit.censoring,
        "log_likelihood": fit.log_likelihood,
        "anderson_darling": form.statistic,
        "goodness_p": form.p_value,
        "low_outlier_p": lowest.p_value,
        "low_outlier": sample.pairs[lowest.index][0].specimen.id if lowest.found else "none",
        "least_field_V_per_m": float(sample.field_V_per_m.min()),
        "greatest_field_V_per_m": float(sample.field_V_per_m.max()),
        "area_scaling": _area_scaling(sample, config),
        **{f"ended by {how}": count for how, count in sorted(ends.items())},
    }
    for name, found in (
        ("thickness_m", [f.thickness_m for f in sample.films if f.thickness_m is not None]),
        ("time_to_end_s", [ramp.duration_s for ramp in ramps]),
        ("rate_V_per_s", [ramp.rate_V_per_s for ramp in ramps]),
    ):
        if found:
            details |= {
                f"{name}_mean": math.fsum(found) / len(found),
                f"{name}_least": min(found),
                f"{name}_greatest": max(found),
            }
    return details


def _area_scaling(sample: Sample, config: BreakdownConfig) -> str:
    if sample.area_m2 is None:
        return "not possible: the register declares no electrode area"
    area_mm2 = from_si(sample.area_m2, "mm2")
    return (
        f"E2 = E1 (A1/A2)^(1/shape) from A1 = {area_mm2:.4g} mm2, for A1/A2 of "
        f"{1 / config.area_ratio_limit:g} to {config.area_ratio_limit:g}"
    )


def _flags(
    sample: Sample,
    inference: Inference,
    form: GoodnessOfFit,
    lowest: LowOutlier,
    lost: list[str],
    config: BreakdownConfig,
) -> tuple[Flag, ...]:
    fit = inference.fit
    flags = [*merged_flags(sample.pairs), *_as_flags(fit.warnings)]
    if fit.censoring == "type I or random":
        flags.append(
            Flag(
                "approximate-interval",
                f"{fit.n - fit.failures} of {fit.n} specimens did not break, each at a limit of "
                "its own: the intervals are then approximate (94 to 95 % in simulation)",
            )
        )
    if form.p_value < config.goodness_level:
        flags.append(
            Flag(
                "poor-fit",
                f"only {100 * form.p_value:.2g} % of Weibull samples lie as far from their fit "
                f"(Anderson-Darling {form.statistic:.3g}): low quantiles cannot be trusted",
            )
        )
    if lowest.found:
        who = sample.pairs[lowest.index][0].specimen.id
        flags.append(
            Flag(
                "low-outlier",
                f"{who} broke at {from_si(lowest.value, 'V/um'):.4g} V/um; only "
                f"{100 * lowest.p_value:.2g} % of Weibull samples hold one as weak; it is in the "
                "fit all the same",
            )
        )
    if lost:
        named = ", ".join(lost[:3]) + (", ..." if len(lost) > 3 else "")
        flags.append(Flag("specimens-refused", f"{len(lost)} gave no value: {named}"))
    return tuple(flags)


def _as_flags(warnings: Sequence[tuple[str, str]]) -> tuple[Flag, ...]:
    return tuple(Flag(name.replace("_", "-"), detail) for name, detail in warnings)


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
