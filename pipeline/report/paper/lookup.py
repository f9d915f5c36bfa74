"""What the database says in the place of a printed material value, or why it says nothing."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeVar

from deamat.core.errors import MissingProperty
from deamat.core.records import Condition, Law, PropertyRecord
from deamat.core.units import from_si, si_factor
from deamat.materials.card import MaterialCard
from deamat.materials.database import Database
from deamat.report.paper import printed
from deamat.report.paper.entry import Entry

T = TypeVar("T")
SYNTHETIC = "SYNTHETIC: simulated, not measured"


def ask(database: Database, material: str, question: Callable[[MaterialCard], T]) -> T | str:
    """Ask the card of a material; say why there is no answer, with the reasons of refusals."""
    if material not in database:
        return f"the database has no material {material}"
    try:
        return question(database[material])
    except MissingProperty as error:
        return error.reason  # what else the card holds is beside the point


def is_synthetic(card: MaterialCard, campaign: str) -> bool:
    """Say whether a campaign of a card is simulated; one without credit counts as the card."""
    marks = [credit.synthetic for credit in card.campaigns if credit.campaign == campaign]
    return any(marks) if marks else card.synthetic


def provenance(card: MaterialCard, found: PropertyRecord | Law) -> str:
    """Name the campaign of a record or law, and say if it is simulated."""
    said = f"campaign {found.campaign}"
    return f"{SYNTHETIC}; {said}" if is_synthetic(card, found.campaign) else said


def missing(path: str, why: str) -> Entry:
    """Make the row of a number that the database does not have."""
    return Entry(path, _printed_or_none(path), None, printed.unit(path), None, why, missing=True)


def _printed_or_none(path: str) -> float | None:
    return printed.value(path) if isinstance(printed.part(path), int | float) else None


def material_entry(
    database: Database, path: str, material: str, key: str, conditions: dict[str, Condition]
) -> Entry:
    """Put the record of a property beside the printed value at a path.

    Parameters
    ----------
    path : of the printed number
    material, key : which record
    conditions : as `MaterialCard.record` takes them
    """

    def question(card: MaterialCard) -> Entry:
        return of_record(path, card, card.record(key, **conditions))

    found = ask(database, material, question)
    return missing(path, found) if isinstance(found, str) else found


def of_record(path: str, card: MaterialCard, record: PropertyRecord) -> Entry:
    """Write a record in the unit of the printed value, and say what stands behind it."""
    unit = printed.unit(path)
    _, factor, _ = si_factor(unit)
    u = record.quantity.standard_uncertainty / factor
    return Entry(
        path,
        printed.value(path),
        from_si(record.quantity.value, unit),
        unit,
        u or None,
        f"{provenance(card, record)}; n = {record.n}, {_interval(record.ci95, unit, u)}",
        is_synthetic(card, record.campaign),
        record.campaign,
        lower_bound=math.isinf(record.ci95[1]),
    )


def _interval(ci95: tuple[float, float], unit: str, u: float) -> str:
    low, high = (from_si(end, unit) for end in ci95)
    written = "" if unit == "1" else f" {unit}"
    if math.isinf(high):
        return f"a lower bound: above {low:.4g}{written}"
    # A value that was only seen to lie between two observations has no distribution.
    kind = "95 % interval" if u else "seen to lie within"
    return f"{kind} {low:.4g} to {high:.4g}{written}"
