"""What the rooms of stress-strain curves do alike: config, slope of a window, refusals."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Annotated

from pydantic import AfterValidator, Field

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.instruments import Declared
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import (
    Condition,
    Flag,
    MeasuredValue,
    Measurement,
    Recording,
    Refusal,
    Source,
    Specimen,
)
from deamat.core.stress_strain import IndexArray, StressStrain
from deamat.estimators.curves.slope import FEW_INDEPENDENT, Line, fit_line, outlying
from deamat.estimators.curves.stress_strain import reloads


def _rising(window: tuple[float, float]) -> tuple[float, float]:
    low, high = window
    if not 0.0 <= low < high:
        raise ValueError(f"a window must be 0 <= low < high, not [{low:g}, {high:g}]")
    return window


StrainWindow = Annotated[tuple[float, float], AfterValidator(_rising)]


class CurveConfig(Declared):
    """What compression and tension decide alike."""

    min_samples: int = Field(
        default=10, ge=3, description="fewest samples in the window that carry a slope"
    )
    unloading_tolerance: float = Field(
        default=1e-4,
        ge=0,
        description="strain may go back by this much inside the window; more, and more than six "
        "times the displacement noise, is unloading",
    )
    own_columns_tolerance: float = Field(
        default=0.01,
        gt=0,
        description="relative difference at which the file's own stress and strain are flagged",
    )


def conditions_of_test(
    specimen: Specimen, window: tuple[float, float] | None, length: Quantity
) -> dict[str, Condition]:
    """Give what the test itself fixes: the window, and speed over length as nominal strain rate."""
    conditions: dict[str, Condition] = {}
    if window is not None:
        conditions["window"] = window
    if "speed_m_per_s" in specimen.numbers:
        rate = abs(specimen.numbers["speed_m_per_s"].value) / length.value
        conditions["rate_per_s"] = float(f"{rate:.6g}")
    return conditions


def recorded(recording: Recording | None) -> Recording:
    """Insist on a recording.

    Raises
    ------
    FitRefused : there is none
    """
    if recording is None:
        raise FitRefused("the register names no data file for this specimen; fill in `file`")
    return recording


def flags_of_loading(recording: Recording, curve: StressStrain, branch: int) -> tuple[Flag, ...]:
    """Pass on what the reader noticed, and flag a specimen that was loaded more than once."""
    if not reloads(curve.nominal_strain, branch):
        return recording.flags
    several = Flag("several-loadings", f"only the first, samples 1 to {branch}, was used")
    return (*recording.flags, several)


def percent(window: tuple[float, float]) -> str:
    """Write a window of strain as text: `0-5 %`."""
    return f"{100 * window[0]:g}-{100 * window[1]:g} %"


def line_span(source: Source, rows: int, first: int, last: int) -> tuple[int, int]:
    """Give the lines of the file that hold samples `first` to `last`.

    Where data rows and lines do not run in step (blank lines between them), the whole span of the
    data is the only certain answer.
    """
    if source.last_line - source.first_line + 1 != rows:
        return source.first_line, source.last_line
    return source.first_line + first, source.first_line + last


def rising_line(strain: FloatArray, stress_Pa: FloatArray, min_samples: int) -> Line:
    """Fit the line of a window; a specimen under load answers with a positive slope.

    Raises
    ------
    FitRefused : the slope is zero or negative
    """
    line = fit_line(strain, stress_Pa)
    if not line.slope > 0.0:
        raise FitRefused(
            f"the slope of the {line.n} samples in the window ({min_samples} are needed) is "
            f"{line.slope:.4g} Pa, not positive; check the contact, the signs and the zero of the "
            "displacement, or use a smaller load cell",
            {"samples": line.n, "samples_needed": min_samples, "slope_Pa": line.slope},
        )
    return line


def relative_lines(value: float, budget: Iterable[Contribution]) -> tuple[Contribution, ...]:
    """Turn relative lines of a budget into those of the value; lines of nothing are left out."""
    return tuple(Contribution(c.source, abs(value) * c.u, c.shared) for c in budget if c.u > 0.0)


def slope_budget(line: Line, curve: StressStrain) -> tuple[Contribution, ...]:
    """Budget of a modulus: the scatter about its line, the load cell, the geometry.

    Rounding to the cell's resolution (uniform, so 1/sqrt(12) of a step) is part of the residuals
    already; where the residuals show less than it must have caused, it stands in their place.
    """
    rounding = curve.stress_resolution_Pa / math.sqrt(12.0 * line.sum_squares_x)
    scatter = math.sqrt(max(line.standard_error**2 - rounding**2, 0.0))
    own = (
        Contribution("scatter about the line, autocorrelated", scatter, shared=False),
        Contribution("load cell resolution", rounding, shared=False),
    )
    return tuple(c for c in own if c.u > 0.0) + relative_lines(
        line.slope, curve.stress_budget + curve.strain_budget
    )


def line_diagnostics(line: Line) -> dict[str, float | int | str]:
    """Keep the numbers that tell how far a slope can be trusted."""
    return {
        "samples": line.n,
        "intercept_Pa": line.intercept,
        "naive_standard_error_Pa": line.naive_standard_error,
        "standard_error_Pa": line.standard_error,
        "autocorrelation": line.autocorrelation,
        "independent_samples": line.independent_samples,
        "degrees_of_freedom": line.degrees_of_freedom,
        "residual_sd_Pa": line.residual_sd,
    }


def correlation_flags(line: Line) -> tuple[Flag, ...]:
    """Flag a slope whose residuals run together so much that its standard error is a guess."""
    if line.independent_samples >= FEW_INDEPENDENT:
        return ()
    return (
        Flag(
            "few-independent-samples",
            f"neighbouring residuals correlate by {line.autocorrelation:.2f}, so {line.n} samples "
            f"count as {line.independent_samples:.1f}: the curve bends or the noise drifts, and "
            "the standard error of the slope is rough",
        ),
    )


def outlying_flags(line: Line, strain: FloatArray, stress_Pa: FloatArray) -> tuple[Flag, ...]:
    """Flag readings that lie far off the line of the others; they stay in the fit all the same."""
    far = outlying(strain, stress_Pa, line)
    if far.size == 0:
        return ()
    return (
        Flag(
            "outlying-readings",
            f"{far.size} of {line.n} readings lie more than 6 standard deviations of the majority "
            f"off the line, the first at {100 * strain[far[0]]:.3g} % strain; they pull the slope",
        ),
    )


def modulus(
    key: str,
    line: Line,
    curve: StressStrain,
    inside: IndexArray,
    recording: Recording,
    *,
    method: str,
    conditions: Mapping[str, Condition],
    flags: tuple[Flag, ...],
    diagnostics: Mapping[str, float | int | str],
    further: tuple[Contribution, ...] = (),
) -> MeasuredValue:
    """Wrap the line of a window as the value of a modulus `[Pa]`."""
    budget = slope_budget(line, curve) + further
    return MeasuredValue(
        key=key,
        quantity=Quantity.from_budget(line.slope, "Pa", budget),
        budget=budget,
        method=f"{method}; {curve.basis}",
        conditions=conditions,
        lines=line_span(
            recording.source, curve.nominal_strain.size, int(inside[0]), int(inside[-1])
        ),
        diagnostics={**line_diagnostics(line), **diagnostics},
        flags=flags
        + correlation_flags(line)
        + outlying_flags(line, curve.nominal_strain[inside], curve.nominal_stress_Pa[inside]),
    )


def refusal(
    specimen: Specimen, key: str, error: FitRefused, conditions: Mapping[str, Condition]
) -> Refusal:
    """Turn an estimator's refusal into one of this specimen's property."""
    return Refusal(
        key,
        error.reason,
        specimen.material,
        specimen.campaign,
        specimen.id,
        {**specimen.conditions, **conditions},
        error.diagnostics,
    )


def nothing_measured(
    specimen: Specimen, keys: Iterable[str], error: FitRefused, recording: Recording | None
) -> Measurement:
    """Refuse every property of a specimen whose curve cannot be made."""
    return Measurement(
        specimen,
        (),
        tuple(refusal(specimen, key, error, {}) for key in keys),
        {},
        None if recording is None else recording.source,
    )
