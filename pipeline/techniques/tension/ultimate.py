"""Strength and elongation of a strip, or their lower limits where it did not break."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import Condition, Flag, MeasuredValue
from deamat.estimators.curves.slip import Slip, find_slip
from deamat.estimators.curves.start import LoadZero, zero_of_load
from deamat.techniques.shared.outcome import line_span, relative_lines
from deamat.techniques.shared.stress_strain import disagreement
from deamat.techniques.tension.config import ELONGATION, STRENGTH
from deamat.techniques.tension.moduli import several_loadings
from deamat.techniques.tension.pull import Pull

_UNBROKEN = {
    "stopped": "the record ends under load",
    "reversed": "the machine turns before the strip breaks",
}


def tensile_strength(pull: Pull, conditions: Mapping[str, Condition]) -> MeasuredValue:
    """Greatest nominal stress; a lower limit where the strip did not break.

    Raises
    ------
    FitRefused : nothing was pulled
    """
    stress, top = pull.curve.nominal_stress_Pa, pull.rupture.maximum
    zero = zero_of_load(stress, pull.curve.first, pull.rupture.first_after)
    strength = _insist_on_load(float(stress[top]) - (0.0 if zero is None else zero.zero_Pa))
    rounding = pull.curve.stress_resolution_Pa / math.sqrt(12.0)
    budget = relative_lines(strength, pull.curve.stress_budget)
    if rounding > 0.0:
        budget += (Contribution("load cell resolution", rounding, shared=False),)
    if zero is not None and zero.u_Pa > 0.0:
        budget += (Contribution("zero of the load cell", zero.u_Pa, shared=False),)
    slip = find_slip(pull.curve.nominal_strain, stress, pull.rupture.last)
    flags = (*pull.flags, *_flags_of_end(pull), *_flags_of_zero(zero), *_flags_of_slip(slip, pull))
    how = "greatest nominal stress"
    limited = pull.rupture.end != "broke" or pull.load_limited
    return _value(pull, STRENGTH, strength, budget, how, top, conditions, flags, limited)


def elongation_at_break(
    pull: Pull, conditions: Mapping[str, Condition], own_columns_tolerance: float
) -> MeasuredValue:
    """Nominal strain of the last sample before the load collapses, or a lower limit of it.

    Parameters
    ----------
    own_columns_tolerance : relative difference from which the file's own strain is held against it

    Raises
    ------
    FitRefused : nothing was pulled, or the strip slid in its grips
    """
    strain, last = pull.curve.nominal_strain, pull.last
    _insist_on_load(float(pull.curve.nominal_stress_Pa[pull.rupture.maximum]))
    slip = find_slip(strain, pull.curve.nominal_stress_Pa, last)
    if slip is not None:
        raise FitRefused(
            f"{_slid(slip, strain)}: slip in the grips or a partial tear, after which the machine "
            "moved farther than the strip was stretched; use grips that follow the strip, or an "
            "extensometer",
            {"slip_strain": float(strain[slip.at]), "slips": slip.count},
        )
    elongation = float(strain[last])
    if not elongation > 0.0:
        raise FitRefused(f"the strain at the break is {100 * elongation:.3g} %, not positive")
    # the break lies somewhere in the sampling interval
    step = abs(float(strain[last] - strain[max(last - 1, 0)])) / math.sqrt(12.0)
    budget = (
        Contribution("sampling interval at break", step, shared=False),
        *relative_lines(elongation, pull.curve.strain_budget),
    )
    u_machine = pull.curve.u_compliance_per_Pa * abs(float(pull.curve.nominal_stress_Pa[last]))
    if u_machine > 0.0:
        budget += (Contribution("machine compliance", u_machine, shared=True),)
    how = "nominal strain of the last sample before the load collapses"
    if pull.rupture.end != "broke":
        how = "nominal strain at the greatest stress, without a break"
    elif pull.load_limited:
        how = "nominal strain where the load begins to hold one value"
    flags = (*pull.flags, *_flags_of_end(pull), *_flags_of_slack(pull, elongation))
    if pull.curve.own is not None:
        of_strain = replace(pull.curve, own=(pull.curve.own[0], None))
        flags += disagreement(of_strain, np.array([last]), own_columns_tolerance)
    limited = (
        pull.rupture.end != "broke" or pull.load_limited or pull.position_held is not None
    )  # fmt: skip
    return _value(pull, ELONGATION, elongation, budget, how, last, conditions, flags, limited)


def _value(
    pull: Pull,
    key: str,
    number: float,
    budget: tuple[Contribution, ...],
    how: str,
    at: int,
    conditions: Mapping[str, Condition],
    flags: tuple[Flag, ...],
    limited: bool,
) -> MeasuredValue:
    size = pull.curve.nominal_stress_Pa.size
    return MeasuredValue(
        key=key,
        quantity=Quantity.from_budget(number, "1" if key == ELONGATION else "Pa", budget),
        budget=budget,
        method=f"{how}; {pull.curve.basis}",
        conditions=conditions,
        lines=line_span(pull.recording.source, size, at, at),
        diagnostics={"sample": at + 1, "samples": size},
        flags=flags + several_loadings(pull, "last"),
        bound="lower" if limited else "exact",
    )


def _insist_on_load(greatest_Pa: float) -> float:
    if greatest_Pa > 0.0:
        return greatest_Pa
    raise FitRefused(
        f"the greatest stress of the loading is {greatest_Pa:.4g} Pa, not positive; nothing was "
        "pulled, or the force is of another sign than the displacement"
    )


def _flags_of_end(pull: Pull) -> tuple[Flag, ...]:
    if pull.rupture.end == "broke":
        return ()
    at = f"at {100 * pull.curve.nominal_strain[pull.rupture.last]:.4g} % strain"
    return (Flag("no-break", f"{_UNBROKEN[pull.rupture.end]}, {at}: a lower limit"),)


def _flags_of_zero(zero: LoadZero | None) -> tuple[Flag, ...]:
    if zero is None:
        return ()
    if zero.zero_Pa != 0.0:
        told = "the same after the break, and was subtracted as the zero of the load cell"
    elif zero.after is None:
        told = "no break shows whether that is a preload or a cell that was not tared"
    else:
        told = f"{zero.after / 1e3:.3g} kPa after the break: the zero of the load is not known"
    return (Flag("untared-load", f"the load starts at {zero.before / 1e3:.3g} kPa; {told}"),)


def _flags_of_slack(pull: Pull, elongation: float) -> tuple[Flag, ...]:
    slack = pull.slack_in(elongation)
    if slack is None:
        return ()
    taut, share = 100 * slack.strain, 100 * slack.strain / elongation
    return (
        Flag(
            "slack",
            f"the strip is taut only from {taut:.2g} % strain on: {share:.2g} % of this elongation "
            "is the way until then",
        ),
    )


def _flags_of_slip(slip: Slip | None, pull: Pull) -> tuple[Flag, ...]:
    if slip is None:
        return ()
    told = f"{_slid(slip, pull.curve.nominal_strain)} ({slip.count} times)"
    return (Flag("slip", f"{told}: slip in the grips or a partial tear"),)


def _slid(slip: Slip, strain: FloatArray) -> str:
    """Say what the load did while the specimen slid."""
    at = f"{100 * strain[slip.at]:.4g} %"
    if slip.sudden:
        return f"the load falls by {100 * slip.loss:.2g} % at once at {at} strain and rises again"
    return (
        f"from {at} to {100 * strain[slip.until]:.4g} % strain the load falls or stands and then "
        f"rises as before, {100 * slip.loss:.2g} % behind"
    )
