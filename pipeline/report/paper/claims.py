"""What the text says of Figures 3 to 7 and 11, recomputed; the figures' data are not published.

Where the article does not say which design a figure shows, the assumption stands in the note.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from deamat.actuator.beam import Beam, actuate, deflection, displacement
from deamat.actuator.elastica import deflect
from deamat.actuator.figure_of_merit import (
    Unimorph,
    multilayer,
    no_electrodes,
    planar,
    single_layer,
)
from deamat.actuator.optimum import (
    best_passive_thickness,
    modulus_ratio_at_fixed_active,
    thickness_ratio_at_fixed_active,
    thickness_ratio_at_fixed_total,
)
from deamat.actuator.ranges import Reals
from deamat.actuator.stack import FIRST_LAYER_DOWN, Layer, Role, Stack
from deamat.actuator.strain import PULL_IN_STRAIN, drive
from deamat.report.paper import printed
from deamat.report.paper.actuators import PASSIVE, own
from deamat.report.paper.entry import Entry, entry

# Not printed. A strip of this length bends as moderately as the article says, a longer one not.
ASSUMED_LENGTH_m = 0.015
_LONGER_m = 0.02
ASSUMED_DENSITY_kg_m3 = 1030.0
ASSUMED_MODULUS_Pa = 1e6  # of the films in Figures 4 and 5
_WIDTH_m = 0.01  # cancels
_TOLERANCE = 1e-9

MIXES = ("sylgard-182-10to1", "sylgard-182-20to1", "sylgard-182-30to1", "sylgard-182-40to1")


def figures() -> list[Entry]:
    """Recompute every number that the text gives for Figures 3 to 7 and 11."""
    film = own("design_1", "designed_um").unimorph
    small = 0.49 * 1e-2  # the ratios below do not depend on the strain
    with_electrodes = single_layer(film, small)
    thin_soft = loss_of_layers(0.001, 10)
    return [
        _off_by_rotation(),
        entry(
            "figure4.spread_of_optima_percent",
            round(100.0 * spread_of_optima(), 9),
            "greatest difference between the optima of Eq. 18 at one total thickness, "
            "Y_p/Y_DE from 0.01 to 10 000",
        ),
        entry(
            "figure5.eq19_off_percent",
            round(100.0 * _off_of_eq19(), 3),
            "greatest relative difference between Eq. 19 and the maximum found numerically, "
            "Y_p/Y_DE from 0.1 to 1000",
        ),
        entry(
            "figure6.loss_by_electrodes_percent",
            100.0 * (1.0 - float(with_electrodes / no_electrodes(film, small))),
            "design 1 as designed (500, 341 and 10 um)",
        ),
        entry(
            "figure7.loss_of_10_layers_percent",
            100.0 * loss_of_layers(0.01, 10),
            "against no electrodes; assumed: passive layer half as thick as all films, and R_t by "
            "their cumulative thickness; against a single layer it is "
            f"{100 * _against_single(0.01):.1f} %",
        ),
        entry("figure7.loss_of_10_layers_thin_soft_percent", 100.0 * thin_soft, "as above"),
        _gain_of_30to1(),
    ]


# --- Figure 3


@dataclass(frozen=True, slots=True)
class Strip:
    """The strip of Figure 3 at one field: shapes of the linear beam and of the elastica `[m]`."""

    linear_x: np.ndarray
    linear_y: np.ndarray
    elastica_x: np.ndarray
    elastica_y: np.ndarray

    @property
    def off(self) -> float:
        """How far the linear tip is off, as a fraction of the elastica's deflection."""
        return float(self.linear_y[-1] / self.elastica_y[-1] - 1.0)


