"""Simulated nanoindentation of small cylinders with a transducer of 5 um travel.

What is simulated: cylinders 5 mm high; a flat tip of 50 um radius on Sylgard 184 and a sphere of
150 um on the others, on purpose, so that both laws are used; moduli that scatter by 4 % between
specimens; approach from 1 um above the surface and back at 0.4 um/s, 2 s at the peak, 30 Hz; a
surface that is not where the depth reads zero; 0.1 uN and 1 nm of noise, an offset, and springs of
the transducer that are compensated to 0.3 N/m; one error of load, depth, each tip's radius and
Poisson's ratio for the whole campaign.
What is not: adhesion (of several uN for such a sphere on real silicone), creep, drift, friction,
roughness, tips that stand askew.

The paper says that 100 uN were applied to the 10:1 mixtures and 50 uN to 20:1, and that higher
ratios were too soft. Here 50 uN are asked of 30:1 and 40:1, and the travel ends before: these files
are written too. The paper prints no modulus: the true one is the twin's own (see `truth.toml`).

Source: loads and materials from Sikulskyi et al. 2022, section 3.3; noise and form by comparison
with a real export; tips and travel declared.
"""

from __future__ import annotations

import math
from datetime import date, datetime, time, timedelta

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.properties import REFERENCE_AGE, property_key
from deamat.core.quantity import Quantity
from deamat.core.units import from_si
from deamat.twin.draws import (
    cell_noise,
    draw_calibration,
    draw_factors,
    on_grid,
    read_caliper,
    stream,
)
from deamat.twin.part import SYNTHETIC, Part, SimulatedTest
from deamat.twin.truth import TrueValue, document, materials, true_value
from deamat.twin.writers import hysitron_text, register_csv

TECHNIQUE = "nanoindentation"
MODULUS = "indentation_modulus"
SPECIMENS, TOO_SOFT_SPECIMENS = 5, 3
CURED_ON, TESTED_ON = date(2022, 1, 10), date(2022, 1, 20)
FACTOR_SD = {MODULUS: 0.04}
TIPS = {"flat": 50e-6, "spherical": 150e-6}
U_TIP_RADIUS_M = 5e-7
POISSON_RATIO, U_POISSON_RATIO = 0.49, 0.005
TOO_SOFT = ("sylgard-182-30to1", "sylgard-182-40to1")

_PEAK_LOAD_N = {"10to1": 100e-6, "20to1": 50e-6, "30to1": 50e-6, "40to1": 50e-6}
_TRAVEL_M = 5e-6
_LIFT_M, _SURFACE_M = 1e-6, 2e-7
_HEIGHT_M, _HEIGHT_SD_M = 5e-3, 2e-4
_SPEED_M_PER_S, _HOLD_S, _SAMPLING_HZ = 0.4e-6, 2.0, 30.0
_LOAD_NOISE_N, _LOAD_MEMORY_S, _DEPTH_NOISE_M = 1e-7, 0.01, 1e-9
_OFFSET_N, _TILT_N_PER_M = 5e-7, 0.3


def true_modulus(material: str) -> TrueValue:
    """Return the twin's own indentation modulus: the compressive one, stiffened by a factor.

    Raises
    ------
    MissingProperty : the truth table does not hold this material
    """
    compressive = true_value("compressive_modulus", material)
    value = document()["indentation"]["stiffening"] * compressive.value
    return TrueValue(MODULUS, material, REFERENCE_AGE, value, property_key(MODULUS).unit)


def tip_of(material: str) -> str:
    """Name the tip that a material is indented with."""
    return "flat" if "-184-" in material else "spherical"


def specimens_of(material: str) -> int:
    """Count the specimens of a material: fewer where it was seen to be too soft."""
    return TOO_SOFT_SPECIMENS if material in TOO_SOFT else SPECIMENS


