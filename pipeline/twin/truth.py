"""The known truth behind the simulated campaign, as `truth.toml` holds it."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.polynomial.polynomial import polyval

from deamat.core.arrays import FloatArray
from deamat.core.errors import MissingProperty
from deamat.core.properties import REFERENCE_AGE
from deamat.core.units import si_factor, to_si

AGED = "2 months"
SECONDS_PER_HOUR = 3600.0

# key in truth.toml -> (property key, unit as printed, age)
_KEYS = {
    "compressive_modulus_MPa": ("compressive_modulus", "MPa", REFERENCE_AGE),
    "compressive_modulus_2_months_MPa": ("compressive_modulus", "MPa", AGED),
    "tensile_modulus_MPa": ("tensile_modulus", "MPa", REFERENCE_AGE),
    "tensile_strength_MPa": ("tensile_strength", "MPa", REFERENCE_AGE),
    "elongation_percent": ("elongation_at_break", "percent", REFERENCE_AGE),
    "relative_permittivity_10Hz": ("relative_permittivity", "1", REFERENCE_AGE),
    "breakdown_strength_V_per_um": ("breakdown_strength", "V/um", REFERENCE_AGE),
}


@dataclass(frozen=True, slots=True)
class TrueValue:
    """What one property of one material truly is: the mean over all specimens that could be made.

    Parameters
    ----------
    key : property key of `core.properties`
    material, age : what it holds for
    value, unit : in SI
    temperature_K : where it holds for one alone
    lower_bound : all that is known is that the truth is not below
    """

    key: str
    material: str
    age: str
    value: float
    unit: str
    temperature_K: float | None = None
    lower_bound: bool = False


@cache
def document() -> dict[str, Any]:
    """Read `truth.toml`."""
    return tomllib.loads((files("deamat.twin") / "truth.toml").read_text("utf-8"))


@cache
def truth_table() -> tuple[TrueValue, ...]:
    """Read the whole table, in the order of `truth.toml`.

    Source: Sikulskyi et al. 2022, Front. Robot. AI 9:1034914, Table 4 (CC BY).
    """
    table = []
    for material, printed in document()["materials"].items():
        for name, value in printed.items():
            key, unit, age = _KEYS[name]
            table.append(TrueValue(key, material, age, to_si(value, unit), si_factor(unit)[0]))
    return tuple(table)


def true_value(key: str, material: str, age: str = REFERENCE_AGE) -> TrueValue:
    """Look one true value up.

    Raises
    ------
    MissingProperty : the table does not hold it
    """
    for entry in truth_table():
        if (entry.key, entry.material, entry.age) == (key, material, age):
            return entry
    known = ", ".join(sorted({f"{e.material} ({e.age})" for e in truth_table() if e.key == key}))
    raise MissingProperty(
        f"the twin knows no {key} of {material} ({age}); it knows that of: {known or 'no material'}"
    )


def materials() -> tuple[str, ...]:
    """List the materials of the table, in its order."""
    return tuple(dict.fromkeys(entry.material for entry in truth_table()))


@dataclass(frozen=True, slots=True)
class TrueViscosity:
    r"""$\mu(t, q) = K(t)\, q^{n(t) - 1}$ with t in hours since mixing; n = 1 if `index` is empty.

    Parameters
    ----------
    rotor : with which the material was measured
    consistency : coefficients of K, lowest order first `[Pa.s^n / h^k]`
    index : coefficients of n, lowest order first `[1 / h^k]`
    """

    material: str
    rotor: int
    consistency: tuple[float, ...]
    index: tuple[float, ...]

    def __call__(self, time_s: FloatArray, rate_per_s: FloatArray) -> FloatArray:
        """Viscosity at times and nominal shear rates, shape (n,) each `[Pa.s]`."""
        hours = np.asarray(time_s) / SECONDS_PER_HOUR
        k = polyval(hours, self.consistency)
        if not self.index:
            return np.asarray(k)
        return np.asarray(k * rate_per_s ** (polyval(hours, self.index) - 1.0))


@cache
def true_viscosities() -> dict[str, TrueViscosity]:
    """Read the laws of viscosity, by material.

    Source: Sikulskyi et al. 2022, Front. Robot. AI 9:1034914, Table 2 (CC BY).
    """
    document = tomllib.loads((files("deamat.twin") / "truth.toml").read_text("utf-8"))
    found = {}
    for material, said in document["viscosity"].items():
        newtonian = "index_low_to_high" not in said
        index = () if newtonian else tuple(said["index_low_to_high"])
        consistency = tuple(said["coefficients_low_to_high"])
        found[material] = TrueViscosity(material, said["rotor"], consistency, index)
    return found
