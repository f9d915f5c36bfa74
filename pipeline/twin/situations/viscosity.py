"""Curing liquids as laboratories have them: an NDJ-8S without a bath, flow curves of a rheometer.

A run is read every 15 min from 0.25 h to 12.5 h after mixing by rotor 3, with noise of 0.3 % of
full scale and a zero of torque that is off by 0.25 % of it (one standard deviation each).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from datetime import datetime, timedelta
from functools import partial

import numpy as np
from numpy.random import Generator

from deamat.core.arrays import FloatArray
from deamat.core.records import Condition
from deamat.core.viscometer import full_scale_Pas
from deamat.twin.part import SYNTHETIC
from deamat.twin.situations.situation import MATERIAL, Made, Situation
from deamat.twin.writers import ndj8s_log, register_csv

_HOUR_s = 3600.0
_MIXED_AT = datetime.fromisoformat("2022-03-01T08:00:00")
_HOURS = np.arange(0.25, 12.51, 0.25)
_ROTOR = 3
_NOISE, _ZERO = 0.003, 0.0025  # of full scale
_START_Pas, _RISE_Pas_per_h = 1.64, 0.1
_ROOM_C = 22.0
_ENERGY_J_per_mol = 2.6e4
_RATES_per_s = np.geomspace(0.1, 100.0, 13)
_RHEOMETER_NOISE = 0.005
_STEADY_Pas = 3.5

# Viscosity in Pa.s and temperature in degrees Celsius at the times of a log.
Seen = tuple[FloatArray, FloatArray]
Distortion = Callable[[Generator, FloatArray, float], Seen]


def _sound() -> FloatArray:
    return _START_Pas + _RISE_Pas_per_h * _HOURS


def _run(
    distort: Distortion,
    asked_h: float,
    speed_rpm: float,
    rng: Generator,
    severity: float,
    liquid: Callable[[float], FloatArray] | None = None,
    by_line: bool = True,
) -> Made:
    """One run whose viscosity at a time is asked for, by a line or as it was read then."""
    true = _sound() if liquid is None else liquid(severity)
    seen, celsius = distort(rng, true, severity)
    full = full_scale_Pas(_ROTOR, speed_rpm)
    torque = seen / full + rng.normal(0.0, _ZERO) + rng.normal(0.0, _NOISE, seen.size)
    shown = np.round(1e3 * np.round(torque, 3) * full) / 1e3
    readings = [
        (_ROTOR, speed_rpm, float(v), float(t))
        for v, t in zip(shown, np.round(torque, 3), strict=True)
    ]
    stamps = [(_MIXED_AT + timedelta(hours=h)).isoformat() for h in _HOURS.tolist()]
    log = ndj8s_log((SYNTHETIC,), stamps, readings, celsius.tolist())
    row = {
        "specimen": "s1", "material": MATERIAL, "file": "1.log",
        "mixed_at": _MIXED_AT.isoformat(), "temperature_C": f"{_ROOM_C:g}",
        "instrument": "simulated NDJ-8S", "comment": SYNTHETIC,
    }  # fmt: skip
    window = (_HOURS >= 1.0) & (_HOURS <= 12.0)
    line = np.polynomial.polynomial.polyfit(_HOURS[window], shown[window], 1)
    naive = float(np.polynomial.polynomial.polyval(asked_h, line))
    if not by_line:
        naive = float(np.interp(asked_h, _HOURS, shown))
    at: dict[str, Condition] = {"time_s": asked_h * _HOUR_s}
    truth = float(np.interp(asked_h, _HOURS, true))
    return Made({"1.log": log, "specimens.csv": register_csv([row])}, truth, naive, at)


def _steady(viscosity: FloatArray) -> Seen:
    return viscosity, np.full(viscosity.size, _ROOM_C)


def _slips(_rng: Generator, true: FloatArray, fall: float) -> Seen:
    """From 8 h on the liquid slips, by a fraction that grows to `fall` at 12 h."""
    return _steady(true * (1.0 - fall * np.clip((_HOURS - 8.0) / 4.0, 0.0, 1.5)))


def _bubbles(rng: Generator, true: FloatArray, low: float) -> Seen:
    """Six readings are low by a fraction that a bubble takes of the rotor."""
    seen = true.copy()
    at = rng.choice(np.arange(5, _HOURS.size - 4), 6, replace=False)
    seen[at] *= 1.0 - low
    return _steady(seen)


def _sound_seen(_rng: Generator, true: FloatArray, _severity: float) -> Seen:
    return _steady(true)


def _gels_late(rise: float) -> FloatArray:
    """Hardly anything for 6 h, then viscosity grows by `rise` times its own until 12 h."""
    after = np.clip((_HOURS - 6.0) / 6.0, 0.0, None)
    return np.asarray(1.5 * (1.0 + 0.01 * _HOURS) * (1.0 + rise * after**2))


def _warms(_rng: Generator, true: FloatArray, kelvin: float) -> Seen:
    """The room warms by so many kelvins until 12 h."""
    celsius = _ROOM_C + kelvin * _HOURS / 12.0
    return true * _arrhenius(celsius), celsius


def _cycles(_rng: Generator, true: FloatArray, kelvin: float) -> Seen:
    """The heating of the room goes on and off every 6 h."""
    celsius = _ROOM_C + kelvin * np.sin(2.0 * np.pi * (_HOURS - 4.5) / 6.0)
    return true * _arrhenius(celsius), celsius


def _arrhenius(celsius: FloatArray) -> FloatArray:
    inverse = 1.0 / (celsius + 273.15) - 1.0 / (_ROOM_C + 273.15)
    return np.asarray(np.exp(_ENERGY_J_per_mol / 8.314462618 * inverse))


def _flow(key: str, sweeps: Callable[[float], Sequence[FloatArray]]) -> Callable[..., Made]:
    return partial(_flow_made, key, sweeps)


def _flow_made(
    key: str, sweeps: Callable[[float], Sequence[FloatArray]], rng: Generator, severity: float
) -> Made:
    """Flow curves below each other in one file; the first one is that of the liquid asked for."""
    levels = [level * np.exp(rng.normal(0.0, 0.0, level.size)) for level in sweeps(severity)]
    gain = np.exp(rng.normal(0.0, 0.01))
    rows = ["Shear Rate [1/s]\tViscosity [Pa.s]"]
    shown = []
    for level in levels:
        noisy = gain * level * np.exp(rng.normal(0.0, _RHEOMETER_NOISE, level.size))
        shown.append(noisy)
        rows += [f"{q:.6g}\t{v:.6g}" for q, v in zip(_measured(level), noisy, strict=True)]
    at: dict[str, Condition] = {}
    if key == "viscosity":
        truth, naive = float(levels[0][0]), float(np.exp(np.log(np.concatenate(shown)).mean()))
    else:
        at = {"rate_per_s": 95.0}
        truth = float(_bending(severity, np.array([95.0]))[0])
        slope, middle = np.polyfit(np.log(_measured(levels[0])), np.log(shown[0]), 1)
        naive = float(np.exp(middle + slope * np.log(95.0)))
    row = {"specimen": "s1", "material": MATERIAL, "file": "1.txt", "comment": SYNTHETIC}
    text = "".join(line + "\n" for line in rows).encode()
    return Made({"1.txt": text, "specimens.csv": register_csv([row])}, truth, naive, at)


def _measured(level: FloatArray) -> FloatArray:
    """Shear rates of a sweep: the full range, or its slow part where fewer were measured."""
    return _RATES_per_s[: level.size]


def _drifting(drift: float) -> list[FloatArray]:
    """Three sweeps, each lower than the one before: the last by twice `drift`."""
    return [np.full(_RATES_per_s.size, _STEADY_Pas * (1.0 - drift * i)) for i in range(3)]


def _bending(bend: float, rates: FloatArray) -> FloatArray:
    """A power-law fluid whose index changes by `bend` beyond 1 1/s."""
    return np.asarray(20.0 * rates**-0.4 * np.maximum(rates, 1.0) ** bend)


def _slow_part(bend: float) -> list[FloatArray]:
    return [_bending(bend, _RATES_per_s[:7])]


def _of_run(
    name: str,
    told: str,
    answer: str,
    causes: tuple[str, ...],
    severity: str,
    severities: tuple[float, ...],
    make: Callable[[Generator, float], Made],
    key: str = "viscosity",
    undetectable: Mapping[float, str] | None = None,
) -> Situation:
    return Situation(
        name, "viscosity", key, told, answer, causes, severity, severities, make,
        undetectable or {},
    )  # fmt: skip


SITUATIONS = (
    _of_run(
        "viscosity-slip",
        "The liquid slips on the rotor or climbs its rod: viscosity falls to the end of the run.",
        "The law ends at the maximum; what is asked beyond is refused.",
        ("falls", "held-to-shape", "systematic-misfit"), "fall at 12 h, fraction",
        (0.07, 0.2, 0.45), partial(_run, _slips, 12.0, 30.0),
        undetectable={0.07: "the readings still rise while the liquid slips, as in a slower cure"},
    ),
    _of_run(
        "viscosity-bubbles",
        "Bubbles come to the rotor: six of fifty readings are low.",
        "Left out, by line.", ("outlying-readings",), "of a reading that a bubble takes, fraction",
        (0.25, 0.6, 0.9), partial(_run, _bubbles, 6.0, 30.0),
    ),
    _of_run(
        "viscosity-induction",
        "An inhibitor holds the cure back for 6 h, then the liquid gels: no law on offer follows.",
        "Read from the readings nearby; the law is as wide as it misses them, or refused.",
        ("systematic-misfit", "held-to-shape"), "rise until 12 h over viscosity",
        (0.2, 0.7, 2.0), partial(_run, _sound_seen, 6.0, 12.0, liquid=_gels_late),
    ),
    _of_run(
        "viscosity-drift",
        "The room warms while the liquid cures, and the probe says so.",
        "Each value has its own temperature as condition; law and doubling time are refused.",
        ("temperature-drift", "temperature-corrected"), "warmer at 12 h, K", (1.0, 3.2, 11.0),
        partial(_run, _warms, 12.0, 30.0, by_line=False),
    ),
    _of_run(
        "viscosity-cycle",
        "The temperature of the room swings, and the probe says so.",
        "Corrected to one temperature by a fitted activation energy, with its uncertainty.",
        ("temperature-corrected", "temperature-drift"), "amplitude, K", (0.9, 2.9, 8.5),
        partial(_run, _cycles, 6.0, 30.0, by_line=False),
    ),
    _of_run(
        "flow-drift",
        "Three sweeps stand in one file, and the liquid changes from one to the next.",
        "The difference is in the uncertainty; beyond 10 % they are refused as no repeats.",
        ("several-sweeps",), "change from sweep to sweep, fraction", (0.03, 0.1, 0.3),
        _flow("viscosity", _drifting),
    ),
    _of_run(
        "flow-beyond",
        "The printing rate lies two powers of ten beyond the rates measured, where n is another.",
        "Extrapolated, flagged, with what n may be off by in the uncertainty.",
        ("extrapolated",), "change of n beyond 1 1/s", (0.0065, 0.021, 0.058),
        _flow("viscosity_at_printing_rate", _slow_part), key="viscosity_at_printing_rate",
    ),
)  # fmt: skip
