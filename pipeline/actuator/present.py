"""A design as text and as JSON; both say what is simulated."""

from __future__ import annotations

import math
from collections import Counter
from typing import Any

from deamat.actuator.compositions import Composition, Refused, Trade
from deamat.actuator.design import Design
from deamat.actuator.ranges import Reals
from deamat.actuator.uncertainty import Bar
from deamat.core.present import SYNTHETIC_BANNER, aligned, readable, readable_conditions
from deamat.core.records import PropertyRecord
from deamat.core.units import from_si

Document = dict[str, Any]

_BOUNDS = {
    "given": "as asked for",
    "breakdown": "set by the breakdown probability",
    "pull-in": "set by pull-in",
}


def design_text(design: Design) -> str:
    """Write a design for people: what to make, how far it bends, what dominates, what to test."""
    r, strip = design.case.request, design.strip
    lines = [f"Design: {r.de} on {r.passive}, electrodes {design.case.electrode.name}"]
    lines += synthetic_lines(design)
    lines += ["", *_facts(design)]
    lines += ["", *_answer(design)]
    if strip.passive_thickness_m != design.drive.best_passive_thickness_m:
        best_um = from_si(design.drive.best_passive_thickness_m, "um")
        lines.append(f"optimum     a passive layer of {best_um:.4g} um would bend most")
    lines += ["", "What dominates"]
    bars = [("input", "u of curvature", "elasticity"), *map(_bar_row, design.tornado)]
    lines += aligned(bars, "  ")
    lines += ["", "Next best test (one further specimen)"]
    rows = [("test", "n", "narrows by", "at best by")]
    for t in design.next_tests:
        best = 1.0 - t.u_best / t.u_now if t.u_now else 0.0
        rows.append((t.test, str(t.n), f"{100 * t.gain:.2f} %", f"{100 * best:.2f} %"))
    lines += aligned(rows, "  ")
    lines += _plan(design)
    lines += ["", "Taken from the cards"]
    lines += aligned([_record_row(x) for x in design.case.values.records()], "  ")
    lines += ["", "Notes", *(f"  {note}" for note in design.notes)]
    return "\n".join(lines) + "\n"


def synthetic_lines(design: Design) -> list[str]:
    """Return the banner and the simulated cards; no line if all was measured."""
    if not design.synthetic:
        return []
    return [f"{SYNTHETIC_BANNER} ({', '.join(design.synthetic)})"]


def design_document(design: Design) -> Document:
    """Write a design for programs; SI throughout, None for what is not known."""
    r, strip = design.case.request, design.strip
    prediction, limits = design.prediction, design.case.limits
    return {
        **_banner(bool(design.synthetic)),
        "synthetic_materials": list(design.synthetic),
        "de": r.de,
        "passive": r.passive,
        "electrode": r.electrode,
        "de_thickness_m": r.de_thickness_m,
        "passive_thickness_m": strip.passive_thickness_m,
        "best_passive_thickness_m": design.drive.best_passive_thickness_m,
        "electrode_thickness_m": strip.electrode_thickness_m,
        "voltage_V": design.voltage_V,
        "voltage_set_by": design.bound,
        "allowed_breakdown_probability": limits.allowed.breakdown_probability,
        "breakdown_voltage_V": _finite(limits.breakdown_V),
        "pull_in_limit_V": float(limits.pull_in_V),
        "failure_probability": design.failure_probability,
        "failure_probability_ci95": design.failure_interval95 and list(design.failure_interval95),
        "curvature_per_m": prediction.value,
        "u_curvature_per_m": prediction.u,
        "first_order_holds": prediction.holds,
        "monte_carlo": {
            "median_per_m": design.draws.median,
            "sd_per_m": _finite(design.draws.sd),
            "ci95_per_m": list(design.draws.interval95),
            "pull_in_probability": design.draws.pull_in_probability,
            "draws": design.draws.draws,
        },
        "blocked_force_N": design.blocked_force_N,
        "tornado": [
            {
                "input": b.name,
                "low_per_m": _finite(b.low),
                "high_per_m": _finite(b.high),
                "u_per_m": b.u,
                "elasticity": b.elasticity,
                "uncertainty_declared": b.declared,
            }
            for b in design.tornado
        ],
        "next_tests": [
            {
                "test": t.test,
                "n": t.n,
                "further": t.further,
                "u_now_per_m": t.u_now,
                "u_then_per_m": t.u_then,
                "u_best_per_m": t.u_best,
            }
            for t in design.next_tests
        ],
        "plan": [step.test for step in design.plan],
        "curve": [
            {
                "voltage_V": p.voltage_V,
                "curvature_per_m": p.curvature_per_m,
                "u_per_m": _finite(p.u_per_m),
                "true_field_V_per_m": p.true_field_V_m,
                "failure_probability": p.failure_probability,
            }
            for p in design.points
        ],
        "records": [_record_document(x) for x in design.case.values.records()],
        "notes": list(design.notes),
    }


