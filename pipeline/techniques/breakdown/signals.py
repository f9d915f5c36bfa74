"""What the two monitors of an amplifier carry: noise of the voltage, jumps of the current."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray

_MAD = 1.4826  # of a normal distribution: standard deviation over median absolute deviation
_SECOND_DIFFERENCE = 6.0**0.5  # its standard deviation over that of white noise
_FOOT = 0.02  # of the greatest voltage: below it the ramp has not begun, and all is noise
_CHARGING_STEPS = 3.0  # usual steps of the voltage, from which a rise charges the film
_MEDIAN_WIDTH = 5
_ENOUGH = 500  # samples that tell the noise to 5 %


def median(values: FloatArray) -> float:
    """Median of a few hundred values, shape (n,), without the checks that take most of numpy's."""
    half = values.size // 2
    if values.size % 2:
        return float(np.partition(values, half)[half])
    parted = np.partition(values, (half - 1, half))
    return 0.5 * float(parted[half - 1] + parted[half])


def deviation(values: FloatArray) -> float:
    """Standard deviation of mostly normal values, by the median absolute deviation."""
    return _MAD * median(np.abs(values - median(values)))


def foot(voltage_V: FloatArray) -> int:
    """First sample at which the voltage has come to 2 % of its greatest."""
    return int(np.argmax(voltage_V >= _FOOT * voltage_V.max()))


def voltage_noise(voltage_V: FloatArray) -> float:
    """Standard deviation of white noise on a rising voltage `[V]`, by its second differences.

    The median absolute deviation lets steps, dips and the collapse aside, and the second
    difference any steady rise.

    Parameters
    ----------
    voltage_V : shape (n,)
    """
    if voltage_V.size < _MEDIAN_WIDTH:
        return 0.0
    last = voltage_V[-_ENOUGH:]
    step = last[1:] - last[:-1]
    return deviation(step[1:] - step[:-1]) / _SECOND_DIFFERENCE


def current_jumps(
    current_A: FloatArray, voltage_V: FloatArray, least_A: float, deviations: float
) -> NDArray[np.intp]:
    """Samples at which the current jumps up, those left out at which a rising voltage charges.

    A leakage that grows with the voltage does not jump; a capacitor takes current only while its
    voltage rises faster than usual.

    Parameters
    ----------
    current_A, voltage_V : shape (n,) each
    least_A : least jump `[A]`
    deviations : by which a jump stands out of the noise of the differences
    """
    size = np.abs(current_A)
    rise = size[1:] - size[:-1]
    jumps: NDArray[np.intp] = 1 + np.flatnonzero(rise >= least_A)
    if not jumps.size:
        return jumps
    jumps = jumps[rise[jumps - 1] >= deviations * deviation(rise)]
    step = np.zeros_like(voltage_V)
    step[1:] = voltage_V[1:] - voltage_V[:-1]
    rising = voltage_V[: int(np.argmax(voltage_V)) + 1]
    usual = median(np.abs(rising[1:] - rising[:-1])) if rising.size > 1 else 0.0
    charging = step > max(
        _CHARGING_STEPS * usual + 2.0 * deviations * voltage_noise(rising),
        0.5 * _FOOT * float(rising[-1]),
    )
    charging[1:] |= charging[:-1]
    # a voltage that comes back after a dip rises fast as well, but the current was there before
    return jumps[~charging[jumps]]


def steadied(voltage_V: FloatArray) -> FloatArray:
    """Running median of five samples, shape (n,): it keeps edges and forgets single samples."""
    half = _MEDIAN_WIDTH // 2
    padded = np.pad(voltage_V, half, mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, _MEDIAN_WIDTH)
    return np.asarray(np.median(windows, axis=1))


def level_at(voltage_V: FloatArray, last: int, noise_V: float) -> tuple[float, float]:
    """Voltage of a noisy ramp at one sample, by the line through those before it.

    Parameters
    ----------
    voltage_V : shape (n,)
    last : the last sample that is on the ramp
    noise_V : standard deviation of the voltage

    Returns
    -------
    voltage and its standard uncertainty `[V]`
    """
    count = min(50, max(5, (last + 1 - foot(voltage_V)) // 3), last + 1)
    v = voltage_V[last + 1 - count : last + 1]
    x = np.arange(1.0 - count, 1.0)
    centred = x - x.mean()
    spread = float(centred @ centred)
    slope = float(centred @ v) / spread if spread > 0.0 else 0.0
    value = float(v.mean()) + slope * float(centred[-1])
    return value, noise_V * (1.0 / count + float(centred[-1]) ** 2 / max(spread, 1.0)) ** 0.5
