"""One specimen: from its ramp, or from what the register says, to the field that broke it."""

from __future__ import annotations

from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution, Quantity
from deamat.core.recording import Recording, Specimen
from deamat.core.records import Condition, Flag, MeasuredValue, Measurement
from deamat.core.technique import Context
from deamat.techniques.breakdown.config import FIELD, BreakdownConfig
from deamat.techniques.breakdown.log import seen_in_log
from deamat.techniques.breakdown.result import FilmTest
from deamat.techniques.breakdown.seen import (
    Seen,
    censored_flag,
    declared_censored,
    refuse_beyond_limit,
)
from deamat.techniques.shared.geometry import gauge_error
from deamat.techniques.shared.outcome import nothing_measured, relative_lines

_CONDITIONS = ("electrode_area_m2", "rate_V_per_s")
_STYLE = (
    "over the undeformed thickness as the register gives it; DC, in the style of ASTM D149 (made "
    "for AC; for DC: ASTM D3755, IEC 60243-2)"
)
_NO_RESULT = (
    "the register names no ramp file and gives neither breakdown_voltage_<unit> nor "
    "breakdown_field_<unit>; fill in one of them"
)


def reduce(
    specimen: Specimen, recording: Recording | None, context: Context[BreakdownConfig]
) -> Measurement[FilmTest]:
    r"""Reduce one specimen to the nominal field at its breakdown, $E = V/t$.

    V is the voltage at the first breakdown (of a step-by-step test, of the step at which it broke);
    t the undeformed thickness as the register gives it (measured at the place of the breakdown, if
    the laboratory did so). A specimen that did not break gives the greatest voltage that it bore,
    marked `censored`.

    Parameters
    ----------
    specimen : with `thickness_m`; without a file also with `breakdown_voltage_V`, or with
        `breakdown_field_V_per_m` alone, and `censored` (yes, no) among its notes
    recording : `time_s`, `voltage_V` and, if there was one, `current_A`

    Source: ASTM D149 in style (it is written for AC); for DC ASTM D3755 and IEC 60243-2.
    """
    try:
        seen = _seen(specimen, recording, context.config)
        thickness = None if seen.is_field else _thickness(specimen)
        value = _field(specimen, seen, thickness, context)
    except FitRefused as error:
        return nothing_measured(specimen, (FIELD,), error, recording)
    source = None if recording is None else recording.source
    film = FilmTest(
        seen.censored, None if thickness is None else thickness.value, seen.ramp, seen.sure
    )
    return Measurement(specimen, (value,), (), film, source)


def _seen(specimen: Specimen, recording: Recording | None, config: BreakdownConfig) -> Seen:
    numbers = specimen.numbers
    if recording is not None:
        return seen_in_log(specimen, recording, config)
    censored = declared_censored(specimen) or False
    what = "borne unbroken" if censored else "of breakdown"
    flags = (censored_flag("the register says so"),) if censored else ()
    if "breakdown_voltage_V" in numbers:
        voltage = numbers["breakdown_voltage_V"]
        refuse_beyond_limit(voltage.value, config)
        alone = Flag(
            "no-ramp", "the register gives the voltage alone: how it rose cannot be audited"
        )
        return Seen(
            voltage.value,
            censored,
            f"voltage {what} as the register gives it",
            budget=_own(voltage),
            flags=(*flags, alone),
        )
    if "breakdown_field_V_per_m" in numbers:
        given = numbers["breakdown_field_V_per_m"]
        alone = Flag(
            "field-as-given",
            "the register gives the field itself: thickness and voltage behind it, and the errors "
            "of both, are not known",
        )
        method = f"field {what} as the register gives it"
        return Seen(given.value, censored, method, True, _own(given), (*flags, alone))
    raise FitRefused(_NO_RESULT)


def _own(given: Quantity) -> tuple[Contribution, ...]:
    """Relative uncertainty that the register states beside a value."""
    if not given.value > 0.0:
        return ()
    return (Contribution("stated in the register", given.u_independent / given.value, False),)


def _field(
    specimen: Specimen,
    seen: Seen,
    thickness: Quantity | None,
    context: Context[BreakdownConfig],
) -> MeasuredValue:
    """Divide by the thickness and put the budget together."""
    flags, details = seen.flags, {**seen.diagnostics}
    budget: tuple[Contribution, ...] = seen.budget
    value, method = seen.value, seen.method
    if thickness is not None:
        value /= thickness.value
        details = {"voltage_V": seen.value, "thickness_m": thickness.value, **details}
        budget += (
            context.machine.shared_error(
                "voltage calibration", "voltage", context.machine.u_voltage_calibration
            ),
            Contribution("thickness reading", thickness.u_independent / thickness.value, False),
            gauge_error(
                "thickness gauge", thickness.u_shared / thickness.value, thickness, "thickness"
            ).inverted(),
        )
        method += f" {_STYLE}"
        if "micrometer_force_N" in specimen.numbers:
            force = specimen.numbers["micrometer_force_N"].value
            flags += (
                Flag("thickness-under-force", f"read under {force:g} N and not corrected for it"),
            )
    lines = relative_lines(value, budget)
    return MeasuredValue(
        key=FIELD,
        quantity=Quantity.from_budget(value, "V/m", lines),
        budget=lines,
        method=method,
        conditions=_conditions(specimen),
        lines=seen.lines,
        diagnostics={"censored": int(seen.censored), **details},
        flags=flags,
    )


def _thickness(specimen: Specimen) -> Quantity:
    if "thickness_m" not in specimen.numbers:
        raise FitRefused(
            "the register gives no thickness of this specimen, so its breakdown voltage is not a "
            "field; add thickness_<unit>, measured at the place of the breakdown"
        )
    thickness = specimen.numbers["thickness_m"]
    if not thickness.value > 0.0:
        raise FitRefused(
            f"the register gives a thickness of {thickness.value:g} m; it must be above zero"
        )
    return thickness


def _conditions(specimen: Specimen) -> dict[str, Condition]:
    """Area and rate of rise, where the register declares them: other ones are other records."""
    return {key: specimen.numbers[key].value for key in _CONDITIONS if key in specimen.numbers}
