"""Samples for the Weibull tests: two published ones, the reference files, and simulated ones."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from mpmath import findroot, log, mp, mpf

from deamat.core.arrays import FloatArray
from deamat.estimators.weibull.sample import BoolArray

# Lawless, Statistical Models and Methods for Lifetime Data, example 4.3: voltage levels at which
# specimens of two cable insulations failed, kV/mm. Maximum likelihood as published there.
# fmt: off
CABLE_I = np.array([
    32, 35.4, 36.2, 39.8, 41.2, 43.3, 45.5, 46, 46.2, 46.4,
    46.5, 46.8, 47.3, 47.3, 47.6, 49.2, 50.4, 50.9, 52.4, 56.3,
])
CABLE_II = np.array([
    39.4, 45.3, 49.2, 49.4, 51.3, 52, 53.2, 53.2, 54.9, 55.5,
    57.1, 57.2, 57.5, 59.2, 61, 62.4, 63.8, 64.3, 67.3, 67.7,
])
# fmt: on

NAMES = (
    "automotive_krivtsov",
    "glass_capacitor_170C_200V",
    "glass_fibre_smith_naylor",
    "insulating_fluid_26kV_n3",
    "insulating_fluid_30kV",
    "insulating_fluid_34kV",
    "lawless_cable_type1",
    "lieblein_zelen_bearings",
    "mylar_polyurethane_100.3kVmm",
    "mylar_polyurethane_122.4kVmm",
    "mylar_polyurethane_219.0kVmm",
    "nist_handbook_8_2_2_1",
    "pet_film_hirose1993_10kV",
    "pet_film_hirose1993_5kV",
    "r_survreg_n8",
    "shock_absorber",
)


@dataclass(frozen=True, slots=True)
class Expected:
    quantity: str
    value: float
    rel_tol: float
    kind: str


@dataclass(frozen=True, slots=True)
class OpenSample:
    x: FloatArray
    censored: BoolArray
    expected: tuple[Expected, ...]

    def by_r(self, quantity: str) -> float:
        (found,) = (
            e.value
            for e in self.expected
            if e.quantity == quantity and e.kind == "independent software" and e.rel_tol == 1e-6
        )
        return found


def open_sample(shared: Path, name: str) -> OpenSample:
    folder = shared / "reference" / "weibull" / "open"
    lines = (folder / f"{name}.csv").read_text().splitlines()
    rows = [line.split(",") for line in lines if line[0] not in "#v"]
    x = [float(value) for value, _, count in rows for _ in range(int(count))]
    censored = [status == "0" for _, status, count in rows for _ in range(int(count))]
    with (folder / "expected.csv").open(newline="") as file:
        expected = tuple(
            Expected(row["quantity"], float(row["value"]), float(row["rel_tol"]), row["kind"])
            for row in csv.DictReader(file)
            if row["dataset"] == name
        )
    return OpenSample(np.array(x), np.array(censored), expected)


def oracle(x: FloatArray, censored: BoolArray, near: float) -> tuple[mpf, mpf]:
    """Scale and shape by 40-digit arithmetic, from the root next to a first guess."""
    with mp.workdps(40):
        values = [mpf(float(v)) for v in x]
        logs = [log(v) for v in values]
        failures = [z for z, c in zip(logs, censored, strict=True) if not c]
        mean = sum(failures) / len(failures)
        largest = max(logs)

        def excess(k: mpf) -> mpf:
            powers = [mp.exp(k * (z - largest)) for z in logs]
            weighted = sum(z * p for z, p in zip(logs, powers, strict=True))
            return weighted / sum(powers) - mean - 1 / k

        shape = findroot(excess, mpf(near))
        total = sum(mp.exp(shape * (z - largest)) for z in logs)
        return mp.exp(largest) * (total / len(failures)) ** (1 / shape), shape


def simulated(
    n: int, m: int, seed: int, shape: float = 8.0, stop_at: int | None = None
) -> tuple[FloatArray, BoolArray]:
    """Draw m samples of n with scale 97; `stop_at` ends each test at that failure (type II)."""
    x = 97.0 * np.random.default_rng(seed).weibull(shape, (m, n))
    if stop_at is None:
        return x, np.zeros(x.shape, dtype=np.bool_)
    limit = np.sort(x, axis=1)[:, stop_at - 1 : stop_at]
    return np.minimum(x, limit), x > limit
