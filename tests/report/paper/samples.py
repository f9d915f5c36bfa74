"""A small database of made-up values: some synthetic, some not, some refused, most missing."""

from __future__ import annotations

from pathlib import Path

from deamat.core.ledger import Provenance
from deamat.core.properties import property_key
from deamat.core.quantity import Quantity
from deamat.core.records import Condition, Law, PropertyRecord, Refusal
from deamat.materials.card import Credit, MaterialCard
from deamat.materials.database import write_database

TWIN = Credit("twin-1", "Simulated", "nobody", "CC BY 4.0", "a twin", synthetic=True)
LAB = Credit("lab-1", "Measured", "Lab One", "CC BY 4.0", "", synthetic=False)


def record(
    key: str,
    value: float,
    u: float,
    campaign: str = TWIN.campaign,
    material: str = "sylgard-182-10to1",
    ci95: tuple[float, float] | None = None,
    **conditions: Condition,
) -> PropertyRecord:
    return PropertyRecord(
        key=key,
        material=material,
        campaign=campaign,
        quantity=Quantity(value, property_key(key).unit, u),
        n=5,
        sd=None,
        ci95=ci95 or (value - 2 * u, value + 2 * u),
        conditions=conditions,
        method="by hand",
        budget=(),
        origins=(),
    )


def law(key: str, coefficients: tuple[float, ...], material: str, kind: str = "polynomial") -> Law:
    """A law in seconds with coefficients per hour, known to 1 % of its constant term."""
    c = tuple(x / 3600.0**k for k, x in enumerate(coefficients))
    covariance = [[0.0] * len(c) for _ in c]
    covariance[0][0] = (0.01 * c[0]) ** 2
    return Law(
        key=key,
        material=material,
        campaign=TWIN.campaign,
        kind=kind,
        unit=property_key(key).unit,
        argument="time since mixing",
        argument_unit="s",
        coefficients=c,
        covariance=tuple(map(tuple, covariance)),
        valid=(3600.0, 43200.0),
        conditions={},
        method="by hand",
    )


def cards() -> tuple[MaterialCard, ...]:
    soft = "sylgard-182-10to1"
    return (
        MaterialCard(
            soft, "Sylgard 182 (10:1)", True,
            records=(
                record("compressive_modulus", 952e3, 12e3, age="after cure"),
                record("compressive_modulus", 843e3, 12e3, age="2 months"),
                record("elongation_at_break", 2.869, 0.047, age="after cure"),
                record("relative_permittivity", 2.60, 0.01, frequency_Hz=10.0),
                record("relative_permittivity", 2.90, 0.01, frequency_Hz=1000.0),
                record(
                    "handling_time", 39600.0, 0.0, ci95=(39600.0, 41400.0), temperature_K=295.15
                ),
                record(
                    "handling_time", 30600.0, 0.0, ci95=(30600.0, float("inf")),
                    temperature_K=323.15,
                ),
            ),
            laws=(law("viscosity", (1.64, 0.30), soft),),
            refusals=(
                Refusal("breakdown_strength", "3 films, 5 are needed", soft, TWIN.campaign),
            ),
            campaigns=(TWIN,),
        ),
        MaterialCard(
            "sylgard-184-10to1", "Sylgard 184 (10:1)", True,
            records=(
                record("compressive_modulus", 1.15e6, 1e4, material="sylgard-184-10to1"),
                record(
                    "tensile_modulus", 1.40e6, 5e4, LAB.campaign, "sylgard-184-10to1",
                    age="after cure",
                ),
            ),
            laws=(law("viscosity", (2.5, 0.2), "sylgard-184-10to1", "exponential"),),
            campaigns=(TWIN, LAB),
        ),
    )  # fmt: skip


def database(processed: Path) -> Path:
    """Write the database into a results folder and give that folder."""
    processed.mkdir(parents=True, exist_ok=True)
    write_database(
        processed / "materials.sqlite", cards(), (), Provenance("1", "c" * 24, (), (), ())
    )
    return processed
