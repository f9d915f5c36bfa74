"""Simulated compression of cylinders between plates (ASTM D575) at 12 mm/min on a 5 kg cell.

What is simulated: cylinders of 28.2 mm (sd 0.28) by 12.1 mm (sd 0.8); moduli that scatter by 3 %
between specimens; soft contact over the first 0.5-1 % strain; a preload of 10-60 mN that nobody
zeroed; 50 Hz sampling to 30 % strain or to 49 N, whichever comes first; a cell with 5 mN steps and
6 mN of filtered noise; travel in steps of 1 um; caliper readings; one calibration error of cell,
crosshead and caliper for the whole campaign.
What is not: friction and barrelling beyond what the apparent modulus holds, creep, compliance of
the machine, or a crosshead that takes a moment to reach its speed (samples that crowd at the start
would weigh the toe more, and a plain slope would no longer be the modulus that is true).

Source: geometry, speed and cell from Sikulskyi et al. 2022, section 3.3; toe and noise by
comparison with real curves of soft cylinders.
"""

from __future__ import annotations

import math
from dataclasses import replace
from datetime import date, datetime, time, timedelta
from functools import cache, partial

import numpy as np

from deamat.core.properties import REFERENCE_AGE
from deamat.core.quantity import Quantity
from deamat.core.units import from_si
from deamat.twin.curves import compensated_slope, compressive_stress
from deamat.twin.draws import (
    cell_noise,
    draw_calibration,
    draw_factors,
    on_grid,
    read_caliper,
    stream,
)
from deamat.twin.part import SYNTHETIC, Part, SimulatedTest
from deamat.twin.truth import AGED, TrueValue, materials, true_value, truth_table
from deamat.twin.writers import chatillon_log, register_csv

TECHNIQUE = "compression"
SPECIMENS = 5
AGES = {REFERENCE_AGE: date(2022, 1, 18), AGED: date(2022, 3, 14)}
CURED_ON = date(2022, 1, 10)
FACTOR_SD = {"compressive_modulus": 0.03}
COMPENSATED = "compressive_modulus_toe_compensated"

_DIAMETER_M, _DIAMETER_SD_M = 28.2e-3, 0.28e-3
_HEIGHT_M, _HEIGHT_SD_M = 12.1e-3, 0.8e-3
_SPEED_M_PER_S = 12e-3 / 60.0
_SAMPLING_HZ, _LAST_STRAIN = 50.0, 0.30
_CELL_LIMIT_N, _CELL_STEP_MN, _CELL_NOISE_N, _CELL_MEMORY_S = 49.0, 5.0, 6e-3, 0.02
_PRELOAD_N = (0.01, 0.06)
_TOE = (0.0015, 0.004)


def simulate_compression(seed: int, material: str, age: str, number: int) -> SimulatedTest:
    """Simulate one compression test in memory.

    Parameters
    ----------
    seed : of the campaign
    material, age : as in the truth table
    number : of the specimen, from 1

    Raises
    ------
    MissingProperty : the truth table does not hold this material at this age
    ConfigError : the seed is negative
    """
    modulus = true_value("compressive_modulus", material, age).value
    errors = draw_calibration(seed, TECHNIQUE)
    rng = stream(seed, TECHNIQUE, material, age, str(number))
    diameter_m = rng.normal(_DIAMETER_M, _DIAMETER_SD_M)
    height_m = rng.normal(_HEIGHT_M, _HEIGHT_SD_M)
    modulus *= draw_factors(rng, FACTOR_SD)["compressive_modulus"]
    toe, preload_N = rng.uniform(*_TOE), rng.uniform(*_PRELOAD_N)
    numbers = {
        "diameter_m": read_caliper(rng, diameter_m, errors),
        "height_m": read_caliper(rng, height_m, errors),
        "speed_m_per_s": Quantity(_SPEED_M_PER_S, "m/s"),
    }
    duration_s = _LAST_STRAIN * height_m / _SPEED_M_PER_S
    time_s = np.arange(math.ceil(duration_s * _SAMPLING_HZ)) / _SAMPLING_HZ
    travel_m = _SPEED_M_PER_S * time_s
    force_N = compressive_stress(travel_m / height_m, modulus, toe) * math.pi / 4.0 * diameter_m**2
    force_N = (1.0 + errors.force) * (force_N + preload_N)
    force_N = force_N + cell_noise(rng, time_s, _CELL_NOISE_N, _CELL_MEMORY_S)
    force_N = on_grid(force_N, 3, _CELL_STEP_MN)
    over = np.flatnonzero(force_N > _CELL_LIMIT_N)
    end = int(over[0]) if over.size else time_s.size
    return SimulatedTest(
        specimen=f"c-{material}-{_slug(age)}-{number}",
        material=material,
        age=age,
        numbers=numbers,
        time_s=time_s[:end],
        displacement_m=on_grid((1.0 + errors.displacement) * travel_m, 6)[:end],
        force_N=force_N[:end],
        truth={
            "compressive_modulus": modulus,
            "diameter_m": diameter_m,
            "height_m": height_m,
            "toe": toe,
            "preload_N": preload_N,
        },
    )


