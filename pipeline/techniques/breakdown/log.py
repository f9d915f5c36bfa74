"""From the log of one test to the voltage at which the film broke, and what a reader must know."""

from __future__ import annotations

import math

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution
from deamat.core.recording import Recording, Specimen
from deamat.core.records import Detail, Flag
from deamat.techniques.breakdown.config import BreakdownConfig
from deamat.techniques.breakdown.ramp import Breakdown, End, Event, find_breakdown
from deamat.techniques.breakdown.result import Ramp
from deamat.techniques.breakdown.rise import Rise, Steps, audit_rise, find_steps
from deamat.techniques.breakdown.seen import (
    Seen,
    censored_flag,
    declared_censored,
    refuse_beyond_limit,
)
from deamat.techniques.breakdown.signals import median
from deamat.techniques.shared.outcome import line_span

_NOISE_FLAG = 0.002  # of the voltage: a noise that is worth saying
_RATE_NOISE = 4.0  # standard deviations that the rate of an eighth may be off by noise alone


def seen_in_log(specimen: Specimen, recording: Recording, config: BreakdownConfig) -> Seen:
    """Find the breakdown in a log and audit the way to it.

    Parameters
    ----------
    recording : `time_s`, `voltage_V` and, if there was one, `current_A`

    Raises
    ------
    FitRefused : a column is missing, time does not increase, the voltage cannot be one of a ramp,
        or it rose in fewer than five samples
    """
    time_s, voltage_V, current_A = _signals(recording, config)
    interval_s = median(time_s[1:] - time_s[:-1]) if time_s.size > 1 else 0.0
    found = find_breakdown(voltage_V, current_A, interval_s, config.criteria())
    steps = find_steps(time_s, voltage_V, found.last, config.least_hold_s)
    rise = (
        audit_rise(time_s, voltage_V, found.peak, config.dip)
        if steps is None
        else Rise(steps.first_V, steps.duration_s, steps.step_V / steps.hold_s, 1.0, 1.0)
    )
    broken, sure = _declared(specimen, found)
    voltage, u_V, step_V = _voltage(found, steps, config, broken=broken)
    return Seen(
        voltage,
        not broken,
        _method(found, steps, config, broken=broken),
        budget=_budget(voltage, u_V, step_V, broken=broken, steps=steps is not None),
        flags=(
            *_flags_of_end(found, broken, sure, current_A is not None),
            *_flags_of_current(found, config, has_current=current_A is not None),
            *_flags_of_rise(specimen, found, rise, steps, broken=broken, config=config),
            *_flags_of_monitor(found, voltage, step_V, interval_s, steps, config),
            *_disagreement(specimen, found, voltage, config),
        ),
        diagnostics=_diagnostics(found, rise, steps, step_V),
        ramp=Ramp(
            time_s, voltage_V, current_A, found.end, rise.duration_s, rise.rate_V_per_s, steps
        ),
        lines=line_span(
            recording.source, time_s.size, 0, min(max(found.peak, found.last) + 1, time_s.size - 1)
        ),
        sure=sure,
    )


def _signals(
    recording: Recording, config: BreakdownConfig
) -> tuple[FloatArray, FloatArray, FloatArray | None]:
    """Return time, voltage and current of a ramp, the polarity made positive."""
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
    refuse_beyond_limit(greatest, config)
    return time_s, voltage_V, columns.get("current_A")


def _declared(specimen: Specimen, found: Breakdown) -> tuple[bool, bool]:
    """Whether it broke, and whether that is sure: the register decides where the log cannot."""
    said = declared_censored(specimen)
    if found.sure or said is None:
        return found.broken, found.sure
    return not said, True


def _voltage(
    found: Breakdown, steps: Steps | None, config: BreakdownConfig, *, broken: bool
) -> tuple[float, float, float]:
    """Voltage that counts, its uncertainty by noise, and the step within which it broke `[V]`."""
    if steps is None:
        return found.voltage_V, found.u_V, found.step_V
    if not broken or config.step_rule == "ASTM D149":
        return steps.level_V, steps.u_V, steps.step_V
    return steps.held_V, steps.u_V, steps.step_V


