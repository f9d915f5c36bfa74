"""One record per property of one material: the mean over specimens, and what stands behind it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from deamat.core.errors import FitRefused
from deamat.core.flags import merged
from deamat.core.properties import property_key
from deamat.core.quantity import Contribution, Quantity, averaged
from deamat.core.records import (
    Bound,
    Condition,
    Detail,
    Flag,
    MeasuredValue,
    Measurement,
    Origin,
    PropertyRecord,
    Refusal,
    Result,
    Summary,
)
from deamat.estimators.censored_mean import mean_with_limits
from deamat.estimators.mean import Mean, apart_of_few, mean_with_shared, outliers, positive_interval

Pair = tuple[Measurement[Result], MeasuredValue]


def summarise_by_mean(
    measurements: Sequence[Measurement[Result]], technique: str, keys: Sequence[str]
) -> Summary:
    """Average each property over the specimens that gave it; values of other conditions stay apart.

    Parameters
    ----------
    measurements : of one material in one campaign; their order does not matter
    technique : its key, for the origins
    keys : property keys in the order of the records

    Raises
    ------
    FitRefused : no measurements, or of more than one material or campaign
    """
    owners = {(m.specimen.campaign, m.specimen.material) for m in measurements}
    if len(owners) != 1:
        raise FitRefused(
            f"a summary is of one material in one campaign, not of {len(owners)}: {sorted(owners)}"
        )
    ordered = sorted(measurements, key=lambda m: (m.specimen.line, m.specimen.id))
    records = tuple(
        _record(pairs, conditions, technique)
        for key in keys
        for pairs, conditions in _alike([(m, v) for m in ordered for v in m.values if v.key == key])
    )
    refusals = tuple(r for m in ordered for r in m.refusals)
    return Summary(tuple(_beside_refused(r, refusals) for r in records), refusals=refusals)


def _beside_refused(record: PropertyRecord, refusals: Sequence[Refusal]) -> PropertyRecord:
    """Flag a mean of which other specimens were left out for their size: it is biased."""
    left_out = [r for r in refusals if r.key == record.key and r.selective]
    if not left_out:
        return record
    survivors = Flag(
        "survivors",
        f"{len(left_out)} of {record.n + len(left_out)} specimens were refused because their slope "
        "could not be told from zero: the mean of the others is biased high",
    )
    return replace(record, flags=(*record.flags, survivors))


def _alike(pairs: Sequence[Pair]) -> Iterator[tuple[list[Pair], dict[str, Condition]]]:
    """Group values by their conditions; a strain rate is that of the machine's speed.

    Heights differ from specimen to specimen and the rates with them, but the speed that was set is
    one condition: the record tells the mean rate of its specimens.
    """
    groups: dict[tuple[object, ...], list[tuple[Pair, dict[str, Condition]]]] = {}
    for measurement, value in pairs:
        conditions = {**measurement.specimen.conditions, **value.conditions}
        fixed = {k: v for k, v in conditions.items() if k != "rate_per_s"}
        speed = measurement.specimen.numbers.get("speed_m_per_s")
        setting = (*sorted(fixed.items()), None if speed is None else speed.value)
        groups.setdefault(setting, []).append(((measurement, value), conditions))
    for members in groups.values():
        conditions = dict(members[0][1])
        rates = [r for _, c in members if isinstance(r := c.get("rate_per_s"), float)]
        if rates:
            conditions["rate_per_s"] = float(f"{math.fsum(rates) / len(rates):.6g}")
        yield [pair for pair, _ in members], conditions


def _record(
    pairs: Sequence[Pair], conditions: Mapping[str, Condition], technique: str
) -> PropertyRecord:
    specimen, first = pairs[0][0].specimen, pairs[0][1]
    n = len(pairs)
    shared = averaged([value.budget for _, value in pairs])
    found = _mean(pairs, math.sqrt(math.fsum(c.u**2 for c in shared)))
    if n == 1:
        budget = first.budget
    else:
        scatter = Contribution(
            "scatter between specimens",
            found.mean.u_independent,
            shared=False,
            degrees_of_freedom=found.scatter_dof,
        )
        budget = (scatter, *shared)
    return PropertyRecord(
        key=first.key,
        material=specimen.material,
        campaign=specimen.campaign,
        quantity=Quantity.from_budget(found.mean.value, first.quantity.unit, budget),
        n=n,
        sd=found.mean.sd,
        ci95=found.ci95,
        conditions=conditions,
        method=first.method if n == 1 else f"{found.method} of {n} specimens; {first.method}",
        budget=budget,
        origins=tuple(origin_of(m, v, technique) for m, v in pairs),
        flags=merged_flags(pairs) + _flags_of_mean(pairs, found.mean.value),
        diagnostics=_diagnostics(pairs, found.mean.degrees_of_freedom),
        bound=found.bound,
    )


@dataclass(frozen=True, slots=True)
class _Found:
    """A mean, its interval, what kind of limit it is and how it was made.

    Parameters
    ----------
    scatter_dof : degrees of freedom of the scatter between the specimens
    """

    mean: Mean
    ci95: tuple[float, float]
    bound: Bound
    method: str
    scatter_dof: float


def _mean(pairs: Sequence[Pair], u_shared: float) -> _Found:
    """Average exact values and lower limits; too few exact ones leave a lower limit."""
    values = [v.quantity.value for _, v in pairs]
    limits = [v.bound == "lower" for _, v in pairs]
    own = pairs[0][1]
    if any(limits):
        try:
            censored = mean_with_limits(values, limits, u_shared)
        except FitRefused:
            at_least = mean_with_shared(values, own.quantity.u_independent, u_shared)
            ci95 = (at_least.value, math.inf)
            return _Found(
                at_least,
                ci95,
                "lower",
                "mean, at least: unbroken ones at their limits,",
                len(pairs) - 1,
            )
        how = f"mean, {limits.count(True)} unbroken ones as lower limits (maximum likelihood),"
        exact = limits.count(False)
        return _Found(censored, positive_interval(censored), "exact", how, exact - 1)
    mean = mean_with_shared(values, own.quantity.u_independent, u_shared, own.degrees_of_freedom)
    interval = mean.ci95 if min(values) < 0.0 else positive_interval(mean)
    return _Found(mean, interval, "exact", "mean", len(pairs) - 1)


def origin_of(measurement: Measurement[Result], value: MeasuredValue, technique: str) -> Origin:
    """Trace a record to one specimen's value, its register row and its bytes."""
    specimen, source = measurement.specimen, measurement.source
    first, last = (None, None) if value.lines is None else value.lines
    return Origin(
        specimen=specimen.id,
        value=value.quantity.value,
        u_independent=value.quantity.u_independent,
        u_shared=value.quantity.u_shared,
        register=specimen.register,
        register_line=specimen.line,
        path=None if source is None else source.path,
        sha256=None if source is None else source.sha256,
        first_line=first,
        last_line=last,
        reader=None if source is None else source.reader,
        technique=technique,
        diagnostics=value.diagnostics,
    )


