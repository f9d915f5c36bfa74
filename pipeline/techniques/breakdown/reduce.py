"""One specimen: from its ramp, or from what the register says, to the field that broke it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import (
    Condition,
    Detail,
    Flag,
    MeasuredValue,
    Measurement,
    Recording,
    Specimen,
)
from deamat.core.technique import Context
from deamat.techniques.breakdown.config import FIELD, BreakdownConfig
from deamat.techniques.breakdown.ramp import Breakdown, Rise, audit_rise, find_breakdown
from deamat.techniques.breakdown.result import FilmTest, Ramp
from deamat.techniques.shared.outcome import line_span, nothing_measured, relative_lines

_CONDITIONS = ("electrode_area_m2", "rate_V_per_s")
_STYLE = (
    "over the undeformed thickness as the register gives it; DC, in the style of ASTM D149 (made "
    "for AC; for DC: ASTM D3755, IEC 60243-2)"
)
_NO_RESULT = (
    "the register names no ramp file and gives neither breakdown_voltage_<unit> nor "
    "breakdown_field_<unit>; fill in one of them"
)


@dataclass(frozen=True, slots=True)
class _Seen:
    """What was seen of one specimen, from whichever source.

    Parameters
    ----------
    value : voltage `[V]`, or field `[V/m]` where `is_field`
    censored : it did not break at this value
    budget : relative lines that belong to the value alone
    """

    value: float
    censored: bool
    method: str
    is_field: bool = False
    budget: tuple[Contribution, ...] = ()
    flags: tuple[Flag, ...] = ()
    diagnostics: Mapping[str, Detail] = field(default_factory=dict)
    ramp: Ramp | None = None
    lines: tuple[int, int] | None = None


def reduce(
    specimen: Specimen, recording: Recording | None, context: Context[BreakdownConfig]
) -> Measurement[FilmTest]:
    r"""Reduce one specimen to the nominal field at its breakdown, $E = V/t$.

    V is the greatest voltage before the first collapse; t the undeformed thickness as the register
    gives it (measured at the place of the breakdown, if the laboratory did so). A specimen that
    did not break gives the greatest voltage that it bore, marked `censored`.

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
    film = FilmTest(seen.censored, None if thickness is None else thickness.value, seen.ramp)
    return Measurement(specimen, (value,), (), film, source)