def simulate_nanoindentation(seed: int, material: str, number: int) -> SimulatedTest:
    """Simulate one indentation in memory; its displacement is the depth.

    Parameters
    ----------
    seed : of the campaign
    material : as in the truth table
    number : of the specimen, from 1

    Raises
    ------
    MissingProperty : the truth table does not hold this material
    ConfigError : the seed is negative
    """
    errors = draw_calibration(seed, TECHNIQUE)
    tip = tip_of(material)
    radius_m = TIPS[tip] + stream(seed, "calibration", "tip", tip).normal(0.0, U_TIP_RADIUS_M)
    poisson = POISSON_RATIO + stream(seed, "calibration", "poisson").normal(0.0, U_POISSON_RATIO)
    rng = stream(seed, TECHNIQUE, material, REFERENCE_AGE, str(number))
    modulus = true_modulus(material).value * draw_factors(rng, FACTOR_SD)[MODULUS]
    height_m = rng.normal(_HEIGHT_M, _HEIGHT_SD_M)
    surface_m = rng.uniform(-_SURFACE_M, _SURFACE_M)
    offset_N, tilt = rng.normal(0.0, _OFFSET_N), rng.normal(0.0, _TILT_N_PER_M)
    reduced = modulus / (1.0 - min(poisson, 0.5) ** 2)
    exponent, stiffness = _law(tip, radius_m, reduced)
    asked_N = _PEAK_LOAD_N[material.rpartition("-")[2]]
    deepest_m = min(surface_m + (asked_N / stiffness) ** (1.0 / exponent), _TRAVEL_M)
    depth_m = np.concatenate(_path(deepest_m))
    time_s = np.arange(depth_m.size) / _SAMPLING_HZ
    force_N = stiffness * np.maximum(depth_m - surface_m, 0.0) ** exponent
    force_N += offset_N + tilt * depth_m + cell_noise(rng, time_s, _LOAD_NOISE_N, _LOAD_MEMORY_S)
    depth_m = depth_m + rng.normal(0.0, _DEPTH_NOISE_M, depth_m.size)
    return SimulatedTest(
        specimen=f"n-{material}-{number}",
        material=material,
        age=REFERENCE_AGE,
        numbers={
            "tip_radius_m": Quantity(TIPS[tip], "m", 0.0, U_TIP_RADIUS_M),
            "height_m": read_caliper(rng, height_m, errors),
            "peak_load_N": Quantity(asked_N, "N"),
        },
        time_s=time_s,
        displacement_m=on_grid((1.0 + errors.displacement) * depth_m, 15),
        force_N=on_grid((1.0 + errors.force) * force_N, 12),
        truth={
            MODULUS: modulus,
            "surface_m": surface_m,
            "tip_radius_m": radius_m,
            "poisson_ratio": min(poisson, 0.5),
        },
    )


def _law(tip: str, radius_m: float, reduced_Pa: float) -> tuple[float, float]:
    """Exponent m and stiffness K of `P = K h^m`."""
    if tip == "flat":
        return 1.0, 2.0 * radius_m * reduced_Pa
    return 1.5, 4.0 / 3.0 * math.sqrt(radius_m) * reduced_Pa


def _path(deepest_m: float) -> list[FloatArray]:
    """Depths of approach, hold and way back, one array each."""
    down = math.ceil((deepest_m + _LIFT_M) / _SPEED_M_PER_S * _SAMPLING_HZ)
    way = np.linspace(-_LIFT_M, deepest_m, down + 1)
    return [way, np.full(int(_HOLD_S * _SAMPLING_HZ), deepest_m), way[-2::-1]]


def nanoindentation_part(seed: int) -> Part:
    """Simulate the indentations of all materials as files with a register."""
    contents: dict[str, bytes] = {}
    rows: list[dict[str, str]] = []
    specimens = {}
    started = datetime.combine(TESTED_ON, time(9, 0))
    for material in materials():
        for number in range(1, specimens_of(material) + 1):
            test = simulate_nanoindentation(seed, material, number)
            file = f"{material}/synthetic-{number}.txt"
            down = int(test.displacement_m.size - _HOLD_S * _SAMPLING_HZ + 1) // 2
            segments = (down, test.displacement_m.size - 2 * down + 1, down - 1)
            contents[f"{TECHNIQUE}/{file}"] = hysitron_text(
                started, segments, test.displacement_m, test.force_N, test.time_s
            )
            rows.append(_row(test, file))
            specimens[test.specimen] = test.truth
            started += timedelta(minutes=4)
    contents[f"{TECHNIQUE}/specimens.csv"] = register_csv(rows)
    truth = tuple(true_modulus(material) for material in materials())
    return Part(TECHNIQUE, contents, truth, draw_calibration(seed, TECHNIQUE), specimens)


def _row(test: SimulatedTest, file: str) -> dict[str, str]:
    return {
        "specimen": test.specimen,
        "material": test.material,
        "file": file,
        "tip": tip_of(test.material),
        "tip_radius_um": f"{from_si(test.numbers['tip_radius_m'].value, 'um'):g}",
        "height_um": f"{from_si(test.numbers['height_m'].value, 'um'):.0f}",
        "peak_load_uN": f"{from_si(test.numbers['peak_load_N'].value, 'uN'):g}",
        "age": test.age,
        "cure": "2 h at 90 C",
        "cured_on": CURED_ON.isoformat(),
        "tested_on": TESTED_ON.isoformat(),
        "temperature_C": "22",
        "humidity_percent": "52",
        "instrument": "simulated Hysitron TI 980",
        "comment": SYNTHETIC,
    }
