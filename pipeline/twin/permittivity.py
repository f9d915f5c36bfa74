r"""Simulated LCR sweeps of films between two plates of 45 x 45 mm, 10 Hz to 10 kHz at 1 V.

What is simulated: films of 300 um (sd 6) whose permittivity scatters by 1.5 %; a broad relaxation
about 15 Hz (Cole-Cole, 3 % strong), so that the permittivity falls a little over the sweep and the
loss has its peak at low frequency; 100 ohm in series; thickness read under a disk micrometer that
presses with 5 N on anvils of 30 mm, under which the film slips and gives way as a neo-Hookean solid
of its true compressive modulus; one error of that force, of the plates' size, of the gauges and of
the meter for the whole campaign; noise that grows towards low frequency; six displayed digits.
Materials are logged with different functions of the meter (Cp-D, Cs-D, R-X), one as a plain table.
What is not: edge field, air gaps, films that stick to the anvils, uneven thickness.

The simulated meter errs less than its maker promises, and on purpose: at 10 Hz a film has 100 Mohm,
for which such a meter promises 10 % (`LcrAccuracy`), more than anything else in the test. Real
sweeps of silicones are flat to a few percent, so real meters are better; here the meter counts as
checked against a reference capacitor, to 1 % at 100 Mohm, and `config/instruments.toml` says so.

Source: plates, films, force and meter from Sikulskyi et al. 2022, section 3.3; the anvil is assumed
(there a disk micrometer of unknown size).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from datetime import date

import numpy as np
from numpy.random import Generator

from deamat.core.arrays import FloatArray
from deamat.core.instruments import LcrAccuracy
from deamat.core.properties import REFERENCE_AGE
from deamat.core.quantity import Quantity
from deamat.core.units import from_si
from deamat.estimators.dielectric.edge_field import vacuum_capacitance
from deamat.estimators.dielectric.impedance import ComplexArray, impedance, loss_tangent, shown
from deamat.estimators.dielectric.squeeze import squeezed_stretch
from deamat.twin.draws import (
    Calibration,
    draw_calibration,
    draw_factors,
    read_caliper,
    read_micrometer,
    stream,
)
from deamat.twin.part import SYNTHETIC, Part
from deamat.twin.truth import TrueValue, materials, true_value, truth_table
from deamat.twin.writers import lcr6000_log, lcr_csv, register_csv

TECHNIQUE = "permittivity"
SPECIMENS = 5
CURED_ON, TESTED_ON = date(2022, 1, 10), date(2022, 1, 20)
FACTOR_SD = {"relative_permittivity": 0.015}
LOSS = "loss_tangent"
# As `config/instruments.toml` declares it for the checked meter, and as the room's default.
METER = LcrAccuracy(
    high_impedance_per_ohm=((150e3, 0.03e-9),),
    source="declared for the simulated meter: checked against a reference capacitor",
)
U_FORCE = 0.05
TABLE = "sylgard-186-10to1"  # written as a plain table of Cp and D
# What the meter was set to for the others.
FUNCTIONS = {
    "sylgard-184-10to1": "Cp-D",
    "sylgard-182-10to1": "Cp-D",
    "sylgard-182-20to1": "Cs-D",
    "sylgard-182-30to1": "R-X",
    "sylgard-182-40to1": "Cp-D",
}

_LEVEL_V = 1.0
_CARD_HZ = 10.0
_FREQUENCY_HZ = np.array([float(f"{10.0 ** (1.0 + k / 10.0):.6g}") for k in range(31)])
_THICKNESS_M, _THICKNESS_SD_M = 300e-6, 6e-6
_PLATE_M, _PLATE_SD_M = 45e-3, 2e-5
_FORCE_N, _ANVIL_M = 5.0, 30e-3
_RELAXATION, _RELAXATION_HZ, _BROADENING = 0.03, 15.0, 0.4
_SERIES_OHM = 100.0
_NOISE, _NOISE_HZ = 2e-5, 100.0
_LIMIT_TO_SIGMA = math.sqrt(3.0)


@dataclass(frozen=True, slots=True)
class LcrCalibration(Calibration):
    """The errors that all sweeps of one campaign have in common, beside those of the gauges.

    Parameters
    ----------
    capacitance, loss : of the meter, in its standard uncertainties at each point
    micrometer_force : relative
    plate_length_m, plate_width_m : true size of the plates
    """

    capacitance: float
    loss: float
    micrometer_force: float
    plate_length_m: float
    plate_width_m: float


@dataclass(frozen=True, slots=True)
class SimulatedSweep:
    """One simulated sweep, with the numbers that its file and its register row hold.

    Parameters
    ----------
    specimen, material, age : who was tested
    numbers : as measured and set, by SI name (`thickness_m`)
    frequency_Hz, capacitance_F : f and $C_p (1 - j D)$ as the meter saw them, shape (n,) each
    truth : what this very film is, by property key, and what distorts its recording
    """

    specimen: str
    material: str
    age: str
    numbers: Mapping[str, Quantity]
    frequency_Hz: FloatArray
    capacitance_F: ComplexArray
    truth: Mapping[str, float]


def draw_lcr_calibration(seed: int) -> LcrCalibration:
    """Draw the errors of meter, micrometer and plates of one campaign."""
    rng = stream(seed, "calibration", TECHNIQUE, "meter")
    return LcrCalibration(
        **asdict(draw_calibration(seed, TECHNIQUE)),
        capacitance=rng.normal(),
        loss=rng.normal(),
        micrometer_force=rng.normal(0.0, U_FORCE),
        plate_length_m=rng.normal(_PLATE_M, _PLATE_SD_M),
        plate_width_m=rng.normal(_PLATE_M, _PLATE_SD_M),
    )


def simulate_permittivity(
    seed: int, material: str, number: int, series_ohm: float = _SERIES_OHM
) -> SimulatedSweep:
    """Simulate one sweep in memory.

    Parameters
    ----------
    seed : of the campaign
    material : as in the truth table
    number : of the specimen, from 1
    series_ohm : resistance of electrodes and leads

    Raises
    ------
    MissingProperty : the truth table does not hold this material
    ConfigError : the seed is negative
    """
    errors = draw_lcr_calibration(seed)
    rng = stream(seed, TECHNIQUE, material, REFERENCE_AGE, str(number))
    thickness_m = rng.normal(_THICKNESS_M, _THICKNESS_SD_M)
    own = {
        key: factor * true_value(key, material).value
        for key, factor in draw_factors(rng, FACTOR_SD).items()
    }
    pressure_Pa = (1.0 + errors.micrometer_force) * _FORCE_N / (math.pi / 4.0 * _ANVIL_M**2)
    stretch = squeezed_stretch(pressure_Pa / true_value("compressive_modulus", material).value)
    vacuum_F = vacuum_capacitance(errors.plate_length_m * errors.plate_width_m, thickness_m)
    film_F = vacuum_F * complex_permittivity(own["relative_permittivity"], _FREQUENCY_HZ)
    true_F = film_F / (1.0 + 2j * math.pi * _FREQUENCY_HZ * series_ohm * film_F)
    at_card = complex_permittivity(own["relative_permittivity"], np.array([_CARD_HZ]))
    return SimulatedSweep(
        specimen=f"p-{material}-{number}",
        material=material,
        age=REFERENCE_AGE,
        numbers={
            "thickness_m": read_micrometer(rng, stretch * thickness_m, errors),
            "micrometer_force_N": Quantity(_FORCE_N, "N"),
            "anvil_diameter_m": Quantity(_ANVIL_M, "m"),
            **_plates(seed, errors),
        },
        frequency_Hz=_FREQUENCY_HZ,
        capacitance_F=_as_the_meter_sees(true_F, errors, rng),
        truth={
            **own,
            LOSS: float(loss_tangent(at_card)[0]),
            "thickness_m": thickness_m,
            "squeeze": 1.0 - stretch,
            "series_ohm": series_ohm,
        },
    )


def complex_permittivity(at_card: float, frequency_Hz: FloatArray) -> ComplexArray:
    r"""Cole-Cole relaxation, scaled to a given real part at 10 Hz.

    $\epsilon^* \propto 1 + \Delta / (1 + (j f / f_0)^{1 - \alpha})$

    Source: K. S. Cole, R. H. Cole, J. Chem. Phys. 9 (1941) 341.
    """
    f = np.append(_CARD_HZ, frequency_Hz)
    shape = 1.0 + _RELAXATION / (1.0 + (1j * f / _RELAXATION_HZ) ** (1.0 - _BROADENING))
    scaled: ComplexArray = at_card / shape[0].real * shape[1:]
    return scaled


def _plates(seed: int, errors: LcrCalibration) -> dict[str, Quantity]:
    """Length and width of the plates, measured once for the whole campaign."""
    rng = stream(seed, TECHNIQUE, "plates")
    return {
        "plate_length_m": read_caliper(rng, errors.plate_length_m, errors),
        "plate_width_m": read_caliper(rng, errors.plate_width_m, errors),
    }


def _as_the_meter_sees(
    true_F: ComplexArray, errors: LcrCalibration, rng: Generator
) -> ComplexArray:
    """Add the meter's own errors, as large as it declares them, and noise."""
    ohm = np.abs(impedance(_FREQUENCY_HZ, true_F))
    u = METER.limit(_FREQUENCY_HZ, ohm, _LEVEL_V, fast=False) / _LIMIT_TO_SIGMA
    noise = _NOISE * (1.0 + _NOISE_HZ / _FREQUENCY_HZ)
    relative = errors.capacitance * u + noise * rng.standard_normal(u.size)
    loss = loss_tangent(true_F) + errors.loss * u + noise * rng.standard_normal(u.size)
    seen_F: ComplexArray = true_F.real * (1.0 + relative) * (1.0 - 1j * loss)
    return seen_F