def compression_part(seed: int) -> Part:
    """Simulate the compression tests of all materials, fresh and aged, as files with a register."""
    contents: dict[str, bytes] = {}
    rows: list[dict[str, str]] = []
    specimens = {}
    for age, day in AGES.items():
        started = datetime.combine(day, time(9, 0))
        for material in materials():
            for number in range(1, SPECIMENS + 1):
                test = simulate_compression(seed, material, age, number)
                file = f"{material}/synthetic-{_slug(age)}-{number}.txt"
                contents[f"{TECHNIQUE}/{file}"] = chatillon_log(
                    started, test.force_N, test.displacement_m, test.time_s
                )
                rows.append(_row(test, file, day))
                specimens[test.specimen] = test.truth
                started += timedelta(minutes=6)
    contents[f"{TECHNIQUE}/specimens.csv"] = register_csv(rows)
    return Part(
        TECHNIQUE, contents, compression_truth(), draw_calibration(seed, TECHNIQUE), specimens
    )


def compression_truth() -> tuple[TrueValue, ...]:
    """List the modulus of every material at every age, and the one that its toe hides."""
    plain = tuple(entry for entry in truth_table() if entry.key in FACTOR_SD)
    return plain + tuple(
        replace(entry, key=COMPENSATED, value=_without_toe() * entry.value) for entry in plain
    )


@cache
def _without_toe() -> float:
    """Return the toe-compensated slope of a modulus of 1, averaged over the toes that are drawn."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    low, high = _TOE
    toes = low + 0.5 * (high - low) * (nodes + 1.0)
    slopes = [compensated_slope(partial(compressive_stress, modulus_Pa=1.0, toe=a)) for a in toes]
    return float(0.5 * weights @ slopes)


def _row(test: SimulatedTest, file: str, tested_on: date) -> dict[str, str]:
    diameter = test.numbers["diameter_m"]
    return {
        "specimen": test.specimen,
        "material": test.material,
        "file": file,
        "diameter_mm": f"{from_si(diameter.value, 'mm'):.2f}",
        "u_diameter_mm": f"{from_si(diameter.u_independent, 'mm'):.3f}",
        "height_mm": f"{from_si(test.numbers['height_m'].value, 'mm'):.2f}",
        "speed_mm_per_min": f"{from_si(_SPEED_M_PER_S, 'mm/min'):.0f}",
        "age": test.age,
        "cure": "2 h at 90 C",
        "cured_on": CURED_ON.isoformat(),
        "tested_on": tested_on.isoformat(),
        "temperature_C": "22",
        "humidity_percent": "52",
        "instrument": "simulated AMETEK CS225, 5 kg cell",
        "comment": SYNTHETIC,
    }


def _slug(age: str) -> str:
    return age.replace(" ", "-")