_HOW: dict[End, str] = {
    "slow collapse": ", which fell slowly while the current flowed,",
    "held by the current limit": ", part of which the amplifier held at its current limit,",
    "self-clearing": ", which came back,",
}


def _method(found: Breakdown, steps: Steps | None, config: BreakdownConfig, *, broken: bool) -> str:
    if steps is not None:
        held = f"a DC test in steps of {steps.step_V:.4g} V, each held {steps.hold_s:.3g} s"
        if not broken:
            return f"voltage of the last step of {held}"
        if config.step_rule == "ASTM D149":
            return f"voltage of the step at which it broke (ASTM D149, method B) in {held}"
        return f"voltage of the last step held to its end (IEC 60243-1) in {held}"
    if not broken:
        return "greatest voltage borne in a DC ramp"
    spike = "" if found.spike_A is None else " with a current spike"
    return f"greatest voltage before the first collapse{spike} of a DC ramp"


def _budget(
    voltage: float, u_V: float, step_V: float, *, broken: bool, steps: bool
) -> tuple[Contribution, ...]:
    """It broke somewhere within the last step: half of it off on average."""
    noise = Contribution("noise of the voltage monitor", u_V / voltage, False)
    if not broken:
        return (noise,)
    what = "step of the test" if steps else "sampling step"
    step = step_V / voltage
    return (
        Contribution(f"broke within a {what}: its place", step / math.sqrt(12.0), False),
        Contribution(f"broke within a {what}: half of it", step / 2.0, True),
        noise,
    )


def _diagnostics(
    found: Breakdown, rise: Rise, steps: Steps | None, step_V: float
) -> dict[str, Detail]:
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
    if found.spike_A is not None:
        details["spike_A"] = found.spike_A
    if found.clearings:
        details |= {"self_clearings": len(found.clearings), "greatest_V": found.greatest_V}
    if found.u_V:
        details["voltage_noise_V"] = found.noise_V
    if steps is not None:
        details |= {"step_V": step_V, "hold_s": steps.hold_s, "last_held_V": steps.held_V}
    return details


_WHY: dict[End, str] = {
    "amplifier limit": "it reached the amplifier's limit",
    "turned down": "the voltage was turned down, no current spiked",
    "file ended": "the file ends without a collapse",
}


def _flags_of_end(
    found: Breakdown, broken: bool, sure: bool, has_current: bool
) -> tuple[Flag, ...]:
    flags = []
    if not broken:
        flags.append(censored_flag(_WHY.get(found.end, f"the register says so, {found.end}")))
    elif not has_current:
        flags.append(
            Flag("no-current-channel", "the collapse of the voltage alone marks the breakdown")
        )
    if not sure:
        counted = "as broken" if broken else "as unbroken"
        flags.append(Flag("end-unsure", f"{_UNSURE[found.end]}: counted {counted}; {_DECLARE}"))
    return tuple(flags)


_DECLARE = "declare `censored` (yes, no) in the register where the laboratory knows"
_UNSURE: dict[End, str] = {
    "collapse without current": "the voltage collapsed within a sampling step and no current "
    "spiked: it broke and the log was too slow to show the current, or it was switched off",
    "part lost without current": "a part of the voltage was lost for good and no current was "
    "recorded: it broke and the amplifier's current limit held the rest, or it was turned down",
    "slow fall without current": "the voltage fell in several samples, far faster than it had "
    "risen, and no current was recorded: it broke and collapsed slowly, or it was turned down",
    "turned down": "the voltage fell slowly and no current was recorded: it was turned down, or "
    "it broke and collapsed slowly",
}


