"""The page: tables laid out as in the article, each cell with printed and recomputed numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from jinja2 import Environment, PackageLoader, StrictUndefined

from deamat.report.paper import printed
from deamat.report.paper.actuators import FILMS
from deamat.report.paper.discrepancies import Discrepancy
from deamat.report.paper.entry import CORRECTED, Entry
from deamat.report.paper.laws import is_fluid
from deamat.report.paper.material_figures import title_of
from deamat.report.paper.tables import TABLE4, run_of

_FAR_u = 2.0  # beyond so many standard uncertainties a material value is marked
# ... and a computed one beyond this relative difference: the text says "about" of its figures, and
# sums are exact.
_OFF = {"table": 0.02, "figure": 0.1, "text": 0.005}
_UPPER_LIMITS = ("figure3.numerical_off_at_22V_per_um_percent",)

_LOOKED_UP = ("table2", "table3", "table4")

_TABLE4_WORDS = {
    "compressive_modulus_MPa": "Compressive modulus after curing, MPa",
    "compressive_modulus_2_months_MPa": "Compressive modulus after 2 months, MPa",
    "tensile_modulus_MPa": "Tensile modulus, MPa",
    "tensile_strength_MPa": "Tensile strength, MPa",
    "elongation_percent": "Elongation, %",
    "relative_permittivity_10Hz": "Relative permittivity at 10 Hz",
    "breakdown_strength_V_per_um": "Breakdown strength, V/µm",
}
_TABLE5_WORDS = {
    "designed_um.passive": "Designed passive layer (optimum), µm",
    "field_V_per_um": "Reached field on the thinned film, V/µm",
    "field_over_breakdown": "Field over breakdown strength",
    "fom_single_layer_per_m": "FOM of the design, 1/m",
    "fom_optimum_per_m": "FOM at the optimum passive layer, 1/m",
    "curvature_per_m": "Experiment, 1/m",
}
_CLAIMS = {
    "figure3": "Tip off by neglected rotation at 22.2 V/µm, % (printed: less than)",
    "figure4": "Spread of the optima at one total thickness, %",
    "figure5": "Eq. 19 off the maximum, %",
    "figure6": "Curvature lost to electrodes, %",
    "figure7": "Curvature lost with 10 layers, %",
    "figure11": "Best 30:1 film over best 10:1 film",
}


@dataclass(frozen=True, slots=True)
class Cell:
    """What one cell of a table shows.

    Parameters
    ----------
    printed, recomputed, difference : in words
    state : `good`, `far`, `missing` or `input`; its colour
    note : shown when the reader asks for it
    corrected : the recomputed number with the right sign of Eq. 4, where it changes it
    lower_bound : the recomputed number is only known to be exceeded
    """

    printed: str
    recomputed: str
    difference: str
    state: str
    note: str
    corrected: str = ""
    lower_bound: bool = False


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure, inline; `name` is that of its files."""

    name: str
    title: str
    svg: str
    synthetic: bool


def digits(value: float | None, figures: int = 4) -> str:
    """Write a number with so many significant figures and no exponent where it can be helped."""
    if value is None:
        return "-"
    if value == 0:
        return "0"
    decimals = max(figures - 1 - math.floor(math.log10(abs(value))), 0)
    return f"{value:.{decimals}f}" if abs(value) < 1e6 and decimals < 9 else f"{value:.{figures}g}"


def with_uncertainty(value: float, u: float | None) -> str:
    """Write a value to the second figure of its uncertainty."""
    if not u:
        return digits(value)
    decimals = 1 - int(f"{u:.1e}".partition("e")[2])
    return (
        f"{round(value, decimals):.{max(decimals, 0)}f} ± {round(u, decimals):.{max(decimals, 0)}f}"
    )


def plain(value: float | None) -> str:
    """Write a number as it is printed."""
    return "" if value is None else f"{value:.5g}"


def cell(entry: Entry, corrected: Entry | None = None) -> Cell:
    """Lay one entry out."""
    if entry.recomputed is None:
        state = "missing" if entry.missing else "input"
        said = "not in the database" if entry.missing else ""
        return Cell(plain(entry.printed), said, "", state, entry.note)
    state, difference = _difference(entry)
    observed = entry.id.startswith("table3.")  # a time that was written down, not computed
    return Cell(
        plain(entry.printed),
        plain(entry.recomputed)
        if observed
        else with_uncertainty(entry.recomputed, entry.standard_uncertainty),
        difference,
        state,
        entry.note,
        "" if corrected is None else digits(corrected.recomputed),
        entry.lower_bound,
    )


def _difference(entry: Entry) -> tuple[str, str]:
    in_u, relative = entry.difference_in_u, entry.relative_difference
    if in_u is not None:
        return "far" if abs(in_u) > _FAR_u else "good", f"{round(in_u, 1) + 0.0:+.1f} u"
    if relative is None:
        return "good", ""
    if entry.id in _UPPER_LIMITS:
        return "good" if relative <= 0 else "far", "below the printed limit" * (relative <= 0)
    allowed = next(off for kind, off in _OFF.items() if entry.id.startswith(kind))
    return "far" if abs(relative) > allowed else "good", _percent(relative)


def _percent(part: float) -> str:
    text = f"{100 * part:+.1f} %"
    return "0.0 %" if text[1:] == "0.0 %" else text


def _why_missing(entries: Mapping[str, Entry], table: str) -> list[str]:
    """List the reasons for which values of a table are missing, each once."""
    cells = [cell(e) for e in entries.values() if e.id.startswith(f"{table}.")]
    return list(dict.fromkeys(c.note for c in cells if c.state == "missing"))


