"""What a technique needs of another one reaches it: of its campaign, its age, its temperature."""

from __future__ import annotations

from typing import Any

import pytest

from deamat import open_database
from deamat.core.quantity import Quantity
from deamat.core.recording import Specimen
from deamat.core.records import PropertyRecord
from deamat.run import run_all
from deamat.run.folders import Folders
from deamat.run.measure import needs_met
from deamat.run.register import register
from deamat.techniques import TECHNIQUES
from tests.materials.samples import modulus
from tests.run.conftest import MATERIALS, run, twin_rows, write_campaign

pytestmark = pytest.mark.usefixtures("quick_figures")

MATERIAL = MATERIALS[0]
KEY = "compressive_modulus"


def film(temperature_K: float | None = 295.15, **conditions: Any) -> Specimen:
    numbers = {} if temperature_K is None else {"temperature_K": Quantity(temperature_K, "K")}
    return Specimen(
        "p1", "m", "c", "permittivity", None, None, numbers, conditions, {}, "c/specimens.csv", 2
    )


def found(value: float, **conditions: Any) -> PropertyRecord:
    return modulus(quantity=Quantity(value, "Pa", 1.0), conditions=conditions)


FRESH = found(1.0, age="after cure")
OLD = found(2.0, age="2 months")
WARM = found(3.0, age="after cure", temperature_K=363.15)
COLD = found(4.0, age="after cure", temperature_K=295.15)


@pytest.mark.parametrize(
    ("specimen", "records", "value"),
    [
        (film(), [OLD, FRESH], 1.0),  # the usual age, where none is stated
        (film(age="2 months"), [FRESH, OLD], 2.0),
        (film(age="2 months"), [FRESH], 1.0),  # the only one
        (film(age="a year"), [FRESH, OLD], None),  # neither is of its age
        (film(), [WARM, COLD], 4.0),
        (film(300.15), [WARM, COLD], 4.0),  # 5 K apart: techniques are used on two days
        (film(300.2), [WARM, COLD], None),
        (film(None), [WARM, COLD], None),
        (film(), [modulus(key="tensile_modulus")], None),
        (film(), [], None),
    ],
)
def test_a_need_is_met_at_the_age_and_the_temperature_of_the_specimen(
    specimen: Specimen, records: list[PropertyRecord], value: float | None
) -> None:
    needs = needs_met(TECHNIQUES["permittivity"], specimen, records)
    assert {key: quantity.value for key, quantity in needs.items()} == (
        {} if value is None else {KEY: value}
    )


def test_a_film_is_measured_with_the_modulus_of_its_own_campaign(folders: Folders) -> None:
    for campaign, techniques in (
        ("with", ("compression", "permittivity")),
        ("without", ("permittivity",)),
    ):
        for technique in techniques:
            name = f"{technique}/specimens.csv"
            rows = [row for row in twin_rows(name) if row["material"] == MATERIAL]
            write_campaign(rows[:2], folders.raw / campaign, name)
        register(folders.raw, campaign, accept_all=True)
    run(folders)
    with open_database(folders.processed) as database:
        card = database[MATERIAL]
    films = [r.campaign for r in card.records if r.key == "relative_permittivity"]
    assert films == ["with"]
    refused = {r.campaign: r.reason for r in card.refusals if r.key == "relative_permittivity"}
    assert list(refused) == ["without"]
    assert (
        "compressive_modulus of this material is not known for this campaign" in refused["without"]
    )


def test_progress_counts_from_none_to_all_specimens(folders: Folders) -> None:
    told: list[tuple[str, int, int]] = []
    run_all(folders, 1, lambda *one: told.append(one))
    assert [one for one in told if one[0] == "compression"] == [
        ("compression", done, 6) for done in range(7)
    ]
