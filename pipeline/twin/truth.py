"""The known truth behind the simulated campaign, as `truth.toml` holds it."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from pipeline.core.errors import MissingProperty
from pipeline.core.properties import REFERENCE_AGE
from pipeline.core.units import si_factor, to_si

AGED = "2 months"

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
    """

    key: str
    material: str
    age: str
    value: float
    unit: str


@cache
def truth_table() -> tuple[TrueValue, ...]:
    """Read the whole table, in the order of `truth.toml`.

    Source: Sikulskyi et al. 2022, Front. Robot. AI 9:1034914, Table 4 (CC BY).
    """
    document = tomllib.loads((files("pipeline.twin") / "truth.toml").read_text("utf-8"))
    table = []
    for material, printed in document["materials"].items():
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
