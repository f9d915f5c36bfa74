"""The closed table of units: every text that may stand for a unit, and its factor to SI.

Conversion happens only at the two edges (formats in, exports and report out). A unit that is not
in this table is an error, never a guess; `pint` checks the table in the tests.
"""

from __future__ import annotations

import difflib
import math
import re

from deamat.core.errors import ConfigError, PipelineError
from deamat.core.number_grammar import NUMBER

_KELVIN_AT_0_C = 273.15

# unit as written -> (SI unit, factor, offset): SI = factor * written + offset
UNITS: dict[str, tuple[str, float, float]] = {
    "1": ("1", 1.0, 0.0),
    "-": ("1", 1.0, 0.0),
    "mm/mm": ("1", 1.0, 0.0),
    "m/m": ("1", 1.0, 0.0),
    "in/in": ("1", 1.0, 0.0),
    "%": ("1", 0.01, 0.0),
    "percent": ("1", 0.01, 0.0),
    "m": ("m", 1.0, 0.0),
    "cm": ("m", 1e-2, 0.0),
    "mm": ("m", 1e-3, 0.0),
    "um": ("m", 1e-6, 0.0),
    "nm": ("m", 1e-9, 0.0),
    "in": ("m", 0.0254, 0.0),
    "inch": ("m", 0.0254, 0.0),
    "mil": ("m", 2.54e-5, 0.0),  # a thousandth of an inch
    "m2": ("m2", 1.0, 0.0),
    "cm2": ("m2", 1e-4, 0.0),
    "mm2": ("m2", 1e-6, 0.0),
    "s": ("s", 1.0, 0.0),
    "sec": ("s", 1.0, 0.0),
    "second": ("s", 1.0, 0.0),
    "ms": ("s", 1e-3, 0.0),
    "us": ("s", 1e-6, 0.0),
    "min": ("s", 60.0, 0.0),
    "h": ("s", 3600.0, 0.0),
    "N": ("N", 1.0, 0.0),
    "mN": ("N", 1e-3, 0.0),
    "uN": ("N", 1e-6, 0.0),
    "kN": ("N", 1e3, 0.0),
    "cN": ("N", 1e-2, 0.0),
    "daN": ("N", 10.0, 0.0),
    "nN": ("N", 1e-9, 0.0),
    "dyn": ("N", 1e-5, 0.0),
    "gf": ("N", 9.80665e-3, 0.0),  # what force gauges can be set to; exact by definition
    "kgf": ("N", 9.80665, 0.0),
    "ozf": ("N", 0.27801385095378125, 0.0),
    "lbf": ("N", 4.4482216152605, 0.0),
    "Pa": ("Pa", 1.0, 0.0),
    "mPa": ("Pa", 1e-3, 0.0),
    "kPa": ("Pa", 1e3, 0.0),
    "MPa": ("Pa", 1e6, 0.0),
    "GPa": ("Pa", 1e9, 0.0),
    "N/mm2": ("Pa", 1e6, 0.0),
    "N/mm^2": ("Pa", 1e6, 0.0),
    "N/m2": ("Pa", 1.0, 0.0),
    "N/cm2": ("Pa", 1e4, 0.0),
    "kgf/cm2": ("Pa", 98066.5, 0.0),
    "dyn/cm2": ("Pa", 0.1, 0.0),
    "bar": ("Pa", 1e5, 0.0),
    "psi": ("Pa", 4.4482216152605 / 0.0254**2, 0.0),
    "ksi": ("Pa", 6894757.293168361, 0.0),
    "mbar": ("Pa", 100.0, 0.0),
    "J": ("J", 1.0, 0.0),
    "mJ": ("J", 1e-3, 0.0),
    "kg": ("kg", 1.0, 0.0),
    "g": ("kg", 1e-3, 0.0),
    "mg": ("kg", 1e-6, 0.0),
    "kg/m3": ("kg/m3", 1.0, 0.0),
    "g/cm3": ("kg/m3", 1e3, 0.0),
    "N/m": ("N/m", 1.0, 0.0),
    "mN/m": ("N/m", 1e-3, 0.0),
    "rad/s": ("rad/s", 1.0, 0.0),
    "m/s": ("m/s", 1.0, 0.0),
    "mm/s": ("m/s", 1e-3, 0.0),
    "mm/min": ("m/s", 1e-3 / 60.0, 0.0),
    "mm_per_min": ("m/s", 1e-3 / 60.0, 0.0),
    "mm_per_s": ("m/s", 1e-3, 0.0),
    "1/s": ("1/s", 1.0, 0.0),
    "per_s": ("1/s", 1.0, 0.0),
    "N.m": ("N.m", 1.0, 0.0),
    "mN.m": ("N.m", 1e-3, 0.0),
    "uN.m": ("N.m", 1e-6, 0.0),
    "Nm": ("N.m", 1.0, 0.0),
    "mNm": ("N.m", 1e-3, 0.0),
    "uNm": ("N.m", 1e-6, 0.0),
    "mrad": ("rad", 1e-3, 0.0),
    "s^-1": ("1/s", 1.0, 0.0),
    "s-1": ("1/s", 1.0, 0.0),
    "1/min": ("rpm", 1.0, 0.0),
    "Pa s": ("Pa.s", 1.0, 0.0),
    "rpm": ("rpm", 1.0, 0.0),  # a setting of the viscometer, kept as it is spoken
    "Hz": ("Hz", 1.0, 0.0),
    "mHz": ("Hz", 1e-3, 0.0),
    "kHz": ("Hz", 1e3, 0.0),
    "MHz": ("Hz", 1e6, 0.0),
    "V": ("V", 1.0, 0.0),
    "mV": ("V", 1e-3, 0.0),
    "kV": ("V", 1e3, 0.0),
    "A": ("A", 1.0, 0.0),
    "mA": ("A", 1e-3, 0.0),
    "nA": ("A", 1e-9, 0.0),
    "uA": ("A", 1e-6, 0.0),
    "F": ("F", 1.0, 0.0),
    "uF": ("F", 1e-6, 0.0),
    "nF": ("F", 1e-9, 0.0),
    "pF": ("F", 1e-12, 0.0),
    "ohm": ("ohm", 1.0, 0.0),
    "kohm": ("ohm", 1e3, 0.0),
    "Mohm": ("ohm", 1e6, 0.0),
    "S": ("S", 1.0, 0.0),
    "mS": ("S", 1e-3, 0.0),
    "uS": ("S", 1e-6, 0.0),
    "nS": ("S", 1e-9, 0.0),
    "S/m": ("S/m", 1.0, 0.0),
    "S/cm": ("S/m", 100.0, 0.0),
    "S_per_m": ("S/m", 1.0, 0.0),
    "rad": ("rad", 1.0, 0.0),
    "deg": ("rad", math.pi / 180.0, 0.0),
    "V/m": ("V/m", 1.0, 0.0),
    "V/um": ("V/m", 1e6, 0.0),
    "V_per_um": ("V/m", 1e6, 0.0),
    "kV_per_mm": ("V/m", 1e6, 0.0),
    "V_per_s": ("V/s", 1.0, 0.0),
    "kV_per_s": ("V/s", 1e3, 0.0),
    "V/s": ("V/s", 1.0, 0.0),
    "Pa.s": ("Pa.s", 1.0, 0.0),
    "Pa.s^n": ("Pa.s^n", 1.0, 0.0),  # of a power-law fluid's consistency, whatever its n
    "Pas": ("Pa.s", 1.0, 0.0),
    "mPa.s": ("Pa.s", 1e-3, 0.0),
    "kPa.s": ("Pa.s", 1e3, 0.0),
    "mPas": ("Pa.s", 1e-3, 0.0),
    "mPa s": ("Pa.s", 1e-3, 0.0),
    "P": ("Pa.s", 0.1, 0.0),  # poise
    "cP": ("Pa.s", 1e-3, 0.0),
    "K": ("K", 1.0, 0.0),
    "C": ("K", 1.0, _KELVIN_AT_0_C),
    "degC": ("K", 1.0, _KELVIN_AT_0_C),
    "degF": ("K", 5.0 / 9.0, _KELVIN_AT_0_C - 32.0 * 5.0 / 9.0),
}

