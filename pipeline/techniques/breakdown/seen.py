"""What was seen of one specimen, in its log or in its register row."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution
from deamat.core.recording import Specimen
from deamat.core.records import Detail, Flag
from deamat.techniques.breakdown.config import BreakdownConfig
from deamat.techniques.breakdown.result import Ramp


@dataclass(frozen=True, slots=True)
class Seen:
    """What was seen of one specimen, from whichever source.

    Parameters
    ----------
    value : voltage `[V]`, or field `[V/m]` where `is_field`
    censored : it did not break at this value
    sure : False where the log does not tell whether it broke
    budget : relative lines that belong to the value alone
    """

    value: float
    censored: bool
    method: str
    is_field: bool = False
    budget: tuple[Contribution, ...] = ()
    flags: tuple[Flag, ...] = ()
    diagnostics: Mapping[str, Detail] = field(default_factory=dict)
    ramp: Ramp | None = None
    sure: bool = True
    lines: tuple[int, int] | None = None


def declared_censored(specimen: Specimen) -> bool | None:
    """Read the register's `censored`; None where it says nothing."""
    if "censored" not in specimen.notes:
        return None
    said = specimen.notes["censored"].strip().casefold()
    if said not in ("yes", "no"):
        raise FitRefused(
            f"the register's `censored` says {specimen.notes['censored']!r}; write yes for a "
            "specimen that did not break, no for one that did"
        )
    return said == "yes"


def refuse_beyond_limit(voltage_V: float, config: BreakdownConfig) -> None:
    """Refuse a voltage that the amplifier cannot give: its unit is wrong, or the limit."""
    if voltage_V > (1.0 + max(config.limit_tolerance, 0.05)) * config.amplifier_limit_V:
        raise FitRefused(
            f"{voltage_V:.4g} V is beyond the amplifier's {config.amplifier_limit_V:g} V; correct "
            "the unit (V or kV), or declare the limit of the amplifier that was used",
            {"voltage_V": voltage_V, "amplifier_limit_V": config.amplifier_limit_V},
        )


def censored_flag(why: str) -> Flag:
    """Say of a specimen that did not break what ended its test."""
    return Flag("right-censored", f"{why}: it bore this field unbroken")
