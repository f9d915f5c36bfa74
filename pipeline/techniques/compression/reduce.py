"""One cylinder: its modulus as the slope over the first strain, plain and from the toe on."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution
from deamat.core.recording import Recording, Specimen
from deamat.core.records import Condition, Detail, Flag, MeasuredValue, Measurement, Refusal
from deamat.core.technique import Context
from deamat.estimators.curves.slope import Line, curvature
from deamat.estimators.curves.stress_strain import (
    MISSABLE,
    Bins,
    bin_slopes,
    loading_branch,
    window,
    zero_of_tangent,
)
from deamat.techniques.compression.config import COMPENSATED, MODULUS, YIELDS, CompressionConfig
from deamat.techniques.compression.plates import BONDED, Plates, plates_of
from deamat.techniques.shared.geometry import circular_section, register_length
from deamat.techniques.shared.modulus import (
    LoadingCurve,
    WindowLine,
    conditions_of_test,
    flags_of_loading,
    modulus,
    percent,
    rising_line,
)
from deamat.techniques.shared.outcome import nothing_measured, recorded, refusal
from deamat.techniques.shared.stress_strain import (
    IndexArray,
    StressStrain,
    disagreement,
    stress_strain,
)


def reduce(
    specimen: Specimen, recording: Recording | None, context: Context[CompressionConfig]
) -> Measurement[LoadingCurve]:
    r"""Reduce one cylinder to its modulus, $Y_c = d\sigma/d\varepsilon$ over the window.

    Ordinary least squares with an intercept, on the first loading only. The slope against strain
    counted from the toe's tangent is a value of its own and never takes the plain one's place.

    Parameters
    ----------
    specimen : with `diameter_m` and `height_m`; `speed_m_per_s` gives the condition `rate_per_s`
    recording : see `shared.stress_strain.stress_strain`

    Source: ASTM D575 for the test, ASTM D638 annex A1 for the toe.
    """
    config = context.config
    try:
        file = recorded(recording)
        height = register_length(specimen.numbers, "height_m")
        section = circular_section(specimen.numbers)
        curve = stress_strain(
            file, section, height, "height", context.machine, config.own_stress_refused
        )
        plates = plates_of(specimen.numbers, specimen.notes)
    except FitRefused as error:
        return nothing_measured(specimen, YIELDS, error, recording)
    branch = loading_branch(curve.nominal_strain)
    loading = _Loading(
        curve,
        curve.nominal_strain[:branch],
        curve.nominal_stress_Pa[:branch],
        file,
        conditions_of_test(specimen, config.window, height),
        flags_of_loading(file, curve, branch),
        plates,
        plates.declared == BONDED and config.correct_bonded_plates,
    )
    values: list[MeasuredValue] = []
    refusals: list[Refusal] = []
    line = None
    try:
        plain, bins, line = _plain(loading, config)
        values.append(plain)
    except FitRefused as error:
        refusals += [refusal(specimen, k, error, loading.conditions) for k in YIELDS]
    else:
        try:
            values.append(_compensated(loading, bins, config, plain.flags))
        except FitRefused as error:
            refusals.append(refusal(specimen, COMPENSATED, error, loading.conditions))
    return Measurement(
        specimen,
        tuple(values),
        tuple(refusals),
        LoadingCurve(loading.strain, loading.stress_Pa, line),
        file.source,
    )


@dataclass(frozen=True, slots=True)
class _Loading:
    """The first loading of a specimen, with what both of its moduli need."""

    curve: StressStrain
    strain: FloatArray
    stress_Pa: FloatArray
    recording: Recording
    conditions: Mapping[str, Condition]
    flags: tuple[Flag, ...]
    plates: Plates
    corrected: bool


def _plain(loading: _Loading, config: CompressionConfig) -> tuple[MeasuredValue, Bins, WindowLine]:
    low, high = config.window
    inside = window(loading.strain, low, high, config.min_samples, config.unloading_tolerance)
    x, y = loading.strain[inside], loading.stress_Pa[inside]
    line = rising_line(x, y, config.min_samples)
    bins = bin_slopes(x, y, low, high, config.toe_bin)
    value = _modulus(
        MODULUS,
        line,
        loading,
        inside,
        method=f"OLS slope with intercept over {percent(config.window)} nominal strain",
        flags=disagreement(loading.curve, inside, config.own_columns_tolerance)
        + _toe_flags(line, bins, config),
        diagnostics=_bin_diagnostics(bins, config.toe_bin),
    )
    return value, bins, WindowLine(config.window, line.slope, line.intercept)


def _modulus(
    key: str,
    line: Line,
    loading: _Loading,
    inside: IndexArray,
    *,
    method: str,
    flags: tuple[Flag, ...],
    diagnostics: Mapping[str, Detail],
    further: tuple[Contribution, ...] = (),
) -> MeasuredValue:
    """Wrap a slope, and say what machine and plates do to it."""
    curve, plates = loading.curve, loading.plates
    told = "" if loading.corrected else f"; {plates.told}"
    if curve.compliance_per_Pa is None:
        told += "; machine compliance not declared"
    value = modulus(
        key,
        line,
        curve,
        inside,
        loading.recording,
        method=method + told,
        conditions=loading.conditions,
        flags=loading.flags + flags + (() if loading.corrected else plates.flags),
        diagnostics={
            **diagnostics,
            "shape_factor": plates.shape_factor,
            "bonded_plates_factor": plates.bonded_factor,
        },
        further=further,
    )
    return plates.corrected(value) if loading.corrected else value


def _compensated(
    loading: _Loading, bins: Bins, config: CompressionConfig, flags: tuple[Flag, ...]
) -> MeasuredValue:
    """Slope over the same range of strain, counted from where the steepest tangent meets zero.

    Parameters
    ----------
    flags : of the plain modulus: what is wrong with the curve is wrong with both
    """
    low, high = config.window
    zero = zero_of_tangent(bins)
    if zero < -MISSABLE * (high - low):
        raise FitRefused(
            f"the steepest tangent meets zero stress at {100 * zero:.3g} % strain, before the test "
            "began: that is a preload, not a toe; zero the force before contact",
            {"zero_strain": zero},
        )
    inside = window(
        loading.strain, zero + low, zero + high, config.min_samples, config.unloading_tolerance
    )
    x, y = loading.strain[inside], loading.stress_Pa[inside]
    line = rising_line(x, y, config.min_samples)
    # where the curve bends, the slope goes with the zero of strain
    bend = abs(curvature(x, y))
    # the tangent may lie anywhere in its bin
    u_zero = bend * config.toe_bin / math.sqrt(12.0)
    # the first load may rest on the specimen, or be that of a cell which nobody zeroed
    u_preload = bend * abs(float(loading.stress_Pa[0])) / line.slope / math.sqrt(3.0)
    value = _modulus(
        COMPENSATED,
        line,
        loading,
        inside,
        method=f"OLS slope over {percent(config.window)} of nominal strain counted from the zero "
        f"of the tangent to the steepest {100 * config.toe_bin:g} % of the window",
        flags=flags,
        diagnostics={"zero_strain": zero},
        further=(
            Contribution("zero of the toe's tangent", u_zero, shared=False),
            Contribution("load before the test: on the specimen or not", u_preload, shared=True),
        ),
    )
    once = {flag.name: flag for flag in reversed(value.flags)}
    return replace(value, flags=tuple(reversed(once.values())))


def _toe_flags(line: Line, bins: Bins, config: CompressionConfig) -> tuple[Flag, ...]:
    """Compare the first bin with the steepest, and the line's start with zero stress."""
    flags: tuple[Flag, ...] = ()
    low, high = config.window
    first = bins.slope[0]
    steepest = math.nan if math.isnan(first) else bins.slope[bins.steepest]
    if first < config.toe_flag_ratio * steepest:
        touching = first >= config.contact_flag_ratio * steepest
        end, start = low + config.toe_bin, low + bins.steepest * config.toe_bin
        flags += (
            Flag(
                "toe" if touching else "contact",
                f"slope {first / 1e3:.4g} kPa up to {100 * end:.3g} % strain, "
                f"{steepest / 1e3:.4g} kPa from {100 * start:.3g} %"
                + ("" if touching else ": the plates hardly touched at first"),
            ),
        )
    rise = line.slope * (high - low)
    if line.intercept > config.preload_flag_ratio * rise:
        flags += (
            Flag(
                "preload",
                f"the line meets zero strain at {line.intercept / 1e3:.3g} kPa, "
                f"{100 * line.intercept / rise:.2g} % of its rise over the window",
            ),
        )
    return flags


def _bin_diagnostics(bins: Bins, width: float) -> dict[str, Detail]:
    slopes: dict[str, Detail] = {
        f"slope_bin_{i + 1}_Pa": slope
        for i, slope in enumerate(bins.slope)
        if not math.isnan(slope)
    }
    return {**slopes, "bin_width": width}
