"""Liquids whose columns are labelled in another unit: time, shear rate, speed and rotor.

Runs are read every 15 min from 0.25 h to 12.5 h after mixing by rotor 3 at 30 rpm, kept as a CSV
with a time that is labelled in seconds; flow curves go from 0.1 1/s to 100 1/s.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from numpy.random import Generator

from deamat.core.arrays import FloatArray
from deamat.core.viscometer import full_scale_Pas
from deamat.twin.part import SYNTHETIC
from deamat.twin.situations.situation import MATERIAL, Made, Situation
from deamat.twin.writers import register_csv

_HOUR_s = 3600.0
_HOURS = np.arange(0.25, 12.51, 0.25)
_ROTOR, _SPEED_rpm = 3, 30.0
_NOISE, _ZERO = 0.003, 0.0025  # of full scale
_START_Pas, _RISE_Pas_per_h = 1.64, 0.18
_BATCH_SD = 0.006
_SIBLINGS = 5
_RATES_per_s = np.geomspace(0.1, 100.0, 13)
_CONSISTENCY = 20.0
_RHEOMETER_NOISE, _RHEOMETER_GAIN = 0.005, 0.01
_PER_MINUTE = 60.0


def _timed(runs: int, remarks: tuple[str, ...], rng: Generator, factor: float) -> Made:
    """Runs of which the first one's time is written `factor` times what it was (0: no fault)."""
    files, rows = {}, []
    zero = rng.normal(0.0, _ZERO)
    for i in range(1, runs + 1):
        slip = factor if factor and i == 1 else 1.0
        level = _level(rng, runs)
        seen = _torque(rng, level * (_START_Pas + _RISE_Pas_per_h * _HOURS), zero)
        files[f"{i}.csv"] = _csv(slip * _HOUR_s * _HOURS, _SPEED_rpm, seen, remarks)
        rows.append(_row(i, f"{i}.csv"))
    truth = _HOUR_s * (1.0 + (_START_Pas + _RISE_Pas_per_h) / _RISE_Pas_per_h)
    naive = ((factor or 1.0) + runs - 1.0) / runs * truth
    return Made({**files, "specimens.csv": register_csv(rows)}, truth, naive)


def _level(rng: Generator, runs: int) -> float:
    """Draw a batch over the mean of many; of one alone that one is asked for."""
    return 1.0 + rng.normal(0.0, _BATCH_SD) if runs > 1 else 1.0


def _torque(rng: Generator, viscosity_Pas: FloatArray, zero: float) -> FloatArray:
    full = full_scale_Pas(_ROTOR, _SPEED_rpm)
    noise = rng.normal(0.0, _NOISE, viscosity_Pas.size)
    return np.round(viscosity_Pas / full + zero + noise, 3)


def _csv(
    time_s: FloatArray,
    speed_rpm: float,
    torque: FloatArray,
    remarks: tuple[str, ...],
    rotor: int = _ROTOR,
    full_Pas: float | None = None,
) -> bytes:
    """Write a CSV with the time in seconds; the torque stands beside what it was turned into."""
    full = full_scale_Pas(_ROTOR, _SPEED_rpm) if full_Pas is None else full_Pas
    lines = [f"# {remark}" for remark in (SYNTHETIC, *remarks)]
    lines.append("time_s,rotor,speed_rpm,viscosity_Pas,torque_percent")
    lines += [
        f"{t:.6g},{rotor},{speed_rpm:g},{full * m:.3f},{100.0 * m:.1f}"
        for t, m in zip(time_s.tolist(), torque.tolist(), strict=True)
    ]
    return "".join(f"{line}\n" for line in lines).encode()


def _row(number: int, file: str) -> dict[str, str]:
    return {
        "specimen": f"s{number}", "material": MATERIAL, "file": file, "temperature_C": "22",
        "instrument": "simulated NDJ-8S", "comment": SYNTHETIC,
    }  # fmt: skip


def _speed(rng: Generator, factor: float) -> Made:
    """The speed in the log is `factor` times that of the rotor, which the display went by."""
    viscosity = _START_Pas + _RISE_Pas_per_h * _HOURS
    seen = _torque(rng, viscosity, rng.normal(0.0, _ZERO))
    speed = _SPEED_rpm * (factor or 1.0)
    log = _csv(_HOUR_s * _HOURS, speed, seen, ())
    return _at_six_hours({"1.csv": log}, [_row(1, "1.csv")], 1.0 / (factor or 1.0))


def _rotor(runs: int, rng: Generator, rotor: float) -> Made:
    """On the first run's day the viscometer was set to another rotor than the one that turned."""
    files, rows = {}, []
    own, zero = full_scale_Pas(_ROTOR, _SPEED_rpm), rng.normal(0.0, _ZERO)
    shown = own
    for i in range(1, runs + 1):
        level = _level(rng, runs)
        seen = _torque(rng, level * (_START_Pas + _RISE_Pas_per_h * _HOURS), zero)
        set_to = int(rotor) if rotor and i == 1 else _ROTOR
        full = full_scale_Pas(set_to, _SPEED_rpm)
        shown = full if i == 1 else shown
        files[f"{i}.csv"] = _csv(_HOUR_s * _HOURS, _SPEED_rpm, seen, (), set_to, full)
        rows.append(_row(i, f"{i}.csv"))
    mean = (shown / own + runs - 1.0) / runs
    return _at_six_hours(files, rows, mean)


