r"""The forms that a law of viscosity can have: each a value and its derivatives by coefficient.

A form is a pure function of the coefficients, the time x, the shear rate (where the form has one)
and the lengths of its polynomials; `FORMS` is the one list of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

POLYNOMIAL = "polynomial"
EXPONENTIAL = "exponential"
POWER_LAW_TO_GEL = "power-law-to-gel"
POWER_LAW_FLUID = "power-law-fluid"

Form = Callable[[FloatArray, float, float | None, Sequence[int]], tuple[float, FloatArray]]


def _powers(x: float, count: int) -> FloatArray:
    return np.power(x, np.arange(count, dtype=np.float64))


def _polynomial(
    c: FloatArray, x: float, _rate: float | None, _parts: Sequence[int]
) -> tuple[float, FloatArray]:
    r"""$y = \sum_k c_k x^k$."""
    powers = _powers(x, len(c))
    return float(powers @ c), powers


def _exponential(
    c: FloatArray, x: float, _rate: float | None, _parts: Sequence[int]
) -> tuple[float, FloatArray]:
    r"""$y = a \exp(b x)$ with coefficients (a, b)."""
    growth = math.exp(c[1] * x)
    return float(c[0] * growth), np.array([growth, c[0] * x * growth])


def _power_law_to_gel(
    c: FloatArray, x: float, _rate: float | None, _parts: Sequence[int]
) -> tuple[float, FloatArray]:
    r"""$y = a (1 - x / x_g)^{-s}$ with coefficients (a, x_g, s).

    Source: the divergence of viscosity towards the gel point, D. Stauffer, A. Coniglio, M. Adam,
    Adv. Polym. Sci. 44 (1982) 103.
    """
    a, gel, s = (float(v) for v in c)
    rest = 1.0 - x / gel
    growth = rest**-s
    return a * growth, np.array(
        [growth, -a * s * growth / rest * x / gel**2, -a * growth * math.log(rest)]
    )


def _power_law_fluid(
    c: FloatArray, x: float, rate: float | None, parts: Sequence[int]
) -> tuple[float, FloatArray]:
    r"""$y = K(x)\, q^{n(x) - 1}$ at the shear rate q; coefficients of K first, then those of n."""
    if rate is None or len(parts) != 2:
        raise ValueError("a power-law fluid has a shear rate and two polynomials")
    k_powers, n_powers = (_powers(x, count) for count in parts)
    factor, index = float(k_powers @ c[: parts[0]]), float(n_powers @ c[parts[0] :])
    thinning = rate ** (index - 1.0)
    slopes = [k_powers * thinning, n_powers * (factor * thinning * math.log(rate))]
    return factor * thinning, np.concatenate(slopes)


FORMS: dict[str, Form] = {
    POLYNOMIAL: _polynomial,
    EXPONENTIAL: _exponential,
    POWER_LAW_TO_GEL: _power_law_to_gel,
    POWER_LAW_FLUID: _power_law_fluid,
}
