"""What an actuator is made of: layers from bottom to top, and which way gravity pulls on it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from deamat.actuator.ranges import Reals, check
from deamat.core.errors import MissingProperty, OutOfRange

Role: TypeAlias = Literal["passive", "electrode", "de", "insulation"]

STANDARD_GRAVITY_m_s2 = 9.80665


@dataclass(frozen=True, slots=True, eq=False)
class Layer:
    """One layer as it was made, before any voltage; each number may be an array over designs.

    Parameters
    ----------
    role : `de` is the dielectric elastomer, driven over its whole width; the others only resist
    thickness_m, width_m : undeformed `[m]`
    modulus_Pa : Young's modulus `[Pa]`
    density_kg_m3 : mass density `[kg/m3]`
    relative_permittivity, poisson_ratio : asked for when a `de` layer is put under voltage `[1]`

    Raises
    ------
    OutOfRange : an unknown role, or a number outside `ranges.RANGES`
    """

    role: Role
    thickness_m: Reals
    modulus_Pa: Reals
    width_m: Reals
    density_kg_m3: Reals
    relative_permittivity: Reals | None = None
    poisson_ratio: Reals | None = None

    def __post_init__(self) -> None:
        if self.role not in get_args(Role):
            raise OutOfRange(f"role is {self.role!r}; allowed are {', '.join(get_args(Role))}")
        where = f"the {self.role} layer"
        check("thickness_m", self.thickness_m, where)
        check("modulus_Pa", self.modulus_Pa, where)
        check("width_m", self.width_m, where)
        check("density_kg_m3", self.density_kg_m3, where)
        if self.relative_permittivity is not None:
            check("relative_permittivity", self.relative_permittivity, where)
        if self.poisson_ratio is not None:
            check("poisson_ratio", self.poisson_ratio, where)

    def dielectric(self) -> tuple[Reals, Reals]:
        """Return relative permittivity and Poisson's ratio, or say which is missing."""
        if self.relative_permittivity is None or self.poisson_ratio is None:
            missing = "relative_permittivity" if self.relative_permittivity is None else ""
            missing = missing or "poisson_ratio"
            raise MissingProperty(f"a de layer under voltage needs its {missing}; it has none")
        return self.relative_permittivity, self.poisson_ratio


@dataclass(frozen=True, slots=True, eq=False)
class Stack:
    """Layers from bottom (first) to top; the positive bending side is that of the first layer.

    Raises
    ------
    OutOfRange : no layers
    """

    layers: tuple[Layer, ...]

    def __post_init__(self) -> None:
        if not self.layers:
            raise OutOfRange("the stack has 0 layers; a beam needs at least one")


@dataclass(frozen=True, slots=True, eq=False)
class Orientation:
    """Which way gravity pulls in the plane of bending.

    Parameters
    ----------
    angle_rad : from the root's axis (pointing to the tip) to the direction of gravity, counted
        towards the side of the first layer `[rad]`
    gravity_m_s2 : magnitude of gravity in the plane of bending `[m/s2]`
    """

    angle_rad: Reals
    gravity_m_s2: Reals = STANDARD_GRAVITY_m_s2

    def __post_init__(self) -> None:
        check("angle_rad", self.angle_rad)
        check("gravity_m_s2", self.gravity_m_s2)


FIRST_LAYER_DOWN = Orientation(
    math.pi / 2
)  # horizontal; weight helps a unimorph, as in the article
FIRST_LAYER_UP = Orientation(-math.pi / 2)  # horizontal; weight works against it
HANGING = Orientation(0.0)
STANDING = Orientation(math.pi)
ON_EDGE = Orientation(0.0, 0.0)  # gravity across the plane of bending does not bend it
