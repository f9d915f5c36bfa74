"""Writes `processed/paper/`: the page, its numbers and its figures, whole or not at all."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from deamat.core.atomic import whole_folder, write_atomically
from deamat.materials.database import Database, open_database
from deamat.report.figures import axes_figure
from deamat.report.paper import printed
from deamat.report.paper.actuator_figures import ACTUATOR_FIGURES
from deamat.report.paper.actuators import table1, table5, totals
from deamat.report.paper.claims import figures
from deamat.report.paper.discrepancies import discrepancies
from deamat.report.paper.entry import CORRECTED, Entry, to_json
from deamat.report.paper.laws import Reading, is_fluid, reading, table2
from deamat.report.paper.material_figures import material_figures
from deamat.report.paper.page import Picture, render
from deamat.report.paper.tables import table3, table4, viscosity_then

FOLDER = "paper"
_INPUTS = {
    "table1": "input, or measured in the cited work",
    "table4_manufacturer": "data sheet of the manufacturer, no campaign measures it",
    "table5": "input",
    "figure3": "against the experiment, whose shapes are not published",
}
# figure -> table and part of the names of the entries that it draws
_DRAWN_FROM = {
    "figure-8a": ("table2.", ""),
    "figure-8b": ("table2.sylgard-186", ""),
    "figure-9a": ("table4.", "compressive_modulus"),
    "figure-9b": ("table4.", "modulus"),
    "figure-10a": ("table4.", "relative_permittivity"),
    "figure-10b": ("table4.", "breakdown_strength"),
}
_EXPERIMENT = "measured by the authors; an experiment is not recomputed"


def write_paper(processed: Path) -> tuple[Path, list[Entry]]:
    """Write `paper/` into the results.

    Parameters
    ----------
    processed : folder with the database

    Returns
    -------
    the page and its numbers

    Raises
    ------
    DatabaseError : there is no database
    ConfigError : something else stands where the folder goes
    """
    with open_database(processed) as database:
        place = processed / FOLDER
        with whole_folder(place) as folder:
            entries = _write(database, folder)
    return place / "index.html", entries


def collect(database: Database) -> list[Entry]:
    """Return every printed number its row, in the order of `printed.toml`."""
    found = [
        *table1(),
        *table2(database),
        *table3(database),
        *table4(database),
        *table5(),
        *figures(),
        *totals(),
    ]
    by_id = {entry.id: entry for entry in found}
    rows: list[Entry] = []
    seen: set[str] = set()
    for path, number in printed.numbers():
        law = ".".join(path.split(".")[:2])
        own = by_id[path] if path in by_id else _input(path, number)
        for row in (by_id.get(law), own, by_id.get(path + CORRECTED)):
            if row is not None and row.id not in seen:
                seen.add(row.id)
                rows.append(row)
    return rows


def _input(path: str, number: float) -> Entry:
    table = path.partition(".")[0]
    if path.endswith((".measured", ".curvature_per_m")):
        note = _EXPERIMENT
    else:
        note = _INPUTS.get(table, "input")
    return Entry(path, number, None, printed.unit(path), None, f"{note}; used as printed")


def _write(database: Database, folder: Path) -> list[Entry]:
    entries = collect(database)
    by_id = {entry.id: entry for entry in entries}
    readings = {m: reading(database, m) for m in printed.part("table2") if is_fluid(m)}
    pictures = _draw(database, folder, by_id, readings)
    viscosities = {name: viscosity_then(database, name) for name in printed.part("table3")}
    page = render(by_id, pictures, discrepancies(list(readings.values())), viscosities)
    write_atomically(folder / "index.html", page)
    write_atomically(folder / "paper.json", to_json(entries))
    return entries


def _draw(
    database: Database,
    folder: Path,
    entries: Mapping[str, Entry],
    readings: Mapping[str, Reading | str],
) -> dict[str, Picture]:
    figures = ACTUATOR_FIGURES | material_figures(database, entries, readings)
    pictures = {}
    for name, (title, draw) in figures.items():
        marked = _shows_synthetic(name, entries)
        svg, _ = axes_figure(folder / "figures", name, title, draw, marked)
        text = svg.read_text(encoding="utf-8")
        pictures[name] = Picture(name, title, text[text.index("<svg") :], marked)
    return pictures


def _shows_synthetic(figure: str, entries: Mapping[str, Entry]) -> bool:
    """Say whether a figure draws simulated data: one simulated value of its kind marks it."""
    if figure not in _DRAWN_FROM:
        return False
    table, words = _DRAWN_FROM[figure]
    return any(
        entry.synthetic and path.startswith(table) and words in path
        for path, entry in entries.items()
    )
