r"""What a dielectric spectrometer computes of a material, as complex permittivity.

Its software divides the measured capacitance by that of the empty cell. Whatever pair it shows
stands for one complex relative permittivity

$$ \epsilon_r^* = \epsilon' - j \epsilon'', \qquad \tan\delta = \epsilon'' / \epsilon', \qquad
   M^* = M' + j M'' = 1 / \epsilon_r^*, \qquad \sigma' = \omega \epsilon_0 \epsilon''. $$

Source: Kremer and Schoenhals, Broadband Dielectric Spectroscopy, chapter 1; IEC 62631-2-1.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.dielectric.edge_field import EPS0_F_per_m
from deamat.estimators.dielectric.impedance import ComplexArray


@dataclass(frozen=True, slots=True)
class MaterialPair:
    """One pair of numbers that a spectrometer can show of a material.

    Parameters
    ----------
    primary, secondary : what they are, with their SI unit
    read : angular frequency `[rad/s]`, primary, secondary to complex permittivity `[1]`
    """

    primary: str
    secondary: str
    read: Callable[[FloatArray, FloatArray, FloatArray], ComplexArray]


def complex_permittivity(
    mode: str, frequency_Hz: FloatArray, primary: FloatArray, secondary: FloatArray
) -> ComplexArray:
    r"""Return the complex relative permittivity behind what a spectrometer shows.

    Parameters
    ----------
    mode : a key of `MATERIAL_PAIRS`, such as `"Eps'-Eps''"`
    frequency_Hz : above zero, shape (n,)
    primary, secondary : in SI, shape (n,) each

    Returns
    -------
    $\epsilon' - j \epsilon''$, shape (n,) `[1]`

    Raises
    ------
    FitRefused : an electric modulus of zero
    """
    pair = MATERIAL_PAIRS[mode]
    zero = np.flatnonzero((primary == 0.0) & (secondary == 0.0))
    if zero.size and pair.read is _read_modulus:
        raise FitRefused(
            f"an electric modulus of zero at {frequency_Hz[zero[0]]:g} Hz: no dielectric has one; "
            "look at the sample and its contacts"
        )
    return pair.read(2.0 * math.pi * frequency_Hz, primary, secondary)


def _read_parts(_w: FloatArray, stored: FloatArray, lost: FloatArray) -> ComplexArray:
    result = stored.astype(np.complex128)
    result.imag = -lost
    return result


def _read_loss_tangent(w: FloatArray, stored: FloatArray, d: FloatArray) -> ComplexArray:
    return _read_parts(w, stored, stored * d)


def _read_modulus(w: FloatArray, stored: FloatArray, lost: FloatArray) -> ComplexArray:
    square = stored**2 + lost**2
    return _read_parts(w, stored / square, lost / square)


def _read_conductivity(w: FloatArray, stored: FloatArray, sigma: FloatArray) -> ComplexArray:
    return _read_parts(w, stored, sigma / (w * EPS0_F_per_m))


MATERIAL_PAIRS: dict[str, MaterialPair] = {
    "Eps'-Eps''": MaterialPair("relative_permittivity", "relative_loss_index", _read_parts),
    "Eps'-tan(delta)": MaterialPair("relative_permittivity", "loss_tangent", _read_loss_tangent),
    "M'-M''": MaterialPair("electric_modulus", "electric_modulus_loss", _read_modulus),
    "Eps'-Sig'": MaterialPair("relative_permittivity", "conductivity_S_per_m", _read_conductivity),
}
