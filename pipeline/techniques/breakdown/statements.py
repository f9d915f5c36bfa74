"""What a card says beside a Weibull fit: its diagnostics, and what weakens it."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence

from deamat.core.records import Detail, Flag
from deamat.core.units import from_si
from deamat.estimators.weibull.intervals import Inference
from deamat.techniques.breakdown.config import BreakdownConfig
from deamat.techniques.breakdown.form import Form, form_details, form_flags
from deamat.techniques.breakdown.sample import Sample
from deamat.techniques.shared.mean import merged_flags


def diagnostics(
    sample: Sample,
    inference: Inference,
    form: Form,
    config: BreakdownConfig,
) -> dict[str, Detail]:
    """List what is known of a sample and its fit, as numbers and names."""
    fit = inference.fit
    ramps = [film.ramp for film in sample.films if film.ramp is not None]
    ends = Counter(ramp.end for ramp in ramps)
    details: dict[str, Detail] = {
        "failures": fit.failures,
        "censored": fit.n - fit.failures,
        "censoring": fit.censoring,
        "log_likelihood": fit.log_likelihood,
        **form_details(sample, form),
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


def flags_of(
    sample: Sample,
    inference: Inference,
    form: Form,
    lost: list[str],
    config: BreakdownConfig,
) -> tuple[Flag, ...]:
    """Say what weakens the fit: of the specimens, of the form, of what is missing."""
    fit = inference.fit
    flags = [*merged_flags(sample.pairs), *as_flags(fit.warnings)]
    flags += form_flags(sample, fit, form, config)
    ramps = [film.ramp for film in sample.films if film.ramp is not None]
    stepped = sum(ramp.steps is not None for ramp in ramps)
    if 0 < stepped < len(ramps):
        flags.append(
            Flag(
                "mixed-tests",
                f"{stepped} of {len(ramps)} were tested in steps that were held, the others by a "
                "ramp: films break at a lower voltage where it is held",
            )
        )
    if lost:
        named = ", ".join(lost[:3]) + (", ..." if len(lost) > 3 else "")
        flags.append(Flag("specimens-refused", f"{len(lost)} gave no value: {named}"))
    return tuple(flags)


def as_flags(warnings: Sequence[tuple[str, str]]) -> tuple[Flag, ...]:
    """Turn an estimator's warnings into flags."""
    return tuple(Flag(name.replace("_", "-"), detail) for name, detail in warnings)