def compositions_document(
    answered: tuple[Composition, ...], refused: tuple[Refused, ...]
) -> Document:
    """Write a comparison for programs."""
    return {
        **_banner(any(c.synthetic for c in answered)),
        "compositions": [
            {
                "de": c.de,
                "passive": c.passive,
                "synthetic": c.synthetic,
                "voltage_V": c.voltage_V,
                "voltage_set_by": c.bound,
                "true_field_V_per_m": c.true_field_V_m,
                "best_passive_thickness_m": c.best_passive_thickness_m,
                "best_curvature_per_m": c.best_curvature_per_m,
                "without_electrodes_per_m": c.without_electrodes_per_m,
            }
            for c in answered
        ],
        "refused": [{"de": x.de, "passive": x.passive, "reason": x.reason} for x in refused],
    }


def compositions_text(answered: tuple[Composition, ...], refused: tuple[Refused, ...]) -> str:
    """Write a comparison for people, most curvature first."""
    head = ("film", "passive", "voltage", "set by", "best passive", "curvature", "no electrodes")
    rows = [
        (
            c.de,
            c.passive,
            f"{from_si(c.voltage_V, 'kV'):.3g} kV",
            c.bound,
            f"{from_si(c.best_passive_thickness_m, 'um'):.4g} um",
            f"{c.best_curvature_per_m:.4g} 1/m",
            f"{c.without_electrodes_per_m:.4g} 1/m",
        )
        for c in answered
    ]
    banner = [SYNTHETIC_BANNER] if any(c.synthetic for c in answered) else []
    lines = ["All compositions, each at its best passive thickness", *banner]
    lines += aligned([head, *rows], "  ")
    lines += [f"  refused: {x.de} on {x.passive}: {x.reason}" for x in refused]
    return "\n".join(lines) + "\n"


def pareto_document(trades: tuple[Trade, ...], synthetic: bool) -> Document:
    """Write a Pareto front for programs."""
    return {
        **_banner(synthetic),
        "pareto": [
            {
                "de": t.de,
                "passive": t.passive,
                "passive_thickness_m": t.passive_thickness_m,
                "voltage_V": t.voltage_V,
                "curvature_per_m": t.curvature_per_m,
                "blocked_force_N": t.blocked_force_N,
            }
            for t in trades
        ],
    }


def pareto_text(trades: tuple[Trade, ...], synthetic: bool) -> str:
    """Write for each voltage of a Pareto front what bends most and what pushes most."""
    rows = [("voltage", "of", "film", "passive", "thickness", "curvature", "blocked force")]
    for voltage in dict.fromkeys(t.voltage_V for t in trades):
        here = [t for t in trades if t.voltage_V == voltage]
        bends = max(here, key=lambda t: t.curvature_per_m)
        pushes = max(here, key=lambda t: t.blocked_force_N)
        for what, t in (("most curvature", bends), ("most force", pushes)):
            rows.append(
                (
                    f"{from_si(t.voltage_V, 'kV'):.3g} kV",
                    what,
                    t.de,
                    t.passive,
                    f"{from_si(t.passive_thickness_m, 'um'):.4g} um",
                    f"{t.curvature_per_m:.3g} 1/m",
                    f"{from_si(t.blocked_force_N, 'uN'):.3g} uN",
                )
            )
    banner = [SYNTHETIC_BANNER] if synthetic else []
    head = f"What no other design beats: the ends of {len(trades)} designs at each voltage"
    return "\n".join([head, *banner, *aligned(rows, "  ")]) + "\n"


