"""Figures of merit: how far a unimorph can bend, in closed form, for choosing materials.

Each bending figure is a curvature and linear in the free strain of the active layer, so any other
active material (piezoelectric, thermal, swelling) is judged by handing in its strain in place of
`dea_strain`. Weight and thinned thicknesses are left to `beam`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deamat.actuator.ranges import RANGES, Reals, check, within
from deamat.actuator.strain import PULL_IN_STRAIN, drive, pull_in_field
from deamat.core.errors import OutOfRange


@dataclass(frozen=True, slots=True, eq=False)
class Unimorph:
    """One passive layer, then electrode and active layers in turn, all of one width.

    All active layers are alike, and so are the `n_active + 1` electrodes. Each number may be an
    array over designs.

    Parameters
    ----------
    passive_thickness_m, passive_modulus_Pa : `[m]`, `[Pa]`
    active_thickness_m, active_modulus_Pa : of one active layer `[m]`, `[Pa]`
    electrode_thickness_m, electrode_modulus_Pa : of one electrode; 0 for none `[m]`, `[Pa]`
    n_active : number of active layers, one for all designs

    Raises
    ------
    OutOfRange : no active layer, or a number outside `ranges.RANGES`

    Source: Sikulskyi et al. 2022, section 2.1.2, assumptions 2-6.
    """

    passive_thickness_m: Reals
    passive_modulus_Pa: Reals
    active_thickness_m: Reals
    active_modulus_Pa: Reals
    electrode_thickness_m: Reals
    electrode_modulus_Pa: Reals
    n_active: int = 1

    def __post_init__(self) -> None:
        check("thickness_m", self.passive_thickness_m, "the passive layer")
        check("modulus_Pa", self.passive_modulus_Pa, "the passive layer")
        check("thickness_m", self.active_thickness_m, "the active layer")
        check("modulus_Pa", self.active_modulus_Pa, "the active layer")
        for quantity, value in (
            ("thickness_m", self.electrode_thickness_m),
            ("modulus_Pa", self.electrode_modulus_Pa),
        ):
            allowed = RANGES[quantity]
            within(quantity, value, 0.0, allowed.high, allowed.unit, allowed.hint, "the electrode")
        within("n_active", self.n_active, 1, 10_000, hint="give the number of active layers")

    @property
    def total_thickness_m(self) -> Reals:
        """Thickness of the whole stack `[m]`."""
        n = self.n_active
        active = n * self.active_thickness_m + (n + 1) * self.electrode_thickness_m
        return self.passive_thickness_m + active


def planar(relative_permittivity: Reals, field_V_m: Reals, modulus_Pa: Reals) -> Reals:
    """Return the figure of merit of a planar actuator, `eps0 eps_r E^2 / Y` `[1]`.

    It ranks materials by the thickness strain they would reach; unlike `dea_strain` it does not
    ask whether the film gets there.

    Parameters
    ----------
    relative_permittivity, field_V_m, modulus_Pa : scalars or arrays; the field at breakdown, or
        whichever field is compared `[1]`, `[V/m]`, `[Pa]`

    Raises
    ------
    OutOfRange : an input outside `ranges.RANGES`

    Source: Sikulskyi et al. 2022, Eq. 1; McKay et al. 2009.
    """
    return drive(relative_permittivity, field_V_m, modulus_Pa)


def dea_strain(
    relative_permittivity: Reals, field_V_m: Reals, modulus_Pa: Reals, poisson_ratio: Reals
) -> Reals:
    """Return the free in-plane strain of a film at its true field, `nu eps0 eps_r E^2 / Y` `[1]`.

    Parameters
    ----------
    relative_permittivity, modulus_Pa, poisson_ratio : of the film `[1]`, `[Pa]`, `[1]`
    field_V_m : true field, on the thinned film `[V/m]`

    Raises
    ------
    OutOfRange : an input outside `ranges.RANGES`, or a field that the film does not reach because
        it pulls in before

    Source: Sikulskyi et al. 2022, Eqs. 4 and 16.
    """
    check("poisson_ratio", poisson_ratio)
    s = drive(relative_permittivity, field_V_m, modulus_Pa)
    if np.max(s) > PULL_IN_STRAIN:
        at = np.argmax(s)
        field, limit = np.broadcast_arrays(
            field_V_m, pull_in_field(modulus_Pa, relative_permittivity), s
        )[:2]
        hint = "above the pull-in field the film has no equilibrium: lower the field"
        within("field_V_m", float(field.flat[at]), 0.0, float(limit.flat[at]), "V/m", hint)
    return poisson_ratio * s


def no_electrodes(unimorph: Unimorph, active_strain: Reals) -> Reals:
    """Return the curvature of a unimorph whose electrodes are thin and soft enough to forget.

    `k = 6 e Y (t + t^2) / (t_a (1 + Y^2 t^4 + Y t (4 + 6 t + 4 t^2)))` with `Y = Y_p / Y_a` and
    `t = t_p / t_a`, `t_a` being all active layers together.

    Parameters
    ----------
    unimorph : its electrodes are ignored
    active_strain : free in-plane strain `e` of the active layer, such as `dea_strain` `[1]`

    Returns
    -------
    curvature towards the passive layer `[1/m]`

    Raises
    ------
    OutOfRange : a strain outside `ranges.RANGES`

    Source: Sikulskyi et al. 2022, Eq. 17.
    """
    check("strain", active_strain, "the active layer")
    ta = unimorph.n_active * unimorph.active_thickness_m
    t = unimorph.passive_thickness_m / ta
    yt = unimorph.passive_modulus_Pa / unimorph.active_modulus_Pa * t
    t2 = t * t
    stiffness = 1.0 + yt * (4.0 + 6.0 * t + 4.0 * t2 + yt * t2)
    return 6.0 * active_strain * yt * (1.0 + t) / (ta * stiffness)


def single_layer(unimorph: Unimorph, active_strain: Reals) -> Reals:
    """Return the curvature of a unimorph with one active layer between two electrodes.

    Sikulskyi et al. 2022, Eq. 16; its polynomial in `t`, `Y`, `R_t = t_el / t_a` and
    `R_Y = Y_el / Y_a` is the composite beam of `beam.bend`, term by term.

    Parameters
    ----------
    unimorph : with `n_active` 1
    active_strain : free in-plane strain of the active layer `[1]`

    Returns
    -------
    curvature towards the passive layer `[1/m]`

    Raises
    ------
    OutOfRange : more than one active layer, a strain outside `ranges.RANGES`
    """
    check("strain", active_strain, "the active layer")
    if unimorph.n_active != 1:
        raise OutOfRange(
            f"the single-layer figure of merit holds for n_active = 1, not {unimorph.n_active}; "
            "use multilayer"
        )
    ta, ya = unimorph.active_thickness_m, unimorph.active_modulus_Pa
    t = unimorph.passive_thickness_m / ta
    r = unimorph.electrode_thickness_m / ta
    yt = unimorph.passive_modulus_Pa / ya * t
    q = unimorph.electrode_modulus_Pa / ya * r
    stiffness = (
        1.0
        + yt * (4.0 + 12.0 * r * (1.0 + r + t) + t * (6.0 + 4.0 * t + yt * t))
        + q * (8.0 + r * (12.0 + 8.0 * r) + q * (12.0 + r * (24.0 + 16.0 * r)))
        + q * yt * (12.0 + r * (36.0 + 32.0 * r + 24.0 * t) + t * (12.0 + 8.0 * t))
    )
    return 6.0 * active_strain * yt * (1.0 + t + 2.0 * r) / (ta * stiffness)


def multilayer(unimorph: Unimorph, active_strain: Reals) -> Reals:
    """Return the curvature of a unimorph with any number of active layers.

    Active layers and electrodes share one centre, `h = (t_p + H) / 2` above that of the passive
    layer, `H` being their height. With `A_p = Y_p t_p` and `A` the stiffness of the rest,
    `k = n Y_a t_a e h A_p / ((A_p + A) (D_p + D) + h^2 A_p A)`, `D_p` and `D` being the bending
    stiffnesses of the two parts about their own centres. Every term is positive, so no digits
    cancel; it is the equilibrium that Eqs. 14 and 15 mean (as printed they do not hold).

    Parameters
    ----------
    unimorph : the layers
    active_strain : free in-plane strain `e` of each active layer `[1]`

    Returns
    -------
    curvature towards the passive layer `[1/m]`

    Raises
    ------
    OutOfRange : a strain outside `ranges.RANGES`

    Source: force and moment equilibrium, Sikulskyi et al. 2022, Eqs. 5 and 6.
    """
    check("strain", active_strain, "the active layer")
    passive = unimorph.passive_modulus_Pa * unimorph.passive_thickness_m
    pull, bending, height = active_part(unimorph)
    h = 0.5 * (unimorph.passive_thickness_m + height)
    own = passive * (unimorph.passive_thickness_m * unimorph.passive_thickness_m) / 12.0 + bending
    force = (
        unimorph.n_active
        * active_strain
        * (unimorph.active_modulus_Pa * unimorph.active_thickness_m)
    )
    return force * h * passive / ((passive + pull) * own + h * h * (passive * pull))


def active_part(unimorph: Unimorph) -> tuple[Reals, Reals, Reals]:
    """Return the layers on top of the passive layer as one, for a strip of unit width.

    Returns
    -------
    its stiffness `[N/m]`, its bending stiffness about its own centre `[N.m]`, its height `[m]`
    """
    n = unimorph.n_active
    ta, te = unimorph.active_thickness_m, unimorph.electrode_thickness_m
    active = unimorph.active_modulus_Pa * ta
    electrode = unimorph.electrode_modulus_Pa * te
    pitch = ta + te
    bending = (
        n * active * (ta * ta)
        + (n + 1) * electrode * (te * te)
        + pitch * pitch * (n * (n * n - 1) * active + n * (n + 1) * (n + 2) * electrode)
    ) / 12.0
    return n * active + (n + 1) * electrode, bending, n * ta + (n + 1) * te
