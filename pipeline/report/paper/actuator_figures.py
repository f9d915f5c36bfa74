"""Figures 3 to 7 and 11, redrawn from what the article prints; none of it is a measurement."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes

from deamat.actuator.figure_of_merit import multilayer, no_electrodes, single_layer
from deamat.actuator.optimum import (
    best_passive_thickness,
    thickness_ratio_at_fixed_active,
    thickness_ratio_at_fixed_total,
)
from deamat.actuator.strain import PULL_IN_STRAIN
from deamat.core.units import from_si
from deamat.report.paper import printed
from deamat.report.paper.actuators import PASSIVE, own
from deamat.report.paper.claims import (
    MIXES,
    at_fixed_film,
    at_fixed_total,
    best,
    free_strain,
    loss_of_layers,
    mixed,
    strip,
)
from deamat.report.style import COLOURS

Draw = Callable[[Axes], None]

_LOOKS = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)))
_CURVATURE = "curvature [1/m]"
_RATIO = "thickness of passive layer over film, t [1]"


def mix(material: str) -> str:
    """Return the mix ratio in an id: `sylgard-182-10to1` to `10:1`."""
    return material.rpartition("-")[2].replace("to", ":")


def figure3(axes: Axes) -> None:
    """Draw design 1 hanging by one end, as a linear beam and as an elastica."""
    fields = (
        0.0,
        printed.si("table5.design_1.field_V_per_um"),
        printed.si("figure3.high_field_V_per_um"),
    )
    for colour, field in zip(COLOURS, fields, strict=False):
        shape = strip(field)
        said = f"{from_si(field, 'V/um'):g} V/µm"
        axes.plot(
            1e3 * shape.elastica_x, 1e3 * shape.elastica_y, color=colour, linestyle="-",
            label=f"{said}, large deflections",
        )  # fmt: skip
        axes.plot(
            1e3 * shape.linear_x, 1e3 * shape.linear_y, color=colour, linestyle="--",
            label=f"{said}, small deflections (Eqs. 9, 10)",
        )  # fmt: skip
    axes.invert_yaxis()
    axes.set_xlabel("along the clamped root's axis [mm]")
    axes.set_ylabel("downwards [mm]")


def figure4a(axes: Axes) -> None:
    """Draw the curvature of optimum designs against their total thickness."""
    total = np.geomspace(1e-4, 2e-3, 100)
    for look, ratio in zip(_LOOKS, (0.1, 1.0, 10.0), strict=False):
        best_ratio = float(thickness_ratio_at_fixed_total(ratio))
        axes.plot(
            1e3 * total, at_fixed_total(total, ratio, best_ratio), linestyle=look,
            linewidth=3.0 if look == "-" else 1.5, label=f"Y = {ratio:g}, t = {best_ratio:.3g}",
        )  # fmt: skip
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("total thickness [mm]")
    axes.set_ylabel(_CURVATURE)


def figure4b(axes: Axes) -> None:
    """Draw the curvature at one total thickness: all optima are alike."""
    t = np.geomspace(1e-2, 1e1, 300)
    total = 1e-3
    for i, ratio in enumerate((0.1, 1.0, 10.0, 100.0, 1000.0)):
        axes.plot(t, at_fixed_total(total, ratio, t), label=f"Y = {ratio:g}", linestyle=_LOOKS[i])
        at = float(thickness_ratio_at_fixed_total(ratio))
        axes.plot(at, at_fixed_total(total, ratio, at), "ko", markersize=5)
    axes.axhline(1.5 * free_strain() / total, color="black", linewidth=0.7)
    axes.set_xscale("log")
    axes.set_xlabel(f"{_RATIO}; dots: Eq. 18, t = 1/√Y")
    axes.set_ylabel(f"{_CURVATURE} at 1 mm in total")


def figure5(axes: Axes) -> None:
    """Draw the curvature on one film: the optimum of Eq. 19 rises with a stiffer, thinner layer."""
    t = np.geomspace(1e-2, 1e1, 300)
    film = 5e-4
    for i, ratio in enumerate((0.1, 1.0, 10.0, 100.0, 1000.0)):
        axes.plot(t, at_fixed_film(film, ratio, t), label=f"Y = {ratio:g}", linestyle=_LOOKS[i])
    ratios = np.geomspace(0.03, 3e3, 200)
    locus = np.asarray(thickness_ratio_at_fixed_active(ratios))
    axes.plot(
        locus, at_fixed_film(film, ratios, locus), color="black", linestyle="-", linewidth=2.0,
        label="optimum, Eq. 19",
    )  # fmt: skip
    axes.set_xscale("log")
    axes.set_xlabel(_RATIO)
    axes.set_ylabel(f"{_CURVATURE} on 500 µm")


def figure6a(axes: Axes) -> None:
    """Draw what electrodes cost design 1 as designed."""
    film = own("design_1", "designed_um").unimorph
    bare = no_electrodes(film, 1e-2)
    thickness = np.geomspace(1e-3, 1.0, 200)

    def part(ratio: float | np.ndarray, modulus_ratio: float) -> np.ndarray:
        unimorph = replace(
            film,
            electrode_thickness_m=film.active_thickness_m * ratio,
            electrode_modulus_Pa=film.active_modulus_Pa * modulus_ratio,
        )
        return 100.0 * np.asarray(single_layer(unimorph, 1e-2)) / float(bare)

    for i, ratio in enumerate((0.01, 0.1, 1.0, 10.0, 100.0)):
        axes.plot(thickness, part(thickness, ratio), linestyle=_LOOKS[i], label=f"R_Y = {ratio:g}")
    here = float(film.electrode_thickness_m / film.active_thickness_m)
    stiffness = float(film.electrode_modulus_Pa / film.active_modulus_Pa)
    axes.plot(
        here, part(here, stiffness), "k*", markersize=11,
        label=f"the article's electrode: {100 - float(part(here, stiffness)):.1f} % lost, "
        f"printed about {printed.value('figure6.loss_by_electrodes_percent'):g} %",
    )  # fmt: skip
    axes.set_xscale("log")
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("electrode over film thickness, R_t [1]")
    axes.set_ylabel("curvature over that without electrodes [%]")


def figure6b(axes: Axes) -> None:
    """Draw how electrodes of several thicknesses move the optimum of design 1."""
    design = own("design_1", "designed_um")
    expansion = printed.value("text.poisson_ratio") * design.drive
    t = np.linspace(0.05, 2.0, 200)
    for i, ratio in enumerate((0.0, 0.01, 0.02, 0.05, 0.1)):
        film = replace(
            design.unimorph,
            electrode_thickness_m=design.unimorph.active_thickness_m * ratio,
        )
        passive = replace(film, passive_thickness_m=film.active_thickness_m * t)
        axes.plot(
            t, single_layer(passive, expansion), linestyle=_LOOKS[i], label=f"R_t = {ratio:g}"
        )
        at = float(best_passive_thickness(film))
        optimum = single_layer(replace(film, passive_thickness_m=at), expansion)
        axes.plot(at / film.active_thickness_m, optimum, "ko", markersize=5)
    axes.set_xlabel(f"{_RATIO}; dots: optimum")
    axes.set_ylabel(f"{_CURVATURE} at 22.2 V/µm")


def figure7(axes: Axes) -> None:
    """Draw what electrodes cost as one film is parted into many."""
    design = own("design_1", "designed_um").unimorph
    electrode = (
        float(design.electrode_thickness_m / design.active_thickness_m),
        float(design.electrode_modulus_Pa / design.active_modulus_Pa),
    )
    layers = np.arange(1, 11)
    for i, (ratio, modulus_ratio, said) in enumerate(
        (
            (0.001, 0.001, ""),
            (0.01, 0.01, ""),
            (0.06, 1.0, ""),
            (0.001, 100.0, ""),
            (*electrode, "the article's electrode, "),
        )
    ):
        kept = [100.0 * (1.0 - loss_of_layers(ratio, int(n), modulus_ratio)) for n in layers]
        axes.plot(
            layers, kept, marker="osD^v"[i], linestyle=_LOOKS[i],
            label=f"{said}R_t = {ratio:.3g}, R_Y = {modulus_ratio:.3g}",
        )  # fmt: skip
    axes.set_ylim(0.0, 105.0)
    axes.set_xlabel("number of films, same thickness in all [1]")
    axes.set_ylabel("curvature over that without electrodes [%]")


def figure11a(axes: Axes) -> None:
    """Draw both layers of one mix at breakdown, with and without electrodes."""
    thickness = np.linspace(2e-5, 1.2e-3, 300)
    nu = printed.value("text.poisson_ratio")
    for colour, material in zip(COLOURS, MIXES, strict=False):
        unimorph, s = mixed(material, material, thickness)
        for look, form, said in (
            ("-", single_layer, "electrodes of 10 µm"),
            (":", no_electrodes, "no electrodes"),
        ):
            axes.plot(
                1e6 * thickness, form(unimorph, nu * s), color=colour, linestyle=look,
                label=f"{mix(material)}, {said}",
            )  # fmt: skip
    axes.set_xlabel("thickness of passive layer [µm]")
    axes.set_ylabel(f"{_CURVATURE} at breakdown")


def figure11b(axes: Axes) -> None:
    """Draw films of several mixes on a 10:1 passive layer, and what pull-in leaves of them."""
    thickness = np.linspace(2e-5, 6e-4, 300)
    nu = printed.value("text.poisson_ratio")
    for colour, material in zip(COLOURS, MIXES, strict=False):
        unimorph, s = mixed(material, PASSIVE, thickness)
        axes.plot(
            1e6 * thickness, multilayer(unimorph, nu * s), color=colour, linestyle="-",
            label=f"{mix(material)} film, linear strain {s:.2f}",
        )  # fmt: skip
        if s > PULL_IN_STRAIN:
            axes.plot(
                1e6 * thickness, multilayer(unimorph, nu * PULL_IN_STRAIN), color=colour,
                linestyle=":", label=f"{mix(material)} film, pulled in at 1/3",
            )  # fmt: skip
        optimum = best(material, PASSIVE)
        axes.plot(1e6 * optimum.passive_m, optimum.curvature_per_m, "ko", markersize=5)
    axes.set_xlabel("thickness of 10:1 passive layer [µm]; dots: optimum")
    axes.set_ylabel(f"{_CURVATURE} at breakdown")


ACTUATOR_FIGURES: dict[str, tuple[str, Draw]] = {
    "figure-3": ("Figure 3: design 1 under its weight (length and density assumed)", figure3),
    "figure-4a": (
        "Figure 4A: optimum designs by total thickness (film of 1 MPa assumed)",
        figure4a,
    ),
    "figure-4b": ("Figure 4B: one total thickness, all optima alike", figure4b),
    "figure-5": ("Figure 5: one film, optimum passive layer", figure5),
    "figure-6a": ("Figure 6A: what electrodes cost design 1", figure6a),
    "figure-6b": ("Figure 6B: electrodes move the optimum", figure6b),
    "figure-7": ("Figure 7: one film parted into many", figure7),
    "figure-11a": ("Figure 11A: both layers of one mix of Sylgard 182", figure11a),
    "figure-11b": ("Figure 11B: films of several mixes on a 10:1 passive layer", figure11b),
}
