r"""What an LCR meter shows, as complex capacitance, and back again.

Whatever pair of numbers a meter shows, they stand for one complex admittance
$Y = G + j \omega C_p$, and all of them are kept here as the complex capacitance

$$ C^* = Y / (j \omega) = C_p (1 - j D), \qquad D = \tan\delta = G / (\omega C_p). $$

Source: identities of circuit theory; IEC 62631-2-1 for the names.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused

ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True, slots=True)
class Pair:
    """One pair of numbers that a meter can show.

    Parameters
    ----------
    primary, secondary : what they are, with their SI unit
    read : angular frequency `[rad/s]`, primary, secondary to complex capacitance `[F]`
    show : angular frequency `[rad/s]`, complex capacitance `[F]` to primary and secondary
    """

    primary: str
    secondary: str
    read: Callable[[FloatArray, FloatArray, FloatArray], ComplexArray]
    show: Callable[[FloatArray, ComplexArray], tuple[FloatArray, FloatArray]]


def complex_capacitance(
    mode: str, frequency_Hz: FloatArray, primary: FloatArray, secondary: FloatArray
) -> ComplexArray:
    """Return the complex capacitance behind what a meter shows.

    Parameters
    ----------
    mode : a key of `PAIRS`, such as `"Cp-D"`
    frequency_Hz : above zero, shape (n,)
    primary, secondary : in SI (angles in rad), shape (n,) each

    Returns
    -------
    $C^* = C_p (1 - j D)$, shape (n,) `[F]`

    Raises
    ------
    FitRefused : a reading of zero where an impedance or a parallel resistance must stand
    """
    pair = PAIRS[mode]
    zero = _ZERO[mode](primary, secondary) if mode in _ZERO else np.zeros(primary.shape, bool)
    if zero.any():
        at = int(np.flatnonzero(zero)[0])
        raise FitRefused(
            f"{mode} reads an impedance of zero at {frequency_Hz[at]:g} Hz: a short circuit is no "
            "specimen; look at plates and leads"
        )
    return pair.read(2.0 * math.pi * frequency_Hz, primary, secondary)


def shown(
    mode: str, frequency_Hz: FloatArray, capacitance_F: ComplexArray
) -> tuple[FloatArray, FloatArray]:
    """Return what a meter shows of a complex capacitance: the inverse of `complex_capacitance`.

    Without any loss there is no parallel resistance to show: Cp-Rp then divides by zero.
    """
    return PAIRS[mode].show(2.0 * math.pi * frequency_Hz, capacitance_F)


def impedance(frequency_Hz: FloatArray, capacitance_F: ComplexArray) -> ComplexArray:
    """Return the complex impedance $Z = 1 / (j omega C^*)$, shape (n,) `[ohm]`."""
    result: ComplexArray = 1.0 / (2j * math.pi * frequency_Hz * capacitance_F)
    return result


def loss_tangent(capacitance_F: ComplexArray) -> FloatArray:
    r"""Return $\tan\delta = -\mathrm{Im}\,C^* / \mathrm{Re}\,C^*$, shape (n,) `[1]`."""
    return -capacitance_F.imag / capacitance_F.real


def _capacitance(stored: FloatArray, lost: FloatArray) -> ComplexArray:
    """C' - jC'' from its two parts."""
    result = stored.astype(np.complex128)
    result.imag = -lost
    return result


def _read_cp_d(_w: FloatArray, c: FloatArray, d: FloatArray) -> ComplexArray:
    return _capacitance(c, c * d)


def _read_cp_rp(w: FloatArray, c: FloatArray, r: FloatArray) -> ComplexArray:
    return _capacitance(c, 1.0 / (w * r))


def _read_cs_d(_w: FloatArray, c: FloatArray, d: FloatArray) -> ComplexArray:
    parallel = c / (1.0 + d * d)
    return _capacitance(parallel, parallel * d)


def _read_cs_rs(w: FloatArray, c: FloatArray, r: FloatArray) -> ComplexArray:
    return _read_cs_d(w, c, w * c * r)


def _read_r_x(w: FloatArray, r: FloatArray, x: FloatArray) -> ComplexArray:
    square = w * (r * r + x * x)
    return _capacitance(-x / square, r / square)


