"""The strip that a designer asks about: passive layer, electrode, one film, electrode."""

from __future__ import annotations

from dataclasses import dataclass

from deamat.actuator.ranges import Reals
from deamat.actuator.strain import InPlane


@dataclass(frozen=True, slots=True, eq=False)
class Strip:
    """One film between two electrodes on a passive layer; each number may be an array.

    Parameters
    ----------
    film_modulus_Pa, relative_permittivity, poisson_ratio, film_thickness_m : of the film as made
    passive_modulus_Pa, passive_thickness_m : of the passive layer
    electrode_modulus_Pa, electrode_thickness_m : of one electrode
    in_plane : rule of `strain.in_plane_strain`
    breakdown_strength_V_m, weibull_shape : scale and shape of the film's breakdown, where known
    area_ratio : electrode area of the strip over that of the breakdown tests `[1]`
    """

    film_modulus_Pa: Reals
    relative_permittivity: Reals
    poisson_ratio: Reals
    film_thickness_m: Reals
    passive_modulus_Pa: Reals
    passive_thickness_m: Reals
    electrode_modulus_Pa: Reals
    electrode_thickness_m: Reals
    in_plane: InPlane
    breakdown_strength_V_m: Reals | None = None
    weibull_shape: Reals | None = None
    area_ratio: float = 1.0
