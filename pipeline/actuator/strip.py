"""The strip that a designer asks about: passive layer, electrode, one film, electrode.

Curvature is that of `beam.actuate` in closed form (thinned film, no weight), so that thousands of
draws and designs cost one pass over arrays.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deamat.actuator.figure_of_merit import Unimorph, active_part, multilayer
from deamat.actuator.optimum import best_passive_thickness
from deamat.actuator.ranges import Reals, check, within
from deamat.actuator.strain import (
    PULL_IN_DRIVE,
    PULL_IN_STRAIN,
    InPlane,
    drive,
    film_drive,
    in_plane_strain,
    pull_in_voltage,
    thickness_strain,
)
from deamat.core.errors import MissingProperty

Floats = NDArray[np.float64]


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

    def moved(self, values: Mapping[str, Floats]) -> Strip:
        """Give the strip with arrays in place of some numbers, by field."""
        fields: dict[str, Any] = dict(values)  # by names that only a run knows
        return replace(self, **fields)

    def weibull(self) -> tuple[Reals, Reals]:
        """Give scale and shape of the breakdown, or say that they are not known."""
        if self.breakdown_strength_V_m is None or self.weibull_shape is None:
            raise MissingProperty(
                "the breakdown limit is unknown: the card of the de layer has no "
                "breakdown_strength with its weibull_shape; test its breakdown, or give a voltage"
            )
        return self.breakdown_strength_V_m, self.weibull_shape


@dataclass(frozen=True, slots=True)
class Allowed:
    """How far the voltage may go.

    Parameters
    ----------
    breakdown_probability : part of the films that may break down, 0 to 1 `[1]`
    pull_in_fraction : highest voltage over that of pull-in, 0 to 1 `[1]`
    area_ratio : electrode area of the strip over that of the breakdown tests `[1]`
    """

    breakdown_probability: float
    pull_in_fraction: float
    area_ratio: float = 1.0

    def __post_init__(self) -> None:
        mend = "it is a fraction: was it given in percent?"
        within("breakdown_probability", self.breakdown_probability, 1e-9, 1.0 - 1e-9, mend=mend)
        within("pull_in_fraction", self.pull_in_fraction, 1e-3, 1.0, mend=mend)


def pulls_in(strip: Strip, voltage_V: Reals) -> Reals:
    """Say which designs have no equilibrium at a voltage."""
    field = voltage_V / strip.film_thickness_m
    s0 = drive(strip.relative_permittivity, field, strip.film_modulus_Pa)
    return np.asarray(s0 > PULL_IN_DRIVE)


def curvature(strip: Strip, voltage_V: Reals) -> Reals:
    """Give the curvature of a weightless strip under voltage, towards the passive layer `[1/m]`.

    Parameters
    ----------
    strip, voltage_V : scalars or arrays that broadcast

    Raises
    ------
    OutOfRange : a number outside `ranges.RANGES`, a voltage above pull-in

    Source: `beam.actuate` with thinning; Sikulskyi et al. 2022, Eqs. 4-9.
    """
    s = strip
    film_drive(
        voltage_V, s.film_thickness_m, s.film_modulus_Pa, s.relative_permittivity, "the de layer"
    )
    return _curvature(strip, voltage_V)


def curvature_or_nan(strip: Strip, voltage_V: Reals) -> Reals:
    """Give the curvature as `curvature` does, NaN for each design that pulls in `[1/m]`."""
    return np.where(pulls_in(strip, voltage_V), np.nan, _curvature(strip, voltage_V))


def best_passive(strip: Strip, voltage_V: Reals) -> Reals:
    """Give the passive thickness that bends most at a voltage, with the film thinned `[m]`."""
    unimorph, _ = _thinned(strip, voltage_V)
    return best_passive_thickness(unimorph)


def blocked_force(strip: Strip, voltage_V: Reals, length_m: float, width_m: float) -> Reals:
    """Give the force that holds the tip of a cantilever at its place, `3 B kappa / (2 L)` `[N]`.

    Parameters
    ----------
    strip, voltage_V : scalars or arrays that broadcast; NaN where a design pulls in
    length_m, width_m : of the strip `[m]`

    Source: small deflections, `kappa L^2 / 2 = F L^3 / (3 B)`.
    """
    check("length_m", length_m)
    check("width_m", width_m)
    unimorph, _ = _thinned(strip, voltage_V)
    tp = unimorph.passive_thickness_m
    passive = unimorph.passive_modulus_Pa * tp
    pull, bending, height = active_part(unimorph)
    h = 0.5 * (tp + height)
    stiffness = passive * tp * tp / 12.0 + bending + h * h * passive * pull / (passive + pull)
    return 1.5 * width_m * stiffness * curvature_or_nan(strip, voltage_V) / length_m


def true_field(strip: Strip, voltage_V: Reals) -> Reals:
    """Give the field on the thinned film, `V / (t0 (1 - s))` `[V/m]`; NaN where it pulls in."""
    field = voltage_V / strip.film_thickness_m
    return np.where(pulls_in(strip, voltage_V), np.nan, field / (1.0 - _thinning(strip, voltage_V)))


def failure_probability(strip: Strip, voltage_V: Reals, area_ratio: float = 1.0) -> Reals:
    """Give the part of films that break down, `1 - exp(-a (E / E_b)^beta)`; 1 beyond pull-in.

    Parameters
    ----------
    strip, voltage_V : scalars or arrays; `E` is the field on the thinned film
    area_ratio : `a`, electrode area over that of the breakdown tests `[1]`

    Raises
    ------
    MissingProperty : the strip's breakdown is not known

    Source: IEC 62539; weakest link over the area.
    """
    scale, shape = strip.weibull()
    hazard = area_ratio * (true_field(strip, voltage_V) / scale) ** shape
    chance: Reals = np.where(np.isnan(hazard), 1.0, -np.expm1(-hazard))
    return chance


def breakdown_field(strip: Strip, allowed: Allowed) -> Reals:
    """Give the field that the allowed part of the films does not survive `[V/m]`.

    `E = E_b (-ln(1 - q) / a)^(1 / beta)`, `a` being the area ratio.

    Raises
    ------
    MissingProperty : the strip's breakdown is not known
    """
    scale, shape = strip.weibull()
    hazard = -np.log1p(-allowed.breakdown_probability) / allowed.area_ratio
    field: Reals = scale * np.power(hazard, 1.0 / np.asarray(shape))
    return field


def highest_voltage(strip: Strip, allowed: Allowed) -> Reals:
    """Give the voltage that breakdown and pull-in allow, whichever comes first `[V]`.

    At the true field `E` the film has thinned by `s = eps0 eps_r E^2 / Y`, so it sees
    `V = E t0 (1 - s)` if `s` is below 1/3; otherwise it pulls in before.

    Raises
    ------
    MissingProperty : the strip's breakdown is not known
    """
    return np.minimum(breakdown_voltage(strip, allowed), pull_in_limit(strip, allowed))


def breakdown_voltage(strip: Strip, allowed: Allowed) -> Reals:
    """Give the voltage at which the film sees `breakdown_field`; infinite if it pulls in before."""
    field = breakdown_field(strip, allowed)
    s = drive(strip.relative_permittivity, field, strip.film_modulus_Pa)
    return np.where(s < PULL_IN_STRAIN, field * strip.film_thickness_m * (1.0 - s), np.inf)


def pull_in_limit(strip: Strip, allowed: Allowed) -> Reals:
    """Give the allowed part of the pull-in voltage `[V]`."""
    limit = pull_in_voltage(
        strip.film_thickness_m, strip.film_modulus_Pa, strip.relative_permittivity
    )
    return allowed.pull_in_fraction * limit


def _thinning(strip: Strip, voltage_V: Reals) -> Reals:
    field = voltage_V / strip.film_thickness_m
    s0 = drive(strip.relative_permittivity, field, strip.film_modulus_Pa)
    return thickness_strain(np.minimum(s0, PULL_IN_DRIVE))


def _thinned(strip: Strip, voltage_V: Reals) -> tuple[Unimorph, Reals]:
    s = _thinning(strip, voltage_V)
    unimorph = Unimorph(
        strip.passive_thickness_m,
        strip.passive_modulus_Pa,
        strip.film_thickness_m * (1.0 - s),
        strip.film_modulus_Pa,
        strip.electrode_thickness_m,
        strip.electrode_modulus_Pa,
    )
    return unimorph, in_plane_strain(s, strip.poisson_ratio, strip.in_plane)


def _curvature(strip: Strip, voltage_V: Reals) -> Reals:
    unimorph, strain = _thinned(strip, voltage_V)
    return multilayer(unimorph, strain)
