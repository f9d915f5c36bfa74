"""Breakdown as laboratories have it: twelve films, a ramp of 500 V/s logged at 10 Hz."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.random import Generator

from deamat.core.arrays import FloatArray
from deamat.estimators.weibull.fit import fit, quantile
from deamat.twin.part import SYNTHETIC
from deamat.twin.situations.situation import MATERIAL, Made, Situation
from deamat.twin.writers import ramp_csv, register_csv

_FILMS = 12
_THICKNESS_um = (100, 150)
_SCALE_V_per_m, _SHAPE = 70e6, 9.0
_RATE_V_per_s, _INTERVAL_s = 500.0, 0.1
_AFTER = 30  # samples that are logged after the end
_NOISE_V, _LEAKAGE_A, _NOISE_A = 1.0, 2e-6, 2e-7
_ARC_A, _LIMIT_A = 8e-3, 20e-3


@dataclass(frozen=True, slots=True)
class _Ramp:
    """What one amplifier logged of one film.

    Parameters
    ----------
    time_s, voltage_V, current_A : shape (n,) each
    thickness_m : of the film
    broke_V : at which it broke
    naive_V : at which a short script sees it end
    at : first sample after the breakdown
    unbroken : what a short script says
    """

    time_s: FloatArray
    voltage_V: FloatArray
    current_A: FloatArray
    thickness_m: float
    broke_V: float
    naive_V: float
    at: int
    unbroken: bool = False


Distortion = Callable[[Generator, _Ramp, float], _Ramp]


def _ramp(thickness_m: float, broke_V: float) -> _Ramp:
    """Collapse at once, the arc fed for one sample."""
    rising = np.arange(0.0, broke_V, _RATE_V_per_s * _INTERVAL_s)
    voltage = np.concatenate([rising, np.zeros(_AFTER)])
    current = np.full(voltage.size, _LEAKAGE_A)
    current[rising.size] = _ARC_A
    time = _INTERVAL_s * np.arange(float(voltage.size))
    return _Ramp(time, voltage, current, thickness_m, broke_V, float(rising[-1]), rising.size)


def _ramps(distort: Distortion, rng: Generator, severity: float) -> Made:
    files: dict[str, bytes] = {}
    rows, naive = [], []
    for number in range(1, _FILMS + 1):
        thickness_m = 1e-6 * float(rng.integers(*_THICKNESS_um))
        true = _ramp(thickness_m, _SCALE_V_per_m * rng.weibull(_SHAPE) * thickness_m)
        seen = distort(rng, true, severity) if severity else true
        voltage = seen.voltage_V + rng.normal(0.0, _NOISE_V, seen.voltage_V.size)
        current = seen.current_A + rng.normal(0.0, _NOISE_A, seen.current_A.size)
        files[f"{number}.csv"] = ramp_csv(SYNTHETIC, seen.time_s, voltage, current)
        naive.append(seen)
        rows.append(
            {
                "specimen": f"s{number}", "material": MATERIAL, "file": f"{number}.csv",
                "thickness_um": f"{1e6 * thickness_m:g}", "comment": SYNTHETIC,
            }
        )  # fmt: skip
    files["specimens.csv"] = register_csv(rows)
    return Made(files, _SCALE_V_per_m, _naive_scale(naive))


def _naive_scale(ramps: Sequence[_Ramp]) -> float:
    """Scale by maximum likelihood, with the shape that the films have if all of them broke."""
    field = np.array([ramp.naive_V / ramp.thickness_m for ramp in ramps])
    shape = fit(field).shape
    broken = max(sum(not ramp.unbroken for ramp in ramps), 1)
    return float((np.sum(field**shape) / broken) ** (1.0 / shape))


def _clearing(rng: Generator, ramp: _Ramp, above: float) -> _Ramp:
    """The film breaks and clears; it bears a part more before it collapses for good."""
    last = _ramp(ramp.thickness_m, ramp.broke_V * (1.0 + above))
    first, end = ramp.at, last.at
    places = [first, *rng.integers(first + 1, max(end - 3, first + 2), 2)]
    for at in places[: 1 + (end - first > 6) * 2]:
        last.voltage_V[at] *= 1.0 - rng.uniform(0.005, 0.3)
        last.current_A[at] = 10.0 ** rng.uniform(-3.7, -1.7)
    return replace(last, broke_V=ramp.broke_V)


def _slow_collapse(rng: Generator, ramp: _Ramp, fraction: float) -> _Ramp:
    """In a fraction of the films the voltage takes many samples to fall."""
    if rng.uniform() > fraction:
        return ramp
    tail = 3 * _AFTER
    samples = rng.uniform(4.0, 15.0)
    rising = ramp.voltage_V[: ramp.at]
    fall = rising[-1] * np.exp(-np.arange(1.0, tail + 1.0) / samples)
    voltage = np.concatenate([rising, fall])
    current = np.full(voltage.size, _LEAKAGE_A)
    current[ramp.at : ramp.at + round(3 * samples)] = _ARC_A
    time = _INTERVAL_s * np.arange(float(voltage.size))
    return replace(ramp, time_s=time, voltage_V=voltage, current_A=current, unbroken=True)


def _plateau(rng: Generator, ramp: _Ramp, fraction: float) -> _Ramp:
    """In a fraction of the films the current limit holds 30 to 90 % of the voltage."""
    if rng.uniform() > fraction:
        return ramp
    voltage, current = ramp.voltage_V.copy(), ramp.current_A.copy()
    voltage[ramp.at :] = rng.uniform(0.3, 0.9) * voltage[ramp.at - 1]
    current[ramp.at :] = _LIMIT_A
    return replace(ramp, voltage_V=voltage, current_A=current, unbroken=True)


def _missed_arc(rng: Generator, ramp: _Ramp, fraction: float) -> _Ramp:
    """The log is slow, and in a fraction of the films the arc lies between two samples."""
    missed = rng.uniform() < fraction
    phase = (ramp.at - (1 if missed else 0)) % 5
    current = ramp.current_A[phase::5]
    voltage = ramp.voltage_V[phase::5]
    return replace(
        ramp, time_s=ramp.time_s[phase::5], voltage_V=voltage, current_A=current,
        naive_V=float(voltage.max()), unbroken=missed,
    )  # fmt: skip


def _slow_log(rng: Generator, ramp: _Ramp, every: float) -> _Ramp:
    """One sample of many is kept, and the arc is fed until the end."""
    step = round(every)
    current = ramp.current_A.copy()
    current[ramp.at :] = _ARC_A
    kept = np.arange(int(rng.integers(step)), current.size, step)
    voltage = ramp.voltage_V[kept]
    return replace(
        ramp, time_s=ramp.time_s[kept], voltage_V=voltage, current_A=current[kept],
        naive_V=float(voltage.max()),
    )  # fmt: skip


def _noisy(rng: Generator, ramp: _Ramp, noise_V: float) -> _Ramp:
    """Noise of the voltage monitor; half of the films collapse slowly."""
    seen = _slow_collapse(rng, ramp, 0.5)
    voltage = seen.voltage_V + rng.normal(0.0, noise_V, seen.voltage_V.size)
    return replace(seen, voltage_V=voltage, naive_V=float(voltage.max()), unbroken=False)


def _steps(rng: Generator, ramp: _Ramp, step_V: float) -> _Ramp:
    """Steps held 20 s and logged every 2 s; the film breaks while a step is held."""
    levels = step_V * np.arange(1.0, np.ceil(ramp.broke_V / step_V) + 1.0)
    rising = np.repeat(levels, 10)
    rising = rising[: rising.size - int(rng.integers(9))]
    voltage = np.concatenate([rising, np.zeros(8)])
    current = np.full(voltage.size, _LEAKAGE_A)
    current[rising.size] = _ARC_A
    time = 2.0 * np.arange(float(voltage.size))
    return replace(
        ramp, time_s=time, voltage_V=voltage, current_A=current, naive_V=float(levels[-1])
    )


_MANY = 30  # films of the registers of fields


def _fields(distort: Fields, key: str, rng: Generator, severity: float) -> Made:
    """A register of fields alone, from a distribution that is no Weibull one."""
    field, truth = distort(rng, severity)
    rows = [
        {
            "specimen": f"s{i}", "material": MATERIAL, "breakdown_field_V_per_um": f"{x / 1e6:.4f}",
            "comment": SYNTHETIC,
        }
        for i, x in enumerate(field.tolist(), start=1)
    ]  # fmt: skip
    best = fit(field)
    return Made(
        {"specimens.csv": register_csv(rows)}, truth, quantile(best.scale, best.shape, _P[key])
    )


Fields = Callable[[Generator, float], tuple[FloatArray, float]]
_P = {"breakdown_B1": 0.01, "breakdown_B10": 0.1}
_WEAK_FRACTION = 0.1


def _quantile_of(survival: Callable[[float], float], p: float) -> float:
    """Solve survival = 1 - p by bisection `[V/m]`."""
    low, high = 1e-3 * _SCALE_V_per_m, 2.0 * _SCALE_V_per_m
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if survival(middle) > 1.0 - p else (low, middle)
    return 0.5 * (low + high)


def _survival(x: float, scale: float, shape: float) -> float:
    return float(np.exp(-((x / scale) ** shape)))


def _populations(rng: Generator, weaker: float, p: float) -> tuple[FloatArray, float]:
    """A tenth of the films is of a weaker population."""
    weak = rng.uniform(size=_MANY) < _WEAK_FRACTION
    scale = _SCALE_V_per_m * (1.0 - weaker)
    field = np.where(weak, scale, _SCALE_V_per_m) * rng.weibull(_SHAPE, _MANY)
    return field, _quantile_of(
        lambda x: (
            _WEAK_FRACTION * _survival(x, scale, _SHAPE)
            + (1.0 - _WEAK_FRACTION) * _survival(x, _SCALE_V_per_m, _SHAPE)
        ),
        p,
    )


def _modes(rng: Generator, inverse: float, p: float) -> tuple[FloatArray, float]:
    """A second kind of flaw of shape 3; the films break at the first of the two."""
    if inverse == 0.0:
        return _SCALE_V_per_m * rng.weibull(_SHAPE, _MANY), quantile(_SCALE_V_per_m, _SHAPE, p)
    scale = _SCALE_V_per_m / inverse
    field = np.minimum(
        _SCALE_V_per_m * rng.weibull(_SHAPE, _MANY), scale * rng.weibull(_FLAWS, _MANY)
    )
    return field, _quantile_of(
        lambda x: _survival(x, scale, _FLAWS) * _survival(x, _SCALE_V_per_m, _SHAPE), p
    )


_FLAWS = 3.0


def _threshold(rng: Generator, part: float, p: float) -> tuple[FloatArray, float]:
    """No film breaks below a threshold, a fraction of the scale."""
    least, shape = part * _SCALE_V_per_m, _SHAPE * (1.0 - part)
    rest = _SCALE_V_per_m - least
    return least + rest * rng.weibull(shape, _MANY), least + quantile(rest, shape, p)


def _thicknesses(rng: Generator, exponent: float) -> Made:
    """The field at breakdown falls with the thickness; the films have 60 to 200 um."""
    rows = []
    fields = []
    for i in range(1, _MANY + 1):
        thickness_um = float(rng.integers(60, 200))
        field = _SCALE_V_per_m * (thickness_um / 110.0) ** -exponent * rng.weibull(_SHAPE)
        fields.append(field)
        rows.append(
            {
                "specimen": f"s{i}", "material": MATERIAL, "thickness_um": f"{thickness_um:g}",
                "breakdown_voltage_kV": f"{field * thickness_um * 1e-9:.5f}", "comment": SYNTHETIC,
            }
        )  # fmt: skip
    return Made({"specimens.csv": register_csv(rows)}, _SHAPE, fit(fields).shape)


def _form(
    name: str,
    key: str,
    told: str,
    answer: str,
    severity: str,
    severities: tuple[float, ...],
    distort: Callable[[Generator, float, float], tuple[FloatArray, float]],
) -> Situation:
    make = partial(_fields, lambda rng, s: distort(rng, s, _P[key]), key)
    causes = ("poor-fit", "form-curved", "low-outlier", "form-untested")
    return Situation(name, "breakdown", key, told, answer, causes, severity, severities, make)


_UNTESTED = (
    "Flagged where the Weibull plot shows it; else `form-untested` says which departure so few "
    "films could not have seen (it stands on every B1 of fewer than 299 films)."
)


def _situation(
    name: str,
    told: str,
    answer: str,
    causes: tuple[str, ...],
    severity: str,
    severities: tuple[float, ...],
    distort: Distortion,
) -> Situation:
    make = partial(_ramps, distort)
    return Situation(
        name, "breakdown", "breakdown_strength", told, answer, causes, severity, severities, make
    )


SITUATIONS = (
    _situation(
        "breakdown-clearing",
        "The film breaks and clears itself: a spike of current, a small dip, and the ramp goes on.",
        "The voltage of the first breakdown; flagged with what came later.",
        ("self-clearing", "current-spikes"), "last collapse above the first breakdown, fraction",
        (0.03, 0.1, 0.3), _clearing,
    ),
    _situation(
        "breakdown-slow-collapse",
        "The voltage takes many samples to collapse, because the amplifier feeds the arc.",
        "A breakdown where the current jumps, however slowly the voltage falls.",
        (), "fraction of the films", (0.25, 0.6, 0.9), _slow_collapse,
    ),
    _situation(
        "breakdown-plateau",
        "The amplifier's current limit holds a part of the voltage over the broken film.",
        "A breakdown where the current jumps, whatever is left of the voltage.",
        (), "fraction of the films", (0.25, 0.6, 0.9), _plateau,
    ),
    _situation(
        "breakdown-missed-arc",
        "The log is slow, and the current of the arc lies between two samples.",
        "Counted as broken, with intervals that hold what it would be had the films held; flagged.",
        ("end-unsure", "counted-both-ways"), "fraction of the films", (0.25, 0.6, 0.9), _missed_arc,
    ),
    _situation(
        "breakdown-slow-log",
        "The voltage rises far between two samples of the log.",
        "Half of the step is in the interval; flagged.",
        ("coarse-sampling",), "samples left out, one kept of", (11.0, 35.0, 60.0), _slow_log,
    ),
    _situation(
        "breakdown-noise",
        "The voltage monitor is noisy, and half of the films collapse slowly.",
        "The voltage of the line through the last samples; noise makes no events.",
        ("voltage-noise",), "noise of the monitor, V", (150.0, 550.0, 1500.0), _noisy,
    ),
    _situation(
        "breakdown-steps",
        "The voltage is raised in steps that are held (ASTM D149, method B).",
        "The voltage of the step at which it broke; half of the step is in the interval.",
        (), "step, V", (500.0, 1500.0, 3000.0), _steps,
    ),
    _form(
        "breakdown-two-populations", "breakdown_B1",
        "A tenth of thirty films is of a weaker population.", _UNTESTED,
        "weaker by, fraction", (0.15, 0.3, 0.5), _populations,
    ),
    _form(
        "breakdown-competing-modes", "breakdown_B1",
        "Flaws of a second kind, shape 3, break thirty films of shape 9 before their time.",
        _UNTESTED, "scale over that of the flaws", (0.15, 0.25, 0.5), _modes,
    ),
    _form(
        "breakdown-threshold", "breakdown_B1",
        "No film breaks below a threshold: a three-parameter Weibull.", _UNTESTED,
        "threshold over scale", (0.2, 0.5, 0.7), _threshold,
    ),
    Situation(
        "breakdown-thickness", "breakdown", "weibull_shape",
        "The field at breakdown falls with the thickness, and the films differ in it.",
        "Tested; where it shows, flagged with the exponent and the shape freed of it, and in the "
        "interval.",
        ("thickness-dependence",), "exponent", (0.12, 0.2, 0.35), _thicknesses,
    ),
)  # fmt: skip