def permittivity_part(seed: int) -> Part:
    """Simulate the sweeps of all materials as files with a register."""
    contents: dict[str, bytes] = {}
    rows: list[dict[str, str]] = []
    specimens = {}
    for material in materials():
        for number in range(1, SPECIMENS + 1):
            sweep = simulate_permittivity(seed, material, number)
            ending = "csv" if material == TABLE else "log"
            row = _row(sweep, f"{material}/synthetic-{number}.{ending}")
            contents[f"{TECHNIQUE}/{row['file']}"] = _file(sweep)
            rows.append(row)
            specimens[sweep.specimen] = sweep.truth
    contents[f"{TECHNIQUE}/specimens.csv"] = register_csv(rows)
    calibration = draw_lcr_calibration(seed)
    return Part(TECHNIQUE, contents, permittivity_truth(), calibration, specimens)


def permittivity_truth() -> tuple[TrueValue, ...]:
    """List permittivity and loss of every material at the card's frequency; all lose alike."""
    stored = tuple(entry for entry in truth_table() if entry.key in FACTOR_SD)
    lost = float(loss_tangent(complex_permittivity(1.0, np.array([_CARD_HZ])))[0])
    return stored + tuple(replace(entry, key=LOSS, value=lost) for entry in stored)


def _file(sweep: SimulatedSweep) -> bytes:
    if sweep.material == TABLE:
        pair = shown("Cp-D", sweep.frequency_Hz, sweep.capacitance_F)
        return lcr_csv(SYNTHETIC, sweep.frequency_Hz, *pair)
    return sweep_log(sweep, FUNCTIONS[sweep.material])


