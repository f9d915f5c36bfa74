"""Viscosity against temperature by one activation energy."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.laws import GAS_CONSTANT_J_per_molK
from deamat.estimators.least_squares.checks import finite_array, same_length
from deamat.estimators.mean import coverage_factor

LEAST_TEMPERATURES = 3


@dataclass(frozen=True, slots=True)
class ArrheniusFit:
    """Coefficients of `core.laws.ARRHENIUS`.

    Parameters
    ----------
    coefficients : a `[unit of y]` and E `[J/mol]`, shape (2,)
    covariance : of them, shape (2, 2)
    dof : degrees of freedom of the covariance; infinite where the errors given are larger than the
        scatter about the line
    relative_scatter : standard deviation of one point about the law, relative
    """

    coefficients: FloatArray
    covariance: FloatArray
    dof: float
    relative_scatter: float


def fit_arrhenius(temperature_K: ArrayLike, y: ArrayLike, u_relative: ArrayLike) -> ArrheniusFit:
    r"""Fit $\ln y = \ln a + \frac{E}{R T}$ by least squares with equal relative errors.

    The error of a point is the scatter about the line, or the root mean square of the uncertainties
    given where that is more: temperatures are off by more than readings scatter.

    Parameters
    ----------
    temperature_K, y, u_relative : positive, shape (m,): each temperature once

    Raises
    ------
    FitRefused : fewer than three temperatures, or a y that does not fall by more than its errors

    Source: E. N. da C. Andrade, Philos. Mag. 17 (1934) 497.
    """
    kelvin, values = finite_array("temperature_K", temperature_K), finite_array("y", y)
    u = finite_array("u_relative", u_relative)
    same_length("y", values, len(kelvin))
    same_length("u_relative", u, len(kelvin))
    if len(np.unique(kelvin)) < LEAST_TEMPERATURES:
        raise FitRefused(
            f"an activation energy needs {LEAST_TEMPERATURES} temperatures, not "
            f"{len(np.unique(kelvin))}"
        )
    if np.any(kelvin <= 0) or np.any(values <= 0):
        raise FitRefused("temperatures and values must be positive")
    x, logs = 1.0 / (GAS_CONSTANT_J_per_molK * kelvin), np.log(values)
    middle = float(x.mean())
    off = x - middle
    energy = float(off @ logs) / float(off @ off)
    residuals = logs - logs.mean() - energy * off
    dof = len(x) - 2
    scatter, stated = (
        math.sqrt(float(residuals @ residuals) / dof),
        math.sqrt(float(u @ u) / len(u)),
    )
    sd, freedom = (scatter, float(dof)) if scatter >= stated else (stated, math.inf)
    u_energy = sd / math.sqrt(float(off @ off))
    if energy <= coverage_factor(freedom) * u_energy:
        raise FitRefused(
            f"the activation energy, {energy / 1e3:.3g} -+ {u_energy / 1e3:.2g} kJ/mol, cannot be "
            "told from zero: viscosity does not fall with temperature by more than it scatters",
            {"activation_energy_J_per_mol": energy, "u_activation_energy_J_per_mol": u_energy},
        )
    a = math.exp(float(logs.mean()) - energy * middle)
    # ln y at the middle and E are independent of each other
    slopes = np.array([[a, -a * middle], [0.0, 1.0]])
    covariance = slopes @ np.diag([sd**2 / len(x), u_energy**2]) @ slopes.T
    return ArrheniusFit(np.array([a, energy]), np.asarray(covariance), freedom, sd)
