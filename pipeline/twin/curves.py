"""Noise-free stress-strain curves of a soft elastomer whose moduli are known exactly."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import OutOfRange
from deamat.estimators.curves.stress_strain import bin_slopes, zero_of_tangent

COMPRESSION_WINDOW = 0.05
TENSION_WINDOW = 0.01
LINEAR_TO = 0.05
TANGENT_BIN = 0.01
_DENSE = 5001
_END_SLOPE = 2.4  # at break, in mean slopes: an elastomer stiffens before it breaks


@cache
def _legendre() -> tuple[FloatArray, FloatArray]:
    nodes, weights = np.polynomial.legendre.leggauss(64)
    return nodes, weights


def window_slope(stress: Callable[[FloatArray], FloatArray], window: float) -> float:
    r"""Least-squares slope of a continuous curve over strains from 0 to w.

    $b = \frac{12}{w^3} \int_0^w (e - w/2)\, s(e)\, de$, by Gauss-Legendre quadrature: what plain
    least squares tends to for ever denser, evenly spaced samples.

    Parameters
    ----------
    stress : strain to stress, shape (n,) to (n,)
    window : upper end w `[1]`
    """
    nodes, weights = _legendre()
    strain = 0.5 * window * (nodes + 1.0)
    return float(3.0 / window * np.sum(weights * nodes * stress(strain)))


def compensated_slope(stress: Callable[[FloatArray], FloatArray]) -> float:
    """Least-squares slope over 5 % strain, counted from the zero of the steepest 1 % tangent.

    Parameters
    ----------
    stress : strain to stress, shape (n,) to (n,); zero at a strain of zero

    Source: ASTM D638, annex A1.
    """
    strain = np.linspace(0.0, COMPRESSION_WINDOW, _DENSE)
    bins = bin_slopes(strain, stress(strain), 0.0, COMPRESSION_WINDOW, TANGENT_BIN)
    zero = zero_of_tangent(bins)
    return window_slope(lambda e: stress(e + zero), COMPRESSION_WINDOW)


def compressive_stress(strain: FloatArray, modulus_Pa: float, toe: float) -> FloatArray:
    r"""Nominal stress of a cylinder between plates, soft contact included.

    Contact closes over a strain of about 3 a, after which a neo-Hookean cylinder follows:
    $r = e - a (1 - e^{-e/a})$, $s = c ((1-r)^{-2} - (1-r)) / 3$; c is such that the plain
    least-squares slope of s over 0 to 5 % strain, toe included, is the modulus.

    Parameters
    ----------
    strain : nominal strain, positive in compression, shape (n,) `[1]`
    modulus_Pa : slope over 0 to 5 % `[Pa]`
    toe : a, strain over which contact closes `[1]`

    Source: neo-Hookean uniaxial compression; toe by comparison with real curves of soft cylinders,
    whose 0 to 1 % slope is 10-55 % below that over 0 to 5 %.
    """

    def shape(e: FloatArray) -> FloatArray:
        stretch = 1.0 - (e + toe * np.expm1(-e / toe))
        return (stretch**-2 - stretch) / 3.0

    return modulus_Pa / window_slope(shape, COMPRESSION_WINDOW) * shape(strain)


def tensile_stress(
    strain: FloatArray, modulus_Pa: float, strength_Pa: float, elongation: float
) -> FloatArray:
    """Nominal stress of a strip up to its break point.

    A straight line to 5 % strain, whose slope is the modulus over any window inside it; from there
    a cubic with the same slope that rises monotonely to the break point.

    Parameters
    ----------
    strain : nominal strain, shape (n,), at most `elongation` `[1]`
    modulus_Pa : slope over 0 to 1 % `[Pa]`
    strength_Pa, elongation : the break point `[Pa]`, `[1]`

    Raises
    ------
    OutOfRange : no monotone cubic reaches the break point, or a strain beyond it

    Source: monotone cubic Hermite interpolation, Fritsch and Carlson 1980.
    """
    span = elongation - LINEAR_TO
    rise = strength_Pa - modulus_Pa * LINEAR_TO
    start = modulus_Pa * span / rise if span > 0 and rise > 0 else math.inf
    if start > 2.9:
        raise OutOfRange(
            f"a break at {strength_Pa:g} Pa and strain {elongation:g} is too far below a line of "
            f"{modulus_Pa:g} Pa for a curve that only rises"
        )
    if strain.size and strain.max() > elongation * (1.0 + 1e-12):
        raise OutOfRange(f"strain {strain.max():g} lies beyond the break at {elongation:g}")
    end = min(_END_SLOPE, math.sqrt(9.0 - start**2))
    x = (strain - LINEAR_TO) / span
    path = x * (start + x * (3.0 - 2.0 * start - end + x * (start + end - 2.0)))
    return np.where(strain <= LINEAR_TO, modulus_Pa * strain, modulus_Pa * LINEAR_TO + rise * path)