def render(
    entries: Mapping[str, Entry],
    pictures: Mapping[str, Picture],
    found: Sequence[Discrepancy],
    viscosities: Mapping[str, tuple[str, str]],
) -> bytes:
    """Write the page.

    Parameters
    ----------
    entries : by id
    pictures : by name, `figure-8a`
    found : D1 to D7
    viscosities : column of Table 3 to the viscosity at its handling time, and what to know of it
    """
    environment = Environment(
        loader=PackageLoader("deamat.report.paper", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    page = environment.get_template("page.html.j2").render(
        source=printed.part("source"),
        synthetic=sorted({e.campaign for e in entries.values() if e.synthetic}),
        marked={e.id.partition(".")[0] for e in entries.values() if e.synthetic},
        reasons={table: _why_missing(entries, table) for table in _LOOKED_UP},
        counts=_counts(entries),
        table1=_table1(entries),
        table2=_table2(entries),
        table3=_table3(entries, viscosities),
        table4=_table4(entries),
        table5=_table5(entries),
        totals=[cell(entries[f"text.total_of_{name}_um"]) for name in FILMS],
        claims={key: _claims(entries, key) for key in _CLAIMS},
        pictures=pictures,
        discrepancies=found,
        stated={
            place: [d for d in found if place in d.where] for d_ in found for place in d_.where
        },
    )
    return page.encode()


def _counts(entries: Mapping[str, Entry]) -> dict[str, int]:
    states = [cell(e).state for e in entries.values()]
    return {state: states.count(state) for state in ("good", "far", "missing", "input")}


def _table1(entries: Mapping[str, Entry]) -> list[dict[str, object]]:
    rows = []
    for row, inputs in printed.part("table1").items():
        author, year = row.split("_")
        columns = {}
        for name in ("analytical", "t_p_opt", "optimum"):
            path = f"table1.{row}.{name}"
            columns[name] = cell(entries[path], entries.get(path + CORRECTED))
        rows.append(
            {
                "name": f"{author.capitalize()} {year}",
                "inputs": _inputs(inputs),
                "measured": plain(inputs["measured"]),
                **columns,
            }
        )
    return rows


def _inputs(row: Mapping[str, object]) -> str:
    electrodes = row["t_el"]
    thickness = (
        " and ".join(plain(t) for t in electrodes) if isinstance(electrodes, list) else electrodes
    )
    return (
        f"{row['n_de']} × {row['t_de']} µm film, {row['Y_de']} MPa, ε {row['eps_r']}, "
        f"{row['V']} V; passive {row['t_p']} µm, {row['Y_p']} MPa; "
        f"electrodes {thickness} µm, {row['Y_el']} MPa"
    )


def _table2(entries: Mapping[str, Entry]) -> list[dict[str, object]]:
    rows = []
    for material in printed.part("table2"):
        path = f"table2.{material}"
        coefficients = [(p, entries[p]) for p, _ in printed.numbers(path)]
        rows.append(
            {
                "name": title_of(material),
                "printed": _formula(path, {p: e.printed for p, e in coefficients}),
                "recomputed": _formula(path, {p: e.recomputed for p, e in coefficients}),
                "curve": cell(entries[path]),
                "fluid": is_fluid(material),
                "coefficients": [(_symbol(p), e.unit, cell(e)) for p, e in coefficients],
            }
        )
    return rows


def _symbol(path: str) -> str:
    _, _, row, power = path.split(".")
    letter = {"K_low_to_high": "K", "printed_exponent_low_to_high": "e"}
    return f"{letter.get(row, 'μ')} · t^{power}"


def _formula(path: str, values: Mapping[str, float | None]) -> str:
    """Write a law in hours; empty where none of its coefficients is known."""
    if all(v is None for v in values.values()):
        return ""
    sides = []
    for row in printed.part(path):
        mine = [v for p, v in values.items() if p.split(".")[2] == row]
        if mine:
            sides.append(_polynomial(mine))
    return sides[0] if len(sides) == 1 else f"({sides[0]}) · rate^({sides[1]}) (D3)"


def _polynomial(coefficients: Sequence[float | None]) -> str:
    powers = ("", " t", *(f" t{mark}" for mark in "²³⁴⁵"))
    terms = [f"{c:.4g}{p}" for c, p in zip(coefficients, powers, strict=False) if c is not None]
    return " + ".join(reversed(terms)).replace("+ -", "− ")


def _table3(
    entries: Mapping[str, Entry], viscosities: Mapping[str, tuple[str, str]]
) -> list[dict[str, object]]:
    columns = []
    for name, row in printed.part("table3").items():
        material, bed_C = run_of(name)
        columns.append(
            {
                "name": title_of(material) + (f" at {bed_C:g} °C" if bed_C is not None else ""),
                "censored": "right_censored" in row,
                "cell": cell(entries[f"table3.{name}.hours"]),
                "then": viscosities[name],
            }
        )
    return columns


def _table4(entries: Mapping[str, Entry]) -> dict[str, object]:
    materials = list(printed.part("table4"))
    rows = []
    for row in TABLE4:
        paths = [f"table4.{material}.{row}" for material in materials]
        cells = [cell(entries[path]) if path in entries else None for path in paths]
        rows.append((_TABLE4_WORDS[row], cells))
    return {"names": [title_of(m) for m in materials], "rows": rows}


def _table5(entries: Mapping[str, Entry]) -> list[tuple[str, list[Cell]]]:
    return [
        (words, [cell(entries[f"table5.{name}.{row}"]) for name in FILMS])
        for row, words in _TABLE5_WORDS.items()
    ]


def _claims(entries: Mapping[str, Entry], figure: str) -> list[tuple[str, Cell]]:
    return [
        (_CLAIMS[figure] + (", R = 0.001" if "thin_soft" in path else ""), cell(entries[path]))
        for path, _ in printed.numbers(figure)
        if entries[path].recomputed is not None
    ]