def merged_flags(pairs: Sequence[Pair]) -> tuple[Flag, ...]:
    """Say each flag of the specimens once, with who has it and the first one's numbers."""
    noticed = [(measurement.specimen.id, flag) for measurement, v in pairs for flag in v.flags]
    return merged(noticed, len(pairs))


def _flags_of_mean(pairs: Sequence[Pair], mean: float) -> tuple[Flag, ...]:
    key = property_key(pairs[0][1].key)
    low, high = key.plausible
    named = [(m.specimen.id, v.quantity.value) for m, v in pairs]
    found = [value for _, value in named]
    flags = []
    if len(pairs) == 1:
        flags.append(
            Flag("single-specimen", "one specimen: the scatter between specimens is unknown")
        )
    flags += [
        Flag(
            "outlier",
            f"{named[i][0]} with {named[i][1]:.5g} {key.unit} stands apart from the other "
            f"{len(pairs) - 1}{' (Grubbs, 1 %)' if len(pairs) > 4 else ''}; it is in the mean all "
            "the same",
        )
        for i in (outliers(found) or apart_of_few(found))
    ]
    odd = [f"{who} {value:.5g}" for who, value in named if not low <= value <= high]
    if odd or not low <= mean <= high:
        flags.append(
            Flag(
                "implausible",
                f"a soft elastomer has {low:g} to {high:g} {key.unit}; mean {mean:.5g}"
                + (f"; outside: {', '.join(odd)}" if odd else ""),
            )
        )
    return tuple(flags)


def _diagnostics(pairs: Sequence[Pair], degrees_of_freedom: float) -> dict[str, Detail]:
    values = [v.quantity.value for _, v in pairs]
    details: dict[str, Detail] = {
        "min": min(values),
        "max": max(values),
        "mean_u_of_a_specimen": math.fsum(v.quantity.standard_uncertainty for _, v in pairs)
        / len(pairs),
    }
    if math.isfinite(degrees_of_freedom):
        details["degrees_of_freedom"] = degrees_of_freedom
    return details