def _seen(specimen: Specimen, recording: Recording | None, config: BreakdownConfig) -> _Seen:
    numbers = specimen.numbers
    if recording is not None:
        return _of_ramp(specimen, recording, config)
    censored = _declared_censored(specimen) or False
    what = "borne unbroken" if censored else "of breakdown"
    flags = (_censored_flag("the register says so"),) if censored else ()
    if "breakdown_voltage_V" in numbers:
        voltage = numbers["breakdown_voltage_V"]
        _refuse_beyond_limit(voltage.value, config)
        alone = Flag(
            "no-ramp", "the register gives the voltage alone: how it rose cannot be audited"
        )
        return _Seen(
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
        return _Seen(given.value, censored, method, True, _own(given), (*flags, alone))
    raise FitRefused(_NO_RESULT)


def _own(given: Quantity) -> tuple[Contribution, ...]:
    """Relative uncertainty that the register states beside a value."""
    if not given.value > 0.0:
        return ()
    return (Contribution("stated in the register", given.u_independent / given.value, False),)


def _declared_censored(specimen: Specimen) -> bool | None:
    """Read the register's `censored`; None where it says nothing."""
    if "censored" not in specimen.notes:
        return None
    said = specimen.notes["censored"].strip().casefold()
    if said not in ("yes", "no"):
        raise FitRefused(
            f"the register's `censored` says {specimen.notes['censored']!r}; write yes for a "
            "specimen that did not break, no for one that did"
        )
    return said == "yes"


def _refuse_beyond_limit(voltage_V: float, config: BreakdownConfig) -> None:
    if voltage_V > (1.0 + max(config.limit_tolerance, 0.05)) * config.amplifier_limit_V:
        raise FitRefused(
            f"{voltage_V:.4g} V is beyond the amplifier's {config.amplifier_limit_V:g} V; correct "
            "the unit (V or kV), or declare the limit of the amplifier that was used",
            {"voltage_V": voltage_V, "amplifier_limit_V": config.amplifier_limit_V},
        )


def _censored_flag(why: str) -> Flag:
    return Flag("right-censored", f"{why}: it bore this field unbroken")


def _of_ramp(specimen: Specimen, recording: Recording, config: BreakdownConfig) -> _Seen:
    """Find the breakdown in a ramp and audit the way to it."""
    time_s, voltage_V, current_A = _signals(recording, config)
    found = find_breakdown(voltage_V, current_A, config.criteria())
    rise = audit_rise(time_s, voltage_V, found.peak, config.dip)
    last = min(found.peak + 1, time_s.size - 1)
    spike = "" if found.spike_A is None else " with a current spike"
    return _Seen(
        found.voltage_V,
        not found.broken,
        f"greatest voltage before the first collapse{spike} of a DC ramp"
        if found.broken
        else "greatest voltage borne in a DC ramp",
        budget=_sampling(found),
        flags=_flags_of_ramp(specimen, found, rise, current_A is not None, config),
        diagnostics=_diagnostics(found, rise),
        ramp=Ramp(time_s, voltage_V, current_A, found.end, rise.duration_s, rise.rate_V_per_s),
        lines=line_span(recording.source, time_s.size, 0, last),
    )


def _signals(
    recording: Recording, config: BreakdownConfig
) -> tuple[FloatArray, FloatArray, FloatArray | None]:
    """Give time, voltage and current of a ramp, the polarity made positive."""
    columns = recording.columns
    for name in ("time_s", "voltage_V"):
        if name not in columns:
            raise FitRefused(
                f"the file has no {name}; it holds {', '.join(columns) or 'nothing'}; log the "
                "voltage of the ramp over time"
            )
    time_s, voltage_V = columns["time_s"], columns["voltage_V"]
    back = np.flatnonzero(np.diff(time_s) <= 0.0)
    if back.size:
        raise FitRefused(
            f"time does not increase at {back.size} of {time_s.size} samples, the first after "
            f"{time_s[back[0]]:g} s; log one ramp to one file",
            {"samples": time_s.size, "steps_back": back.size},
        )
    if -float(voltage_V.min()) > float(voltage_V.max()):
        voltage_V = -voltage_V
    greatest = float(voltage_V.max())
    if greatest < config.least_voltage_V:
        raise FitRefused(
            f"the voltage never passes {greatest:.4g} V, and a ramp reaches "
            f"{config.least_voltage_V:g} V at least; correct the unit (V or kV) or the channel",
            {"greatest_V": greatest},
        )
    _refuse_beyond_limit(greatest, config)
    return time_s, voltage_V, columns.get("current_A")


def _sampling(found: Breakdown) -> tuple[Contribution, ...]:
    """It broke somewhere within the last sampling step: half of it above on average."""
    if not found.broken:
        return ()
    step = found.step_V / found.voltage_V
    return (
        Contribution("broke within a sampling step: its place", step / math.sqrt(12.0), False),
        Contribution("broke within a sampling step: half of it", step / 2.0, True),
    )


def _diagnostics(found: Breakdown, rise: Rise) -> dict[str, Detail]:
    details: dict[str, Detail] = {
        "end": found.end,
        "start_V": rise.start_V,
        "time_to_end_s": rise.duration_s,
        "rate_V_per_s": rise.rate_V_per_s,
        "rate_slowest": rise.slowest,
        "rate_fastest": rise.fastest,
        "sampling_step_V": found.step_V,
        "flashovers": len(found.flashovers),
    }
    return details if found.spike_A is None else {**details, "spike_A": found.spike_A}


_WHY = {
    "amplifier limit": "it reached the amplifier's limit",
    "turned down": "the voltage was turned down, no current spiked",
    "file ended": "the file ends without a collapse",
    "flashover": "a part of the voltage was lost and did not come back",
}


def _flags_of_ramp(
    specimen: Specimen, found: Breakdown, rise: Rise, has_current: bool, config: BreakdownConfig
) -> tuple[Flag, ...]:
    flags = []
    if not found.broken:
        flags.append(_censored_flag(_WHY[found.end]))
    elif not has_current:
        flags.append(
            Flag("no-current-channel", "the collapse of the voltage alone marks the breakdown")
        )
    if found.flashovers:
        at = ", ".join(f"{v / 1e3:.4g}" for v in found.flashovers)
        flags.append(
            Flag("flashover", f"at {at} kV a part of the voltage was lost and came back; discarded")
        )
    numbers = specimen.numbers
    set_rate = numbers["rate_V_per_s"].value if "rate_V_per_s" in numbers else rise.rate_V_per_s
    ratios = (rise.slowest, rise.fastest, rise.rate_V_per_s / set_rate if set_rate > 0 else 0.0)
    if any(abs(ratio - 1.0) > config.rate_tolerance for ratio in ratios):
        flags.append(
            Flag(
                "rate-of-rise",
                f"{rise.rate_V_per_s:.4g} V/s on the whole, {ratios[0]:.2g} to {ratios[1]:.2g} "
                f"times that in parts, and {set_rate:.4g} V/s were set",
            )
        )
    if found.broken and rise.duration_s < config.least_time_s:
        flags.append(
            Flag(
                "fast-rise",
                f"it broke after {rise.duration_s:.4g} s; a slow rise takes more than "
                f"{config.least_time_s:g} s",
            )
        )
    if rise.start_V > config.start_flag_ratio * found.voltage_V:
        part = 100.0 * rise.start_V / found.voltage_V
        flags.append(Flag("high-start", f"the ramp started at {part:.3g} % of the voltage reached"))
    return (*flags, *_disagreement(specimen, found, config))


def _disagreement(
    specimen: Specimen, found: Breakdown, config: BreakdownConfig
) -> tuple[Flag, ...]:
    """Hold what the register says beside the file against the ramp, which counts."""
    flags = []
    if "breakdown_voltage_V" in specimen.numbers:
        said = specimen.numbers["breakdown_voltage_V"].value
        if abs(said - found.voltage_V) > config.register_tolerance * found.voltage_V:
            flags.append(f"{said:.5g} V in the register, {found.voltage_V:.5g} V in the ramp")
    censored = _declared_censored(specimen)
    if censored is not None and censored == found.broken:
        flags.append(f"censored: {'yes' if censored else 'no'} in the register, {found.end}")
    return tuple(Flag("register-disagrees", f"{text}; the ramp was used") for text in flags)


def _field(
    specimen: Specimen,
    seen: _Seen,
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
            Contribution("voltage calibration", context.machine.u_voltage_calibration, True),
            Contribution("thickness reading", thickness.u_independent / thickness.value, False),
            Contribution("thickness gauge", thickness.u_shared / thickness.value, True),
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
