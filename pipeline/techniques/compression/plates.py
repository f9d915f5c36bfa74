"""Friction at the plates: a cylinder that cannot spread at its ends is stiffer."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import Flag, MeasuredValue

_SOURCE = "Gent & Lindley 1959"
BONDED, LUBRICATED = "bonded", "lubricated"


@dataclass(frozen=True, slots=True)
class Plates:
    r"""What the plates do to a cylinder: $E_a = E (1 + 2 S^2)$ where it is bonded to them.

    Parameters
    ----------
    declared : `bonded`, `lubricated`, or empty where the register does not say
    shape_factor : $S = D / 4h$, loaded area over free area `[1]`
    u_independent, u_shared : relative standard uncertainties of S `[1]`

    Source: A. N. Gent, P. B. Lindley, Proc. Inst. Mech. Eng. 173 (1959) 111: incompressible discs,
    small strain.
    """

    declared: str
    shape_factor: float
    u_independent: float
    u_shared: float

    @property
    def bonded_factor(self) -> float:
        """How many times as stiff a bonded cylinder is as its material."""
        return 1.0 + 2.0 * self.shape_factor**2

    @property
    def flags(self) -> tuple[Flag, ...]:
        """Say what bonded plates do to a value that is not corrected for them."""
        if self.declared != BONDED:
            return ()
        said = f"the plates are bonded: with the shape factor {self.shape_factor:.3g} the slope is "
        said += f"{self.bonded_factor:.3g} times Young's modulus (1 + 2 S^2, {_SOURCE}); not "
        said += "corrected (compression.correct_bonded_plates)"
        return (Flag("plate-friction", said),)

    @property
    def told(self) -> str:
        """State the effect for the method of a value that is not corrected."""
        if self.declared == LUBRICATED:
            return "plates lubricated"
        if self.declared == BONDED:
            return f"plates bonded, {self.bonded_factor:.3g} times Young's modulus"
        return f"friction at the plates not declared (1 to {self.bonded_factor:.3g} times)"

    def corrected(self, value: MeasuredValue) -> MeasuredValue:
        """Divide a modulus by the factor of bonded plates."""
        factor = self.bonded_factor
        modulus = value.quantity.value / factor
        slope = 4.0 * self.shape_factor**2 / factor  # of ln(factor) over ln(S)
        shape = (
            Contribution("shape factor, reading", modulus * slope * self.u_independent, False),
            Contribution("shape factor, gauge calibration", modulus * slope * self.u_shared, True),
        )
        budget = (*(replace(line, u=line.u / factor) for line in value.budget), *shape)
        return replace(
            value,
            quantity=Quantity.from_budget(modulus, value.quantity.unit, budget),
            budget=budget,
            method=f"{value.method}; divided by 1 + 2 S^2 = {factor:.4g} for bonded plates "
            f"({_SOURCE})",
        )


def plates_of(numbers: Mapping[str, Quantity], notes: Mapping[str, str]) -> Plates:
    """Read from a row what the plates do to its cylinder.

    Raises
    ------
    FitRefused : the register's `plates` is neither `bonded` nor `lubricated`
    """
    declared = notes.get("plates", "")
    if declared not in ("", BONDED, LUBRICATED):
        raise FitRefused(
            f"the register's plates are {declared!r}; write {BONDED} or {LUBRICATED}, or leave the "
            "cell empty"
        )
    diameter, height = numbers["diameter_m"], numbers["height_m"]
    parts = [(q.u_independent / q.value, q.u_shared / q.value) for q in (diameter, height)]
    return Plates(
        declared,
        diameter.value / (4.0 * height.value),
        math.hypot(*(own for own, _ in parts)),
        math.hypot(*(shared for _, shared in parts)),
    )
