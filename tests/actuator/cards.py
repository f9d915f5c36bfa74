"""Cards made by hand to design with: round numbers, no measurement behind them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from deamat.actuator.declared import Designs, load_designs
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import Condition, Origin, PropertyRecord
from deamat.materials.card import Credit, MaterialCard

ROOT = Path(__file__).resolve().parents[2]
STATE: dict[str, Condition] = {"age": "after cure", "cure": "2 h at 90 C"}
NONE: Mapping[str, Condition] = {}
CAMPAIGN = "made-2026"
AREA: dict[str, Condition] = {"electrode_area_m2": 1e-4}


def declared() -> Designs:
    """What the project itself declares."""
    return load_designs(ROOT / "config")


def record(
    material: str,
    key: str,
    value: float,
    unit: str,
    relative: tuple[float, float] = (0.02, 0.01),
    n: int = 5,
    conditions: Mapping[str, Condition] = NONE,
) -> PropertyRecord:
    """Return a record with relative independent and shared uncertainty."""
    technique = {"compressive_modulus": "compression", "relative_permittivity": "permittivity"}
    lines = tuple(
        Contribution(source, share * value, shared)
        for source, share, shared in (
            ("scatter between specimens", relative[0], False),
            ("calibration", relative[1], True),
        )
        if share
    )
    quantity = Quantity.from_budget(value, unit, lines)
    origin = Origin(
        "S1", value, 0.0, 0.0, "made-2026/specimens.csv", 2, None, None, None, None, None,
        technique.get(key, "breakdown"),
    )  # fmt: skip
    u = quantity.standard_uncertainty
    return PropertyRecord(
        key=key, material=material, campaign=CAMPAIGN, quantity=quantity, n=n, sd=None,
        ci95=(value - 2 * u, value + 2 * u), conditions={**STATE, **conditions},
        method="made by hand", budget=lines, origins=(origin,),
        area_ratio_limit=10.0 if "electrode_area_m2" in conditions else None,
    )  # fmt: skip


def card(
    material: str,
    modulus_Pa: float,
    permittivity: float = 2.6,
    strength_V_m: float | None = None,
    shape: float = 10.0,
    *,
    synthetic: bool = False,
    conditions: Mapping[str, Condition] = NONE,
) -> MaterialCard:
    """Return a card with modulus, permittivity and, if a strength is given, breakdown."""
    records = [
        record(material, "compressive_modulus", modulus_Pa, "Pa", conditions=conditions),
        record(
            material,
            "relative_permittivity",
            permittivity,
            "1",
            (0.01, 0.01),
            conditions=conditions,
        ),
    ]
    if strength_V_m is not None:
        more = {**AREA, **conditions}
        records += [
            record(material, "breakdown_strength", strength_V_m, "V/m", (0.03, 0.01), 20, more),
            record(material, "weibull_shape", shape, "1", (0.1, 0.0), 20, more),
        ]
    credit = Credit(CAMPAIGN, "Made by hand", "nobody", "CC BY 4.0", "tests", synthetic)
    return MaterialCard(material, material, synthetic, records=tuple(records), campaigns=(credit,))


def cards(*, synthetic: bool = False, breakdown: bool = True) -> dict[str, MaterialCard]:
    """Return a stiff, a soft and a very soft one; the last one has no breakdown."""
    strength = (90e6, 50e6) if breakdown else (None, None)
    return {
        "stiff": card("stiff", 1e6, strength_V_m=strength[0], synthetic=synthetic),
        "soft": card("soft", 1e5, strength_V_m=strength[1], synthetic=synthetic),
        "gel": card("gel", 3e4, synthetic=synthetic),
    }
