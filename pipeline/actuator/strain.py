"""How much a dielectric elastomer film thins under voltage, up to the pull-in that ends it.

The Maxwell pressure acts on the film as it is now, not as it was made, so the thickness strain `s`
solves `s (1 - s)^2 = s0` with the drive `s0 = eps0 eps_r (V / t0)^2 / Y`.
"""

from __future__ import annotations

import math
from typing import Literal, TypeAlias

import numpy as np

from deamat.actuator.ranges import Reals, check, within
from deamat.core.errors import OutOfRange

VACUUM_PERMITTIVITY_F_m = 8.8541878188e-12  # CODATA 2022
PULL_IN_STRAIN = 1.0 / 3.0
PULL_IN_DRIVE = 4.0 / 27.0

# Which in-plane strain a film compressed by p takes: `poisson` is that of a plain pressure (the
# article's choice), `maxwell` that of the full Maxwell stress, which also pulls along the film.
InPlane: TypeAlias = Literal["poisson", "maxwell"]


def drive(relative_permittivity: Reals, field_V_m: Reals, modulus_Pa: Reals) -> Reals:
    """Return the Maxwell pressure over the modulus, `s0 = eps0 eps_r E^2 / Y`.

    With the nominal field `V / t0` it drives `thickness_strain`; with the true field, that on the
    thinned film, it is the thickness strain itself. It is also the small-strain answer.

    Parameters
    ----------
    relative_permittivity, field_V_m, modulus_Pa : scalars or arrays `[1]`, `[V/m]`, `[Pa]`

    Raises
    ------
    OutOfRange : an input outside `ranges.RANGES`

    Source: Pelrine, Kornbluh and Joseph 1998; Sikulskyi et al. 2022, Eqs. 1 and 4.
    """
    check("relative_permittivity", relative_permittivity)
    check("field_V_m", field_V_m)
    check("modulus_Pa", modulus_Pa)
    pressure_Pa = VACUUM_PERMITTIVITY_F_m * relative_permittivity * (field_V_m * field_V_m)
    return pressure_Pa / modulus_Pa


def thickness_strain(nominal_drive: Reals) -> Reals:
    """Return the thickness strain at equilibrium: the smallest root of `s (1 - s)^2 = s0`.

    `s = (4/3) sin^2(asin(sqrt(27 s0 / 4)) / 3)`, which loses no digits at small drive.

    Parameters
    ----------
    nominal_drive : `s0` with the field on the undeformed thickness, 0 to 4/27 `[1]`

    Returns
    -------
    compression, counted positive, 0 to 1/3 `[1]`

    Raises
    ------
    OutOfRange : beyond 4/27 the film pulls in and has no equilibrium

    Source: Sikulskyi et al. 2022, Eq. 4, with the sign that thinning asks for.
    """
    within(
        "drive eps0 eps_r (V/t0)^2 / Y",
        nominal_drive,
        0.0,
        PULL_IN_DRIVE,
        hint="beyond 4/27 the film pulls in and has no equilibrium",
    )
    if isinstance(nominal_drive, (float, int)):
        root = math.sqrt(min(6.75 * nominal_drive, 1.0))
        return 4.0 / 3.0 * math.sin(math.asin(root) / 3.0) ** 2
    # 6.75 x 4/27 may round to just above 1
    third = np.arcsin(np.sqrt(np.minimum(6.75 * nominal_drive, 1.0))) / 3.0
    return 4.0 / 3.0 * np.sin(third) ** 2


def paper_eq4(nominal_drive: Reals) -> Reals:
    """Return the thickness strain as Eq. 4 prints it, for comparison with the article only.

    With a positive drive the printed form solves `s (1 + s)^2 = s0`: a film that thickens. It
    loses digits below a drive of about 1e-6.

    Parameters
    ----------
    nominal_drive : as for `thickness_strain` `[1]`

    Source: Sikulskyi et al. 2022, Eq. 4 as printed.
    """
    half = 1.0 + 13.5 * nominal_drive
    f = (half + np.sqrt(half**2 - 1.0)) ** (1.0 / 3.0)
    return -2.0 / 3.0 + (f + 1.0 / f) / 3.0


