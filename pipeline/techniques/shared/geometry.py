"""Lengths of the register, and the cross-sections that they make."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution, Quantity


def register_length(numbers: Mapping[str, Quantity], name: str) -> Quantity:
    """Take a length such as `diameter_m` from the register.

    Raises
    ------
    FitRefused : the register does not give it, or gives nothing positive
    """
    if name not in numbers:
        raise FitRefused(
            f"the register gives no {name.removesuffix('_m')} of this specimen; fill in its column "
            f"({name}m)"
        )
    length = numbers[name]
    if not length.value > 0.0:
        raise FitRefused(f"the register's {name} is {length.value:g} m; a length must be positive")
    return length


def scale_budget(
    what: str, length: Quantity, power: float = 1.0, column: str | None = None
) -> tuple[Contribution, ...]:
    """List what an error of a length does to a value that goes with its power, relative `[1]`.

    Parameters
    ----------
    column : of the register whose gauge read it, without its unit; `what` by default
    """
    relative = power / length.value
    lines = (
        Contribution(f"{what}, reading", relative * length.u_independent, shared=False),
        gauge_error(
            f"{what}, gauge calibration", relative * length.u_shared, length, column or what
        ),
    )
    return tuple(c for c in lines if c.u > 0.0)


def gauge_error(source: str, u: float, length: Quantity, column: str) -> Contribution:
    """Return the line of a budget that is the error of a length's gauge, with its calibration."""
    if length.calibration is None:
        return Contribution(source, u, shared=True)
    return Contribution(
        source, u, shared=True, calibration=length.calibration, calibrated=column.replace(" ", "_")
    )


def inverted(budget: Iterable[Contribution]) -> tuple[Contribution, ...]:
    """Return the relative lines of what goes with the inverse: shared errors change their sign."""
    return tuple(line.inverted() if line.shared else line for line in budget)


@dataclass(frozen=True, slots=True)
class Section:
    """A cross-section before the test.

    Parameters
    ----------
    area_m2 : its area `[m^2]`
    budget : relative standard uncertainties of the area `[1]`
    """

    area_m2: float
    budget: tuple[Contribution, ...]


def circular_section(numbers: Mapping[str, Quantity]) -> Section:
    r"""Area of a cylinder, $A = \pi d^2 / 4$, from the register's `diameter_m`."""
    d = register_length(numbers, "diameter_m")
    return Section(math.pi * d.value**2 / 4.0, scale_budget("diameter", d, 2.0))


def rectangular_section(numbers: Mapping[str, Quantity]) -> Section:
    """Area of a flat strip, A = w t, from the register's `width_m` and `thickness_m`."""
    w, t = register_length(numbers, "width_m"), register_length(numbers, "thickness_m")
    return Section(w.value * t.value, scale_budget("width", w) + scale_budget("thickness", t))