def strip(field_V_m: float, length_m: float = ASSUMED_LENGTH_m) -> Strip:
    """Hang design 1 by one end at a field on its thinned film, weight downwards."""
    beam = _beam(field_V_m)
    at = np.linspace(0.0, 1.0, 101)
    x = length_m * at
    shape = deflect(beam, length_m, FIRST_LAYER_DOWN, _TOLERANCE)
    curled_x, curled_y, _ = shape.shape(at)
    return Strip(
        x + np.asarray(displacement(beam, x, length_m)),
        np.asarray(deflection(beam, x, length_m, FIRST_LAYER_DOWN)),
        curled_x,
        curled_y,
    )


def _beam(field_V_m: float) -> Beam:
    design = own("design_1")
    u = design.unimorph

    def layer(role: Role, thickness_m: Reals, modulus_Pa: Reals) -> Layer:
        plain = Layer(role, thickness_m, modulus_Pa, _WIDTH_m, ASSUMED_DENSITY_kg_m3)
        if role != "de":
            return plain
        ratio = printed.value("text.poisson_ratio")
        permittivity = design.relative_permittivity
        return replace(plain, relative_permittivity=permittivity, poisson_ratio=ratio)

    electrode = layer("electrode", u.electrode_thickness_m, u.electrode_modulus_Pa)
    film = layer("de", u.active_thickness_m, u.active_modulus_Pa)
    passive = layer("passive", u.passive_thickness_m, u.passive_modulus_Pa)
    # The strain at a true field is its drive, so the voltage is field times thinned thickness
    s = drive(design.relative_permittivity, field_V_m, u.active_modulus_Pa)
    voltage_V = field_V_m * u.active_thickness_m * (1.0 - s)
    return actuate(Stack((passive, electrode, film, electrode)), voltage_V, "poisson")


def _off_by_rotation() -> Entry:
    field = printed.si("table5.design_1.field_V_per_um")
    return entry(
        "figure3.numerical_off_at_22V_per_um_percent",
        100.0 * strip(field).off,
        "printed as an upper limit; tip of the small-deflection beam against the elastica; length "
        f"and density are not printed, assumed {1000 * ASSUMED_LENGTH_m:g} mm and "
        f"{ASSUMED_DENSITY_kg_m3:g} kg/m3 ({100 * strip(field, _LONGER_m).off:.1f} % at "
        f"{1000 * _LONGER_m:g} mm)",
    )


# --- Figures 4 and 5: films and passive layer alone


def free_strain() -> float:
    """Return the in-plane strain of the films of Figures 4 and 5 at their breakdown strength."""
    s = planar(
        printed.value("figure4.relative_permittivity"),
        printed.si("figure4.breakdown_strength_V_per_um"),
        ASSUMED_MODULUS_Pa,
    )
    return float(printed.value("text.poisson_ratio") * s)


def at_fixed_total(total_m: Reals, modulus_ratio: Reals, ratio: Reals) -> Reals:
    """Curvature of a film and passive layer of this total and thickness ratio `[1/m]`."""
    active = total_m / (1.0 + ratio)
    return _bare(active * ratio, active, modulus_ratio)


def at_fixed_film(film_m: Reals, modulus_ratio: Reals, ratio: Reals) -> Reals:
    """Return the curvature of a passive layer `ratio` times as thick as its film `[1/m]`."""
    return _bare(film_m * ratio, film_m, modulus_ratio)


def _bare(passive_m: Reals, active_m: Reals, modulus_ratio: Reals) -> Reals:
    y = ASSUMED_MODULUS_Pa
    unimorph = Unimorph(passive_m, modulus_ratio * y, active_m, y, 0.0, 0.0)
    return no_electrodes(unimorph, free_strain())


def spread_of_optima() -> float:
    """Say how far the optima of Eq. 18 differ at one total thickness."""
    ratios = np.geomspace(1e-2, 1e4, 61)
    best = np.asarray(at_fixed_total(1e-3, ratios, thickness_ratio_at_fixed_total(ratios)))
    return float(best.max() / best.min() - 1.0)


