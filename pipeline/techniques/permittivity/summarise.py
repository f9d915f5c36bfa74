"""All films of a material: means at the card's frequency, and how they depend on frequency."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from deamat.core.records import Detail, Measurement, PropertyRecord, Refusal, Summary
from deamat.core.technique import Context
from deamat.estimators.mean import mean_with_shared
from deamat.techniques.permittivity.config import (
    LOSS,
    PERMITTIVITY,
    YIELDS,
    PermittivityConfig,
)
from deamat.techniques.permittivity.result import Dependence, FilmSpectrum
from deamat.techniques.shared.mean import summarise_by_mean


def summarise(
    measurements: Sequence[Measurement[FilmSpectrum]], context: Context[PermittivityConfig]
) -> Summary:
    """Average the films and state how the permittivity depends on frequency."""
    summary = summarise_by_mean(measurements, "permittivity", YIELDS)
    records, refusals = [], list(summary.refusals)
    for record in summary.records:
        if record.key == PERMITTIVITY:
            films = _films_of(record, measurements)
            records.append(_with_dependence(record, films, context.config))
        elif (loss := _not_below_zero(record)) is not None:
            records.append(loss)
        else:
            refusals.append(_refused_below_zero(record))
    return replace(summary, records=tuple(records), refusals=tuple(refusals))


def _refused_below_zero(loss: PropertyRecord) -> Refusal:
    value, u = loss.quantity.value, loss.quantity.standard_uncertainty
    return Refusal(
        LOSS,
        f"the loss comes out below zero, {value:.2g} +- {2.0 * u:.2g}: the meter turns the phase; "
        "trim open and short, or check it against a capacitor without loss",
        loss.material,
        loss.campaign,
        conditions=loss.conditions,
    )


def _not_below_zero(loss: PropertyRecord) -> PropertyRecord | None:
    """End value and interval of a loss at zero, below which no film is.

    The interval is otherwise the symmetric one, on no log scale: what is not told from zero has
    no order of magnitude. None where all of it lies below zero.
    """
    quantity = loss.quantity
    values = [origin.value for origin in loss.origins]
    low, high = mean_with_shared(values, quantity.u_independent, quantity.u_shared).ci95
    if high <= 0.0:
        return None
    if low > 0.0:
        return loss
    value = replace(quantity, value=max(quantity.value, 0.0))
    # a film below zero, within what the meter tells, is no implausible one
    flags = tuple(flag for flag in loss.flags if flag.name != "implausible")
    return replace(loss, quantity=value, ci95=(0.0, high), flags=flags)


def _films_of(
    record: PropertyRecord, measurements: Sequence[Measurement[FilmSpectrum]]
) -> list[Dependence]:
    """Find what the films behind a record say of their dependence on frequency."""
    return [
        m.result.dependence
        for m in measurements
        if m.result is not None
        and m.result.dependence is not None
        and any({**m.specimen.conditions, **v.conditions} == record.conditions for v in m.values)
    ]


def _with_dependence(
    record: PropertyRecord, films: Sequence[Dependence], config: PermittivityConfig
) -> PropertyRecord:
    """Add the mean permittivity at the stated frequencies and the change up to the highest."""
    change = _mean([f.change_to_top for f in films])
    top = _mean([f.top_frequency_Hz for f in films])
    u = math.hypot(_mean([f.u_change_by_meter for f in films]), _scatter(films))
    details: dict[str, Detail] = {
        f"relative_permittivity_{stated:g}_Hz": _mean([f.stated[stated] for f in films])
        for stated in config.stated_frequencies_Hz
        if all(stated in f.stated for f in films)
    }
    details |= {
        "slope_per_decade": _mean([f.slope_per_decade for f in films]),
        "change_to_top_frequency": change,
        "u_change_to_top_frequency": u,
    }
    span = f"from {record.conditions['frequency_Hz']:g} Hz to {top:g} Hz"
    told = f"{'falls' if change < 0 else 'rises'} by {100 * abs(change):.2g} % {span}"
    if abs(change) < 2.0 * u:
        told = f"does not depend on frequency {span} by more than is told ({100 * change:+.2g} %)"
    return replace(
        record,
        method=f"{record.method}; eps_r {told}, +- {200 * u:.2g} %",
        diagnostics={**record.diagnostics, **details},
    )


def _mean(values: Sequence[float]) -> float:
    return math.fsum(values) / len(values)


def _scatter(films: Sequence[Dependence]) -> float:
    """Standard error of the mean change; the meter's part is in no specimen's scatter."""
    values = [f.change_to_top for f in films]
    if len(values) < 2:
        return 0.0
    mean = _mean(values)
    return math.sqrt(math.fsum((v - mean) ** 2 for v in values) / (len(values) - 1) / len(values))
