"""One run to the values of its law, or one flow curve to K and n."""

from __future__ import annotations

from deamat.core.errors import FitRefused
from deamat.core.instruments import Machine
from deamat.core.quantity import Contribution
from deamat.core.recording import Recording, Specimen
from deamat.core.records import MeasuredValue, Measurement, Refusal
from deamat.core.technique import Context
from deamat.techniques.shared.outcome import nothing_measured, refusal
from deamat.techniques.viscosity.clock import refuse_impossible_end, since_mixing_s
from deamat.techniques.viscosity.config import (
    ALWAYS,
    ALWAYS_OF_FLOW_CURVES,
    AT_PRINTING_RATE,
    DOUBLING,
    ViscosityConfig,
)
from deamat.techniques.viscosity.fitted import Fitted
from deamat.techniques.viscosity.flow_curve import flow_curve_values
from deamat.techniques.viscosity.pooled import fit_law
from deamat.techniques.viscosity.printing import one_rate, too_far
from deamat.techniques.viscosity.readings import Readings, audited
from deamat.techniques.viscosity.result import Run
from deamat.techniques.viscosity.values import asked_of, drifting, drifts, measured
from deamat.techniques.viscosity.window import Windowed, stated_temperature_K, windowed

_CALIBRATION = "viscometer calibration"


def reduce(
    specimen: Specimen, recording: Recording | None, context: Context[ViscosityConfig]
) -> Measurement[Run]:
    """Reduce one run to the values of its law, or one flow curve to K and n.

    Parameters
    ----------
    specimen : `mixed_at` in its notes where the file is stamped by the clock; `sample` where a
        file holds several flow curves
    recording : with `viscosity_Pas` and a time (`time_s`, `utc_s`, `local_clock_s`,
        `time_of_day_s`) or `shear_rate_per_s`
    context : with the viscometer's limits

    Source: Sikulskyi et al. 2022, section 3.2 and Table 2, for windows and laws.
    """
    config = context.config
    source = None if recording is None else recording.source
    readings: Readings | None = None
    flows = recording is not None and "shear_rate_per_s" in recording.columns
    try:
        if recording is None:
            raise FitRefused("the register names no data file for this run; fill in `file`")
        if flows:
            found = flow_curve_values(specimen, recording, config)
            return Measurement(specimen, found.values, found.refusals, found.readings, source)
        times = since_mixing_s(specimen, recording, context.timezone)
        refuse_impossible_end(times, config.run_s)
        readings = audited(recording, times, context.machine, config)
        window = windowed(readings, config, stated_temperature_K(specimen))
        fitted = fit_law([window], config)
    except FitRefused as error:
        keys = ALWAYS_OF_FLOW_CURVES if flows else ALWAYS
        return nothing_measured(specimen, keys, error, recording, readings)
    shared = _viscometer(readings, context.machine)
    values_, refusals = _values(specimen, readings, window, fitted, config, shared)
    return Measurement(specimen, values_, refusals, readings, source)


def _viscometer(readings: Readings, machine: Machine) -> Contribution:
    """Name the error that all readings share; without rotor and speed it is none of the machine."""
    if readings.of_full_scale:
        return machine.shared_error(_CALIBRATION, "torque", 0.0)
    return Contribution(_CALIBRATION, 0.0, shared=True)


def _values(
    specimen: Specimen,
    readings: Readings,
    window: Windowed,
    fitted: Fitted,
    config: ViscosityConfig,
    shared: Contribution,
) -> tuple[tuple[MeasuredValue, ...], tuple[Refusal, ...]]:
    law = fitted.law
    lines = window.readings.line
    span = (int(lines.min()), int(lines.max()))
    flags = tuple(dict.fromkeys((*readings.flags, *window.readings.flags, *law.flags)))
    method = f"{law.name}, {window.rule}; {readings.errors}"
    values, refusals = [], []
    for asked in asked_of(law, window, config):
        try:
            values.append(measured(asked, fitted, config, method, flags, span, shared))
        except FitRefused as error:
            refusals.append(refusal(specimen, asked.key, error, asked.conditions))
    if drifts(window):
        refusals.append(refusal(specimen, DOUBLING, drifting(window), {}))
    unknown = one_rate(config) if law.rates is None else too_far(law.rates, config)
    if unknown is not None:
        refusals.append(refusal(specimen, AT_PRINTING_RATE, unknown, {}))
    return tuple(values), tuple(refusals)