def sweep_log(sweep: SimulatedSweep, function: str) -> bytes:
    """Write a sweep as the meter's PC-logged replies, set to one of its functions."""
    pair = shown(function, sweep.frequency_Hz, sweep.capacitance_F)
    return lcr6000_log(SYNTHETIC, function, sweep.frequency_Hz, *pair)


def _row(sweep: SimulatedSweep, file: str) -> dict[str, str]:
    numbers = sweep.numbers
    return {
        "specimen": sweep.specimen,
        "material": sweep.material,
        "file": file,
        "thickness_um": f"{from_si(numbers['thickness_m'].value, 'um'):.0f}",
        "micrometer_force_N": f"{_FORCE_N:g}",
        "anvil_diameter_mm": f"{from_si(_ANVIL_M, 'mm'):g}",
        "plate_length_mm": f"{from_si(numbers['plate_length_m'].value, 'mm'):.2f}",
        "plate_width_mm": f"{from_si(numbers['plate_width_m'].value, 'mm'):.2f}",
        "age": sweep.age,
        "cure": "2 h at 90 C",
        "cured_on": CURED_ON.isoformat(),
        "tested_on": TESTED_ON.isoformat(),
        "temperature_C": "22",
        "humidity_percent": "52",
        "instrument": "simulated GW Instek LCR-6020, checked against a reference capacitor",
        "comment": SYNTHETIC,
    }
