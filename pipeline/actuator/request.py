"""What a designer asks for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from deamat.actuator.declared import Wanted
from deamat.actuator.ranges import check, within
from deamat.core.records import Condition
from deamat.core.units import to_si

Where: TypeAlias = Mapping[str, Condition | None]


@dataclass(frozen=True, slots=True)
class Request:
    """What a designer asks for.

    Parameters
    ----------
    de, passive, electrode : material ids of the database, key of a declared electrode
    de_thickness_m : of the film as made `[m]`
    passive_thickness_m : None takes the one that bends most
    voltage_V : None takes the highest allowed one
    breakdown_probability : None takes the declared one
    where : conditions of the records, see `card_values.gather`

    Raises
    ------
    OutOfRange : a length or voltage outside `ranges.RANGES`, a voltage of zero
    """

    de: str
    passive: str
    electrode: str
    de_thickness_m: float
    passive_thickness_m: float | None = None
    voltage_V: float | None = None
    breakdown_probability: float | None = None
    where: Where = field(default_factory=dict)

    def __post_init__(self) -> None:
        check("thickness_m", self.de_thickness_m, "the de layer")
        if self.passive_thickness_m is not None:
            check("thickness_m", self.passive_thickness_m, "the passive layer")
        if self.voltage_V is not None:
            check("voltage_V", self.voltage_V, "the de layer")
            if self.voltage_V == 0.0:
                within("voltage_V", 0.0, 1e-3, 1e6, "V", "a film without voltage does not bend")

    @classmethod
    def of(cls, wanted: Wanted) -> Request:
        """Take a design of `config/designs.toml`."""
        passive, voltage = wanted.passive_thickness_um, wanted.voltage_kV
        return cls(
            wanted.de,
            wanted.passive,
            wanted.electrode,
            to_si(wanted.de_thickness_um, "um"),
            None if passive is None else to_si(passive, "um"),
            None if voltage is None else to_si(voltage, "kV"),
        )
