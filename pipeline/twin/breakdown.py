"""Simulated breakdown of thin films under a slowly rising DC voltage on a Trek 20/20C.

What is simulated: films of 100-150 um; fields of breakdown from a Weibull distribution whose scale
is the breakdown strength that the paper prints; an electrode of 10 mm diameter; a ramp that starts
at half of the voltage expected at 125 um and rises at a rate that lets half of the specimens live
some 150 s; monitors read at 2 Hz with 1 V of noise, in a DAQ log for 10:1 and 20:1 and in a plain
table in kV for 30:1; for 40:1 no log at all, but the highest voltage that the amplifier's display
showed, to 10 V, in the register; readings of a micrometer; one calibration error of voltage
monitor and of micrometer for the whole campaign. A film that would break at the start is started
lower, as if somebody had known.
What is not: flashovers, conditioning, heating, the contraction of the film
under the field, thickness that varies over one film, or strength that depends on thickness.

The paper prints no Weibull shape. The twin's own truth is 12, 10, 9 and 8 for 10:1 to 40:1: the
range that thin silicone films are known for, falling with the strength.

Source: strength, film thickness, amplifier and slow rate of rise from Sikulskyi et al. 2022, Table
4 and section 3.3; shapes, electrode and rates of rise chosen here.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.properties import REFERENCE_AGE
from deamat.core.quantity import Quantity
from deamat.core.units import from_si
from deamat.estimators.weibull.fit import quantile
from deamat.twin.draws import Calibration, draw_calibration, on_grid, read_micrometer, stream
from deamat.twin.part import SYNTHETIC, Part
from deamat.twin.truth import TrueValue, true_value
from deamat.twin.writers import daq_ramp_log, ramp_csv, register_csv

TECHNIQUE = "breakdown"
SPECIMENS = 20
CURED_ON, TESTED_ON = date(2022, 1, 10), date(2022, 1, 21)
VOLTAGE_MONITOR, CURRENT_MONITOR = 2000.0, 2e-3  # V/V, A/V
ELECTRODE_AREA_M2 = 78.5e-6

_THICKNESS_M = (100e-6, 150e-6)
_EXPECTED_THICKNESS_M = 125e-6
_SAMPLING_HZ, _QUIET_S, _TRIP_S, _AFTER = 2.0, 2.0, 0.8, 5
_START = 0.5  # of the voltage expected
_LOWER_START = 0.9  # of the voltage at which a weak film breaks
_VOLTAGE_NOISE_V, _CURRENT_NOISE_A, _CURRENT_LIMIT_A = 1.0, 2e-6, 20e-3
_LEAKAGE_OHM = 1e12
_U_DISPLAY_V = 10.0 / math.sqrt(12.0)  # half a step either way


@dataclass(frozen=True, slots=True)
class _Plan:
    """How one composition is tested, and the shape of its strength."""

    shape: float
    rate_V_per_s: float
    form: str


_PLANS: dict[str, _Plan] = {
    "sylgard-182-10to1": _Plan(12.0, 40.0, "daq"),
    "sylgard-182-20to1": _Plan(10.0, 25.0, "daq"),
    "sylgard-182-30to1": _Plan(9.0, 20.0, "plain"),
    "sylgard-182-40to1": _Plan(8.0, 12.5, "register"),
}
MATERIALS = tuple(_PLANS)


@dataclass(frozen=True, slots=True)
class SimulatedRamp:
    """One simulated breakdown test, with the numbers that its file and its register row hold.

    Parameters
    ----------
    numbers : thickness, area and rate of rise by SI name; `breakdown_voltage_V` as the display
        showed it where no log was kept
    time_s, voltage_V, current_A : as the monitors showed them, shape (n,) each
    truth : what this very specimen is
    """

    specimen: str
    material: str
    numbers: Mapping[str, Quantity]
    time_s: FloatArray
    voltage_V: FloatArray
    current_A: FloatArray
    truth: Mapping[str, float]


def true_shape(material: str) -> float:
    """Return the Weibull shape that the twin has chosen for a material."""
    return _PLANS[material].shape


def keeps_log(material: str) -> bool:
    """Say whether the ramps of a material are logged, or only noted in the register."""
    return _PLANS[material].form != "register"


def simulate_breakdown(seed: int, material: str, number: int) -> SimulatedRamp:
    """Simulate one ramp to breakdown in memory.

    Parameters
    ----------
    seed : of the campaign
    material : one of `MATERIALS`
    number : of the specimen, from 1

    Raises
    ------
    MissingProperty : the truth table holds no breakdown strength of this material
    ConfigError : the seed is negative
    """
    scale = true_value("breakdown_strength", material).value
    plan = _PLANS[material]
    errors = draw_calibration(seed, TECHNIQUE)
    rng = stream(seed, TECHNIQUE, material, REFERENCE_AGE, str(number))
    thickness_m = rng.uniform(*_THICKNESS_M)
    field_V_per_m = scale * rng.weibull(plan.shape)
    breaks_at_V = field_V_per_m * thickness_m
    numbers = {
        "thickness_m": read_micrometer(rng, thickness_m, errors),
        "electrode_area_m2": Quantity(ELECTRODE_AREA_M2, "m2"),
        "rate_V_per_s": Quantity(plan.rate_V_per_s, "V/s"),
    }
    if plan.form == "register":
        shown_V = 10.0 * round((1.0 + errors.voltage) * breaks_at_V / 10.0)
        numbers["breakdown_voltage_V"] = Quantity(shown_V, "V", _U_DISPLAY_V)
    start_V = min(_START * scale * _EXPECTED_THICKNESS_M, _LOWER_START * breaks_at_V)
    on_s = _QUIET_S + rng.uniform(0.0, 1.0 / _SAMPLING_HZ)
    break_s = on_s + (breaks_at_V - start_V) / plan.rate_V_per_s
    time_s = np.arange(math.ceil(break_s * _SAMPLING_HZ) + _AFTER) / _SAMPLING_HZ
    voltage_V = np.where(time_s < on_s, 0.0, start_V + plan.rate_V_per_s * (time_s - on_s))
    current_A = voltage_V / _LEAKAGE_OHM
    broken, tripped = time_s >= break_s, time_s >= break_s + _TRIP_S
    arc = broken & ~tripped
    voltage_V[broken] = 0.0
    voltage_V[arc] = breaks_at_V * rng.uniform(0.01, 0.1, int(arc.sum()))
    current_A[broken] = 0.0
    current_A[arc] = _CURRENT_LIMIT_A * rng.uniform(0.6, 1.0, int(arc.sum()))
    voltage_V = (1.0 + errors.voltage) * voltage_V + rng.normal(0, _VOLTAGE_NOISE_V, time_s.size)
    current_A = current_A + rng.normal(0.0, _CURRENT_NOISE_A, time_s.size)
    return SimulatedRamp(
        specimen=f"b-{material}-{number}",
        material=material,
        numbers=numbers,
        time_s=time_s,
        voltage_V=VOLTAGE_MONITOR * on_grid(voltage_V / VOLTAGE_MONITOR, 4),
        current_A=CURRENT_MONITOR * on_grid(current_A / CURRENT_MONITOR, 4),
        truth={
            "breakdown_field": field_V_per_m,
            "thickness_m": thickness_m,
            "breakdown_voltage_V": breaks_at_V,
        },
    )


def breakdown_truth() -> tuple[TrueValue, ...]:
    """List what is true of the strength of every material: scale, shape and two quantiles."""
    table = []
    for material in MATERIALS:
        strength = true_value("breakdown_strength", material)
        scale, shape = strength.value, true_shape(material)
        table.append(strength)
        table += [
            TrueValue(key, material, REFERENCE_AGE, value, unit)
            for key, value, unit in (
                ("weibull_shape", shape, "1"),
                ("weibull_shape_unbiased", shape, "1"),  # another estimate of the same shape
                ("breakdown_B10", quantile(scale, shape, 0.1), "V/m"),
                ("breakdown_B1", quantile(scale, shape, 0.01), "V/m"),
            )
        ]
    return tuple(table)


def breakdown_part(seed: int) -> Part:
    """Simulate the breakdown tests of the four compositions of Sylgard 182, with a register."""
    contents: dict[str, bytes] = {}
    rows: list[dict[str, str]] = []
    specimens = {}
    for material in MATERIALS:
        for number in range(1, SPECIMENS + 1):
            ramp = simulate_breakdown(seed, material, number)
            file = f"{material}/synthetic-{number}.csv" if keeps_log(material) else ""
            if file:
                contents[f"{TECHNIQUE}/{file}"] = _log(ramp)
            rows.append(_row(ramp, file))
            specimens[ramp.specimen] = ramp.truth
    contents[f"{TECHNIQUE}/specimens.csv"] = register_csv(rows)
    calibration: Calibration = draw_calibration(seed, TECHNIQUE)
    return Part(TECHNIQUE, contents, breakdown_truth(), calibration, specimens)


def _log(ramp: SimulatedRamp) -> bytes:
    if _PLANS[ramp.material].form == "plain":
        return ramp_csv(SYNTHETIC, ramp.time_s, ramp.voltage_V, ramp.current_A)
    return daq_ramp_log(
        SYNTHETIC,
        VOLTAGE_MONITOR,
        CURRENT_MONITOR,
        ramp.time_s,
        ramp.voltage_V / VOLTAGE_MONITOR,
        ramp.current_A / CURRENT_MONITOR,
    )


def _row(ramp: SimulatedRamp, file: str) -> dict[str, str]:
    shown = ramp.numbers.get("breakdown_voltage_V")
    return {
        "specimen": ramp.specimen,
        "material": ramp.material,
        "file": file,
        "thickness_um": f"{from_si(ramp.numbers['thickness_m'].value, 'um'):.0f}",
        "electrode_area_mm2": f"{from_si(ELECTRODE_AREA_M2, 'mm2'):.1f}",
        "rate_V_per_s": f"{ramp.numbers['rate_V_per_s'].value:g}",
        "breakdown_voltage_kV": "" if shown is None else f"{from_si(shown.value, 'kV'):.2f}",
        "u_breakdown_voltage_kV": ""
        if shown is None
        else f"{from_si(shown.u_independent, 'kV'):.4f}",
        "censored": "" if shown is None else "no",
        "age": REFERENCE_AGE,
        "cure": "2 h at 90 C",
        "cured_on": CURED_ON.isoformat(),
        "tested_on": TESTED_ON.isoformat(),
        "temperature_C": "22",
        "humidity_percent": "52",
        "instrument": "simulated Trek 20/20C",
        "comment": SYNTHETIC,
    }
