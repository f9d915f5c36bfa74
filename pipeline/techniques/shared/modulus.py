"""A modulus: the slope of a stress-strain curve over a window, its budget and its flags."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution, Quantity
from deamat.core.recording import Recording, Specimen
from deamat.core.records import Condition, Flag, MeasuredValue
from deamat.estimators.curves.slope import FEW_INDEPENDENT, Line, fit_line, outlying
from deamat.estimators.curves.stress_strain import reloads
from deamat.estimators.mean import coverage_factor
from deamat.techniques.shared.geometry import inverted
from deamat.techniques.shared.outcome import line_span, relative_lines
from deamat.techniques.shared.stress_strain import IndexArray, StressStrain

_RISES = 0.8  # of the variance of stress that a line explains: such a window is no noise


@dataclass(frozen=True, slots=True)
class WindowLine:
    """The line that was fitted to a window of nominal strain.

    Parameters
    ----------
    window : lowest and highest nominal strain
    slope_Pa, intercept_Pa : the modulus, and the stress at zero strain
    """

    window: tuple[float, float]
    slope_Pa: float
    intercept_Pa: float


@dataclass(frozen=True, slots=True)
class LoadingCurve:
    """The first loading of a specimen and the line of its modulus.

    Parameters
    ----------
    nominal_strain, nominal_stress_Pa : shape (n,) each
    line : None where the modulus was refused
    """

    nominal_strain: FloatArray
    nominal_stress_Pa: FloatArray
    line: WindowLine | None

    @property
    def columns(self) -> dict[str, FloatArray]:
        """Strain and stress."""
        return {
            "nominal_strain": self.nominal_strain,
            "nominal_stress_Pa": self.nominal_stress_Pa,
        }


def conditions_of_test(
    specimen: Specimen, window: tuple[float, float] | None, length: Quantity
) -> dict[str, Condition]:
    """What the test itself fixes: the window, and speed over length as nominal strain rate."""
    conditions: dict[str, Condition] = {}
    if window is not None:
        conditions["window"] = window
    if "speed_m_per_s" in specimen.numbers:
        rate = abs(specimen.numbers["speed_m_per_s"].value) / length.value
        conditions["rate_per_s"] = float(f"{rate:.6g}")
    return conditions


def flags_of_loading(recording: Recording, curve: StressStrain, branch: int) -> tuple[Flag, ...]:
    """Pass on what the reader noticed, and flag a specimen that was loaded more than once."""
    noticed = recording.flags + curve.flags
    if not reloads(curve.nominal_strain, branch):
        return noticed
    several = Flag("several-loadings", f"only the first, samples 1 to {branch}, was used")
    return (*noticed, several)


def percent(window: tuple[float, float]) -> str:
    """Write a window of strain as text: `0-5 %`."""
    return f"{100 * window[0]:g}-{100 * window[1]:g} %"


def rising_line(strain: FloatArray, stress_Pa: FloatArray, min_samples: int) -> Line:
    """Fit the line of a window; a specimen under load answers with a positive slope.

    Raises
    ------
    FitRefused : the slope is zero or negative, or its 95 % interval includes zero; values that
        are not refused for that are a selection, and `selective` says so
    """
    line = fit_line(strain, stress_Pa)
    found: dict[str, float | int | str] = {
        "samples": line.n, "samples_needed": min_samples, "slope_Pa": line.slope,
    }  # fmt: skip
    half = coverage_factor(line.degrees_of_freedom) * line.standard_error
    explained = line.slope**2 * line.sum_squares_x
    noise = (line.n - 2) * line.residual_sd**2
    # a curve that bends leaves correlated residuals and a rough error, but it rises all the same
    if line.slope > half or (line.slope > 0.0 and explained > _RISES * (explained + noise)):
        return line
    if line.slope > 0.0 or line.slope > -half:
        raise FitRefused(
            f"the slope of the {line.n} samples in the window, {line.slope:.4g} Pa, cannot be told "
            f"from zero: its 95 % interval is {line.slope - half:.4g} to {line.slope + half:.4g} "
            "Pa; the specimen may hang loose (slack), or the load cell is too coarse",
            {**found, "half_width_Pa": half},
            selective=True,
        )
    raise FitRefused(
        f"the slope of the {line.n} samples in the window ({min_samples} are needed) is "
        f"{line.slope:.4g} Pa, not positive; check the contact, the signs and the zero of the "
        "displacement, or use a smaller load cell",
        found,
        selective=True,
    )


def slope_budget(line: Line, curve: StressStrain) -> tuple[Contribution, ...]:
    """Budget of a modulus: the scatter about its line, the load cell, the geometry.

    Rounding to the cell's resolution (uniform, so 1/sqrt(12) of a step) is part of the residuals
    already; where the residuals show less than it must have caused, it stands in their place.
    """
    rounding = curve.stress_resolution_Pa / math.sqrt(12.0 * line.sum_squares_x)
    scatter = math.sqrt(max(line.standard_error**2 - rounding**2, 0.0))
    own = (
        Contribution(
            "scatter about the line, autocorrelated",
            scatter,
            shared=False,
            degrees_of_freedom=line.degrees_of_freedom,
        ),
        Contribution("load cell resolution", rounding, shared=False),
        Contribution("machine compliance", line.slope**2 * curve.u_compliance_per_Pa, shared=True),
    )
    return tuple(c for c in own if c.u > 0.0) + relative_lines(
        line.slope, curve.stress_budget + inverted(curve.strain_budget)
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
        degrees_of_freedom=line.degrees_of_freedom,
        diagnostics={**line_diagnostics(line), **diagnostics},
        flags=flags
        + correlation_flags(line)
        + outlying_flags(line, curve.nominal_strain[inside], curve.nominal_stress_Pa[inside]),
    )