def _at_six_hours(files: dict[str, bytes], rows: list[dict[str, str]], factor: float) -> Made:
    truth = _START_Pas + 6.0 * _RISE_Pas_per_h
    contents = {**files, "specimens.csv": register_csv(rows)}
    return Made(contents, truth, factor * truth, {"time_s": 6.0 * _HOUR_s})


def _rates(with_stress: bool, rng: Generator, thinning: float) -> Made:
    """A flow curve whose rates are in 1/min and labelled in 1/s; K is asked for."""
    slip = _PER_MINUTE if thinning else 1.0
    exponent = -(thinning or 0.3)
    gain = np.exp(rng.normal(0.0, _RHEOMETER_GAIN))
    noise = np.exp(rng.normal(0.0, _RHEOMETER_NOISE, _RATES_per_s.size))
    viscosity = gain * _CONSISTENCY * _RATES_per_s**exponent * noise
    head = ["Shear Rate [1/s]", "Viscosity [Pa.s]", *(["Shear Stress [Pa]"] * with_stress)]
    lines = ["\t".join(head)]
    for rate, mu in zip(_RATES_per_s.tolist(), viscosity.tolist(), strict=True):
        stress = [f"{rate * mu:.6g}"] * with_stress
        lines.append("\t".join([f"{slip * rate:.6g}", f"{mu:.6g}", *stress]))
    row = {"specimen": "s1", "material": MATERIAL, "file": "1.txt", "comment": SYNTHETIC}
    text = "".join(f"{line}\n" for line in lines).encode()
    naive = _CONSISTENCY * slip**-exponent
    return Made({"1.txt": text, "specimens.csv": register_csv([row])}, _CONSISTENCY, naive)


def _of_units(
    name: str,
    told: str,
    answer: str,
    causes: tuple[str, ...],
    severity: str,
    severities: tuple[float, ...],
    make: Callable[[Generator, float], Made],
    key: str,
    undetectable: Mapping[float, str] | None = None,
) -> Situation:
    return Situation(
        name, "viscosity", key, told, answer, causes, severity, severities, make,
        undetectable or {},
    )  # fmt: skip


_DOUBLING = "viscosity_doubling_time"
_TIMES = "time written over time passed"
_ALONE = "a liquid that cures in twelve minutes writes the same file as one that takes twelve hours"
_NO_STRESS = "rate and viscosity alone: with another unit of rate they are those of another K"
_OWN_ROTOR = "torque, speed and viscosity agree: what the display was set to is all that there is"

SITUATIONS = (
    _of_units(
        "viscosity-time-unit",
        "One run alone, whose column of time is in another unit than its label says.",
        "Refused where the run ends within a minute of mixing, or after more than a week.",
        ("time-unit", "implausible"), _TIMES, (1.0 / 3600.0, 1.0 / 60.0, 60.0, 3600.0),
        partial(_timed, 1, ()), _DOUBLING, undetectable={1.0 / 60.0: _ALONE},
    ),
    _of_units(
        "viscosity-time-unit-siblings",
        "One of five runs of a liquid has its time in another unit.",
        "Flagged: the others rise as far in sixty times as long.",
        ("time-unit",), _TIMES, (1.0 / 60.0, 60.0), partial(_timed, _SIBLINGS, ()), _DOUBLING,
    ),
    _of_units(
        "viscosity-time-unit-header",
        "One run alone, whose column of time is in another unit, and whose header says how long it "
        "took.",
        "Flagged: the header and the column contradict each other.",
        ("time-unit",), _TIMES, (1.0 / 60.0, 60.0),
        partial(_timed, 1, ("Duration: 12.25 h",)), _DOUBLING,
    ),
    _of_units(
        "viscosity-speed-slip",
        "The speed in the log is not the one at which the rotor turned.",
        "Refused: viscosity, torque and speed contradict each other.",
        ("contradicting",), "speed written over speed", (0.4, 2.0), _speed, "viscosity",
    ),
    _of_units(
        "viscosity-rotor-alone",
        "The viscometer was set to another rotor than the one that turned; one run alone.",
        "Nothing: the log is that of another liquid.",
        ("outlier",), "rotor set in place of 3", (2.0, 4.0), partial(_rotor, 1), "viscosity",
        undetectable={2.0: _OWN_ROTOR, 4.0: _OWN_ROTOR},
    ),
    _of_units(
        "viscosity-rotor-siblings",
        "For one of five runs the viscometer was set to another rotor than the one that turned.",
        "Flagged: that run stands apart from the others.",
        ("outlier",), "rotor set in place of 3", (2.0, 4.0), partial(_rotor, _SIBLINGS),
        "viscosity",
    ),
    _of_units(
        "flow-rate-unit",
        "Shear rates are in 1/min and labelled in 1/s; the stress stands beside them.",
        "Refused: stress over rate is not the viscosity.",
        ("contradicting",), "1 - n", (0.0072, 0.0233, 0.064), partial(_rates, True),
        "flow_consistency",
    ),
    _of_units(
        "flow-rate-unit-alone",
        "Shear rates are in 1/min and labelled in 1/s, beside viscosities alone.",
        "Nothing, but for the calibration of 3 % in the interval.",
        ("contradicting",), "1 - n", (0.0072, 0.0233, 0.064), partial(_rates, False),
        "flow_consistency", undetectable={0.0233: _NO_STRESS, 0.064: _NO_STRESS},
    ),
)  # fmt: skip
