"""Tables 3 and 4: handling times and electromechanical values beside those of the database."""

from __future__ import annotations

import re
from dataclasses import replace

from deamat.core.present import readable_record
from deamat.core.properties import REFERENCE_AGE
from deamat.core.records import Condition
from deamat.core.units import to_si
from deamat.materials.card import MaterialCard
from deamat.materials.database import Database
from deamat.report.paper import printed
from deamat.report.paper.entry import Entry
from deamat.report.paper.lookup import ask, material_entry, missing, of_record

HANDLING, VISCOSITY_THEN = "handling_time", "viscosity_at_handling_time"
ROOM_C = (22.0, 3.0)  # of the article, and how far an unheated bed may be from it

# row of Table 4 -> property key and conditions
TABLE4: dict[str, tuple[str, dict[str, Condition]]] = {
    "compressive_modulus_MPa": ("compressive_modulus", {"age": REFERENCE_AGE}),
    "compressive_modulus_2_months_MPa": ("compressive_modulus", {"age": "2 months"}),
    "tensile_modulus_MPa": ("tensile_modulus", {}),
    "tensile_strength_MPa": ("tensile_strength", {}),
    "elongation_percent": ("elongation_at_break", {}),
    "relative_permittivity_10Hz": ("relative_permittivity", {"frequency_Hz": 10.0}),
    "breakdown_strength_V_per_um": ("breakdown_strength", {}),
}
_BED = re.compile(r"(?P<material>.+)-bed(?P<bed_C>\d+)C")


def table4(database: Database) -> list[Entry]:
    """Look every measured value of Table 4 up."""
    return [
        material_entry(database, f"table4.{material}.{row}", material, *TABLE4[row])
        for material, rows in printed.part("table4").items()
        for row in rows
    ]


def table3(database: Database) -> list[Entry]:
    """Look every handling time of Table 3 up."""
    return [_handling(database, name) for name in printed.part("table3")]


def viscosity_then(database: Database, name: str) -> tuple[str, str]:
    """Say which viscosity a column of Table 3 had at its handling time, and the caveat or why not.

    Returns
    -------
    text : value with its interval and shear rate, empty where there is none
    note : the caveat beside it, or the reason
    """
    material, bed_C = run_of(name)

    def question(card: MaterialCard) -> tuple[str, str]:
        where = _bed(card, bed_C)
        record = card.record(VISCOSITY_THEN, **where)
        text = readable_record(record)
        if "rate_per_s" in record.conditions:
            text += f" at {record.conditions['rate_per_s']:.3g} 1/s"
        return text, "; ".join(flag.detail for flag in record.flags)

    found = ask(database, material, question)
    return ("", found) if isinstance(found, str) else found


def _bed(card: MaterialCard, bed_C: float | None) -> dict[str, Condition | None]:
    """Conditions of the record that was printed on this bed, None for one at room temperature."""
    return _unheated(card) if bed_C is None else {"temperature_K": to_si(bed_C, "C")}


def run_of(name: str) -> tuple[str, float | None]:
    """Part a column of Table 3 into material and bed temperature `[degree Celsius]`."""
    heated = _BED.fullmatch(name)
    return (heated["material"], float(heated["bed_C"])) if heated else (name, None)


def _handling(database: Database, name: str) -> Entry:
    path = f"table3.{name}.hours"
    material, bed_C = run_of(name)

    def question(card: MaterialCard) -> Entry:
        return of_record(path, card, card.record(HANDLING, **_bed(card, bed_C)))

    found = ask(database, material, question)
    if isinstance(found, str):
        return missing(path, found)
    if printed.part(f"table3.{name}").keys() >= {"right_censored"}:
        why = printed.part(f"table3.{name}.why")
        note = f"printed as a lower bound ({why}); {found.note}"
        return replace(found, standard_uncertainty=None, note=note)
    return found


def _unheated(card: MaterialCard) -> dict[str, Condition | None]:
    """Find the bed temperature of the record that was printed at the temperature of the room."""
    room_C, within_K = ROOM_C
    near = [
        record.conditions["temperature_K"]
        for record in card.records
        if record.key == HANDLING
        and "temperature_K" in record.conditions
        and isinstance(record.conditions["temperature_K"], float)
        and abs(record.conditions["temperature_K"] - to_si(room_C, "C")) <= within_K
    ]
    if near:
        return {"temperature_K": near[0]}
    stated = any(r.key == HANDLING and "temperature_K" in r.conditions for r in card.records)
    return {"temperature_K": None} if stated else {}