def _read_polar(w: FloatArray, z: FloatArray, theta: FloatArray) -> ComplexArray:
    return _capacitance(-np.sin(theta) / (w * z), np.cos(theta) / (w * z))


def _read_cp_q(w: FloatArray, c: FloatArray, q: FloatArray) -> ComplexArray:
    return _read_cp_d(w, c, 1.0 / q)


def _read_cs_q(w: FloatArray, c: FloatArray, q: FloatArray) -> ComplexArray:
    return _read_cs_d(w, c, 1.0 / q)


def _read_cp_g(w: FloatArray, c: FloatArray, g: FloatArray) -> ComplexArray:
    return _capacitance(c, g / w)


def _read_g_b(w: FloatArray, g: FloatArray, b: FloatArray) -> ComplexArray:
    return _capacitance(b / w, g / w)


def _show_cp_d(_w: FloatArray, c: ComplexArray) -> tuple[FloatArray, FloatArray]:
    return c.real, loss_tangent(c)


def _show_cp_rp(w: FloatArray, c: ComplexArray) -> tuple[FloatArray, FloatArray]:
    return c.real, -1.0 / (w * c.imag)


def _show_cs_d(_w: FloatArray, c: ComplexArray) -> tuple[FloatArray, FloatArray]:
    d = loss_tangent(c)
    return c.real * (1.0 + d * d), d


def _show_cs_rs(w: FloatArray, c: ComplexArray) -> tuple[FloatArray, FloatArray]:
    series, d = _show_cs_d(w, c)
    return series, d / (w * series)


def _show_r_x(w: FloatArray, c: ComplexArray) -> tuple[FloatArray, FloatArray]:
    square = w * (c.real**2 + c.imag**2)
    return -c.imag / square, -c.real / square


def _show_cp_q(_w: FloatArray, c: ComplexArray) -> tuple[FloatArray, FloatArray]:
    return c.real, 1.0 / loss_tangent(c)


def _show_cs_q(w: FloatArray, c: ComplexArray) -> tuple[FloatArray, FloatArray]:
    series, d = _show_cs_d(w, c)
    return series, 1.0 / d


def _show_cp_g(w: FloatArray, c: ComplexArray) -> tuple[FloatArray, FloatArray]:
    return c.real, -c.imag * w


def _show_g_b(w: FloatArray, c: ComplexArray) -> tuple[FloatArray, FloatArray]:
    return -c.imag * w, c.real * w


def _show_polar(w: FloatArray, c: ComplexArray) -> tuple[FloatArray, FloatArray]:
    return 1.0 / (w * np.abs(c)), np.arctan2(-c.real, -c.imag)


PAIRS: dict[str, Pair] = {
    "Cp-D": Pair("parallel_capacitance_F", "loss_tangent", _read_cp_d, _show_cp_d),
    "Cp-Rp": Pair("parallel_capacitance_F", "parallel_resistance_ohm", _read_cp_rp, _show_cp_rp),
    "Cs-D": Pair("series_capacitance_F", "loss_tangent", _read_cs_d, _show_cs_d),
    "Cs-Rs": Pair("series_capacitance_F", "series_resistance_ohm", _read_cs_rs, _show_cs_rs),
    "Cp-Q": Pair("parallel_capacitance_F", "quality_factor", _read_cp_q, _show_cp_q),
    "Cs-Q": Pair("series_capacitance_F", "quality_factor", _read_cs_q, _show_cs_q),
    "Cp-G": Pair("parallel_capacitance_F", "conductance_S", _read_cp_g, _show_cp_g),
    "G-B": Pair("conductance_S", "susceptance_S", _read_g_b, _show_g_b),
    "R-X": Pair("series_resistance_ohm", "reactance_ohm", _read_r_x, _show_r_x),
    "Z-theta": Pair("impedance_ohm", "phase_rad", _read_polar, _show_polar),
}

# readings that no finite capacitance can have
_ZERO: dict[str, Callable[[FloatArray, FloatArray], NDArray[np.bool_]]] = {
    "Cp-Rp": lambda _, resistance: resistance == 0.0,
    "Cp-Q": lambda _, quality: quality == 0.0,
    "Cs-Q": lambda _, quality: quality == 0.0,
    "R-X": lambda resistance, reactance: (resistance == 0.0) & (reactance == 0.0),
    "Z-theta": lambda modulus, _: modulus == 0.0,
}
