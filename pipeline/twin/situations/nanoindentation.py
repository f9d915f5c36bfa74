"""Indentation as laboratories have it: three indents of a sphere of 100 um, 2 um deep."""

from __future__ import annotations

import math
from collections.abc import Callable
from datetime import UTC, datetime
from functools import partial

import numpy as np
from numpy.random import Generator

from deamat.core.arrays import FloatArray
from deamat.twin.part import SYNTHETIC
from deamat.twin.situations.situation import MATERIAL, Made, Situation
from deamat.twin.writers import hysitron_text, register_csv

_SPECIMENS = 3
_RADIUS_m, _DEEPEST_m, _LIFT_m = 100e-6, 2e-6, 1e-6
_MODULUS_Pa, _SCATTER, _NU = 1e6, 0.03, 0.49
_NOISE_N, _TILT_N_per_m = 2e-7, 0.1
_SPACING_m, _HOLD = 2e-8, 30
_STAMP = datetime(2025, 1, 6, 10, 0, tzinfo=UTC)

Indent = tuple[FloatArray, FloatArray]  # depth, and load without noise
Situated = Callable[[Generator, float, float], Indent]


def _hertz(depth_m: FloatArray, reduced_Pa: float) -> FloatArray:
    above: FloatArray = np.maximum(depth_m, 0.0) ** 1.5
    return 4.0 / 3.0 * reduced_Pa * math.sqrt(_RADIUS_m) * above


def _there(first_m: float) -> FloatArray:
    return np.linspace(first_m, _DEEPEST_m, round((_DEEPEST_m - first_m) / _SPACING_m) + 1)


def _preloaded(rng: Generator, reduced_Pa: float, preload: float) -> Indent:
    """Start in contact, `preload` of the travel deep, with depth and perhaps load zeroed there."""
    down = _there(-_LIFT_m) if preload == 0.0 else _there(0.0)
    path = np.concatenate([down, np.full(_HOLD, down[-1]), down[-2::-1]])
    load = _hertz(path + preload * _DEEPEST_m, reduced_Pa)
    return path, load - (load[0] if rng.integers(2) else 0.0)


def sticking(rng: Generator, reduced_Pa: float, pull: float) -> Indent:
    """Come into contact with some and leave with all of the adhesion (JKR)."""
    down = _there(-_LIFT_m)
    peak = float(_hertz(down[-1:], reduced_Pa)[0])
    work = pull * peak / (1.5 * math.pi * _RADIUS_m)
    share = rng.uniform(0.0, 1.0)
    there = np.where(down < 0.0, 0.0, _jkr(down, reduced_Pa, share * work))
    back = _jkr(down[::-1], reduced_Pa, work)
    hold = np.linspace(there[-1], back[0], _HOLD)
    return (
        np.concatenate([down, np.full(_HOLD, down[-1]), down[::-1]]),
        np.concatenate([there, hold, back]),
    )


def _jkr(depth_m: FloatArray, reduced_Pa: float, work: float) -> FloatArray:
    r"""Load of a sphere that sticks, along its radius of contact a, down to where it snaps off.

    $h = a^2/R - \sqrt{2 \pi a W / E^*}$, $P = 4 E^* a^3 / 3R - \sqrt{8 \pi W E^* a^3}$
    """
    if work == 0.0:
        return _hertz(depth_m, reduced_Pa)
    snap = (math.pi * work * _RADIUS_m**2 / (8.0 * reduced_Pa)) ** (1.0 / 3.0)
    a = np.geomspace(snap, 3.0 * math.sqrt(_RADIUS_m * _DEEPEST_m), 4000)
    h = a**2 / _RADIUS_m - np.sqrt(2.0 * math.pi * a * work / reduced_Pa)
    p = 4.0 * reduced_Pa * a**3 / (3.0 * _RADIUS_m) - np.sqrt(
        8.0 * math.pi * work * reduced_Pa * a**3
    )
    return np.where(depth_m < h[0], 0.0, np.interp(depth_m, h, p))


def _made(situated: Situated, rng: Generator, severity: float) -> Made:
    files: dict[str, bytes] = {}
    rows, truths, naive = [], [], []
    for number in range(1, _SPECIMENS + 1):
        modulus = _MODULUS_Pa * (1.0 + rng.normal(0.0, _SCATTER))
        depth, load = situated(rng, modulus / (1.0 - _NU**2), severity)
        if depth[0] < 0.0:
            load = load + rng.normal(0.0, _TILT_N_per_m) * depth
        load = load + rng.normal(0.0, _NOISE_N, load.size)
        down = int(depth.argmax()) + 1
        name = f"{number}.txt"
        segments = (down, _HOLD, depth.size - down - _HOLD)
        files[name] = hysitron_text(
            _STAMP, segments, depth, load, 0.05 * np.arange(depth.size, dtype=np.float64)
        )
        rows.append(
            {
                "specimen": f"s{number}", "material": MATERIAL, "file": name, "tip": "spherical",
                "tip_radius_um": f"{1e6 * _RADIUS_m:g}", "height_mm": "5", "comment": SYNTHETIC,
            }
        )  # fmt: skip
        truths.append(modulus)
        naive.append(_naive(depth[:down], load[:down]))
    files["specimens.csv"] = register_csv(rows)
    return Made(files, float(np.mean(truths)), float(np.mean(naive)))


def _naive(depth_m: FloatArray, load_N: FloatArray) -> float:
    """What a short script says: Hertz' law from the depth on where the load begins to rise."""
    from_zero = depth_m >= 0.0
    h, p = depth_m[from_zero], load_N[from_zero] - load_N[:5].mean()
    stiffness = float(h**1.5 @ p) / float(h**3 @ np.ones_like(h))
    return 0.75 * stiffness / math.sqrt(_RADIUS_m) * (1.0 - _NU**2)


_KEY = "indentation_modulus"

SITUATIONS = (
    Situation(
        "indentation-preload", "nanoindentation", _KEY,
        "The record starts in contact, at a preload where depth and perhaps load were zeroed.",
        "Hertz' law with contact point and zero of the load free, flagged.",
        ("starts-in-contact",), "depth before the record over depth in it", (0.02, 0.07, 0.25),
        partial(_made, _preloaded),
    ),
    Situation(
        "indentation-adhesion", "nanoindentation", _KEY,
        "The tip sticks, less on its way in than on its way out.",
        "JKR (or DMT, by Tabor's parameter) on the way out, with the measured pull-off.",
        ("adhesion",), "pull-off over peak load without adhesion", (0.05, 0.17, 0.5),
        partial(_made, sticking),
    ),
)  # fmt: skip