def _banner(synthetic: bool) -> Document:
    return {"synthetic": synthetic, "banner": SYNTHETIC_BANNER if synthetic else None}


def _facts(design: Design) -> list[str]:
    strip = design.strip
    layers = (
        ("passive", strip.passive_thickness_m),
        ("electrode", strip.electrode_thickness_m),
        ("de", strip.film_thickness_m),
        ("electrode", strip.electrode_thickness_m),
    )
    made = ", ".join(f"{name} {from_si(float(t), 'um'):.4g} um" for name, t in layers)
    field_V_um = from_si(design.points[-1].true_field_V_m, "V/um")
    voltage_kV, limit_kV = (
        from_si(v, "kV") for v in (design.voltage_V, float(design.case.limits.pull_in_V))
    )
    part = f"{100 * design.case.limits.allowed.pull_in_fraction:g} %"
    why = _BOUNDS[design.bound]
    lines = [
        f"layers      {made} (bottom to top)",
        f"voltage     {voltage_kV:.4g} kV, {why}; {field_V_um:.3g} V/um on the thinned film",
        f"pull-in     {part} of its voltage is {limit_kV:.4g} kV",
    ]
    chance, interval = design.failure_probability, design.failure_interval95
    if chance is None or interval is None:
        lines.append("breakdown   limit unknown: the card has no breakdown strength that fits")
    else:
        lines.append(
            f"breakdown   {100 * chance:.2g} % of the films fail at this voltage "
            f"(95 % from {100 * interval[0]:.2g} to {100 * interval[1]:.2g} %)"
        )
    return lines


def _answer(design: Design) -> list[str]:
    p, mc = design.prediction, design.draws
    low, high = mc.interval95
    holds = "" if p.holds else ", which does not hold here"
    drawn = f"{mc.draws} draws, {100 * mc.pull_in_probability:.2g} % pull in"
    force_uN = from_si(design.blocked_force_N, "uN")
    return [
        f"curvature   {p.value:.4g} ± {p.u:.2g} 1/m to first order{holds}",
        f"            {mc.median:.4g} 1/m, 95 % from {low:.4g} to {high:.4g} 1/m",
        f"            by Monte Carlo ({drawn})",
        f"force       {force_uN:.3g} uN blocked at the tip",
    ]


def _plan(design: Design) -> list[str]:
    steps = design.plan
    if not steps:
        return []
    counts = Counter(step.test for step in steps)
    best = ", ".join(f"{count} {test}" for test, count in counts.items())
    gain = 100 * (1.0 - steps[-1].u_then / steps[0].u_now)
    return [f"  the next {len(steps)} specimens are best spent on {best}: {gain:.2g} % narrower"]


def _bar_row(bar: Bar) -> tuple[str, str, str]:
    u = f"{bar.u:.2g} 1/m" if bar.declared else "not declared"
    return bar.name, u, f"{bar.elasticity:+.2f}"


def _record_row(record: PropertyRecord) -> tuple[str, ...]:
    value = readable(record.quantity, record.key)
    return (
        record.material, record.key, value, f"n = {record.n}",
        readable_conditions(record.conditions),
    )  # fmt: skip


def _record_document(record: PropertyRecord) -> Document:
    q = record.quantity
    return {
        "material": record.material,
        "key": record.key,
        "value": q.value,
        "unit": q.unit,
        "u_independent": q.u_independent,
        "u_shared": q.u_shared,
        "n": record.n,
        "campaign": record.campaign,
        "conditions": dict(record.conditions),
    }


def _finite(value: Reals | None) -> float | None:
    return float(value) if value is not None and math.isfinite(value) else None
