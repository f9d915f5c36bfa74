"""Simulated tension of dogbones (ASTM D412 die D) to break at 40 mm/min on a 1 kg cell.

What is simulated: narrow sections of 3 mm (sd 0.02) by 300 um (sd 6), gauge length 33 mm (sd 0.2);
scatter between specimens of 4 % in modulus, 8 % in strength and 6 % in elongation; 0.1-0.3 mN of
film that nobody tared; 100 Hz to 5 % strain, then 2 Hz,
then 100 Hz again around the break, with five samples near zero after it; gauge readings; one
calibration error of cell, crosshead and gauges for the whole campaign.
What is not: slip in the grips, slack, viscoelasticity, compliance of the machine.

The cell shows 0.01 mN and has 0.04 mN of filtered noise. That is better than most 1 kg cells
promise (0.1-1 mN), and on purpose: at 1 % strain the softest film (40:1) pulls with 0.2 mN, so that
a cell with 1 mN of noise could not have told the sign of the modulus that the paper prints. As it
is, one specimen of 40:1 gives its 0-1 % slope to about 15 %, one of 10:1 to 0.3 %.

Source: geometry, speed and cell from Sikulskyi et al. 2022, section 3.3. There the same machine did
both tests; here tension is written in another maker's form, so that both forms are used.
"""

from __future__ import annotations

import math
from datetime import date

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.properties import REFERENCE_AGE
from deamat.core.quantity import Quantity
from deamat.core.units import from_si
from deamat.twin.curves import LINEAR_TO, tensile_stress
from deamat.twin.draws import (
    cell_noise,
    draw_calibration,
    draw_factors,
    on_grid,
    read_caliper,
    read_micrometer,
    stream,
)
from deamat.twin.part import SYNTHETIC, Part, SimulatedTest
from deamat.twin.truth import materials, true_value, truth_table
from deamat.twin.writers import bluehill_csv, register_csv

TECHNIQUE = "tension"
SPECIMENS = 5
CURED_ON, TESTED_ON = date(2022, 1, 10), date(2022, 1, 19)
FACTOR_SD = {"tensile_modulus": 0.04, "tensile_strength": 0.08, "elongation_at_break": 0.06}

_WIDTH_M, _WIDTH_SD_M = 3.0e-3, 2e-5
_THICKNESS_M, _THICKNESS_SD_M = 300e-6, 6e-6
_GAUGE_LENGTH_M, _GAUGE_LENGTH_SD_M = 33e-3, 2e-4
_SPEED_M_PER_S = 40e-3 / 60.0
_SCAN_HZ, _SLOW_EVERY, _AROUND_BREAK, _AFTER_BREAK = 100, 50, 10, 5
_CELL_NOISE_N, _CELL_MEMORY_S = 4e-5, 0.01
_TARE_N = (1e-4, 3e-4)


