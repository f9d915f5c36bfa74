"""Numbers for people: a readable unit, rounded by their own uncertainty. The one place for it.

Only the edges towards people (text, figures, pages) use this; cards and the database keep SI.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from deamat.core.quantity import Quantity
from deamat.core.records import Condition, PropertyRecord
from deamat.core.units import from_si

SYNTHETIC_BANNER = "SYNTHETIC: simulated data, not measurements"

# SI unit -> (smallest magnitude, unit that people read from there on), largest first
_LADDERS: dict[str, tuple[tuple[float, str], ...]] = {
    "Pa": ((1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (0.0, "Pa")),
    "Pa.s": ((1.0, "Pa.s"), (0.0, "mPa.s")),
    "V/m": ((0.0, "V/um"),),
    "s": ((3600.0, "h"), (60.0, "min"), (0.0, "s")),
    "m": ((1.0, "m"), (1e-3, "mm"), (0.0, "um")),
    "m2": ((0.0, "mm2"),),
    "Hz": ((1e3, "kHz"), (0.0, "Hz")),
}

# Units as pages and figures write them; a terminal may lack these letters.
_TYPESET = {
    "um": "µm", "uN": "µN", "V/um": "V/µm", "C": "°C", "Pa.s": "Pa·s", "mPa.s": "mPa·s",
    "m2": "m²", "mm2": "mm²",
}  # fmt: skip

# Pure numbers that are spoken of in percent; the others (permittivity, shape) are not.
_PERCENT = frozenset({"elongation_at_break"})

# condition key -> (words, unit that people read)
_CONDITION_WORDS: dict[str, tuple[str, str]] = {
    "age": ("age", "1"),
    "cure": ("cure", "1"),
    "temperature_K": ("temperature", "C"),
    "humidity": ("humidity", "%"),
    "frequency_Hz": ("frequency", "Hz"),
    "rate_per_s": ("rate", "1/s"),
    "time_s": ("time since mixing", "h"),
    "window": ("window", "1"),  # of strain or of time in s: the method says which
    "electrode": ("electrode", "1"),
    "electrode_area_m2": ("electrode area", "mm2"),
    "rate_V_per_s": ("rate of rise", "V/s"),
}


@dataclass(frozen=True, slots=True)
class Scale:
    """How the numbers around one quantity are written.

    Parameters
    ----------
    unit : the unit that people read
    decimals : of a number in that unit (negative rounds to tens); None shows six digits
    """

    unit: str
    decimals: int | None

    def number(self, si: float) -> str:
        """Write one SI value, or a standard uncertainty, without its unit."""
        scaled = from_si(si, self.unit)
        if self.decimals is None or not math.isfinite(scaled):
            return f"{scaled:.6g}"
        # Adding zero turns -0.0 into 0.0.
        return f"{round(scaled, self.decimals) + 0.0:.{max(self.decimals, 0)}f}"

    def with_number(self, si: float) -> str:
        """Write one SI value with its unit."""
        return self.with_unit(self.number(si))

    def typeset(self) -> Scale:
        """Return the same scale with its unit as pages and figures write it: `V/µm`."""
        return Scale(_TYPESET.get(self.unit, self.unit), self.decimals)

    def with_unit(self, text: str) -> str:
        """Put the unit behind a text; a pure number has none."""
        return text if self.unit == "1" else f"{text} {self.unit}"


def readable_unit(magnitude: float, unit: str, key: str = "") -> str:
    """Choose the unit in which people read a value of this magnitude `[unit]`."""
    if key in _PERCENT:
        return "%"
    if unit not in _LADDERS:
        return unit
    return next(name for low, name in _LADDERS[unit] if abs(magnitude) >= low)


def scale_of(quantity: Quantity, key: str = "") -> Scale:
    """Choose unit and decimals so that the uncertainty shows two significant digits.

    Parameters
    ----------
    quantity : value and uncertainty in SI
    key : property key, for the pure numbers that are spoken of in percent
    """
    u = quantity.standard_uncertainty
    unit = readable_unit(quantity.value or u, quantity.unit, key)
    if u == 0:
        return Scale(unit, None)
    return Scale(unit, _two_digits(from_si(u, unit)))


def _two_digits(u: float) -> int:
    exponent = int(f"{u:.1e}".partition("e")[2])  # after rounding: 0.0996 is 0.10
    return 1 - exponent


def readable_uncertainty(u: float, unit: str) -> str:
    """Write a standard uncertainty (SI) with two significant digits in the unit asked for."""
    scaled = from_si(u, unit)
    return Scale(unit, _two_digits(scaled) if scaled else 0).with_number(u)


def readable(quantity: Quantity, key: str = "") -> str:
    """Write a quantity as `158.8 ± 1.1 kPa`; without an uncertainty as `158.8 kPa`."""
    return _with_uncertainty(quantity, scale_of(quantity, key))


def _with_uncertainty(quantity: Quantity, scale: Scale) -> str:
    text = scale.number(quantity.value)
    if scale.decimals is not None:
        text += f" ± {scale.number(quantity.standard_uncertainty)}"
    return scale.with_unit(text)


def readable_record(record: PropertyRecord, scale: Scale | None = None) -> str:
    """Write the value of a record: `158.8 ± 1.1 kPa`, `6 to 6.5 h` or `>= 12 h` of a limit.

    Parameters
    ----------
    scale : None chooses the one of the record's quantity
    """
    scale = scale or scale_of(record.quantity, record.key)
    if record.bound == "interval":
        return readable_interval(record.ci95, scale)
    if record.bound == "lower":
        return f">= {scale.with_number(record.quantity.value)}"
    return _with_uncertainty(record.quantity, scale)


def said_of(records: Sequence[PropertyRecord]) -> tuple[str, ...]:
    """Write what a figure says of each record, in typeset units.

    `tensile modulus 0.95 ± 0.02 MPa, n = 8 (95 % interval 0.90 to 1.00 MPa)`; conditions are told
    where they tell records of one property apart.
    """
    lines = []
    for record in records:
        alike = [other.conditions for other in records if other.key == record.key]
        telling = {
            key: value
            for key, value in record.conditions.items()
            if any(other.get(key) != value for other in alike)
        }
        words = record.key.replace("_", " ")
        at = f" ({readable_conditions(telling, typeset=True)})" if telling else ""
        scale = scale_of(record.quantity, record.key).typeset()
        line = f"{words}{at} {readable_record(record, scale)}, n = {record.n}"
        if record.bound == "exact":
            line += f" (95 % interval {readable_interval(record.ci95, scale)})"
        lines.append(line)
    return tuple(lines)


def readable_interval(interval: tuple[float, float], scale: Scale) -> str:
    """Write an interval on the scale of its quantity: `156.4 to 161.2 kPa`, `above 6.0 h`."""
    low, high = interval
    if math.isinf(low) and math.isinf(high):
        return "no bound"
    if math.isinf(high):
        return scale.with_unit(f"above {scale.number(low)}")
    if math.isinf(low):
        return scale.with_unit(f"below {scale.number(high)}")
    return scale.with_unit(f"{scale.number(low)} to {scale.number(high)}")


def readable_conditions(conditions: Mapping[str, Condition], typeset: bool = False) -> str:
    """Write conditions as `age after cure, temperature 23 C`, in the order of the closed list.

    Parameters
    ----------
    typeset : write `23 °C`, as pages and figures do
    """
    said = []
    for key in sorted(conditions, key=list(_CONDITION_WORDS).index):
        words, unit = _CONDITION_WORDS[key]
        scale = Scale(unit, None).typeset() if typeset else Scale(unit, None)
        said.append(f"{words} {_readable_condition(conditions[key], scale)}")
    return ", ".join(said) or "none stated"


def _readable_condition(value: Condition, scale: Scale) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, tuple):
        return scale.with_unit(" to ".join(scale.number(v) for v in value))
    return scale.with_number(value)


def si_text(value: float, unit: str) -> str:
    """Write an SI value with every digit that it has."""
    return Scale(unit, None).with_unit(repr(float(value)))


def aligned(rows: Sequence[Sequence[str]], indent: str = "") -> list[str]:
    """Set rows of cells as lines whose columns stand under each other; all have one length."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = []
    for row in rows:
        cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        lines.append((indent + "  ".join(cells)).rstrip())
    return lines
