"""Viscosity of a curing liquid: laws over time, power-law fluids, flow curves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.records import MeasuredValue, Measurement, Recording, Refusal, Specimen, Summary
from deamat.core.technique import Context, Technique
from deamat.techniques._mean_record import summarise_by_mean
from deamat.techniques.viscosity.clock import since_mixing_s
from deamat.techniques.viscosity.config import ViscosityConfig
from deamat.techniques.viscosity.figure import draw
from deamat.techniques.viscosity.flow_curve import flow_curve_values
from deamat.techniques.viscosity.pooled import fit_law, fit_runs, laws_of, refuse_mixed_units
from deamat.techniques.viscosity.readings import Readings, audited, from_curve
from deamat.techniques.viscosity.time_law import TimeLaw
from deamat.techniques.viscosity.values import (
    CONSISTENCY,
    CONSISTENCY_WIDE_CUP,
    DOUBLING,
    INDEX,
    LIMIT,
    VISCOSITY,
    asked_of,
    measured,
)
from deamat.techniques.viscosity.window import Windowed, windowed

VERSION = 2


def reduce(specimen: Specimen, recording: Recording | None, context: Context) -> Measurement:
    """Reduce one run to the values of its law, or one flow curve to K and n.

    Parameters
    ----------
    specimen : `mixed_at` in its notes where the file is stamped by the clock; `sample` where a
        file holds several flow curves
    recording : with `viscosity_Pas` and a time (`time_s`, `utc_s`, `local_clock_s`,
        `time_of_day_s`) or `shear_rate_per_s`
    context : with a `ViscosityConfig` and the viscometer's limits

    Source: Sikulskyi et al. 2022, section 3.2 and Table 2, for windows and laws.
    """
    config: ViscosityConfig = context.config
    source = None if recording is None else recording.source
    curve: dict[str, FloatArray] = {}
    try:
        if recording is None:
            raise FitRefused("the register names no data file for this run; fill in `file`")
        if "shear_rate_per_s" in recording.columns:
            values, curve = flow_curve_values(specimen, recording)
            return Measurement(specimen, values, (), curve, source)
        times = since_mixing_s(specimen, recording, context.timezone)
        readings = audited(recording, times, context.machine, config)
        curve = readings.columns
        window = windowed(readings, config)
        law = fit_law([window], config)
    except FitRefused as error:
        return Measurement(
            specimen, (), tuple(_refusal(specimen, key, error) for key in _ALWAYS), curve, source
        )
    values_, refusals = _values(specimen, readings, window, law, config)
    return Measurement(specimen, values_, refusals, curve, source)


def _values(
    specimen: Specimen,
    readings: Readings,
    window: Windowed,
    law: TimeLaw,
    config: ViscosityConfig,
) -> tuple[tuple[MeasuredValue, ...], tuple[Refusal, ...]]:
    lines = window.readings.line
    span = (int(lines.min()), int(lines.max()))
    flags = tuple(dict.fromkeys((*readings.flags, *window.readings.flags, *law.flags)))
    method = f"{law.name}, {window.rule}; {readings.errors}"
    values, refusals = [], []
    for asked in asked_of(law, window, config):
        try:
            values.append(measured(asked, law, method, flags, span))
        except FitRefused as error:
            refused = _refusal(specimen, asked.key, error)
            conditions = {**specimen.conditions, **asked.conditions}
            refusals.append(
                Refusal(
                    refused.key, refused.reason, refused.material, refused.campaign,
                    refused.specimen, conditions, refused.diagnostics,
                )
            )  # fmt: skip
    return tuple(values), tuple(refusals)


def _refusal(specimen: Specimen, key: str, error: FitRefused) -> Refusal:
    return Refusal(
        key, error.reason, specimen.material, specimen.campaign, specimen.id,
        specimen.conditions, error.diagnostics,
    )  # fmt: skip


def summarise(measurements: Sequence[Measurement], context: Context) -> Summary:
    """Average the values of the runs, and fit one law to all of them."""
    config: ViscosityConfig = context.config
    summary = summarise_by_mean(measurements, f"viscosity@{VERSION}", TECHNIQUE.yields)
    ordered = sorted(measurements, key=lambda m: (m.specimen.line, m.specimen.id))
    runs = [m for m in ordered if m.values and "time_s" in m.curve]
    if not runs:
        return summary
    windows = [windowed(from_curve(m.curve), config) for m in runs]
    specimen = runs[0].specimen
    try:
        refuse_mixed_units({m.specimen.id: w for m, w in zip(runs, windows, strict=True)})
    except FitRefused as error:
        mixed = tuple(_refusal(specimen, key, error) for key in _ALWAYS)
        return Summary((), (), (*summary.refusals, *mixed))
    try:
        law, levels = fit_runs(windows, config)
    except FitRefused as error:
        refused = _refusal(specimen, VISCOSITY, error)
        return Summary(summary.records, (), (*summary.refusals, refused))
    origins = next((r.origins for r in summary.records if r.key == VISCOSITY), ())
    method = windows[0].rule
    law = replace(law, diagnostics={**law.diagnostics, **_temperature(runs)})
    return Summary(
        summary.records, laws_of(law, levels, specimen, method, origins), summary.refusals
    )


def _temperature(runs: Sequence[Measurement]) -> dict[str, float]:
    """Mean temperature of the runs, where the register tells it of all of them `[K]`."""
    stated = [m.specimen.numbers[_TEMPERATURE] for m in runs if _TEMPERATURE in m.specimen.numbers]
    if len(stated) < len(runs):
        return {}
    return {_TEMPERATURE: sum(t.value for t in stated) / len(stated)}


_TEMPERATURE = "temperature_K"
# Refused by name where a run gives nothing; the others are only asked of some liquids.
_ALWAYS = (VISCOSITY, DOUBLING)

TECHNIQUE = Technique(
    key="viscosity",
    version=VERSION,
    yields=(VISCOSITY, DOUBLING, LIMIT, CONSISTENCY, INDEX, CONSISTENCY_WIDE_CUP),
    needs=(),
    config=ViscosityConfig,
    required=(),
    optional=("mass_kg",),
    reduce=reduce,
    summarise=summarise,
    figure=draw,
)
