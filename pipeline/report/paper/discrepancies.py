"""D1 to D7: where the article contradicts itself or its inputs, with the numbers that show it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from deamat.actuator.strain import PULL_IN_DRIVE, paper_eq4, thickness_strain
from deamat.core.units import from_si
from deamat.report.paper import printed
from deamat.report.paper.actuators import (
    BY_EQUATION_4,
    bend,
    electrode_for,
    electrode_that_sums_up,
    literature,
    own,
)
from deamat.report.paper.laws import FOOTNOTE, READINGS, Reading

_EXAMPLE_DRIVE = 0.1


@dataclass(frozen=True, slots=True)
class Discrepancy:
    """One contradiction.

    Parameters
    ----------
    key : D1 to D7
    title : what is wrong, in a line
    text : what follows from what, with numbers
    where : ids of the sections of the page in which it is stated
    """

    key: str
    title: str
    text: str
    where: tuple[str, ...]


def discrepancies(readings: Sequence[Reading | str]) -> tuple[Discrepancy, ...]:
    """State all of them.

    Parameters
    ----------
    readings : what the database says of the exponent of each composition of Sylgard 186
    """
    return (_d1(), _d2(), _d3(readings), _d4(), _d5(), _d6(), _d7())


def _d1() -> Discrepancy:
    wrong, right = float(paper_eq4(_EXAMPLE_DRIVE)), thickness_strain(_EXAMPLE_DRIVE)
    rows = []
    for row in BY_EQUATION_4:
        design = literature(row)
        values = [bend(design, law).curvature_per_m for law in (paper_eq4, thickness_strain)]
        rows.append(f"{_name(row)} {values[0]:.4g} as printed, {values[1]:.4g} corrected")
    return Discrepancy(
        "D1",
        "Eq. 4 has the wrong sign",
        "Thinning raises the field, so the thickness strain solves s (1 - s)² = s0 and is larger "
        "than the drive s0. The printed closed form solves s (1 + s)² = s0 and gives less: at "
        f"s0 = {_EXAMPLE_DRIVE:g} it gives {wrong:.4f}, right is {right:.4f}. At s0 = 4/27 = "
        f"{PULL_IN_DRIVE:.3f} (s = 1/3) the film pulls in, which the printed form does not know. "
        f"In curvature [1/m]: {'; '.join(rows)}.",
        ("table1",),
    )


def _d2() -> Discrepancy:
    found = bend(own("design_2"))
    target = printed.value("table5.design_2.fom_single_layer_per_m")
    modulus, softer = electrode_for(target, "electrode_modulus_Pa")
    thickness, thinner = electrode_for(target, "electrode_thickness_m")
    passive = from_si(float(own("design_2").unimorph.passive_thickness_m), "um")
    return Discrepancy(
        "D2",
        "Design 2 is not derivable from the printed inputs",
        f"They give {found.curvature_per_m:.2f} per m and an optimum of {found.optimum_per_m:.2f}; "
        f"printed are {target:g} and {printed.value('table5.design_2.fom_optimum_per_m'):g}, and "
        f"the experiment gave {printed.value('table5.design_2.curvature_per_m'):g}. An electrode "
        f"of {from_si(modulus, 'MPa'):.2f} MPa, or of {from_si(thickness, 'um'):.1f} µm, would "
        f"give {target:g}, but then {passive:.0f} µm is far from the optimum "
        f"({from_si(softer.best_passive_m, 'um'):.0f} or "
        f"{from_si(thinner.best_passive_m, 'um'):.0f} µm, {softer.optimum_per_m:.1f} or "
        f"{thinner.optimum_per_m:.1f} per m). No input was tuned to hide it. Figure 11's gain of "
        f"{printed.value('figure11.gain_of_30to1'):g} for the same pair does not come out either.",
        ("table5", "figure11"),
    )


def _d3(readings: Sequence[Reading | str]) -> Discrepancy:
    return Discrepancy(
        "D3",
        "The exponent of Sylgard 186 cannot be n − 1",
        "The footnote of Table 2 says μ = K·rate^(n−1) and the text says pseudoplastic, yet the "
        "printed exponent e is positive (0.31, 0.39): as n − 1 the fluid would thicken. It can be "
        "n itself, or 1 − n. The database stores K and n, never a bare exponent. "
        + " ".join(_said(r) for r in readings),
        ("table2", "figure8"),
    )


def _said(found: Reading | str) -> str:
    if isinstance(found, str):
        return f"Not decided by data: {found}."
    distances = ", ".join(f"{found.off[name]:.3f} for {name}" for name in READINGS)
    whose = (
        " (SYNTHETIC data: this is the reading that the simulation took, and no evidence for what "
        "the authors measured)"
        if found.synthetic
        else ""
    )
    against = "" if found.name == FOOTNOTE else "; not the footnote's n − 1"
    return (
        f"{found.material}: the data have n = {found.index[0]:.3f} to {found.index[1]:.3f} and "
        f"support {found.name}{against} (distance in n: {distances}){whose}."
    )


def _d4() -> Discrepancy:
    return Discrepancy(
        "D4",
        "Eq. 14 does not hold as printed",
        "Its electrode term carries Y_DE t_DE where it needs Y_el t_el, and t_p²/3 stands where "
        "t_p/2 belongs (a length is wanted, not an area). Every multilayer value here solves the "
        "equilibrium of force and moment (Eqs. 5 and 6) instead of Eqs. 14 and 15.",
        ("table1", "figure7"),
    )


def _d5() -> Discrepancy:
    sums = ", ".join(
        f"{printed.value(f'text.total_of_{name}_um'):g} µm ({said})"
        for name, said in (("design_1", "design 1"), ("design_2", "design 2"))
    )
    meant = sorted({from_si(electrode_that_sums_up(n), "um") for n in ("design_1", "design_2")})
    return Discrepancy(
        "D5",
        "Three electrode thicknesses for the same actuators",
        f"The totals of Table 1, {sums}, mean electrodes of "
        f"{' and '.join(f'{t:.0f}' for t in meant[:1])} µm; Table 1 itself says "
        f"{printed.value('text.electrode_in_table1_um'):g} µm and Table 5 says "
        f"{printed.value('table5.design_1.measured_um.electrode'):g} µm. Design 1 of Table 5 comes "
        "out with Table 5's.",
        ("table1", "table5"),
    )


def _d6() -> Discrepancy:
    found = bend(literature("araromi_2012"))
    right = bend(literature("araromi_2012"), thickness_strain)
    return Discrepancy(
        "D6",
        "The optimum of Araromi 2012 does not come out",
        f"Printed are {printed.value('table1.araromi_2012.t_p_opt'):g} µm and "
        f"{printed.value('table1.araromi_2012.optimum'):g} per m; the printed inputs give "
        f"{from_si(found.best_passive_m, 'um'):.2f} µm and {found.optimum_per_m:.0f} per m with "
        f"the linear strain, with which the design itself comes out ({found.curvature_per_m:.3f}). "
        f"With thinned films and Eq. 4 the right way round the design bends "
        f"{right.curvature_per_m:.2f} per m.",
        ("table1",),
    )


def _d7() -> Discrepancy:
    diameter = printed.value("text.cylinder_diameter_mm")
    height = printed.value("text.cylinder_height_mm")
    shape = diameter / (4.0 * height)
    return Discrepancy(
        "D7",
        "Friction at the plates raises the compressive modulus",
        f"The article's cylinder, {diameter:g} mm by {height:g} mm, has the shape factor D/(4h) = "
        f"{shape:.2f}. Bonded between its plates it would seem about 1 + 2 S² = "
        f"{1 + 2 * shape**2:.2f} times as stiff; free to slide, not at all. Neither the article "
        "nor this table corrects for it: the moduli are apparent ones, slopes over 0-5 % in "
        "compression and 0-1 % in tension.",
        ("table4", "figure9"),
    )


def _name(row: str) -> str:
    author, year = row.split("_")
    return f"{author.capitalize()} {year}"
