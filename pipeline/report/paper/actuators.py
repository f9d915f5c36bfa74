"""Tables 1 and 5: every design as its printed inputs give it, and with the right sign of Eq. 4."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from deamat.actuator.figure_of_merit import Unimorph, multilayer
from deamat.actuator.optimum import best_passive_thickness
from deamat.actuator.ranges import Reals
from deamat.actuator.strain import drive, paper_eq4, thickness_strain
from deamat.core.units import from_si, to_si
from deamat.report.paper import printed
from deamat.report.paper.entry import CORRECTED, Entry, entry

StrainLaw = Callable[[Reals], Reals]

FILMS = {"design_1": "sylgard-182-10to1", "design_2": "sylgard-182-30to1"}
PASSIVE = "sylgard-182-10to1"

# Rows that come out with thinned films and Eq. 4 as printed; the others with the linear strain.
BY_EQUATION_4 = ("kadooka_2016", "duduta_2016")
_LINEAR = "linear strain eps0 eps_r E^2 / Y"
_AS_PRINTED = "Eq. 4 as printed, thinned films; its sign is wrong (D1)"
_RIGHT = "Eq. 4 with the right sign, s (1 - s)^2 = s0, thinned films (D1)"
_NOTES = {
    "araromi_2012": {
        "t_p_opt": "does not come out (D6): the optimum of these inputs lies elsewhere",
        "optimum": "does not come out (D6): the curvature at the optimum of these inputs",
    },
    "haghiashtiani_2018": dict.fromkeys(
        ("analytical", "t_p_opt", "optimum"), f"{_LINEAR}, mean of the two electrodes"
    ),
}


@dataclass(frozen=True, slots=True)
class Design:
    """One actuator as the article prints it.

    Parameters
    ----------
    unimorph : layers as made
    relative_permittivity : of the films `[1]`
    field_V_m : nominal in Table 1, on the thinned film in Table 5 `[V/m]`
    """

    unimorph: Unimorph
    relative_permittivity: float
    field_V_m: float

    @property
    def drive(self) -> float:
        """Maxwell pressure over modulus `[1]`."""
        u = self.unimorph
        return float(drive(self.relative_permittivity, self.field_V_m, u.active_modulus_Pa))


@dataclass(frozen=True, slots=True)
class Bend:
    """What a design comes to.

    Parameters
    ----------
    curvature_per_m : of the design `[1/m]`
    best_passive_m : passive thickness that bends most on its films `[m]`
    optimum_per_m : curvature there `[1/m]`
    """

    curvature_per_m: float
    best_passive_m: float
    optimum_per_m: float


def literature(row: str) -> Design:
    """Read a design of Table 1; two unlike electrodes count by their mean."""

    def layer(name: str) -> tuple[float, float]:
        paths = [path for path, _ in printed.numbers(f"table1.{row}.t_{name}")]
        thickness = math.fsum(map(printed.si, paths)) / len(paths)
        return thickness, printed.si(f"table1.{row}.Y_{name}")

    films, (film, modulus) = int(printed.value(f"table1.{row}.n_de")), layer("de")
    return Design(
        Unimorph(*layer("p"), film, modulus, *layer("el"), films),
        printed.value(f"table1.{row}.eps_r"),
        printed.si(f"table1.{row}.V") / film,
    )


def own(name: str, thicknesses: str = "measured_um") -> Design:
    """Read a design of Table 5 with moduli and permittivity of Table 4."""
    here, film = f"table5.{name}.{thicknesses}", f"table4.{FILMS[name]}"
    return Design(
        Unimorph(
            printed.si(f"{here}.passive"),
            printed.si(f"table4.{PASSIVE}.compressive_modulus_MPa"),
            printed.si(f"{here}.de"),
            printed.si(f"{film}.compressive_modulus_MPa"),
            printed.si(f"{here}.electrode"),
            printed.si("electrode.youngs_modulus_MPa"),
        ),
        printed.value(f"{film}.relative_permittivity_10Hz"),
        printed.si(f"table5.{name}.field_V_per_um"),
    )


def bend(design: Design, law: StrainLaw | None = None) -> Bend:
    """Compute curvature and optimum of a design.

    Parameters
    ----------
    design : as printed
    law : nominal drive to thickness strain of films that thin by it; None for the linear strain
        on films as thick as they were made
    """
    unimorph, s = design.unimorph, design.drive
    if law is not None:
        s = float(law(s))
        unimorph = replace(unimorph, active_thickness_m=unimorph.active_thickness_m * (1.0 - s))
    expansion = printed.value("text.poisson_ratio") * s
    best = float(best_passive_thickness(unimorph))
    at_best = replace(unimorph, passive_thickness_m=best)
    return Bend(float(multilayer(unimorph, expansion)), best, float(multilayer(at_best, expansion)))


def table1() -> list[Entry]:
    """Recompute the analytical columns of Table 1."""
    entries = []
    for row in printed.part("table1"):
        by_equation_4 = row in BY_EQUATION_4
        note = _AS_PRINTED if by_equation_4 else _LINEAR
        found = bend(literature(row), paper_eq4 if by_equation_4 else None)
        entries += _columns(row, found, note)
        if by_equation_4:
            entries += _columns(row, bend(literature(row), thickness_strain), _RIGHT, CORRECTED)
    return entries


def _columns(row: str, found: Bend, note: str, suffix: str = "") -> list[Entry]:
    own_notes = _NOTES.get(row, {})
    return [
        entry(
            f"table1.{row}.{name}",
            value,
            own_notes.get(name, note),
            suffix=suffix,
        )
        for name, value in (
            ("analytical", found.curvature_per_m),
            ("t_p_opt", from_si(found.best_passive_m, "um")),
            ("optimum", found.optimum_per_m),
        )
    ]


def table5() -> list[Entry]:
    """Recompute fields, figures of merit and optima of Table 5."""
    entries = []
    for name in FILMS:
        design, found = own(name), bend(own(name))
        field = true_field_V_m(name)
        strength = printed.si(f"table4.{FILMS[name]}.breakdown_strength_V_per_um")
        why = "linear strain at the printed field, moduli and permittivity of Table 4"
        lost = "" if name == "design_1" else "NOT derivable from the printed inputs (D2); "
        entries += [
            _designed(name),
            entry(
                f"table5.{name}.field_V_per_um",
                from_si(field, "V/um"),
                "voltage over the film's thickness at equilibrium, s (1 - s)^2 = s0",
            ),
            entry(
                f"table5.{name}.field_over_breakdown",
                design.field_V_m / strength,
                "printed field over the printed breakdown strength of Table 4",
            ),
            entry(f"table5.{name}.fom_single_layer_per_m", found.curvature_per_m, lost + why),
            entry(
                f"table5.{name}.fom_optimum_per_m",
                found.optimum_per_m,
                f"{lost}{why}; best passive layer {from_si(found.best_passive_m, 'um'):.0f} um",
            ),
        ]
    return entries


def true_field_V_m(name: str) -> float:
    """Return the field on the thinned film of a design of Table 5 at its voltage `[V/m]`."""
    design = own(name)
    film = design.unimorph
    nominal = printed.si(f"table5.{name}.voltage_kV") / film.active_thickness_m
    s0 = drive(design.relative_permittivity, nominal, film.active_modulus_Pa)
    return float(nominal / (1.0 - thickness_strain(s0)))


def _designed(name: str) -> Entry:
    planned = own(name, "designed_um")
    best = bend(planned)
    short = 1.0 - best.curvature_per_m / best.optimum_per_m
    return entry(
        f"table5.{name}.designed_um.passive",
        from_si(best.best_passive_m, "um"),
        "best passive layer on the designed film; the maximum is flat, the printed thickness "
        f"bends {100 * short:.1f} % less",
    )


def electrode_for(curvature_per_m: float, which: str) -> tuple[float, Bend]:
    """Find the electrode that would bring design 2 to a curvature, and what that does to it.

    Parameters
    ----------
    curvature_per_m : wanted `[1/m]`
    which : `electrode_modulus_Pa` or `electrode_thickness_m`, lowered from its printed value

    Returns
    -------
    the value `[Pa]` or `[m]`, and the curvature and optimum that go with it
    """
    design = own("design_2")
    at_most = float(getattr(design.unimorph, which))
    parts = np.linspace(0.0, 1.0, 2001)
    expansion = printed.value("text.poisson_ratio") * design.drive
    curvatures = multilayer(_with(design, which, at_most * parts).unimorph, expansion)
    # Softer and thinner electrodes bend more: the curvature falls along `parts`
    part = float(np.interp(-curvature_per_m, -np.asarray(curvatures), parts))
    return at_most * part, bend(_with(design, which, at_most * part))


def _with(design: Design, which: str, value: Reals) -> Design:
    unimorph = design.unimorph
    if which == "electrode_modulus_Pa":
        return replace(design, unimorph=replace(unimorph, electrode_modulus_Pa=value))
    return replace(design, unimorph=replace(unimorph, electrode_thickness_m=value))


def electrode_that_sums_up(name: str) -> float:
    """Return the electrode thickness that a total of Table 1 means `[m]`."""
    u = own(name).unimorph
    total = to_si(printed.value(f"text.total_of_{name}_um"), "um")
    return float(total - u.passive_thickness_m - u.active_thickness_m) / 2.0


def totals() -> list[Entry]:
    """Add the layers of Table 5 up and hold them against the totals that Table 1 prints."""
    return [
        entry(
            f"text.total_of_{name}_um",
            from_si(float(own(name).unimorph.total_thickness_m), "um"),
            "the layers of Table 5 with electrodes of 10 um; the printed sum means "
            f"{from_si(electrode_that_sums_up(name), 'um'):.0f} um (D5)",
        )
        for name in FILMS
    ]
