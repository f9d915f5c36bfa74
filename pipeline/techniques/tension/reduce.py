"""One strip: modulus at small strain, strength, elongation at break."""

from __future__ import annotations

from functools import partial

from deamat.core.errors import FitRefused
from deamat.core.recording import Recording, Specimen
from deamat.core.records import MeasuredValue, Measurement, Refusal
from deamat.core.technique import Context
from deamat.estimators.curves.rupture import find_rupture
from deamat.estimators.curves.stress_strain import loading_branch
from deamat.techniques.shared.geometry import rectangular_section, register_length
from deamat.techniques.shared.modulus import LoadingCurve, conditions_of_test
from deamat.techniques.shared.outcome import nothing_measured, recorded, refusal
from deamat.techniques.shared.stress_strain import stress_strain
from deamat.techniques.tension.config import ELONGATION, MODULI, STRENGTH, TensionConfig
from deamat.techniques.tension.extensometer import by_extensometer
from deamat.techniques.tension.moduli import plain_modulus, taut_modulus
from deamat.techniques.tension.pull import pulled
from deamat.techniques.tension.ultimate import elongation_at_break, tensile_strength


def reduce(
    specimen: Specimen, recording: Recording | None, context: Context[TensionConfig]
) -> Measurement[LoadingCurve]:
    r"""Reduce one strip to moduli, strength and elongation; each stands or falls by itself.

    $Y_t = d\sigma/d\varepsilon$ over the window by ordinary least squares with an intercept, plain
    and counted from where the strip is taut; strength = greatest nominal stress, elongation =
    nominal strain of the last sample before the load collapses. A strip that did not break gives
    lower limits of both.

    Parameters
    ----------
    specimen : with `width_m`, `thickness_m` and `gauge_length_m`; `speed_m_per_s` gives the
        condition `rate_per_s`
    recording : see `shared.stress_strain.stress_strain`

    Source: ASTM D412; ASTM D638 annex A1 for slack.
    """
    config = context.config
    try:
        file = recorded(recording)
        gauge = register_length(specimen.numbers, "gauge_length_m")
        section = rectangular_section(specimen.numbers)
        curve = stress_strain(
            file, section, gauge, "gauge length", context.machine, config.own_stress_refused
        )
        curve = by_extensometer(curve, config)
    except FitRefused as error:
        return nothing_measured(specimen, (MODULI[0], STRENGTH, ELONGATION), error, recording)
    rupture = find_rupture(curve.nominal_strain, curve.nominal_stress_Pa, config.break_drop)
    branch = min(loading_branch(curve.nominal_strain), rupture.last + 1)
    pull = pulled(curve, file, branch, rupture)
    slope_conditions = conditions_of_test(specimen, config.window, gauge)
    conditions = conditions_of_test(specimen, None, gauge)
    values: list[MeasuredValue] = []
    refusals: list[Refusal] = []
    line = None
    slack = pull.slack(config)
    try:
        value, line = plain_modulus(pull, slack, config, slope_conditions)
        values.append(value)
    except FitRefused as error:
        refusals.append(refusal(specimen, MODULI[0], error, slope_conditions))
    if slack is not None:
        try:
            values.append(taut_modulus(pull, slack, config, slope_conditions))
        except FitRefused as error:
            refusals.append(refusal(specimen, MODULI[1], error, slope_conditions))
    elongation = partial(elongation_at_break, own_columns_tolerance=config.own_columns_tolerance)
    for key, make in ((STRENGTH, tensile_strength), (ELONGATION, elongation)):
        try:
            values.append(make(pull, conditions))
        except FitRefused as error:
            refusals.append(refusal(specimen, key, error, conditions))
    return Measurement(
        specimen,
        tuple(values),
        tuple(refusals),
        LoadingCurve(
            curve.nominal_strain[: rupture.last + 1],
            curve.nominal_stress_Pa[: rupture.last + 1],
            line,
        ),
        file.source,
    )
