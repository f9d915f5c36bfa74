"""One strip: modulus at small strain, strength, elongation at break."""

from __future__ import annotations

import math
from collections.abc import Mapping

from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import (
    Condition,
    Flag,
    MeasuredValue,
    Measurement,
    Recording,
    Refusal,
    Specimen,
)
from deamat.core.technique import Context
from deamat.estimators.curves.stress_strain import Break, find_break, loading_branch, window
from deamat.techniques.shared.geometry import rectangular_section, register_length
from deamat.techniques.shared.modulus import (
    LoadingCurve,
    WindowLine,
    conditions_of_test,
    flags_of_loading,
    modulus,
    percent,
    rising_line,
)
from deamat.techniques.shared.outcome import (
    line_span,
    nothing_measured,
    recorded,
    refusal,
    relative_lines,
)
from deamat.techniques.shared.stress_strain import StressStrain, disagreement, stress_strain
from deamat.techniques.tension.config import ELONGATION, MODULUS, STRENGTH, YIELDS, TensionConfig


def reduce(
    specimen: Specimen, recording: Recording | None, context: Context[TensionConfig]
) -> Measurement[LoadingCurve]:
    r"""Reduce one strip to modulus, strength and elongation; each stands or falls by itself.

    $Y_t = d\sigma/d\varepsilon$ over the window by ordinary least squares with an intercept,
    strength = greatest nominal stress, elongation = nominal strain of the last sample before the
    load collapses, or of the greatest stress where no collapse was recorded (flagged).

    Parameters
    ----------
    specimen : with `width_m`, `thickness_m` and `gauge_length_m`; `speed_m_per_s` gives the
        condition `rate_per_s`
    recording : see `shared.stress_strain.stress_strain`

    Source: ASTM D412.
    """
    config = context.config
    try:
        file = recorded(recording)
        gauge = register_length(specimen.numbers, "gauge_length_m")
        section = rectangular_section(specimen.numbers)
        curve = stress_strain(file, section, gauge, "gauge length", context.machine)
    except FitRefused as error:
        return nothing_measured(specimen, YIELDS, error, recording)
    branch = loading_branch(curve.nominal_strain)
    rupture = find_break(curve.nominal_stress_Pa, branch, config.break_drop)
    end = rupture.last + 1 if rupture.seen else branch
    values: list[MeasuredValue] = []
    refusals: list[Refusal] = []
    slope_conditions = conditions_of_test(specimen, config.window, gauge)
    conditions = conditions_of_test(specimen, None, gauge)
    flags = flags_of_loading(file, curve, branch)
    line = None
    try:
        value, line = _modulus(curve, end, file, config, slope_conditions, flags)
        values.append(value)
    except FitRefused as error:
        refusals.append(refusal(specimen, MODULUS, error, slope_conditions))
    try:
        values += _ultimate(curve, rupture, file, conditions, flags)
    except FitRefused as error:
        refusals += [refusal(specimen, key, error, conditions) for key in (STRENGTH, ELONGATION)]
    return Measurement(
        specimen,
        tuple(values),
        tuple(refusals),
        LoadingCurve(curve.nominal_strain[:end], curve.nominal_stress_Pa[:end], line),
        file.source,
    )


def _modulus(
    curve: StressStrain,
    end: int,
    recording: Recording,
    config: TensionConfig,
    conditions: Mapping[str, Condition],
    flags: tuple[Flag, ...],
) -> tuple[MeasuredValue, WindowLine]:
    low, high = config.window
    strain, stress = curve.nominal_strain[:end], curve.nominal_stress_Pa[:end]
    inside = window(strain, low, high, config.min_samples, config.unloading_tolerance)
    line = rising_line(strain[inside], stress[inside], config.min_samples)
    value = modulus(
        MODULUS,
        line,
        curve,
        inside,
        recording,
        method=f"OLS slope with intercept over {percent(config.window)} nominal strain",
        conditions=conditions,
        flags=flags + disagreement(curve, inside, config.own_columns_tolerance),
        diagnostics={},
    )
    return value, WindowLine(config.window, line.slope, line.intercept)


def _ultimate(
    curve: StressStrain,
    rupture: Break,
    recording: Recording,
    conditions: Mapping[str, Condition],
    flags: tuple[Flag, ...],
) -> list[MeasuredValue]:
    """Strength and elongation from the greatest stress and the break."""
    strain, stress = curve.nominal_strain, curve.nominal_stress_Pa
    top, last = rupture.maximum, rupture.last
    strength = float(stress[top])
    if not strength > 0.0:
        raise FitRefused(
            f"the greatest stress of the loading is {strength:.4g} Pa, not positive; nothing was "
            "pulled, or the force is of another sign than the displacement"
        )
    if not rupture.seen:
        flags += (
            Flag(
                "break-not-recorded",
                f"the load is never seen to collapse; the values are those of the greatest stress, "
                f"sample {top + 1} of {stress.size}, and the specimen may have held more",
            ),
        )
    rounding = curve.stress_resolution_Pa / math.sqrt(12.0)
    strength_budget = relative_lines(strength, curve.stress_budget)
    if rounding > 0.0:
        strength_budget += (Contribution("load cell resolution", rounding, shared=False),)
    elongation = float(strain[last])
    # the break lies somewhere in the sampling interval
    step = abs(float(strain[last] - strain[max(last - 1, 0)])) / math.sqrt(12.0)
    elongation_budget = (
        Contribution("sampling interval at break", step, shared=False),
        *relative_lines(elongation, curve.strain_budget),
    )
    where = "of the last sample before the load collapses"
    if not rupture.seen:
        where = "at the greatest stress, the break not being recorded"

    def value(
        key: str, number: float, unit: str, budget: tuple[Contribution, ...], how: str, at: int
    ) -> MeasuredValue:
        line = line_span(recording.source, stress.size, at, at)
        return MeasuredValue(
            key=key,
            quantity=Quantity.from_budget(number, unit, budget),
            budget=budget,
            method=f"{how}; {curve.basis}",
            conditions=conditions,
            lines=line,
            diagnostics={"sample": at + 1, "samples": stress.size},
            flags=flags,
        )

    return [
        value(STRENGTH, strength, "Pa", strength_budget, "greatest nominal stress", top),
        value(ELONGATION, elongation, "1", elongation_budget, f"nominal strain {where}", last),
    ]
