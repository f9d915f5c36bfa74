"""Stacks to test with."""

from __future__ import annotations

import numpy as np

from deamat.actuator.figure_of_merit import Unimorph
from deamat.actuator.ranges import Reals
from deamat.actuator.stack import Layer, Role, Stack

WIDTH_m = 0.01
DENSITY_kg_m3 = 1030.0


def layer(role: Role, thickness_m: Reals, modulus_Pa: Reals, width_m: Reals = WIDTH_m) -> Layer:
    """Return a layer with the film properties of Sylgard 182 (10:1)."""
    return Layer(role, thickness_m, modulus_Pa, width_m, DENSITY_kg_m3, 2.58, 0.49)


def stacked(unimorph: Unimorph) -> Stack:
    """Spell a unimorph out layer by layer."""
    u = unimorph
    electrode = layer("electrode", u.electrode_thickness_m, u.electrode_modulus_Pa)
    film = layer("de", u.active_thickness_m, u.active_modulus_Pa)
    passive = layer("passive", u.passive_thickness_m, u.passive_modulus_Pa)
    return Stack((passive, electrode, *(film, electrode) * u.n_active))


def random_unimorphs(count: int, n_active: int, seed: int) -> Unimorph:
    """Draw designs far wider than any made: thicknesses and moduli over many decades."""
    rng = np.random.default_rng(seed)

    def decades(low: float, high: float) -> Reals:
        return np.asarray(10.0 ** rng.uniform(low, high, count))

    ta, ya = decades(-5, -3), decades(5, 8)
    return Unimorph(
        ta * decades(-3, 1),
        ya * decades(-2, 4),
        ta,
        ya,
        ta * decades(-4, 0.3),
        ya * decades(-3, 3),
        n_active,
    )


def strip() -> Stack:
    """Return the measured design 1 of Sikulskyi et al. 2022, Table 5."""
    return Stack(
        (
            layer("passive", 304e-6, 0.957e6),
            layer("electrode", 10e-6, 3.5e6),
            layer("de", 446e-6, 0.957e6),
            layer("electrode", 10e-6, 3.5e6),
        )
    )
