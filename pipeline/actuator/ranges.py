"""What the dimensions of an actuator may be: a value in the wrong unit is refused."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import OutOfRange

# One design, or one value per design: every formula here is plain arithmetic, so that scalars run
# at the speed of floats and arrays at the speed of numpy.
Reals: TypeAlias = float | FloatArray


@dataclass(frozen=True, slots=True)
class Range:
    """Lowest and highest allowed value `[unit]`, and what would put right a value outside."""

    low: float
    high: float
    unit: str
    hint: str


_LENGTHS = "lengths are in metres: was it given in micrometres or millimetres?"
_MODULI = "moduli are in pascals: was it given in megapascals or gigapascals?"
_FIELDS = "fields are in volts per metre: was it given in volts per micrometre?"

_UNIT_SLIPS = (_LENGTHS, _MODULI, _FIELDS)  # which make no number zero or negative

RANGES: dict[str, Range] = {
    "thickness_m": Range(1e-9, 0.05, "m", _LENGTHS),
    "width_m": Range(1e-6, 1.0, "m", _LENGTHS),
    "length_m": Range(1e-6, 10.0, "m", _LENGTHS),
    "modulus_Pa": Range(1e2, 1e13, "Pa", _MODULI),
    "density_kg_m3": Range(1.0, 3e4, "kg/m3", "densities are in kg/m3: was it given in g/cm3?"),
    "poisson_ratio": Range(0.0, 0.5, "", "an isotropic solid that stays solid has 0 to 0.5"),
    "relative_permittivity": Range(1.0, 1e5, "", "it is relative to vacuum"),
    "field_V_m": Range(0.0, 1e10, "V/m", _FIELDS),
    "voltage_V": Range(0.0, 1e6, "V", "give its magnitude in volts: polarity does not matter"),
    "gravity_m_s2": Range(0.0, 300.0, "m/s2", "give the magnitude in the plane of bending"),
    "angle_rad": Range(-7.0, 7.0, "rad", "angles are in radians: was it given in degrees?"),
    "strain": Range(-0.5, 0.5, "", "strains are fractions: was it given in percent?"),
    "bending_stiffness_N_m2": Range(1e-20, 1e6, "N.m2", "it is the sum of width x modulus x I"),
    "weight_N_m": Range(0.0, 1e6, "N/m", "it is the weight of a metre of strip"),
}


def check(quantity: str, value: Reals, where: str = "") -> None:
    """Refuse a value outside the one table of allowed ranges.

    Parameters
    ----------
    quantity : a key of `RANGES`
    value : one value or one per design
    where : whose it is, such as `"layer 2 (electrode)"`

    Raises
    ------
    OutOfRange : outside the range or not finite; names quantity, first bad value and range
    """
    allowed = RANGES[quantity]
    within(quantity, value, allowed.low, allowed.high, allowed.unit, allowed.hint, where)


def within(
    quantity: str,
    value: Reals,
    low: float,
    high: float,
    unit: str = "",
    hint: str = "",
    where: str = "",
) -> None:
    """Refuse a value outside a range that depends on other values; as `check` otherwise."""
    if isinstance(value, (float, int)):
        if low <= value <= high:
            return
    else:
        # Extremes first: two passes without a temporary, and NaN fails both comparisons.
        values = np.asarray(value)
        if values.size and values.min() >= low and values.max() <= high:
            return
    raise OutOfRange(_complaint(quantity, np.asarray(value, float), low, high, unit, hint, where))


def _complaint(
    quantity: str,
    values: FloatArray,
    low: float,
    high: float,
    unit: str,
    hint: str,
    where: str,
) -> str:
    unit = f" {unit}" if unit else ""
    owner = f" of {where}" if where else ""
    allowed = f"allowed is {low:g} to {high:g}{unit}"
    if not values.size:
        return f"{quantity}{owner} is an empty array; {allowed}"
    bad = np.flatnonzero(~((values >= low) & (values <= high)))
    place = f" at design {bad[0]}" if values.ndim else ""
    if hint in _UNIT_SLIPS and values.flat[bad[0]] <= 0.0:
        hint = "give its magnitude, greater than zero"
    return f"{quantity}{owner} is {values.flat[bad[0]]:g}{unit}{place}; {allowed}; {hint}".rstrip(
        "; "
    )
