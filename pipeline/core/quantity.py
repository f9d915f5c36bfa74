"""A value with its unit and the two kinds of uncertainty that behave differently in a mean."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, ClassVar

from deamat.core.errors import OutOfRange
from deamat.core.kinds import SAID, UNCERTAINTY, UNIT
from deamat.core.schema import After, Entry, Mark
from deamat.core.units import si_factor


@dataclass(frozen=True, slots=True)
class Contribution:
    """One line of an uncertainty budget: a standard uncertainty and where it comes from."""

    ENTRY: ClassVar = Entry("contribution", "budgets")

    source: Annotated[str, SAID, "What causes it, such as `load cell calibration`."]
    u: Annotated[float, UNCERTAINTY, "Standard uncertainty, in the unit of the value."]
    shared: Annotated[bool, "One error common to all specimens: it never averages away."]
    calibration: Annotated[
        str | None,
        "Id of the calibration that the error is of: one error in all values that name it. Left "
        "out where none is declared.",
    ] = None
    calibrated: Annotated[
        str | None, "What of it: `force`, `voltage`, or the column of a gauge (`thickness`)."
    ] = None
    inverse: Annotated[
        bool, "The value falls where what the error is of rises. Left out where it is false."
    ] = False
    assumed: Annotated[
        bool,
        "From default limits: no entry of `config/instruments.toml` matches the instrument. Left "
        "out where it is false.",
    ] = False
    degrees_of_freedom: Annotated[
        float | None,
        "Of the standard uncertainty: then the error has Student's t distribution. Left out where "
        "it counts as known.",
    ] = None

    @property
    def signed_u(self) -> float:
        """The standard uncertainty, negative where the value falls as the error rises."""
        return -self.u if self.inverse else self.u

    def scaled(self, factor: float) -> Contribution:
        """Return the line of a value that is so many times as large, whatever the sign."""
        return replace(self, u=abs(factor) * self.u)

    def inverted(self) -> Contribution:
        """Return the line of a value that goes with the inverse."""
        return replace(self, inverse=not self.inverse)


def averaged(budgets: Sequence[Iterable[Contribution]]) -> tuple[Contribution, ...]:
    """Average each shared line over the budgets of several specimens: one error for each cause."""
    totals: dict[Contribution, float] = {}
    for budget in budgets:
        for line in budget:
            if line.shared:
                cause = replace(line, u=0.0)
                totals[cause] = totals.get(cause, 0.0) + line.u
    return tuple(replace(cause, u=u / len(budgets)) for cause, u in totals.items())


@dataclass(frozen=True, slots=True)
class Quantity:
    """A value in SI with independent and shared standard uncertainty.

    The combined standard uncertainty is `u = sqrt(u_independent^2 + u_shared^2)`. A mean over n
    specimens divides only the independent part by sqrt(n).

    Raises
    ------
    OutOfRange : a value that is not finite, or an uncertainty that is negative or not finite

    Source: JCGM 100:2008 (GUM), 5.1 and 5.2.
    """

    value: float
    unit: Annotated[str, UNIT]
    u_independent: Annotated[
        float,
        UNCERTAINTY,
        Mark.ALWAYS,
        "Part that averages away over specimens (scatter between them, fit).",
    ] = 0.0
    u_shared: Annotated[
        float,
        UNCERTAINTY,
        Mark.ALWAYS,
        "Part common to the campaign (gauge, load cell, plate area): it never averages away.",
    ] = 0.0
    calibration: Annotated[
        str | None, Mark.NOT_WRITTEN, "Id of the calibration of its gauge: budgets name it."
    ] = None

    def __post_init__(self) -> None:
        if not math.isfinite(self.value):
            raise OutOfRange(f"a quantity must be finite, not {self.value} {self.unit}")
        for name, u in (("u_independent", self.u_independent), ("u_shared", self.u_shared)):
            if not (math.isfinite(u) and u >= 0):
                raise OutOfRange(f"{name} must be finite and not negative, not {u} {self.unit}")

    @property
    def standard_uncertainty(
        self,
    ) -> Annotated[
        float,
        UNCERTAINTY,
        After("unit"),
        "Combined: the root of the sum of the squares of the two parts below.",
    ]:
        """Combined standard uncertainty `[unit]`."""
        return math.hypot(self.u_independent, self.u_shared)

    def to(self, unit: str) -> Quantity:
        """Return the quantity in another unit, for people: everything here computes in SI.

        Raises
        ------
        OutOfRange : the unit is one of something else
        UnknownUnit : the unit is not in the closed table
        """
        mine, other = si_factor(self.unit), si_factor(unit)
        if mine[0] != other[0]:
            raise OutOfRange(f"{self.value:g} {self.unit} cannot be returned in {unit}")
        factor = mine[1] / other[1]
        return Quantity(
            *(factor * self.value + (mine[2] - other[2]) / other[1], unit),
            *(factor * self.u_independent, factor * self.u_shared),
        )

    @classmethod
    def from_budget(cls, value: float, unit: str, budget: Iterable[Contribution]) -> Quantity:
        """Add up a budget in quadrature, shared and independent lines apart."""
        lines = list(budget)
        return cls(
            value,
            unit,
            math.sqrt(math.fsum(c.u**2 for c in lines if not c.shared)),
            math.sqrt(math.fsum(c.u**2 for c in lines if c.shared)),
        )
