"""`config/designs.toml`: what a design takes from no card, each with its source."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from pathlib import Path
from typing import Literal, TypeVar

from pydantic import Field

from deamat.actuator.strain import InPlane
from deamat.core.config import validate
from deamat.core.declared import Declared
from deamat.core.errors import ConfigError
from deamat.core.toml import parse_toml
from deamat.core.units import to_si

DESIGNS_FILE = "designs.toml"

T = TypeVar("T")


class Sourced(Declared):
    """A declared fact says where it comes from."""

    source: str = Field(min_length=3)


class Model(Sourced):
    """Which of several models and properties enters."""

    modulus: Literal["compressive_modulus", "tensile_modulus", "indentation_modulus"] = Field(
        description="property of the cards that is taken for Young's modulus"
    )
    in_plane: InPlane = Field(description="rule of `deamat.actuator.strain.in_plane_strain`")


class Elastomer(Sourced):
    """What is taken to be alike in all films."""

    poisson_ratio: float = Field(ge=0, le=0.5)


class Electrode(Sourced):
    """One electrode material, as it is applied."""

    name: str
    youngs_modulus_MPa: float = Field(gt=0)
    u_youngs_modulus_MPa: float | None = Field(
        default=None, ge=0, description="standard uncertainty; none is known where it is left out"
    )
    thickness_um: float = Field(gt=0)


class Geometry(Sourced):
    """The active part of the strip."""

    length_mm: float = Field(gt=0)
    width_mm: float = Field(gt=0)

    @property
    def length_m(self) -> float:
        """Length in SI `[m]`."""
        return to_si(self.length_mm, "mm")

    @property
    def width_m(self) -> float:
        """Width in SI `[m]`."""
        return to_si(self.width_mm, "mm")

    @property
    def area_m2(self) -> float:
        """Electrode area `[m2]`."""
        return self.length_m * self.width_m


class Tolerances(Sourced):
    """Standard uncertainties of the layers that will be made: no material test narrows them."""

    u_de_thickness_um: float = Field(ge=0)
    u_passive_thickness_um: float = Field(ge=0)
    u_electrode_thickness_um: float = Field(ge=0)


class Limits(Declared):
    """How far the voltage may go."""

    breakdown_probability: float = Field(
        default=0.01, gt=0, lt=1, description="fraction of the films that may break down"
    )
    pull_in_fraction: float = Field(
        default=0.9, gt=0, le=1, description="highest voltage over that of pull-in"
    )


class Wanted(Declared):
    """One design by name: what `deamat design NAME` asks for."""

    de: str
    passive: str
    electrode: str
    de_thickness_um: float = Field(gt=0)
    passive_thickness_um: float | None = Field(
        default=None, gt=0, description="the one that bends most where it is left out"
    )
    voltage_kV: float | None = Field(
        default=None, gt=0, description="the highest allowed one where it is left out"
    )


class Designs(Declared):
    """`config/designs.toml`."""

    model: Model
    elastomer: Elastomer
    geometry: Geometry
    tolerances: Tolerances
    limits: Limits = Limits()
    electrodes: Mapping[str, Electrode]
    designs: Mapping[str, Wanted] = Field(default_factory=dict)

    def electrode(self, key: str) -> Electrode:
        """Return a declared electrode; `ConfigError` names the nearest ones otherwise."""
        return _named(self.electrodes, key, "electrode")

    def wanted(self, name: str) -> Wanted:
        """Return a declared design; `ConfigError` names the nearest ones otherwise."""
        return _named(self.designs, name, "design")


def _named(known: Mapping[str, T], key: str, what: str) -> T:
    if key not in known:
        near = difflib.get_close_matches(key, known, n=3) or sorted(known)
        raise ConfigError(
            f"{DESIGNS_FILE} declares no {what} {key!r}; nearest: {', '.join(near) or 'none'}"
        )
    return known[key]


def load_designs(folder: str | Path) -> Designs:
    """Read and validate `designs.toml` of a configuration folder.

    Raises
    ------
    ConfigError : no such file, TOML that does not parse, an unknown or missing key, a value out
        of range
    """
    path = Path(folder) / DESIGNS_FILE
    if not path.is_file():
        raise ConfigError(f"no {path}: a design needs its electrode, tolerances and model declared")
    try:
        document = parse_toml(path.read_bytes())
    except ValueError as error:
        raise ConfigError(f"{path}: {error}") from error
    return validate(Designs, document, path)