_SPELLINGS = str.maketrans(
    {"\u00b5": "u", "\u03bc": "u", "\u00b2": "2", "\u00b3": "3", "\u00b9": "1", "\u207b": "-",
     "\u00b0": "", "\u00b7": ".", "\u22c5": ".", "\u03a9": "ohm", "\u2126": "ohm"}
)  # fmt: skip

_WRITTEN = re.compile(rf"\s*({NUMBER.pattern})\s*([^\W\d_]\S*|%)?\s*")


class UnknownUnit(PipelineError):
    """A unit that the closed table does not hold."""


def _spelled(unit: str) -> str:
    plain = unit.strip()
    if plain == "\u00b0":
        return "deg"
    if plain.startswith(("\u00b0F", "\u2109")):
        return "degF"  # without its sign it would be a farad
    return plain.translate(_SPELLINGS)


def known(unit: str) -> bool:
    """Say whether the table holds this unit, in any of its spellings."""
    return _spelled(unit) in UNITS


def si_factor(unit: str) -> tuple[str, float, float]:
    """Return the SI unit, factor and offset of a unit: `SI = factor * written + offset`.

    Raises
    ------
    UnknownUnit : the unit is not in the table; the message names the nearest ones
    """
    spelled = _spelled(unit)
    try:
        return UNITS[spelled]
    except KeyError:
        near = difflib.get_close_matches(spelled, UNITS, n=3) or sorted(UNITS)
        raise UnknownUnit(
            f"unknown unit {unit!r}; known units near it: {', '.join(near)}"
        ) from None


def to_si(value: float, unit: str) -> float:
    """Convert a value to SI, raising `UnknownUnit` for a unit outside the table."""
    _, factor, offset = si_factor(unit)
    return factor * value + offset


def from_si(value: float, unit: str) -> float:
    """Convert an SI value to the unit asked for (the edge towards exports and report)."""
    _, factor, offset = si_factor(unit)
    return (value - offset) / factor


def read_quantity(text: str, si_unit: str, what: str) -> float:
    """Read a number that people write with its unit, such as `500um`, into SI `[si_unit]`.

    Parameters
    ----------
    text : number and unit, with or without a space
    si_unit : the SI unit that it must come to: `"m"` for a length
    what : whose value it is, for the message

    Raises
    ------
    ConfigError : not a number, a bare number (it is ambiguous), a unit of something else
    UnknownUnit : the unit is not in the table
    """
    allowed = ", ".join(sorted(u for u, (si, _, _) in UNITS.items() if si == si_unit))
    found = _WRITTEN.fullmatch(text)
    if not found:
        raise ConfigError(f"{what} is {text!r}; give a number with its unit ({allowed})")
    number, unit = found.groups()
    if unit is None:
        raise ConfigError(
            f"{what} is {text!r}: a bare number is ambiguous; give it with its unit ({allowed})"
        )
    if si_factor(unit)[0] != si_unit:
        raise ConfigError(f"{what} is {text!r}: {unit} does not fit; give it in {allowed}")
    return to_si(float(number), unit)