def amplification(strain: Reals) -> Reals:
    """Return what a small error of the drive grows to, `ds/ds0 = 1 / ((1 - s) (1 - 3 s))`.

    It is 1 for a weakly driven film and infinite at pull-in. For relative errors multiply by
    `s0 / s`: `d ln s / d ln s0 = (1 - s) / (1 - 3 s)`.

    Parameters
    ----------
    strain : thickness strain, 0 to 1/3 `[1]`

    Raises
    ------
    OutOfRange : a strain that no film in equilibrium has
    """
    within("thickness strain", strain, 0.0, PULL_IN_STRAIN, hint="a film pulls in at 1/3")
    with np.errstate(divide="ignore"):
        return np.divide(1.0, (1.0 - strain) * (1.0 - 3.0 * strain))


def pull_in_voltage(thickness_m: Reals, modulus_Pa: Reals, relative_permittivity: Reals) -> Reals:
    """Return the voltage beyond which the film collapses, `t0 sqrt(4 Y / (27 eps0 eps_r))` `[V]`.

    Parameters
    ----------
    thickness_m : of the undeformed film `[m]`
    modulus_Pa, relative_permittivity : of the film `[Pa]`, `[1]`

    Raises
    ------
    OutOfRange : an input outside `ranges.RANGES`
    """
    check("thickness_m", thickness_m)
    unit_field = drive(relative_permittivity, 1.0, modulus_Pa)
    return thickness_m * np.sqrt(PULL_IN_DRIVE / unit_field)


def pull_in_field(modulus_Pa: Reals, relative_permittivity: Reals) -> Reals:
    """Return the true field at pull-in, `sqrt(Y / (3 eps0 eps_r))`: no film ever sees a higher one.

    Parameters
    ----------
    modulus_Pa, relative_permittivity : of the film `[Pa]`, `[1]`

    Raises
    ------
    OutOfRange : an input outside `ranges.RANGES`
    """
    return np.sqrt(PULL_IN_STRAIN / drive(relative_permittivity, 1.0, modulus_Pa))


def film_drive(
    voltage_V: Reals,
    thickness_m: Reals,
    modulus_Pa: Reals,
    relative_permittivity: Reals,
    where: str = "",
) -> Reals:
    """Return the nominal drive of a film under voltage, refusing one that would pull in.

    Parameters
    ----------
    voltage_V : between its electrodes `[V]`
    thickness_m, modulus_Pa, relative_permittivity : of the undeformed film
    where : whose film, for the message

    Raises
    ------
    OutOfRange : an input outside `ranges.RANGES`, or a voltage above pull-in (it is named)
    """
    check("voltage_V", voltage_V, where)
    check("thickness_m", thickness_m, where)
    s0 = drive(relative_permittivity, voltage_V / thickness_m, modulus_Pa)
    if np.max(s0) > PULL_IN_DRIVE:
        at = np.argmax(s0)
        limit = np.broadcast_to(
            pull_in_voltage(thickness_m, modulus_Pa, relative_permittivity), np.shape(s0)
        ).flat[at]
        within(
            "voltage_V",
            float(np.broadcast_to(voltage_V, np.shape(s0)).flat[at]),
            0.0,
            float(limit),
            "V",
            "above the pull-in voltage the film has no equilibrium: lower the voltage, or take a "
            "thicker, stiffer or less permittive film",
            where,
        )
    return s0


def in_plane_strain(strain: Reals, poisson_ratio: Reals, rule: InPlane) -> Reals:
    """Return the free in-plane strain of a film whose Maxwell pressure over modulus is `s`.

    `poisson`: `nu s`, a plain pressure on the faces. `maxwell`: `p / (2 Y) = s / 2`, the full
    Maxwell stress; both agree for an incompressible film, nu = 1/2. The thinning is `s` under
    both (the full stress would thin by `(1/2 + nu) s`, 1 % less at nu = 0.49).

    Parameters
    ----------
    strain : thickness strain `p / Y` `[1]`
    poisson_ratio : of the film `[1]`
    rule : which of the two

    Raises
    ------
    OutOfRange : a Poisson's ratio outside 0 to 0.5, an unknown rule

    Source: Sikulskyi et al. 2022, Eq. 4 (`poisson`); Maxwell stress in an isotropic solid.
    """
    check("poisson_ratio", poisson_ratio)
    if rule == "poisson":
        return poisson_ratio * strain
    if rule == "maxwell":
        return 0.5 * strain
    raise OutOfRange(f"in-plane rule is {rule!r}; allowed are 'poisson' and 'maxwell'")
