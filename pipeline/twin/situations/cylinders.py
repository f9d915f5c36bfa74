"""Cylinders between plates: what situations of compression, conditions and registers begin with.

Soft cylinders of 28.2 mm by 12.1 mm (standard deviations 0.28 and 0.8 mm), 12 mm/min to 12 %
strain, logged at 25 Hz; moduli of 300 kPa that scatter by 3 % between specimens.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from deamat.core.arrays import FloatArray
from deamat.twin.curves import COMPRESSION_WINDOW, compressive_stress
from deamat.twin.part import SYNTHETIC
from deamat.twin.situations.situation import MATERIAL, Made
from deamat.twin.writers import bluehill_csv, register_csv

SPECIMENS = 5
MODULUS = "compressive_modulus"
MODULUS_Pa = 300e3
SPEED_mm_per_min = 12.0
_SCATTER = 0.03
_DIAMETER_m, _DIAMETER_SD_m = 28.2e-3, 0.28e-3
_HEIGHT_m, _HEIGHT_SD_m = 12.1e-3, 0.8e-3
_READING_m = 20e-6
_NOISE_N = 0.01
_TOE, _LAST_STRAIN, _SAMPLING_Hz = 1e-4, 0.12, 25.0


@dataclass(frozen=True, slots=True)
class Cylinder:
    """What one machine recorded of one cylinder, and what is true of it.

    Parameters
    ----------
    modulus_Pa, diameter_m, height_m : true
    read_diameter_m, read_height_m : by a caliper
    time_s, travel_m, force_N : as recorded, shape (n,)
    """

    modulus_Pa: float
    diameter_m: float
    height_m: float
    read_diameter_m: float
    read_height_m: float
    time_s: FloatArray
    travel_m: FloatArray
    force_N: FloatArray

    @property
    def area_m2(self) -> float:
        """Area of its section."""
        return 0.25 * math.pi * self.diameter_m**2


def cylinder(
    rng: Generator, modulus_Pa: float = MODULUS_Pa, height_m: float | None = None
) -> Cylinder:
    """Compress a cylinder.

    Parameters
    ----------
    modulus_Pa : of its material
    height_m : where it is not the usual one
    """
    own = modulus_Pa * (1.0 + rng.normal(0.0, _SCATTER))
    diameter = rng.normal(_DIAMETER_m, _DIAMETER_SD_m)
    height = rng.normal(_HEIGHT_m, _HEIGHT_SD_m)
    height = height if height_m is None else height_m
    last_s = _LAST_STRAIN * height / (SPEED_mm_per_min * 1e-3 / 60.0)
    time = np.arange(0.0, last_s, 1.0 / _SAMPLING_Hz)
    travel = SPEED_mm_per_min * 1e-3 / 60.0 * time
    force = 0.25 * math.pi * diameter**2 * compressive_stress(travel / height, own, _TOE)
    force = force + rng.normal(0.0, _NOISE_N, force.size)
    read = (diameter + rng.normal(0.0, _READING_m), height + rng.normal(0.0, _READING_m))
    return Cylinder(own, diameter, height, *read, time, travel, force)


def row(one: Cylinder, number: int) -> dict[str, str]:
    """Write the row of a register."""
    return {
        "specimen": f"cyl-{number}", "material": MATERIAL, "file": f"{number}.csv",
        "diameter_mm": f"{1e3 * one.read_diameter_m:.2f}",
        "height_mm": f"{1e3 * one.read_height_m:.2f}", "comment": SYNTHETIC,
    }  # fmt: skip


def log(one: Cylinder, *header: tuple[str, str, str]) -> bytes:
    """Write the export of a machine, with further lines in its header."""
    remark = ("General : Comment", SYNTHETIC, "")
    return bluehill_csv((remark, *header), one.time_s, one.travel_m, one.force_N)


def table(one: Cylinder, factor: float, load_unit: str) -> bytes:
    """Write a plain table with a stress of its own, `factor` times force over area.

    Parameters
    ----------
    load_unit : which the label of the load names, over numbers that are newtons
    """
    stress_kPa = 1e-3 * factor * one.force_N / one.area_m2
    label = f"time_s,displacement_mm,force_{load_unit},stress_kPa"
    columns = (one.time_s, 1e3 * one.travel_m, one.force_N, stress_kPa)
    rows = zip(*(column.tolist() for column in columns), strict=True)
    body = [f"{t:.2f},{x:.4f},{f:.4f},{s:.4f}" for t, x, f, s in rows]
    return "".join(f"{line}\n" for line in (f"# {SYNTHETIC}", label, *body)).encode()


def naive_modulus(one: Cylinder, cells: Mapping[str, str]) -> float:
    """Return what a short script says: the slope over 5 % of a row's height and area `[Pa]`."""
    diameter, height = 1e-3 * float(cells["diameter_mm"]), 1e-3 * float(cells["height_mm"])
    strain = one.travel_m / height
    inside = strain <= COMPRESSION_WINDOW
    if inside.sum() < 3:
        return math.nan
    slope = float(np.polyfit(strain[inside], one.force_N[inside], 1)[0])
    return slope / (0.25 * math.pi * diameter**2)


def made(
    cylinders: Sequence[Cylinder],
    rows: Sequence[Mapping[str, str]],
    files: Mapping[str, bytes],
    naive: Sequence[float],
) -> Made:
    """Hand over a register with its files; the truth is the mean over the cylinders."""
    truth = math.fsum(one.modulus_Pa for one in cylinders) / len(cylinders)
    said = math.fsum(naive) / len(naive)
    return Made({**files, "specimens.csv": register_csv(rows)}, truth, said)
