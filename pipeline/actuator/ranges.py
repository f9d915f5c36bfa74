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
    """What is allowed of a quantity.

    Parameters
    ----------
    low, high : lowest and highest value `[unit]`
    hint : what would put right a value outside
    unit_slip : the hint asks for a slip of units, which makes no number zero or negative
    """

    low: float
    high: float
    unit: str
    hint: str
    unit_slip: bool = False


_LENGTHS = "lengths are in metres: was it given in micrometres or millimetres?"
_MODULI = "moduli are in pascals: was it given in megapascals or gigapascals?"
_FIELDS = "fields are in volts per metre: was it given in volts per micrometre?"

RANGES: dict[str, Range] = {
    "thickness_m": Range(1e-9, 0.05, "m", _LENGTHS, unit_slip=True),
    "width_m": Range(1e-6, 1.0, "m", _LENGTHS, unit_slip=True),
    "length_m": Range(1e-6, 10.0, "m", _LENGTHS, unit_slip=True),
    "modulus_Pa": Range(1e2, 1e13, "Pa", _MODULI, unit_slip=True),
    "density_kg_m3": Range(1.0, 3e4, "kg/m3", "densities are in kg/m3: was it given in g/cm3?"),
    "poisson_ratio": Range(0.0, 0.5, "", "an isotropic solid that stays solid has 0 to 0.5"),
    "relative_permittivity": Range(1.0, 1e5, "", "it is relative to vacuum"),
    "field_V_m": Range(0.0, 1e10, "V/m", _FIELDS, unit_slip=True),
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
    if not _inside(value, allowed.low, allowed.high):
        raise OutOfRange(_complaint(quantity, np.asarray(value, float), allowed, where))


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
    if not _inside(value, low, high):
        allowed = Range(low, high, unit, hint)
        raise OutOfRange(_complaint(quantity, np.asarray(value, float), allowed, where))


def _inside(value: Reals, low: float, high: float) -> bool:
    if isinstance(value, (float, int)):
        return low <= value <= high
    # Extremes first: two passes without a temporary, and NaN fails both comparisons.
    values = np.asarray(value)
    return bool(values.size and values.min() >= low and values.max() <= high)


def _complaint(quantity: str, values: FloatArray, allowed: Range, where: str) -> str:
    low, high, hint = allowed.low, allowed.high, allowed.hint
    unit = f" {allowed.unit}" if allowed.unit else ""
    owner = f" of {where}" if where else ""
    said = f"allowed is {low:g} to {high:g}{unit}"
    if not values.size:
        return f"{quantity}{owner} is an empty array; {said}"
    bad = np.flatnonzero(~((values >= low) & (values <= high)))
    place = f" at design {bad[0]}" if values.ndim else ""
    if allowed.unit_slip and values.flat[bad[0]] <= 0.0:
        hint = "give its magnitude, greater than zero"
    return f"{quantity}{owner} is {values.flat[bad[0]]:g}{unit}{place}; {said}; {hint}".rstrip("; ")
