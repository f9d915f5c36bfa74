r"""The forms that a law of viscosity can have: each a value and its derivatives by coefficient.

A form is a pure function of the coefficients, shape (p,), the times x, shape (n,), the shear rates,
shape (n,), where the form has any, and the lengths of its polynomials. It gives values, shape (n,),
and derivatives, shape (n, p). `FORMS` is the one list of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from deamat.core.arrays import FloatArray

POLYNOMIAL = "polynomial"
EXPONENTIAL = "exponential"
POWER_LAW_TO_GEL = "power-law-to-gel"
POWER_LAW_FLUID = "power-law-fluid"
ARRHENIUS = "arrhenius"
GAS_CONSTANT_J_per_molK = 8.314462618

Form = Callable[
    [FloatArray, FloatArray, FloatArray | None, Sequence[int]], tuple[FloatArray, FloatArray]
]


def _powers(x: FloatArray, count: int) -> FloatArray:
    return np.power(x[:, None], np.arange(count, dtype=np.float64))


def _polynomial(
    c: FloatArray, x: FloatArray, _rate: FloatArray | None, _parts: Sequence[int]
) -> tuple[FloatArray, FloatArray]:
    r"""$y = \sum_k c_k x^k$."""
    powers = _powers(x, len(c))
    return powers @ c, powers


def _exponential(
    c: FloatArray, x: FloatArray, _rate: FloatArray | None, _parts: Sequence[int]
) -> tuple[FloatArray, FloatArray]:
    r"""$y = a \exp(b x)$ with coefficients (a, b)."""
    growth = np.exp(c[1] * x)
    return c[0] * growth, np.stack([growth, c[0] * x * growth], axis=1)


def _power_law_to_gel(
    c: FloatArray, x: FloatArray, _rate: FloatArray | None, _parts: Sequence[int]
) -> tuple[FloatArray, FloatArray]:
    r"""$y = a (1 - x / x_g)^{-s}$ with coefficients (a, x_g, s), for $x < x_g$.

    Source: the divergence of viscosity towards the gel point, D. Stauffer, A. Coniglio, M. Adam,
    Adv. Polym. Sci. 44 (1982) 103.
    """
    a, gel, s = c
    rest = 1.0 - x / gel
    growth = rest**-s
    return a * growth, np.stack(
        [growth, -a * s * growth / rest * x / gel**2, -a * growth * np.log(rest)], axis=1
    )


def _power_law_fluid(
    c: FloatArray, x: FloatArray, rate: FloatArray | None, parts: Sequence[int]
) -> tuple[FloatArray, FloatArray]:
    r"""$y = K(x)\, q^{n(x) - 1}$ at the shear rate q; coefficients of K first, then those of n."""
    if rate is None or len(parts) != 2:
        raise ValueError("a power-law fluid has a shear rate and two polynomials")
    k_powers, n_powers = (_powers(x, count) for count in parts)
    factor, index = k_powers @ c[: parts[0]], n_powers @ c[parts[0] :]
    thinning = rate ** (index - 1.0)
    value = factor * thinning
    slopes = [k_powers * thinning[:, None], n_powers * (value * np.log(rate))[:, None]]
    return value, np.concatenate(slopes, axis=1)


def _arrhenius(
    c: FloatArray, x: FloatArray, _rate: FloatArray | None, _parts: Sequence[int]
) -> tuple[FloatArray, FloatArray]:
    r"""$y = a \exp\big(\frac{E}{R x}\big)$ with coefficients (a, E `[J/mol]`), x `[K]`.

    Source: E. N. da C. Andrade, Philos. Mag. 17 (1934) 497.
    """
    inverse = 1.0 / (GAS_CONSTANT_J_per_molK * x)
    growth = np.exp(c[1] * inverse)
    return c[0] * growth, np.stack([growth, c[0] * inverse * growth], axis=1)


FORMS: dict[str, Form] = {
    POLYNOMIAL: _polynomial,
    EXPONENTIAL: _exponential,
    POWER_LAW_TO_GEL: _power_law_to_gel,
    POWER_LAW_FLUID: _power_law_fluid,
    ARRHENIUS: _arrhenius,
}


def coefficient_names(kind: str, count: int, parts: Sequence[int]) -> tuple[str, ...]:
    """Name the coefficients of a form as its equation does, in their order.

    Parameters
    ----------
    count : of coefficients
    parts : lengths of the polynomials in a form that has several
    """
    if kind == EXPONENTIAL:
        return "a", "b"
    if kind == POWER_LAW_TO_GEL:
        return "a", "x_gel", "s"
    if kind == ARRHENIUS:
        return "a", "E"
    if kind == POWER_LAW_FLUID:
        return tuple(f"{name}{k}" for name, n in zip("Kn", parts, strict=True) for k in range(n))
    return tuple(f"c{k}" for k in range(count))


def lower_bounds(kind: str, valid: tuple[float, float]) -> dict[str, float]:
    """Lowest value of each coefficient that has one.

    The gel point lies after the last reading; what flows more easily in the warmth has E >= 0.
    """
    if kind == POWER_LAW_TO_GEL:
        return {"x_gel": math.nextafter(valid[1], math.inf)}
    return {"a": 0.0, "E": 0.0} if kind == ARRHENIUS else {}


def evaluate(
    kind: str, coefficients: FloatArray, parts: Sequence[int], x: float, rate: float | None = None
) -> tuple[float, FloatArray]:
    """Value and derivatives, shape (p,), of a form at one point."""
    rates = None if rate is None else np.array([rate])
    value, slopes = FORMS[kind](coefficients, np.array([x]), rates, parts)
    return float(value[0]), slopes[0]
