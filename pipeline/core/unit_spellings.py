"""How instruments and people write units: case, plurals, blanks and signs, to the closed table.

Only for files, where a unit stands in brackets or in a row of units. Names of register columns
keep the exact spelling: `run_a` is a note, not a current.
"""

from __future__ import annotations

import re
import unicodedata

from deamat.core.units import UNITS, UnknownUnit, si_factor
from deamat.core.units import known as known_exactly

_WORDS = {
    "s": ("sec", "secs", "seconds", "sek", "sekunden", "sekunde", "sekundy", "segundos", "secondi",
          "secondes", "seconde", "\u0441", "\u0441\u0435\u043a", "\u79d2", "\ucd08"),
    "min": ("minute", "minutes", "mins", "minuten", "\u5206"),
    "h": ("hr", "hrs", "hour", "hours", "stunde", "stunden", "std", "heures", "horas", "ore",
          "godz", "\u0447", "\u5c0f\u65f6", "\u6642\u9593"),
    "ms": ("msec", "millisecond", "milliseconds"),
    "mm": ("millimeter", "millimetre", "millimeters", "millimetres", "\u043c\u043c",
           "\u6beb\u7c73"),
    "um": ("micron", "microns", "micrometer", "micrometre", "\u5fae\u7c73"),
    "nm": ("nanometer", "nanometre"),
    "m": ("meter", "metre", "meters", "metres"),
    "in": ("inches", '"'),
    "mil": ("mils",),
    "N": ("newton", "newtons", "\u043d", "\u725b", "\u725b\u987f"),
    "kN": ("kilonewton", "kilonewtons", "\u043a\u043d", "\u5343\u725b"),
    "gf": ("gram-force", "gramforce"),
    "kgf": ("kp", "kg-force"),
    "lbf": ("lb-f", "lbsf"),
    "V": ("volt", "volts"),
    "kV": ("kilovolt", "kilovolts"),
    "A": ("amp", "amps", "ampere", "amperes"),
    "Hz": ("hertz",),
    "ohm": ("ohms",),
    "F": ("farad", "farads"),
    "deg": ("degree", "degrees", "grad"),
    "rad": ("radian", "radians"),
    "percent": ("pct",),
    "Pa": ("pascal", "pascals", "\u043f\u0430"),
    "kPa": ("\u043a\u043f\u0430", "kilopascal", "kilopascals", "\u5343\u5e15"),
    "MPa": ("\u043c\u043f\u0430", "megapascal", "megapascals", "\u5146\u5e15"),
    "Pa.s": ("pa*s", "pa-s", "pas", "n s/m2", "n\u00b7s/m2", "n.s/m2", "ns/m2", "n*s/m2"),
    "kPa.s": ("kpa s", "kpa\u00b7s", "kpa*s", "kpas"),
    "mPa.s": ("mpa*s", "mpa-s"),
    "cP": ("centipoise", "cpoise"),
    "P": ("poise",),
    "dyn": ("dyne", "dynes"),
    "dyn/cm2": ("dyne/cm2", "dynes/cm2", "d/cm2", "dyn/cm^2", "dyne/cm^2", "dyn/sq cm"),
    "N/m2": ("n/m^2",),
    "N/cm2": ("n/cm^2",),
    "kgf/cm2": ("kgf/cm^2", "kg/cm2", "kg/cm^2"),
    "psi": ("lbf/in2", "lbf/in^2", "lb/in2"),
    "g/cm3": ("g/cm^3", "g/cc", "g/ml"),
    "1/s": ("1/sec", "sec-1", "sec^-1", "/s", "1/second"),
    "rpm": ("u/min", "r/min", "tr/min", "min-1", "rev/min"),
    "mN.m": ("mn-m", "mn m"),
    "uN.m": ("un-m", "un m"),
    "N.m": ("n-m", "n m"),
    "C": ("celsius", "deg c", "degc", "\u2103"),
    "degF": ("fahrenheit", "deg f"),
    "K": ("kelvin", "deg k"),
}  # fmt: skip
_ALIASES = {word: unit for unit, words in _WORDS.items() for word in words}
_SECONDS = ("S", "mS", "uS", "nS")  # over a time they are no siemens
# what may mean two things, and what to write for either
_AMBIGUOUS = {
    "lb": ("lbf (a force)", "kg (a mass)"),
    "lbs": ("lbf (a force)", "kg (a mass)"),
    "cps": ("cP (centipoise)", "1/s (counts per second)"),
    "oz": ("ozf (a force)", "kg (a mass)"),
}


_LETTERS = {0xB2: "2", 0xB3: "3", 0xB5: "u", 0x3BC: "u", 0x3C9: "ohm"}
_POINTS = dict.fromkeys((0x22C5, 0x2219, 0x2022, 0x30FB, 0xFF65), "\u00b7")  # between two units


def _folded() -> dict[str, tuple[str, ...]]:
    """Units that differ from a text in the case of their letters alone."""
    found: dict[str, list[str]] = {}
    for unit in UNITS:
        same = found.setdefault(unit.casefold(), [])
        if all(UNITS[unit] != UNITS[other] for other in same):
            same.append(unit)
    return {folded: tuple(units) for folded, units in found.items()}


_FOLDED = _folded()


def unit_as_written(text: str, si_unit: str = "") -> str | None:
    """Return the unit of the table that a text in a file stands for, or None if it is no unit.

    Parameters
    ----------
    text : as written, without brackets
    si_unit : what the column must come to, where its label says so: it decides between letters
        of either case (`S` over a time), never between two units of the same quantity

    Raises
    ------
    UnknownUnit : it may be one of several; names the choices
    """
    plain = re.sub(r"\s*([./*])\s*", r"\1", " ".join(text.translate(_POINTS).split()))
    if not plain:
        return None
    if known_exactly(plain) and not (si_unit == "s" and plain in _SECONDS):
        return plain
    folded = plain.casefold().rstrip(".")
    if folded in _AMBIGUOUS:
        _refuse(text, _AMBIGUOUS[folded])
    if folded in _ALIASES:
        return _ALIASES[folded]
    spelled = unicodedata.normalize("NFKC", folded).casefold().translate(_LETTERS)
    if spelled in _ALIASES:
        return _ALIASES[spelled]
    if plain.endswith(".") and known_exactly(plain[:-1]):
        return plain[:-1]
    choices = _FOLDED.get(spelled, ())
    if si_unit:
        choices = tuple(unit for unit in choices if si_factor(unit)[0] == si_unit) or choices
    if len(choices) > 1 and plain[:1] == "M" and plain[1:2].islower():
        choices = tuple(unit for unit in choices if unit.startswith("M"))  # `Mpa`
    if len(choices) > 1:
        _refuse(text, choices)
    if not choices or (len(plain) == 1 and si_unit != si_factor(choices[0])[0]):
        return None
    return choices[0]


def _of_other_case(unit: str, si_unit: str) -> str | None:
    """Return the unit of the wanted kind that differs from this one of another kind in case alone.

    `S` over a time is no siemens.
    """
    if not si_unit or si_factor(unit)[0] == si_unit:
        return None
    fitting = [u for u in _FOLDED.get(unit.casefold(), ()) if si_factor(u)[0] == si_unit]
    return fitting[0] if len(fitting) == 1 else None


def _refuse(text: str, choices: tuple[str, ...]) -> None:
    raise UnknownUnit(
        f"the unit {text!r} may be {' or '.join(choices)}; write the one that is meant"
    )
