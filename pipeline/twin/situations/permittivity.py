"""Permittivity as laboratories have it: three films of 300 um, a checked LCR meter, 10 Hz."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.random import Generator

from deamat.core.arrays import FloatArray
from deamat.estimators.dielectric.edge_field import vacuum_capacitance
from deamat.twin.part import SYNTHETIC
from deamat.twin.situations.situation import MATERIAL, Made, Situation
from deamat.twin.writers import lcr6000_log, register_csv

_SPECIMENS = 3
_THICKNESS_m, _THICKNESS_SD_m, _READING_m = 300e-6, 6e-6, 1e-6
_PLATE_m = 45e-3
_PERMITTIVITY, _SCATTER, _LOSS = 2.7, 0.01, 0.012
_NOISE, _NOISE_OF_LOSS = 2e-4, 1e-4
_DISPERSION = 0.004  # fall of the permittivity per decade
_FREQUENCY_Hz = np.array([float(f"{10.0 ** (1.0 + k / 10.0):.6g}") for k in range(31)])


@dataclass(frozen=True, slots=True)
class _Sweep:
    """What the meter logged of one film, shape (n,) each, over its true permittivity and loss."""

    frequency_Hz: FloatArray
    permittivity: FloatArray
    loss: FloatArray


Distortion = Callable[[Generator, _Sweep, float], _Sweep]


def _film(rng: Generator) -> _Sweep:
    own = _PERMITTIVITY * (1.0 + rng.normal(0.0, _SCATTER))
    decades = np.log10(_FREQUENCY_Hz) - 1.0
    return _Sweep(_FREQUENCY_Hz, own * (1.0 - _DISPERSION * decades), _LOSS * (1.0 - 0.1 * decades))


def _made(key: str, distort: Distortion, rng: Generator, severity: float) -> Made:
    files: dict[str, bytes] = {}
    rows, truths, naive = [], [], []
    # in each material the same: where the meter changes its range, how the oven goes
    seed = int(rng.integers(2**31))
    for number in range(1, _SPECIMENS + 1):
        film = _film(rng)
        seen = distort(np.random.default_rng(seed), film, severity) if severity else film
        thickness = rng.normal(_THICKNESS_m, _THICKNESS_SD_m)
        read = thickness + rng.normal(0.0, _READING_m)
        vacuum = vacuum_capacitance(_PLATE_m**2, thickness)
        n = seen.frequency_Hz.size
        capacitance = vacuum * seen.permittivity * (1.0 + rng.normal(0.0, _NOISE, n))
        loss = seen.loss + rng.normal(0.0, _NOISE_OF_LOSS, n)
        name = f"{number}.log"
        files[name] = lcr6000_log(SYNTHETIC, "Cp-D", seen.frequency_Hz, capacitance, loss)
        rows.append(
            {
                "specimen": f"s{number}", "material": MATERIAL, "file": name,
                "thickness_um": f"{1e6 * read:.1f}", "micrometer_force_N": "0",
                "plate_length_mm": f"{1e3 * _PLATE_m:g}", "plate_width_mm": f"{1e3 * _PLATE_m:g}",
                "instrument": "LCR-6020 checked", "comment": SYNTHETIC,
            }
        )  # fmt: skip
        at = seen.frequency_Hz == seen.frequency_Hz.min()
        if key == "loss_tangent":
            truths.append(float(film.loss[0]))
            naive.append(float(loss[at].mean()))
        else:
            truths.append(float(film.permittivity[0]))
            naive.append(float(capacitance[at].mean() / vacuum_capacitance(_PLATE_m**2, read)))
    files["specimens.csv"] = register_csv(rows)
    return Made(files, float(np.mean(truths)), float(np.mean(naive)))


def _first_point(rng: Generator, film: _Sweep, off: float) -> _Sweep:
    """One or two points at the start read too much."""
    points = int(rng.integers(1, 3))
    factor = np.ones(film.permittivity.size)
    factor[:points] += off
    return replace(film, permittivity=film.permittivity * factor)


def _range_step(rng: Generator, film: _Sweep, step: float) -> _Sweep:
    """Below a frequency between 20 and 1000 Hz the meter reads more."""
    edge = 10.0 ** rng.uniform(1.3, 3.0)
    factor = np.where(film.frequency_Hz < edge, 1.0 + step, 1.0)
    return replace(film, permittivity=film.permittivity * factor)


def _polarised(rng: Generator, film: _Sweep, height: float) -> _Sweep:
    s = rng.uniform(0.8, 1.6)
    rise = height * (film.frequency_Hz / 10.0) ** -s
    lost = film.loss + rise * min(abs(math.tan(0.5 * math.pi * s)), 0.5)
    return replace(film, permittivity=film.permittivity * (1.0 + rise), loss=lost)


def _sweeps(rng: Generator, film: _Sweep, shift: float) -> _Sweep:
    """From two to six sweeps follow each other, up or up and down; their mean is off by `shift`."""
    count = int(rng.integers(2, 7))
    there_and_back = bool(rng.integers(2))
    last = -2.0 * shift
    parts = []
    for k in range(count):
        turn = slice(None, None, -1 if there_and_back and k % 2 else 1)
        parts.append((film.frequency_Hz[turn], film.permittivity[turn]
                      * (1.0 + last * k / (count - 1)), film.loss[turn]))  # fmt: skip
    return _Sweep(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def _repeats(rng: Generator, film: _Sweep, shift: float) -> _Sweep:
    """Each frequency is read several times while the reading creeps; the mean is off by `shift`."""
    count = int(rng.integers(2, 6))
    creep = 1.0 + 2.0 * shift * np.arange(count) / (count - 1)
    return _Sweep(
        np.repeat(film.frequency_Hz, count),
        (film.permittivity[:, None] * creep).ravel(),
        np.repeat(film.loss, count),
    )


def _wild_loss(rng: Generator, film: _Sweep, off: float) -> _Sweep:
    """The loss at the first frequency is another number, larger by `off`."""
    loss = film.loss.copy()
    loss[: int(rng.integers(1, 3))] += off
    return replace(film, loss=loss)


_EPS = "relative_permittivity"


def _situation(
    name: str,
    told: str,
    answer: str,
    causes: tuple[str, ...],
    severity: str,
    severities: tuple[float, ...],
    distort: Distortion,
    key: str = _EPS,
) -> Situation:
    make = partial(_made, key, distort)
    return Situation(name, "permittivity", key, told, answer, causes, severity, severities, make)


SITUATIONS = (
    _situation(
        "permittivity-first-point",
        "The first one or two points of the sweep, 10 Hz among them, were read before the meter "
        "had settled.",
        "One point is left out and read from its neighbours, with a wider interval; two are taken "
        "for a step.",
        ("outlying-point", "range-step"), "off, fraction", (0.03, 0.1, 0.3), _first_point,
    ),
    _situation(
        "permittivity-range-step",
        "The meter changes its range during the sweep, and one of the ranges is off.",
        "The value lies half-way between both sides, and its interval holds both; beyond 10 % it "
        "is refused.",
        ("range-step", "outlying-point"), "step, fraction", (0.03, 0.1, 0.3), _range_step,
    ),
    _situation(
        "permittivity-polarisation",
        "Ions in the film polarise the electrodes: capacitance and loss rise together towards low "
        "frequency.",
        "Flagged and in the interval up to 5 %; beyond, the value is that at the lowest stated "
        "frequency that is free of it.",
        ("electrode-polarisation",), "rise at 10 Hz, fraction", (0.03, 0.1, 0.3), _polarised,
    ),
    _situation(
        "permittivity-sweeps",
        "Several sweeps stand in one file: an oven that warms up, or up and down.",
        "The first sweep, with the drift in its interval; refused beyond 5 %.",
        ("several-sweeps",), "mean of the sweeps off, fraction", (0.03, 0.1, 0.3), _sweeps,
    ),
    _situation(
        "permittivity-repeats",
        "Each frequency is read several times, and the readings creep.",
        "The drift is in the interval; refused beyond 5 %.",
        ("drifting-repeats",), "mean of the readings off, fraction", (0.005, 0.03, 0.1), _repeats,
    ),
    _situation(
        "permittivity-wild-loss",
        "One loss, at the first frequency, is another number.",
        "Left out and read from its neighbours; refused where two points are off.",
        ("outlying-point",), "off, absolute", (0.004, 0.03, 0.7), _wild_loss, "loss_tangent",
    ),
)  # fmt: skip
