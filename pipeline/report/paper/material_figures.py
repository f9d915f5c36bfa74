"""Figures 8 to 10: the printed values and those of the database in one picture."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np
from matplotlib.axes import Axes

from deamat.core.errors import MissingProperty
from deamat.core.properties import REFERENCE_AGE
from deamat.core.records import Law
from deamat.core.units import from_si
from deamat.materials.curves import CurvesError
from deamat.materials.database import Database, MissingMaterial
from deamat.report.paper import printed
from deamat.report.paper.entry import Entry
from deamat.report.paper.laws import (
    FOOTNOTE,
    HOURS,
    PLAUSIBLE,
    READINGS,
    VISCOSITY,
    Reading,
    fitted,
    hours_of,
    is_fluid,
    printed_viscosity,
    rate_for,
    rates_of,
)
from deamat.report.style import COLOURS, decade_ticks

Draw = Callable[[Axes], None]

_TIMES_h = 45
_AT_h = 2.0  # of Figure 8B
_MODULI = {
    "compressive_modulus_MPa": "compression, after cure",
    "compressive_modulus_2_months_MPa": "compression, 2 months",
    "tensile_modulus_MPa": "tension",
}
_STRAIN_DRAWN = 0.10


def title_of(material: str) -> str:
    """Write an id as people do: `sylgard-182-10to1` as `Sylgard 182 (10:1)`."""
    maker, number, mix = material.split("-")
    return f"{maker.capitalize()} {number} ({mix.replace('to', ':')})"


def viscosity_law(database: Database, material: str) -> Law | None:
    """Return the law of a material's viscosity, if the database has one."""
    try:
        return database[material].law(VISCOSITY)
    except (MissingMaterial, MissingProperty):
        return None


# --- Figure 8


def figure8a(axes: Axes, database: Database, readings: Mapping[str, Reading | str]) -> None:
    """Draw the printed laws and the fitted ones with their 95 % band over 1 to 12 h."""
    hours = np.linspace(*HOURS, _TIMES_h)
    for colour, material in zip(COLOURS, printed.part("table2"), strict=False):
        name = _reading_of(readings, material)
        law = viscosity_law(database, material)
        rate = rate_for(law)
        at_rate = f" at {rate:.2g} 1/s" if is_fluid(material) else ""
        there = printed_viscosity(material, hours, np.full_like(hours, rate), name)
        axes.plot(
            hours,
            there,
            color=colour,
            linestyle="--",
            label=f"{title_of(material)}, printed{at_rate}",
        )
        if law is None:
            continue
        low, high = hours_of(law)
        times = np.linspace(low, high, _TIMES_h)
        found = [fitted(law, float(t), rate) for t in times]
        values = np.array([q.value for q in found])
        u = np.array([q.standard_uncertainty for q in found])
        axes.plot(
            times, values, color=colour, linestyle="-", label=f"{title_of(material)}, recomputed"
        )
        axes.fill_between(times, values - 2 * u, values + 2 * u, color=colour, alpha=0.2, lw=0)
    axes.set_yscale("log")
    axes.set_xlabel("time since mixing [h]; bands: ± 2 u")
    axes.set_ylabel("viscosity [Pa.s]")


def _reading_of(readings: Mapping[str, Reading | str], material: str) -> str:
    found = readings.get(material, "")
    return found.name if isinstance(found, Reading) else PLAUSIBLE


def figure8b(axes: Axes, database: Database) -> None:
    """Draw the three readings of the printed exponent against shear rate, and the data's law."""
    rates = np.geomspace(0.02, 100.0, 60)
    fluids = [m for m in printed.part("table2") if is_fluid(m)]
    for colour, material in zip(COLOURS, fluids, strict=False):
        for look, name in zip(("--", "-.", ":"), READINGS, strict=True):
            footnote = ", as the footnote says" if name == FOOTNOTE else ""
            axes.plot(
                rates, printed_viscosity(material, np.full_like(rates, _AT_h), rates, name),
                color=colour, linestyle=look, linewidth=1.0,
                label=f"{title_of(material)}, printed, {name}{footnote}",
            )  # fmt: skip
        law = viscosity_law(database, material)
        known = None if law is None else rates_of(law)
        if law is None or known is None or not hours_of(law)[0] <= _AT_h <= hours_of(law)[1]:
            continue
        held = np.geomspace(*known, 20)
        found = [fitted(law, _AT_h, float(rate)).value for rate in held]
        axes.plot(
            held, found, color=colour, linestyle="-", linewidth=3.0,
            label=f"{title_of(material)}, recomputed",
        )  # fmt: skip
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("shear rate [1/s]")
    axes.set_ylabel(f"viscosity {_AT_h:g} h after mixing [Pa.s]")


# --- Figure 9


