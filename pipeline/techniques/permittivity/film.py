"""The film between its plates: its thickness without the micrometer's force, and its area."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import Flag
from deamat.core.technique import Context
from deamat.core.units import from_si
from deamat.estimators.dielectric.edge_field import vacuum_capacitance
from deamat.estimators.dielectric.squeeze import (
    squeeze_sensitivity,
    squeezed_stretch,
    sticking_modulus,
)
from deamat.techniques.permittivity.config import MODULUS, PermittivityConfig
from deamat.techniques.shared.geometry import register_length, scale_budget


@dataclass(frozen=True, slots=True)
class Film:
    """One film between two equal rectangular plates.

    Parameters
    ----------
    thickness_m : without any force on it
    read_m : as read under the micrometer
    sticking_m : what the thickness would be if the film stuck to the anvils
    area_m2, perimeter_m : of one plate
    budget : relative standard uncertainties of d/A `[1]`
    correction : what was done to the thickness, in words
    edge_corrected : the capacitance comes without the edge field
    """

    thickness_m: float
    read_m: float
    sticking_m: float
    area_m2: float
    perimeter_m: float
    budget: tuple[Contribution, ...]
    correction: str
    edge_corrected: bool = False

    @property
    def squeeze(self) -> float:
        """Strain under the micrometer, `1 - d_read / d` `[1]`."""
        return 1.0 - self.read_m / self.thickness_m

    @property
    def empty_F(self) -> float:
        """Capacitance of the plates alone, at the thickness as read `[F]`."""
        return vacuum_capacitance(self.area_m2, self.read_m)

    @property
    def aspect(self) -> float:
        """Root of the area over the thickness `[1]`."""
        return math.sqrt(self.area_m2) / self.thickness_m


def film_of(numbers: Mapping[str, Quantity], context: Context[PermittivityConfig]) -> Film:
    """Undo the micrometer's squeeze and measure the plates.

    Parameters
    ----------
    numbers : `thickness_m`, `plate_length_m`, `plate_width_m`, `micrometer_force_N` (0 for a
        thickness read without contact) and, if there is a force, `anvil_diameter_m`
    context : if there is a force, the compressive modulus

    Raises
    ------
    FitRefused : something of this is not known, or the film is squeezed beyond the declared limit

    Source: see `deamat.estimators.dielectric.squeeze`.
    """
    read = register_length(numbers, "thickness_m")
    length = register_length(numbers, "plate_length_m")
    width = register_length(numbers, "plate_width_m")
    # the same plates for every film: whatever their size is wrong by, it is wrong for all
    u_area = math.hypot(
        length.standard_uncertainty / length.value, width.standard_uncertainty / width.value
    )
    stretch, sticking, squeezed, correction = _squeeze(numbers, read, context)
    return Film(
        thickness_m=read.value / stretch,
        read_m=read.value,
        sticking_m=read.value / sticking,
        area_m2=length.value * width.value,
        perimeter_m=2.0 * (length.value + width.value),
        budget=(
            *scale_budget("film thickness", read, column="thickness"),
            *squeezed,
            Contribution("plate area", u_area, shared=True, inverse=True),
        ),
        correction=correction,
    )


def _squeeze(
    numbers: Mapping[str, Quantity], read: Quantity, context: Context[PermittivityConfig]
) -> tuple[float, float, tuple[Contribution, ...], str]:
    """Stretch under the anvils (assumed, and if the film stuck), its budget, and words for it."""
    config, force = context.config, _force(numbers)
    if force.value == 0.0:
        return 1.0, 1.0, (), "thickness read without contact"
    if "anvil_diameter_m" not in numbers:
        raise FitRefused(
            f"the thickness was read under {force.value:g} N, but on which area is not declared: "
            "fill in anvil_diameter_mm of the register"
        )
    anvil = register_length(numbers, "anvil_diameter_m")
    if MODULUS not in context.needs:
        raise FitRefused(
            f"the thickness was read under {force.value:g} N and the {MODULUS} of this material "
            "is not known for this campaign and age, so the squeeze cannot be undone; add its "
            "compression tests, or read the thickness without contact (micrometer_force_N = 0)"
        )
    modulus = context.needs[MODULUS]
    pressure = force.value / (math.pi / 4.0 * anvil.value**2)
    bonded = pressure / sticking_modulus(modulus.value, read.value, anvil.value)
    ratio = pressure / modulus.value if config.anvil_contact == "slipping" else bonded
    stretch = squeezed_stretch(ratio)
    if 1.0 - stretch > config.max_squeeze:
        raise FitRefused(
            f"{force.value:g} N on an anvil of {from_si(anvil.value, 'mm'):g} mm are "
            f"{pressure / 1e3:.3g} kPa, {ratio:.2g} of the film's modulus: squeezed by "
            f"{100 * (1 - stretch):.3g} %, more than the {100 * config.max_squeeze:g} % up to "
            "which the correction is trusted; use a larger anvil, less force, or no contact",
            {"pressure_Pa": pressure, "squeeze": 1.0 - stretch},
        )
    words = (
        f"thickness corrected for {force.value:g} N on an anvil of "
        f"{from_si(anvil.value, 'mm'):g} mm ({config.anvil_contact} neo-Hookean film, measured "
        f"{MODULUS})"
    )
    sensitivity = squeeze_sensitivity(ratio)
    u_force = math.hypot(force.standard_uncertainty / force.value, config.u_micrometer_force)
    budget = (
        ("modulus, in the squeeze", modulus.standard_uncertainty / modulus.value),
        ("micrometer force, in the squeeze", u_force),
        ("anvil diameter, in the squeeze", 2.0 * anvil.standard_uncertainty / anvil.value),
    )
    return (
        stretch,
        squeezed_stretch(bonded),
        tuple(Contribution(source, sensitivity * u, shared=True) for source, u in budget),
        words,
    )


def _force(numbers: Mapping[str, Quantity]) -> Quantity:
    if "micrometer_force_N" not in numbers:
        raise FitRefused(
            "the register does not say under which force the thickness was read: fill in "
            "micrometer_force_N (0 for a reading without contact)"
        )
    force = numbers["micrometer_force_N"]
    if force.value < 0.0:
        raise FitRefused(f"micrometer_force_N is {force.value:g}; a force is not negative")
    return force


def film_flags(film: Film, config: PermittivityConfig) -> tuple[Flag, ...]:
    """Flag a film that is too thick for its plates, or much squeezed by the micrometer."""
    flags: tuple[Flag, ...] = ()
    if film.aspect < config.min_aspect:
        flags += (
            Flag(
                "electrode-aspect",
                f"sqrt(A)/d = {film.aspect:.3g}, where more than {config.min_aspect:g} is asked "
                "for: the edge field counts",
            ),
        )
    if film.squeeze > config.squeeze_flag:
        less = 100.0 * (1.0 - film.sticking_m / film.thickness_m)
        flags += (
            Flag(
                "squeezed-film",
                f"read {100 * film.squeeze:.3g} % too thin if it slips under the anvils, beyond "
                f"the {100 * config.squeeze_flag:g} % over which the modulus is known; if it "
                f"stuck to them, eps_r would be {less:.3g} % lower",
            ),
        )
    return flags