def _flags_of_current(
    found: Breakdown, config: BreakdownConfig, *, has_current: bool
) -> tuple[Flag, ...]:
    flags = []
    if found.clearings:
        first = config.after_clearing == "first breakdown"
        flags.append(
            Flag(
                "self-clearing",
                f"spikes of current at {_places(found.clearings)}, after which the voltage came "
                f"back and rose to {found.greatest_V / 1e3:.4g} kV: breakdowns that cleared, or "
                f"flashovers; {'the first breakdown' if first else 'the final collapse'} counts "
                "(`after_clearing`)",
            )
        )
    if found.spikes:
        flags.append(
            Flag(
                "current-spikes",
                f"spikes of current at {_places(found.spikes)} without a dip of the voltage: "
                "partial discharge or self-clearing; they were not counted as a breakdown",
            )
        )
    if found.flashovers:
        at = ", ".join(f"{v / 1e3:.4g}" for v in found.flashovers[:3])
        more = f" and {len(found.flashovers) - 3} more" if len(found.flashovers) > 3 else ""
        flags.append(
            Flag(
                "flashover",
                f"at {at} kV{more} a part of the voltage was lost and came back; discarded"
                + ("" if has_current else _NO_CURRENT),
            )
        )
    return tuple(flags)


_NO_CURRENT = " (without a current it cannot be told from a breakdown that cleared: self-clearing)"


def _places(events: tuple[Event, ...]) -> str:
    told = [
        f"{e.voltage_V / 1e3:.4g} kV ({1e3 * (e.current_A or 0.0):.3g} mA"
        + (f", {100.0 * e.lost:.2g} % of the voltage lost)" if e.lost else ")")
        for e in events[:3]
    ]
    return ", ".join(told) + (f" and {len(events) - 3} more" if len(events) > 3 else "")


def _flags_of_rise(
    specimen: Specimen,
    found: Breakdown,
    rise: Rise,
    steps: Steps | None,
    *,
    broken: bool,
    config: BreakdownConfig,
) -> tuple[Flag, ...]:
    flags = []
    numbers = specimen.numbers
    set_rate = numbers["rate_V_per_s"].value if "rate_V_per_s" in numbers else rise.rate_V_per_s
    ratios = (rise.slowest, rise.fastest, rise.rate_V_per_s / set_rate if set_rate > 0 else 0.0)
    tolerances = (*2 * (config.rate_tolerance + _RATE_NOISE * rise.u_part,), config.rate_tolerance)
    if steps is None and any(
        abs(ratio - 1.0) > tolerance for ratio, tolerance in zip(ratios, tolerances, strict=True)
    ):
        flags.append(
            Flag(
                "rate-of-rise",
                f"{rise.rate_V_per_s:.4g} V/s on the whole, {ratios[0]:.2g} to {ratios[1]:.2g} "
                f"times that in parts, and {set_rate:.4g} V/s were set",
            )
        )
    if steps is None and broken and rise.duration_s < config.least_time_s:
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
    return tuple(flags)


def _flags_of_monitor(
    found: Breakdown,
    voltage: float,
    step_V: float,
    interval_s: float,
    steps: Steps | None,
    config: BreakdownConfig,
) -> tuple[Flag, ...]:
    flags = []
    if found.noise_V > _NOISE_FLAG * voltage:
        flags.append(
            Flag(
                "voltage-noise",
                f"the voltage monitor carries {found.noise_V:.3g} V rms of noise: the voltage is "
                "that of the line through the last samples",
            )
        )
    if steps is None and step_V > config.coarse_step * voltage:
        flags.append(
            Flag(
                "coarse-sampling",
                f"the voltage rose {step_V:.3g} V between samples ({interval_s:.3g} s): it may "
                "have broken so much higher; log faster, or raise it more slowly",
            )
        )
    return tuple(flags)


def _disagreement(
    specimen: Specimen, found: Breakdown, voltage: float, config: BreakdownConfig
) -> tuple[Flag, ...]:
    """Hold what the register says beside the file against the ramp, which counts."""
    flags = []
    if "breakdown_voltage_V" in specimen.numbers:
        said = specimen.numbers["breakdown_voltage_V"].value
        if abs(said - voltage) > config.register_tolerance * voltage:
            flags.append(f"{said:.5g} V in the register, {voltage:.5g} V in the ramp")
    censored = declared_censored(specimen)
    if found.sure and censored is not None and censored == found.broken:
        flags.append(f"censored: {'yes' if censored else 'no'} in the register, {found.end}")
    return tuple(Flag("register-disagrees", f"{text}; the ramp was used") for text in flags)
