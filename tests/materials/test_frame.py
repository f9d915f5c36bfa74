"""Cards as a DataFrame: every record a row, its unit beside it; ranges take what is certain."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from deamat.core.errors import MissingProperty, OutOfRange
from deamat.core.properties import CONDITIONS
from deamat.core.quantity import Quantity
from deamat.core.units import UnknownUnit
from deamat.materials.database import open_database, write_database
from deamat.materials.frame import Range, to_frame
from tests.materials.samples import FILES, PROVENANCE, card, modulus

LOWER = modulus(
    key="handling_time",
    quantity=Quantity(21600.0, "s"),
    ci95=(21600.0, math.inf),
    bound="lower",
)
INTERVAL = modulus(
    key="handling_time",
    quantity=Quantity(21600.0, "s"),
    ci95=(21600.0, 23400.0),
    bound="interval",
)


def test_every_record_is_a_row_that_says_its_unit() -> None:
    frame = to_frame([card()])
    assert frame.columns.tolist()[:9] == [
        *("material", "name", "synthetic", "campaign", "property"),
        *("value", "unit", "u_independent", "u_shared"),
    ]
    assert {*CONDITIONS} - {"window"} < {*frame.columns}
    row = frame.iloc[0]
    assert row[
        ["material", "property", "value", "unit", "n", "bound", "flags", "age"]
    ].tolist() == [
        *("gel-a", "compressive_modulus", 158812.5, "Pa", 2, "exact", "toe", "after cure"),
    ]
    assert row[["u_independent", "u_shared", "standard_uncertainty", "sd"]].tolist() == [
        *(600.0, 800.0, 1000.0, 848.5),
    ]
    assert row[["ci95_low", "ci95_high", "window_low", "window_high"]].tolist() == [
        *(156412.5, 161212.5, 0.0, 0.05),
    ]
    assert math.isnan(row["temperature_K"])
    assert frame["property"].tolist() == [*(["compressive_modulus"] * 2), "handling_time"]
    assert frame["temperature_K"].tolist()[2] == 296.15
    assert str(frame["frequency_Hz"].dtype) == "float64"


def test_what_only_some_records_state_has_a_column() -> None:
    scaled = modulus(area_ratio_limit=10.0, conditions={})
    frame = to_frame([card(records=(scaled, *card().records))])
    assert frame["area_ratio_limit"].tolist()[0] == 10.0
    assert frame["area_ratio_limit"].isna().tolist() == [False, True, True, True]


def test_units_are_those_asked_for() -> None:
    frame = to_frame([card()], units={"compressive_modulus": "kPa"})
    row = frame.iloc[0]
    numbers = ["value", "u_independent", "u_shared", "standard_uncertainty", "sd", "ci95_low"]
    assert row[numbers].tolist() == pytest.approx([158.8125, 0.6, 0.8, 1.0, 0.8485, 156.4125])
    assert frame["unit"].tolist() == ["kPa", "kPa", "s"]
    assert math.isnan(frame["sd"].iloc[1])


@pytest.mark.parametrize(
    ("limits", "inside"),
    [
        ((None, None), True),
        ((158812.5, 158812.5), True),
        (("158 kPa", "159 kPa"), True),
        ((158813.0, "160 kPa"), False),
        (("0.171 MPa", None), True),  # the aged record is one of the material's
        ((None, "158 kPa"), False),
    ],
)
def test_a_range_selects_materials(limits: Range, inside: bool) -> None:
    other = card(
        material="gel-b", records=(modulus(material="gel-b", quantity=Quantity(1e3, "Pa")),)
    )
    frame = to_frame([other, card()], {"compressive_modulus": limits})
    assert ("gel-a" in set(frame["material"])) == inside
    assert len(frame) == 3 * inside + (limits == (None, None) or limits[0] is None)


@pytest.mark.parametrize(
    ("record", "limits", "inside"),
    [
        (LOWER, ("6 h", None), True),
        (LOWER, ("6 h", "1000 h"), False),
        (LOWER, ("7 h", None), False),
        (INTERVAL, ("6 h", "6.5 h"), True),
        (INTERVAL, ("6 h", "6.4 h"), False),
    ],
)
def test_a_limit_lies_in_a_range_only_where_that_is_certain(
    record: object, limits: Range, inside: bool
) -> None:
    frame = to_frame([card(records=(record,))], {"handling_time": limits})
    assert len(frame) == inside


def test_several_ranges_must_all_hold() -> None:
    both = {"compressive_modulus": ("100 kPa", None), "handling_time": ("1 h", "10 h")}
    assert len(to_frame([card()], both)) == 3
    assert len(to_frame([card()], {**both, "tensile_modulus": (None, None)})) == 0


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(MissingProperty, match="no property is called 'modulus'"):
        to_frame([], {"modulus": (None, None)})
    with pytest.raises(OutOfRange) as caught:
        to_frame([], units={"compressive_modulus": "mm"})
    assert str(caught.value) == "compressive_modulus is kept in Pa, which cannot be returned in mm"
    with pytest.raises(UnknownUnit, match="unknown unit 'kp'"):
        to_frame([], units={"compressive_modulus": "kp"})


def test_a_database_is_the_frame_of_its_cards(tmp_path: Path) -> None:
    write_database(tmp_path / "materials.sqlite", [card()], FILES, PROVENANCE)
    with open_database(tmp_path) as database:
        everything = database.to_frame({"handling_time": ("1 h", None)}, {"handling_time": "h"})
    assert everything.equals(to_frame([card().canonical()], units={"handling_time": "h"}))
