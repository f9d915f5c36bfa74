"""All films of a material: means at the card's frequency, and how they depend on frequency."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from deamat.core.records import Detail, Measurement, PropertyRecord, Summary
from deamat.core.technique import Context
from deamat.techniques.permittivity.config import PERMITTIVITY, VERSION, YIELDS, PermittivityConfig
from deamat.techniques.shared.mean import summarise_by_mean


def summarise(measurements: Sequence[Measurement], context: Context) -> Summary:
    """Average the films and state how the permittivity depends on frequency."""
    config: PermittivityConfig = context.config
    summary = summarise_by_mean(measurements, f"permittivity@{VERSION}", YIELDS)
    return replace(
        summary,
        records=tuple(
            _with_dependence(record, config) if record.key == PERMITTIVITY else record
            for record in summary.records
        ),
    )


def _with_dependence(record: PropertyRecord, config: PermittivityConfig) -> PropertyRecord:
    """Add the mean permittivity at the stated frequencies and the change up to the highest."""
    names = [f"relative_permittivity_{f:g}_Hz" for f in config.stated_frequencies_Hz]
    means = {name: _mean(record, name) for name in [*names, "slope_per_decade"]}
    change, top = _mean(record, "change_to_top_frequency"), _mean(record, "top_frequency_Hz")
    if change is None or top is None:
        return record
    u = math.hypot(_mean(record, "u_change_by_meter") or 0.0, _scatter(record))
    details: dict[str, Detail] = {name: mean for name, mean in means.items() if mean is not None}
    details |= {"change_to_top_frequency": change, "u_change_to_top_frequency": u}
    span = f"from {config.card_frequency_Hz:g} Hz to {top:g} Hz"
    told = f"{'falls' if change < 0 else 'rises'} by {100 * abs(change):.2g} % {span}"
    if abs(change) < 2.0 * u:
        told = f"does not depend on frequency {span} by more than is told ({100 * change:+.2g} %)"
    return replace(
        record,
        method=f"{record.method}; eps_r {told}, +- {200 * u:.2g} %",
        diagnostics={**record.diagnostics, **details},
    )


def _values(record: PropertyRecord, name: str) -> list[float]:
    return [float(o.diagnostics[name]) for o in record.origins if name in o.diagnostics]


def _mean(record: PropertyRecord, name: str) -> float | None:
    """Mean over the specimens; None unless every one of them has it."""
    values = _values(record, name)
    return math.fsum(values) / len(values) if len(values) == len(record.origins) else None


def _scatter(record: PropertyRecord) -> float:
    """Standard error of the mean change; the meter's part is in no specimen's scatter."""
    values = _values(record, "change_to_top_frequency")
    if len(values) < 2:
        return 0.0
    mean = math.fsum(values) / len(values)
    return math.sqrt(math.fsum((v - mean) ** 2 for v in values) / (len(values) - 1) / len(values))
