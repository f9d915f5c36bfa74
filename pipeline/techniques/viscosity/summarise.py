"""All runs of one liquid: means of their values, and one law fitted to all of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from deamat.core.errors import FitRefused
from deamat.core.recording import Specimen
from deamat.core.records import Measurement, Summary
from deamat.core.technique import Context
from deamat.techniques.shared.mean import summarise_by_mean
from deamat.techniques.shared.outcome import refusal
from deamat.techniques.viscosity.against_temperature import temperature_laws
from deamat.techniques.viscosity.config import (
    AGAINST_TEMPERATURE,
    ALWAYS,
    VISCOSITY,
    YIELDS,
    ViscosityConfig,
)
from deamat.techniques.viscosity.pooled import fit_runs, laws_of, refuse_mixed_units
from deamat.techniques.viscosity.readings import Readings
from deamat.techniques.viscosity.result import Run
from deamat.techniques.viscosity.temperature import alike, refuse_mixed_temperatures
from deamat.techniques.viscosity.window import Windowed, stated_temperature_K, windowed


def summarise(
    measurements: Sequence[Measurement[Run]], context: Context[ViscosityConfig]
) -> Summary:
    """Average the values of the runs, and fit one law to all of them."""
    config = context.config
    ordered = sorted(measurements, key=lambda m: (m.specimen.line, m.specimen.id))
    tolerance_K = config.temperature_tolerance_K
    summary = _with_temperature_law(
        summarise_by_mean(alike(ordered, tolerance_K), "viscosity", YIELDS), ordered[0].specimen
    )
    runs = [
        (m.specimen, windowed(m.result, config, stated_temperature_K(m.specimen)))
        for m in ordered
        if m.values and isinstance(m.result, Readings)
    ]
    if not runs:
        return summary
    specimens, windows = [s for s, _ in runs], [w for _, w in runs]
    specimen = specimens[0]
    try:
        refuse_mixed_units({s.id: w for s, w in runs})
    except FitRefused as error:
        mixed = tuple(refusal(specimen, key, error, {}) for key in ALWAYS)
        return Summary((), (), (*summary.refusals, *mixed))
    try:
        refuse_mixed_temperatures({s.id: w.probe for s, w in runs}, tolerance_K)
        law, levels = fit_runs(windows, config)
    except FitRefused as error:
        refused = refusal(specimen, VISCOSITY, error, {})
        return Summary(summary.records, summary.laws, (*summary.refusals, refused))
    origins = next((r.origins for r in summary.records if r.key == VISCOSITY), ())
    method = windows[0].rule
    laws = laws_of(law, levels, specimen, method, origins, _temperature_K(specimens, windows))
    return Summary(summary.records, (*laws, *summary.laws), summary.refusals)


def _with_temperature_law(summary: Summary, specimen: Specimen) -> Summary:
    """Add the law of viscosity against temperature where three temperatures or more tell it."""
    try:
        return replace(summary, laws=temperature_laws(summary.records, specimen))
    except FitRefused as error:
        refused = refusal(specimen, AGAINST_TEMPERATURE, error, {})
        return replace(summary, refusals=(*summary.refusals, refused))


def _temperature_K(runs: Sequence[Specimen], windows: Sequence[Windowed]) -> float | None:
    """Mean temperature of the runs, by their probes or else as the register states it `[K]`."""
    kelvin = [w.probe.mean_K for w in windows if w.probe is not None]
    if len(kelvin) < len(windows):
        stated = [stated_temperature_K(run) for run in runs]
        kelvin = [k for k in stated if k is not None]
    return math.fsum(kelvin) / len(kelvin) if len(kelvin) == len(runs) else None
