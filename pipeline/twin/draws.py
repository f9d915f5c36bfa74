"""What chance decides: random streams, gauge readings, calibration errors, noise of a load cell.

Every stream has its own key, so that a technique that is added later leaves the others' numbers as
they are.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.random import PCG64, Generator, SeedSequence

from deamat.core.arrays import FloatArray
from deamat.core.errors import ConfigError
from deamat.core.instruments import Gauge, Machine
from deamat.core.quantity import Quantity

# The errors are drawn from the standard uncertainties that `config/instruments.toml` declares: only
# then can the stated intervals cover the truth as often as they say.
MACHINE = Machine(
    u_force_calibration=0.005, u_displacement_calibration=0.002, u_voltage_calibration=0.005
)
CALIPER = Gauge(u_reading_m=1e-5, u_calibration_m=1e-5)
MICROMETER = Gauge(u_reading_m=1e-6, u_calibration_m=1e-6)
CALIPER_STEP_M = 1e-5
MICROMETER_STEP_M = 1e-6


@dataclass(frozen=True, slots=True)
class Calibration:
    """The errors that all tests of one technique in one campaign have in common.

    Parameters
    ----------
    force, displacement : relative errors of load cell and crosshead `[1]`
    voltage : relative error of the high-voltage monitor, common to all techniques `[1]`
    caliper_m, micrometer_m : errors of the gauges, common to all techniques `[m]`
    torque : error of a viscometer's zero, as fraction of full scale `[1]`
    """

    force: float
    displacement: float
    caliper_m: float
    micrometer_m: float
    voltage: float
    torque: float


def stream(seed: int, *key: str) -> Generator:
    """Open the random stream of one thing, such as `("tension", material, age, "1")`.

    Raises
    ------
    ConfigError : the seed is negative
    """
    if seed < 0:
        raise ConfigError(f"the seed must be 0 or more, not {seed}")
    return Generator(PCG64(SeedSequence([seed, zlib.crc32("/".join(key).encode())])))


def draw_calibration(seed: int, technique: str) -> Calibration:
    """Draw the calibration errors of a technique's machine and of the campaign's gauges."""
    machine = stream(seed, "calibration", technique)
    gauges = stream(seed, "calibration", "gauges")
    monitor = stream(seed, "calibration", "high voltage")
    return Calibration(
        force=machine.normal(0.0, MACHINE.u_force_calibration),
        displacement=machine.normal(0.0, MACHINE.u_displacement_calibration),
        caliper_m=gauges.normal(0.0, CALIPER.u_calibration_m),
        micrometer_m=gauges.normal(0.0, MICROMETER.u_calibration_m),
        voltage=monitor.normal(0.0, MACHINE.u_voltage_calibration),
        torque=0.0,
    )


def draw_factors(rng: Generator, sd: Mapping[str, float]) -> dict[str, float]:
    """Draw how far one specimen is from its material: normal factors with mean 1."""
    return {name: 1.0 + rng.normal(0.0, u) for name, u in sd.items()}


def read_caliper(rng: Generator, length_m: float, errors: Calibration) -> Quantity:
    """Measure a length with the caliper, with both kinds of error and the display's step."""
    return _read(rng, length_m, errors.caliper_m, CALIPER, CALIPER_STEP_M)


def read_micrometer(rng: Generator, length_m: float, errors: Calibration) -> Quantity:
    """Measure a thickness with the micrometer, with both kinds of error and the display's step."""
    return _read(rng, length_m, errors.micrometer_m, MICROMETER, MICROMETER_STEP_M)


def _read(rng: Generator, true_m: float, error_m: float, gauge: Gauge, step_m: float) -> Quantity:
    reading = true_m + error_m + rng.normal(0.0, gauge.u_reading_m)
    return Quantity(round(reading / step_m) * step_m, "m", gauge.u_reading_m, gauge.u_calibration_m)


def cell_noise(rng: Generator, time_s: FloatArray, sd_N: float, memory_s: float) -> FloatArray:
    r"""Draw the noise of a load cell behind a first-order filter (Ornstein-Uhlenbeck process).

    $n_i = a_i n_{i-1} + \sqrt{1 - a_i^2}\, w_i$ with $a_i = \exp(-(t_i - t_{i-1})/\tau)$ and
    $w_i \sim N(0, s^2)$: standard deviation s at any, even a changing, sampling interval.

    Parameters
    ----------
    time_s : sampling times, rising, shape (n,) `[s]`
    sd_N : standard deviation s `[N]`
    memory_s : correlation time tau of the filter `[s]`
    """
    keep = np.exp(-np.diff(time_s) / memory_s)
    fresh = rng.normal(0.0, sd_N, time_s.size)
    fresh[1:] *= np.sqrt(1.0 - keep**2)
    noise = fresh.tolist()
    for i, a in enumerate(keep.tolist(), start=1):
        noise[i] += a * noise[i - 1]
    return np.asarray(noise, dtype=np.float64)


def on_grid(values: FloatArray, decimals: int, step: float = 1.0) -> FloatArray:
    """Round to an instrument's step, counted in units of the last decimal that it displays."""
    scale = 10.0**decimals
    return np.round(values * scale / step) * step / scale