def _off_of_eq19() -> float:
    ratios = np.geomspace(0.1, 1e3, 41)
    y = ASSUMED_MODULUS_Pa
    film = Unimorph(1e-4, ratios * y, 5e-4, y, 0.0, 0.0)
    found = np.asarray(best_passive_thickness(film)) / 5e-4
    printed_optimum = np.asarray(modulus_ratio_at_fixed_active(found))
    return float(np.max(np.abs(printed_optimum / ratios - 1.0)))


# --- Figures 6 and 7


def layers_of(ratio: float, modulus_ratio: float, n: int) -> Unimorph:
    """Part the film of Figure 7 into n, with electrodes `ratio` times as thick as all films."""
    film, y = 5e-4, ASSUMED_MODULUS_Pa
    passive = film * float(thickness_ratio_at_fixed_active(1.0))
    return Unimorph(passive, y, film / n, y, ratio * film, modulus_ratio * y, n)


def loss_of_layers(ratio: float, n: int, modulus_ratio: float | None = None) -> float:
    """Say which part of the curvature the electrodes cost; `R_Y = R_t` unless it is given."""
    unimorph = layers_of(ratio, ratio if modulus_ratio is None else modulus_ratio, n)
    return 1.0 - float(multilayer(unimorph, 1e-2) / no_electrodes(unimorph, 1e-2))


def _against_single(ratio: float) -> float:
    return 1.0 - (1.0 - loss_of_layers(ratio, 10)) / (1.0 - loss_of_layers(ratio, 1))


# --- Figure 11


@dataclass(frozen=True, slots=True)
class Best:
    """The best design of a mix at breakdown.

    Parameters
    ----------
    passive_m : best passive thickness `[m]`
    curvature_per_m : by the linear strain at the breakdown strength, as the article has it
    reachable_per_m : no more than the film strains at pull-in
    drive : thickness strain that the linear law promises `[1]`
    """

    passive_m: float
    curvature_per_m: float
    reachable_per_m: float
    drive: float


def mixed(film: str, passive: str, passive_m: Reals | None = None) -> tuple[Unimorph, float]:
    """Put a film of one mix on a passive layer of another, both of Table 4.

    Returns
    -------
    layers with the designed film and electrodes, and the linear strain at breakdown `[1]`
    """
    design = own("design_1", "designed_um").unimorph
    unimorph = replace(
        design,
        active_modulus_Pa=printed.si(f"table4.{film}.compressive_modulus_MPa"),
        passive_modulus_Pa=printed.si(f"table4.{passive}.compressive_modulus_MPa"),
        passive_thickness_m=design.passive_thickness_m if passive_m is None else passive_m,
    )
    s = planar(
        printed.value(f"table4.{film}.relative_permittivity_10Hz"),
        printed.si(f"table4.{film}.breakdown_strength_V_per_um"),
        unimorph.active_modulus_Pa,
    )
    return unimorph, float(s)


def best(film: str, passive: str) -> Best:
    """Find the passive thickness that bends most at the film's breakdown strength."""
    unimorph, s = mixed(film, passive)
    thickness = float(best_passive_thickness(unimorph))
    unimorph = replace(unimorph, passive_thickness_m=thickness)
    nu = printed.value("text.poisson_ratio")
    return Best(
        thickness,
        float(single_layer(unimorph, nu * s)),
        float(single_layer(unimorph, nu * min(s, PULL_IN_STRAIN))),
        s,
    )


def _gain_of_30to1() -> Entry:
    soft, stiff = best("sylgard-182-30to1", PASSIVE), best(PASSIVE, PASSIVE)
    return entry(
        "figure11.gain_of_30to1",
        soft.curvature_per_m / stiff.curvature_per_m,
        f"{soft.curvature_per_m:.0f} against {stiff.curvature_per_m:.0f} per m, optima at the "
        "printed breakdown strengths; as in D2 the printed inputs do not give the printed gain. "
        f"The linear strain of the 30:1 film would be {soft.drive:.2f}, beyond pull-in (1/3): "
        f"what it reaches is {soft.reachable_per_m:.0f} per m",
    )
