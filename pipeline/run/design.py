"""`deamat design`: from what stands on the command line to text, JSON and figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from deamat.actuator.compositions import compare as compare_all
from deamat.actuator.compositions import pareto as pareto_front
from deamat.actuator.declared import Designs, load_designs
from deamat.actuator.design import design as answer
from deamat.actuator.present import (
    compositions_document,
    compositions_text,
    design_document,
    design_text,
    pareto_document,
    pareto_text,
)
from deamat.actuator.request import Request
from deamat.core.errors import ConfigError
from deamat.core.slug import file_stem
from deamat.core.units import from_si, read_quantity
from deamat.materials.card import MaterialCard, read_card
from deamat.materials.database import open_database
from deamat.run.folders import Folders


@dataclass(frozen=True, slots=True)
class Asked:
    """The words of the command line, None for what was left out."""

    name: str | None
    de: str | None
    passive: str | None
    electrode: str | None
    t_de: str | None
    t_passive: str | None
    voltage: str | None
    probability: float | None
    where: Mapping[str, str]
    cards: tuple[Path, ...] = ()


def run_design(
    folders: Folders, asked: Asked, *, compare: bool, pareto: bool, figures: Path | None
) -> tuple[dict[str, Any], str]:
    """Answer a request; give its JSON document and its text, and draw figures if asked to.

    Raises
    ------
    ConfigError : something that a design needs is neither asked for nor declared
    PipelineError : as `deamat.actuator.design.design`
    """
    declared = load_designs(folders.config)
    request = request_of(asked, declared)
    cards = _cards(folders, asked.cards, (request.de, request.passive))
    found = answer(cards, declared, request)
    document, text = design_document(found), design_text(found)
    compared = compare_all(cards, declared, request) if compare or figures else None
    front = pareto_front(cards, declared, request) if pareto or figures else None
    simulated = {material for material, card in cards.items() if card.synthetic}
    marked = front is not None and any({t.de, t.passive} & simulated for t in front)
    if compare and compared is not None:
        document["comparison"] = compositions_document(*compared)
        text += "\n" + compositions_text(*compared)
    if pareto and front is not None:
        document["pareto"] = pareto_document(front, marked)
        text += "\n" + pareto_text(front, marked)
    if figures is not None and compared is not None and front is not None:
        from deamat.report import design as draw

        film = f"films of {from_si(request.de_thickness_m, 'um'):.4g} um"
        name = file_stem("design", request.de, "on", request.passive, longest=100)
        drawn = [
            *draw.curvature_figure(figures, f"{name}-curvature", found),
            *draw.tornado_figure(figures, f"{name}-tornado", found),
            *draw.compositions_figure(
                figures, f"{name}-compositions", f"All compositions, {film}", compared[0]
            ),
            *draw.pareto_figure(
                figures, f"{name}-pareto", f"What no other design beats, {film}", front, marked
            ),
        ]
        document["figures"] = [str(path) for path in drawn]
        text += "\nFigures\n" + "".join(f"  {path}\n" for path in drawn)
    return document, text


def _cards(
    folders: Folders, files: Sequence[Path], wanted: Sequence[str]
) -> dict[str, MaterialCard]:
    """Return the cards of these files, or all of the database where there are none."""
    if not files:
        with open_database(folders.processed) as database:  # names the nearest of a wrong material
            return {
                material: database[material] for material in dict.fromkeys([*wanted, *database])
            }
    read = [read_card(file) for file in files]
    cards = {card.material: card for card in read}
    if len(cards) < len(read):
        raise ConfigError(f"two of the cards are of one material: {', '.join(map(str, files))}")
    for material in wanted:
        if material not in cards:
            raise ConfigError(f"none of the cards is of {material!r}; there is {', '.join(cards)}")
    return cards


def request_of(asked: Asked, declared: Designs) -> Request:
    """Read the words of the command line over a declared design, if one is named.

    Raises
    ------
    ConfigError : no such design, something missing, a length without its unit
    """
    if asked.name is not None:
        request = Request.of(declared.wanted(asked.name))
    else:
        needed = {"--de": asked.de, "--passive": asked.passive, "--electrode": asked.electrode}
        missing = [
            option for option, value in {**needed, "--t-de": asked.t_de}.items() if not value
        ]
        if missing:
            known = ", ".join(declared.designs) or "none"
            raise ConfigError(
                f"a design needs {', '.join(missing)}, or the name of a declared one ({known})"
            )
        thickness_m = read_quantity(asked.t_de or "", "m", "--t-de")
        request = Request(asked.de or "", asked.passive or "", asked.electrode or "", thickness_m)
    changes: dict[str, Any] = {
        field: value
        for field, value in (
            ("de", asked.de), ("passive", asked.passive), ("electrode", asked.electrode)
        )
        if value
    }  # fmt: skip
    for field, text, unit, option in (
        ("de_thickness_m", asked.t_de, "m", "--t-de"),
        ("passive_thickness_m", asked.t_passive, "m", "--t-passive"),
        ("voltage_V", asked.voltage, "V", "--voltage"),
    ):
        if text is not None:
            changes[field] = read_quantity(text, unit, option)
    return replace(
        request, **changes, breakdown_probability=asked.probability, where=dict(asked.where)
    )
