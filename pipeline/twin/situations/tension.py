"""Tension as laboratories have it: five strips, a load cell of 50 N, 40 mm/min."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.random import Generator

from deamat.core.arrays import FloatArray
from deamat.twin.part import SYNTHETIC
from deamat.twin.situations.situation import MATERIAL, Made, Situation
from deamat.twin.writers import bluehill_csv, register_csv

_SPECIMENS = 5
_WIDTH_m, _THICKNESS_m, _GAUGE_m = 6e-3, 2e-3, 40e-3
_SPEED_m_per_s = 40e-3 / 60.0
_MODULUS_Pa, _STRENGTH_STRAIN = 1e6, 2.5
_SCATTER = 0.03
_NOISE_N = 2e-4
_WINDOW = 0.01


@dataclass(frozen=True, slots=True)
class _Pull:
    """What one machine recorded of one strip, and what is true of the strip.

    Parameters
    ----------
    travel_m, force_N : as recorded, shape (n,)
    modulus_Pa, elongation : of this strip
    ceiling_N : above it the load channel shows nothing, noise included
    """

    travel_m: FloatArray
    force_N: FloatArray
    modulus_Pa: float
    elongation: float
    ceiling_N: float = math.inf


Distortion = Callable[[Generator, _Pull, float], _Pull]


def _stress(strain: FloatArray, modulus_Pa: float) -> FloatArray:
    """A rubber that softens a little and stiffens again: slope `modulus_Pa` at zero."""
    return modulus_Pa * (strain - 0.12 * strain**2 + 0.045 * strain**3)


def _pull(rng: Generator) -> _Pull:
    modulus = _MODULUS_Pa * (1.0 + rng.normal(0.0, _SCATTER))
    elongation = _STRENGTH_STRAIN * (1.0 + rng.normal(0.0, _SCATTER))
    fine = np.linspace(0.0, 0.05, 101)
    coarse = np.linspace(0.05, elongation, 200)[1:]
    strain = np.concatenate([fine, coarse])
    force = _WIDTH_m * _THICKNESS_m * _stress(strain, modulus)
    after = strain[-1] + np.linspace(2e-3, 1e-2, 5)
    return _Pull(
        _GAUGE_m * np.concatenate([strain, after]),
        np.concatenate([force, np.zeros(5)]),
        modulus,
        elongation,
    )


def _made(key: str, distort: Distortion, rng: Generator, severity: float) -> Made:
    files: dict[str, bytes] = {}
    rows, truths, naive = [], [], []
    for number in range(1, _SPECIMENS + 1):
        true = _pull(rng)
        seen = distort(rng, true, severity) if severity else true
        force = seen.force_N + rng.normal(0.0, _NOISE_N, seen.force_N.size)
        force = np.minimum(force, seen.ceiling_N)
        name = f"{number}.csv"
        seconds = 0.05 * np.arange(force.size, dtype=np.float64)
        header = [("General : Comment", SYNTHETIC, "")]
        files[name] = bluehill_csv(header, seconds, seen.travel_m, force)
        rows.append(
            {
                "specimen": f"s{number}", "material": MATERIAL, "file": name,
                "width_mm": f"{1e3 * _WIDTH_m:g}", "thickness_mm": f"{1e3 * _THICKNESS_m:g}",
                "gauge_length_mm": f"{1e3 * _GAUGE_m:g}", "comment": SYNTHETIC,
            }
        )  # fmt: skip
        truths.append(_value(key, true))
        naive.append(_naive(key, replace(seen, force_N=force)))
    files["specimens.csv"] = register_csv(rows)
    return Made(files, float(np.mean(truths)), float(np.mean(naive)))


def _value(key: str, pull: _Pull) -> float:
    if key in (_MODULUS, _COMPENSATED):
        strain = np.linspace(0.0, _WINDOW, 201)
        return float(np.polyfit(strain, _stress(strain, pull.modulus_Pa), 1)[0])
    if key == "elongation_at_break":
        return pull.elongation
    return float(_stress(np.array([pull.elongation]), pull.modulus_Pa)[0])


def _naive(key: str, pull: _Pull) -> float:
    """What a short script says: slope of what lies in the window, greatest load, last strain."""
    strain = pull.travel_m / _GAUGE_m
    stress = pull.force_N / (_WIDTH_m * _THICKNESS_m)
    if key in (_MODULUS, _COMPENSATED):
        start = _HINGE if key == _COMPENSATED else 0.0
        inside = (strain >= start) & (strain <= start + _WINDOW)
        return float(np.polyfit(strain[inside], stress[inside], 1)[0]) if inside.sum() > 2 else 0.0
    top = int(stress.argmax())
    return float(strain[top]) if key == "elongation_at_break" else float(stress[top])


def _position(_rng: Generator, pull: _Pull, offset: float) -> _Pull:
    return replace(pull, travel_m=pull.travel_m + offset * _GAUGE_m)


def _slack(_rng: Generator, pull: _Pull, slack: float) -> _Pull:
    late = np.maximum(pull.travel_m - slack * _GAUGE_m, 0.0)
    return replace(pull, force_N=np.interp(late, pull.travel_m, pull.force_N))


def _rounded(_rng: Generator, pull: _Pull, over: float) -> _Pull:
    """The strip becomes taut around a strain, gradually."""
    strain = pull.travel_m / _GAUGE_m - _HINGE
    taut = 0.5 * (strain + np.hypot(strain, over))
    return replace(pull, force_N=np.interp(_GAUGE_m * taut, pull.travel_m, pull.force_N))


def _untared(_rng: Generator, pull: _Pull, part: float) -> _Pull:
    return replace(pull, force_N=pull.force_N + part * float(pull.force_N.max()))


def _until(pull: _Pull, strain: float) -> _Pull:
    kept = pull.travel_m <= strain * _GAUGE_m
    return replace(pull, travel_m=pull.travel_m[kept], force_N=pull.force_N[kept])


def _stopped(_rng: Generator, pull: _Pull, missing: float) -> _Pull:
    return _until(pull, pull.elongation * (1.0 - missing))


def _reversed(_rng: Generator, pull: _Pull, missing: float) -> _Pull:
    there = _until(pull, pull.elongation * (1.0 - missing))
    back = slice(None, None, -8)
    return replace(
        pull,
        travel_m=np.concatenate([there.travel_m, there.travel_m[back]]),
        force_N=np.concatenate([there.force_N, 0.9 * there.force_N[back]]),
    )


def _slip(rng: Generator, pull: _Pull, slid: float) -> _Pull:
    """The strip slides at a strain between 0.8 and 1.2: its own strain stays behind by `slid`."""
    at = rng.uniform(0.8, 1.2)
    strain = pull.travel_m / _GAUGE_m
    held = np.where(strain > at, np.maximum(strain - slid * pull.elongation, 0.0), strain)
    last = pull.elongation * (1.0 + slid)
    travel = np.concatenate([strain, np.linspace(strain[-1], last, 60)[1:], [last + 0.01]])
    own = np.concatenate([held, np.linspace(held[-1], pull.elongation, 60)[1:], [0.0]])
    own[travel >= last] = np.where(travel[travel >= last] > last, 0.0, pull.elongation)
    force = _WIDTH_m * _THICKNESS_m * _stress(own, pull.modulus_Pa)
    return replace(pull, travel_m=_GAUGE_m * travel, force_N=force)


def _cycles(_rng: Generator, pull: _Pull, part: float) -> _Pull:
    """Three cycles to a fraction of the elongation, then the pull."""
    there = _until(pull, pull.elongation * (1.0 - part))
    back = slice(None, None, -2)
    travel = np.concatenate([there.travel_m, there.travel_m[back]])
    force = np.concatenate([there.force_N, 0.97 * there.force_N[back]])
    return replace(
        pull,
        travel_m=np.concatenate([travel, travel, travel, pull.travel_m]),
        force_N=np.concatenate([force, force, force, pull.force_N]),
    )


def _saturated(_rng: Generator, pull: _Pull, missing: float) -> _Pull:
    """The load cell, or what amplifies it, shows nothing above a part of the strength."""
    return replace(pull, ceiling_N=(1.0 - missing) * float(pull.force_N.max()))


def _frozen(_rng: Generator, pull: _Pull, missing: float) -> _Pull:
    """The displacement stays where it is from a part of the elongation on."""
    stuck = pull.elongation * (1.0 - missing) * _GAUGE_m
    return replace(pull, travel_m=np.minimum(pull.travel_m, stuck))


def _few_samples(_rng: Generator, pull: _Pull, every: float) -> _Pull:
    kept = np.arange(pull.travel_m.size) % round(every) == 0
    kept[101:] = True
    return replace(pull, travel_m=pull.travel_m[kept], force_N=pull.force_N[kept])


def _noisy(rng: Generator, pull: _Pull, part: float) -> _Pull:
    """Noise of the cell as a fraction of the load at the end of the window."""
    scale = part * _WIDTH_m * _THICKNESS_m * _MODULUS_Pa * _WINDOW
    return replace(pull, force_N=pull.force_N + rng.normal(0.0, scale, pull.force_N.size))


_MODULUS, _STRENGTH, _ELONGATION = "tensile_modulus", "tensile_strength", "elongation_at_break"
_COMPENSATED = "tensile_modulus_toe_compensated"
_HINGE, _SHARP = 0.003, 1e-6  # strain: where a strip with slack is taut, and over which at least


def _situation(
    name: str,
    key: str,
    told: str,
    answer: str,
    causes: tuple[str, ...],
    severity: str,
    severities: tuple[float, ...],
    distort: Distortion,
) -> Situation:
    make = partial(_made, key, distort)
    return Situation(name, "tension", key, told, answer, causes, severity, severities, make)


SITUATIONS = (
    _situation(
        "tension-position", _ELONGATION,
        "The displacement column is the absolute position of the crosshead.",
        "Counted from the first sample where the load shows that nothing is stretched there.",
        ("displacement-zeroed",), "position at the start, gauge lengths", (0.075, 0.25, 0.75),
        _position,
    ),
    _situation(
        "tension-slack", _MODULUS,
        "The strip hangs loose at first.",
        "Flagged; the compensated modulus stands beside the plain one; refused where the window "
        "holds nothing but slack.",
        ("slack",), "slack, strain", (0.0007, 0.0017, 0.0036), _slack,
    ),
    Situation(
        "tension-round-toe", "tension", _COMPENSATED,
        "The strip hangs loose at first, and becomes taut gradually.",
        "Counted from where a hinge fits best; how much steeper the curve becomes later is in the "
        "uncertainty, and flagged.",
        ("toe",), "strain over which it becomes taut", (0.0006, 0.0022, 0.0095),
        lambda rng, severity: _made(_COMPENSATED, _rounded, rng, severity or _SHARP), sound=False,
    ),
    _situation(
        "tension-untared", _STRENGTH,
        "Nobody balanced the load cell: it shows a load before the pull and after the break.",
        "The zero after the break is subtracted, with its uncertainty.",
        ("untared-load",), "load at the start over load at break", (0.03, 0.1, 0.3), _untared,
    ),
    _situation(
        "tension-stopped", _ELONGATION,
        "The travel ends before the strip breaks.",
        "A lower limit.", ("no-break",), "elongation not reached, fraction", (0.03, 0.1, 0.3),
        _stopped,
    ),
    _situation(
        "tension-reversed", _ELONGATION,
        "The machine turns before the strip breaks.",
        "A lower limit: a reversal is no break.", ("no-break",),
        "elongation not reached, fraction", (0.03, 0.1, 0.3), _reversed,
    ),
    _situation(
        "tension-slip", _ELONGATION,
        "The strip slides in its grips.",
        "Elongation is refused, strength is flagged.", ("slip",), "slid, elongations",
        (0.03, 0.1, 0.3), _slip,
    ),
    _situation(
        "tension-cycles", _ELONGATION,
        "Conditioning cycles come before the break.",
        "Modulus of the first loading, strength and elongation of the break.",
        ("several-loadings",), "elongation above the cycles, fraction", (0.03, 0.1, 0.3), _cycles,
    ),
    _situation(
        "tension-saturated", _STRENGTH,
        "The load cell saturates before the strip breaks.",
        "Lower limits for strength and elongation, flagged.", ("held-channel",),
        "strength not shown, fraction", (0.03, 0.1, 0.3), _saturated,
    ),
    _situation(
        "tension-frozen", _ELONGATION,
        "The displacement freezes before the strip breaks.",
        "A lower limit, flagged.", ("held-channel",), "elongation not shown, fraction",
        (0.03, 0.1, 0.3), _frozen,
    ),
    _situation(
        "tension-few-samples", _MODULUS,
        "The log is slow: few samples lie in the window.",
        "An interval as wide as so few samples ask for, or a refusal that names the setting.",
        (), "samples left out, one kept of", (2.0, 4.0, 8.0), _few_samples,
    ),
    _situation(
        "tension-noise", _MODULUS,
        "The load cell is too large for the strip.",
        "An interval as wide as the noise; refused where the slope cannot be told from zero.",
        ("survivors",), "noise over the load at the end of the window", (0.1, 0.3, 1.0), _noisy,
    ),
)  # fmt: skip