def simulate_tension(seed: int, material: str, number: int) -> SimulatedTest:
    """Simulate one tension test to break in memory.

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
    rng = stream(seed, TECHNIQUE, material, REFERENCE_AGE, str(number))
    width_m = rng.normal(_WIDTH_M, _WIDTH_SD_M)
    thickness_m = rng.normal(_THICKNESS_M, _THICKNESS_SD_M)
    gauge_length_m = rng.normal(_GAUGE_LENGTH_M, _GAUGE_LENGTH_SD_M)
    factors = draw_factors(rng, FACTOR_SD)
    own = {key: factor * true_value(key, material).value for key, factor in factors.items()}
    tare_N = rng.uniform(*_TARE_N)
    numbers = {
        "width_m": read_caliper(rng, width_m, errors),
        "thickness_m": read_micrometer(rng, thickness_m, errors),
        "gauge_length_m": read_caliper(rng, gauge_length_m, errors),
        "speed_m_per_s": Quantity(_SPEED_M_PER_S, "m/s"),
    }
    elongation = own["elongation_at_break"]
    time_s, whole = _sampling(elongation * gauge_length_m / _SPEED_M_PER_S)
    travel_m = _SPEED_M_PER_S * time_s
    force_N = np.zeros_like(time_s)
    force_N[:whole] = (width_m * thickness_m) * tensile_stress(
        travel_m[:whole] / gauge_length_m,
        own["tensile_modulus"],
        own["tensile_strength"],
        elongation,
    )
    force_N = (1.0 + errors.force) * (force_N + tare_N)
    force_N += cell_noise(rng, time_s, _CELL_NOISE_N, _CELL_MEMORY_S)
    return SimulatedTest(
        specimen=f"t-{material}-{number}",
        material=material,
        age=REFERENCE_AGE,
        numbers=numbers,
        time_s=time_s,
        displacement_m=on_grid((1.0 + errors.displacement) * travel_m, 7),
        force_N=on_grid(force_N, 5),
        truth={
            **own,
            "width_m": width_m,
            "thickness_m": thickness_m,
            "gauge_length_m": gauge_length_m,
            "tare_N": tare_N,
        },
    )


def _sampling(break_s: float) -> tuple[FloatArray, int]:
    """Sampling times (n,) `[s]`, and how many of them lie before the break."""
    fast = math.ceil(LINEAR_TO * _GAUGE_LENGTH_M / _SPEED_M_PER_S * _SCAN_HZ)
    last = math.floor(break_s * _SCAN_HZ)
    slow = np.arange(fast, last, _SLOW_EVERY)
    around = np.arange(last - _AROUND_BREAK, last + 1)
    before = np.unique(np.concatenate([np.arange(fast), slow, around]))
    scans = np.concatenate([before, np.arange(last + 1, last + 1 + _AFTER_BREAK)])
    return scans / float(_SCAN_HZ), before.size


def tension_part(seed: int) -> Part:
    """Simulate the tension tests of all materials as files with a register."""
    contents: dict[str, bytes] = {}
    rows: list[dict[str, str]] = []
    specimens = {}
    for material in materials():
        for number in range(1, SPECIMENS + 1):
            test = simulate_tension(seed, material, number)
            row = _row(test, f"{material}/synthetic-{number}.csv")
            header = [
                ("General : Comment", SYNTHETIC, ""),
                ("General : Specimen label", test.specimen, ""),
                ("Test : Rate", row["speed_mm_per_min"], "mm/min"),
            ]
            contents[f"{TECHNIQUE}/{row['file']}"] = bluehill_csv(
                header, test.time_s, test.displacement_m, test.force_N
            )
            rows.append(row)
            specimens[test.specimen] = test.truth
    contents[f"{TECHNIQUE}/specimens.csv"] = register_csv(rows)
    truth = tuple(entry for entry in truth_table() if entry.key in FACTOR_SD)
    return Part(TECHNIQUE, contents, truth, draw_calibration(seed, TECHNIQUE), specimens)


def _row(test: SimulatedTest, file: str) -> dict[str, str]:
    return {
        "specimen": test.specimen,
        "material": test.material,
        "file": file,
        "width_mm": f"{from_si(test.numbers['width_m'].value, 'mm'):.2f}",
        "thickness_um": f"{from_si(test.numbers['thickness_m'].value, 'um'):.0f}",
        "gauge_length_mm": f"{from_si(test.numbers['gauge_length_m'].value, 'mm'):.2f}",
        "speed_mm_per_min": f"{from_si(_SPEED_M_PER_S, 'mm/min'):.0f}",
        "age": test.age,
        "cure": "2 h at 90 C",
        "cured_on": CURED_ON.isoformat(),
        "tested_on": TESTED_ON.isoformat(),
        "temperature_C": "22",
        "humidity_percent": "52",
        "instrument": "simulated AMETEK CS225, 1 kg cell",
        "comment": SYNTHETIC,
    }