def figure9a(axes: Axes, database: Database) -> None:
    """Draw a compression curve after cure of every composition."""
    for colour, material in zip(COLOURS, printed.part("table4"), strict=False):
        curve = _first_curve(database, material)
        if curve is None:
            axes.plot([], [], color=colour, label=f"{title_of(material)}: no curve")
            continue
        strain, stress_Pa = curve
        inside = (strain > 0) & (strain <= _STRAIN_DRAWN) & (stress_Pa > 0)
        axes.plot(
            100 * strain[inside], from_si(1.0, "kPa") * stress_Pa[inside], color=colour,
            linestyle="-", label=title_of(material),
        )  # fmt: skip
        modulus = printed.si(f"table4.{material}.compressive_modulus_MPa")
        line = np.array([0.005, 0.05])
        axes.plot(100 * line, from_si(1.0, "kPa") * modulus * line, color=colour, linestyle=":")
    axes.plot([], [], color="black", linestyle=":", label="printed modulus, 0-5 %")
    axes.set_yscale("log")
    axes.set_ylim(bottom=0.05)
    axes.set_xlabel("nominal compressive strain [%]")
    axes.set_ylabel("nominal stress [kPa]")


def _first_curve(database: Database, material: str) -> tuple[np.ndarray, np.ndarray] | None:
    """Return strain and stress of the first specimen behind the compressive modulus after cure."""
    try:
        record = database[material].record("compressive_modulus", age=REFERENCE_AGE)
        curves = database.curves(material, "compression")
    except (MissingMaterial, MissingProperty, CurvesError):
        return None
    specimen = record.origins[0].specimen
    mine = (curves["specimen"].values == specimen) & (curves["campaign"].values == record.campaign)
    samples = np.isin(curves["of_curve"].values, np.flatnonzero(mine))
    if not samples.any():
        return None
    return curves["nominal_strain"].values[samples], curves["nominal_stress_Pa"].values[samples]


def figure9b(axes: Axes, entries: Mapping[str, Entry]) -> None:
    """Draw all moduli, printed and recomputed."""
    rows = [
        (f"{title_of(material)}, {said}", entries[f"table4.{material}.{row}"])
        for material in printed.part("table4")
        for row, said in _MODULI.items()
    ]
    draw_pairs(axes, rows, "modulus [MPa]", logarithmic=True)


# --- Figure 10


def figure10(axes: Axes, entries: Mapping[str, Entry], row: str, name: str) -> None:
    """Draw one property of Table 4 of all compositions that have it."""
    rows = [
        (title_of(material), entries[f"table4.{material}.{row}"])
        for material, found in printed.part("table4").items()
        if row in found
    ]
    draw_pairs(axes, rows, name, logarithmic=False)


def draw_pairs(
    axes: Axes, rows: Sequence[tuple[str, Entry]], name: str, *, logarithmic: bool
) -> None:
    """Draw printed values as hollow diamonds and recomputed ones as dots with whiskers of 2 u."""
    at = np.arange(len(rows))[::-1]
    known = [(y, e) for y, (_, e) in zip(at, rows, strict=True) if e.recomputed is not None]
    axes.plot(
        [_number(e.printed) for _, e in rows], at, marker="D", markersize=7, markerfacecolor="none",
        color="black", linestyle="none", label="printed",
    )  # fmt: skip
    if known:
        axes.errorbar(
            [_number(e.recomputed) for _, e in known], [y for y, _ in known],
            xerr=[2.0 * (e.standard_uncertainty or 0.0) for _, e in known],
            fmt="o", color=COLOURS[0], capsize=3, label="recomputed, ± 2 u",
        )  # fmt: skip
    for y, (_, e) in zip(at, rows, strict=True):
        if e.recomputed is None and e.printed is not None:
            axes.annotate(
                "not in the database", (e.printed, y), (10, 0), textcoords="offset points",
                va="center", fontsize=7.5, color="#555555", fontstyle="italic",
            )  # fmt: skip
    axes.set_yticks(at, [label for label, _ in rows])
    axes.set_ylim(-0.7, len(rows) - 0.3)
    axes.set_xlabel(name)
    axes.set_ylabel("composition")
    if logarithmic:
        axes.set_xscale("log")
        decade_ticks(axes.xaxis)
    else:
        axes.margins(x=0.25)


def _number(value: float | None) -> float:
    return math.nan if value is None else value


def material_figures(
    database: Database, entries: Mapping[str, Entry], readings: Mapping[str, Reading | str]
) -> dict[str, tuple[str, Draw]]:
    """Bind the figures of materials to a database: name to title and drawing."""
    permittivity = partial(
        figure10, row="relative_permittivity_10Hz", name="relative permittivity at 10 Hz [1]"
    )
    breakdown = partial(
        figure10, row="breakdown_strength_V_per_um", name="breakdown strength [V/µm]"
    )
    return {
        "figure-8a": (
            "Figure 8A: viscosity after mixing",
            partial(figure8a, database=database, readings=readings),
        ),
        "figure-8b": (
            "Figure 8B: Sylgard 186 against shear rate, and what its exponent may mean",
            partial(figure8b, database=database),
        ),
        "figure-9a": ("Figure 9A: compression", partial(figure9a, database=database)),
        "figure-9b": ("Figure 9B: moduli", partial(figure9b, entries=entries)),
        "figure-10a": ("Figure 10A: relative permittivity", partial(permittivity, entries=entries)),
        "figure-10b": ("Figure 10B: breakdown strength", partial(breakdown, entries=entries)),
    }
