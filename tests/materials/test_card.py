from __future__ import annotations

import json
import math
import pickle
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given

from deamat.core.errors import CardError, MissingProperty
from deamat.core.quantity import Quantity
from deamat.core.records import Flag
from deamat.materials.card import MaterialCard, read_card
from tests.materials import samples
from tests.materials.samples import aged, card, modulus, refusal, viscosity_law

GIVEN_AWAY = Path(__file__).parents[1] / "data" / "cards" / "gel-a.json"


def test_a_plain_question_gets_the_value_at_the_reference_age() -> None:
    assert card()["compressive_modulus"] == Quantity(158812.5, "Pa", 600.0, 800.0)


def test_conditions_choose_among_records() -> None:
    assert card().record("compressive_modulus", age="2 months").quantity.value == 171000.0
    assert card().record("handling_time").conditions == {"temperature_K": 296.15}


@pytest.mark.parametrize("window", [(0.0, 0.05), [0.0, 0.05], "0,0.05", "0, 0.0500001"])
def test_numbers_are_met_as_people_copy_them(window: tuple[float, float] | str) -> None:
    found = card().record("compressive_modulus", age="after cure", window=window)
    assert found.quantity.value == 158812.5
    assert card().record("handling_time", temperature_K="296.15").n == 1


@pytest.mark.parametrize("temperature", ["warm", 297.0, "297"])
def test_other_numbers_are_not_met(temperature: str | float) -> None:
    with pytest.raises(MissingProperty, match="no handling_time of gel-a with temperature_K="):
        card().record("handling_time", temperature_K=temperature)


def test_none_asks_for_a_record_without_the_condition() -> None:
    plain = modulus(conditions={})
    both = card(records=(plain, modulus(conditions={"age": "2 months"})))
    assert both.record("compressive_modulus", age=None) == plain


def test_a_card_that_was_given_away_is_read_and_written_as_it_was() -> None:
    """Whoever has it must be able to design from it: new fields have defaults and stay out."""
    assert read_card(GIVEN_AWAY) == card().canonical()
    assert card().to_json() == GIVEN_AWAY.read_bytes()


def test_what_is_missing_is_told_apart_from_what_there_is_instead() -> None:
    with pytest.raises(MissingProperty) as caught:
        card().record("viscosity")
    error = pickle.loads(pickle.dumps(caught.value))  # as a worker process hands it on
    assert error.reason == "gel-a has no viscosity"
    assert error.hint == (
        "it has a law, ask for card.law('viscosity'); there is compressive_modulus, handling_time"
    )
    assert str(error) == f"{error.reason}; {error.hint}"


def test_several_records_at_the_reference_age_are_refused_with_the_choices() -> None:
    other = modulus(campaign="soft-2027")
    with pytest.raises(MissingProperty) as caught:
        card(records=(modulus(), other, aged()))["compressive_modulus"]
    assert str(caught.value) == (
        "2 records of compressive_modulus of gel-a; choose "
        "(campaign='soft-2026') or (campaign='soft-2027')"
    )
    chosen = card(records=(modulus(), other, aged())).record(
        "compressive_modulus", campaign="soft-2027"
    )
    assert chosen == other


def test_several_records_of_which_none_is_at_the_reference_age_are_refused() -> None:
    with pytest.raises(MissingProperty) as caught:
        card(records=(aged(), aged(conditions={"age": "fresh"})))["compressive_modulus"]
    assert str(caught.value) == (
        "2 records of compressive_modulus of gel-a; choose "
        "(age='2 months', window=(0.0, 0.05)) or (age='fresh', window=None)"
    )


def test_an_age_that_nobody_measured_names_those_there_are() -> None:
    with pytest.raises(MissingProperty) as caught:
        card().record("compressive_modulus", age="1 year")
    assert str(caught.value) == (
        "no compressive_modulus of gel-a with age='1 year'; there is "
        "(campaign='soft-2026', age='after cure', window=(0.0, 0.05)) or "
        "(campaign='soft-2026', age='2 months', window=(0.0, 0.05))"
    )


def test_an_unknown_condition_is_not_ignored() -> None:
    with pytest.raises(MissingProperty, match="no condition is called temperature; known: camp"):
        card().record("compressive_modulus", temperature=300.0)


def test_a_missing_key_names_those_there_are() -> None:
    with pytest.raises(MissingProperty) as caught:
        card()["loss_tangent"]
    assert str(caught.value) == (
        "gel-a has no loss_tangent; there is compressive_modulus, handling_time"
    )


def test_a_refused_key_says_why_and_for_which_specimens() -> None:
    refused = card(refusals=(refusal("A1"), refusal("A2"), refusal(None, "unloading inside")))
    with pytest.raises(MissingProperty) as caught:
        refused["tensile_modulus"]
    assert str(caught.value) == (
        "gel-a has no tensile_modulus, it was refused: 2 samples in the window, 10 are needed "
        "(A1, A2); unloading inside; there is compressive_modulus, handling_time"
    )


def test_a_key_that_has_only_a_law_points_to_it() -> None:
    with pytest.raises(MissingProperty, match=r"ask for card\.law\('viscosity'\)"):
        card()["viscosity"]


def test_laws_are_chosen_like_records() -> None:
    warm = viscosity_law(conditions={"temperature_K": 323.15})
    both = card(laws=(viscosity_law(), warm))
    assert both.law("viscosity", temperature_K=323.15) == warm
    with pytest.raises(MissingProperty, match="2 records of law of viscosity of gel-a; choose"):
        both.law("viscosity")
    with pytest.raises(MissingProperty, match="no law of loss_tangent; there is viscosity"):
        both.law("loss_tangent")


def test_a_card_lists_its_keys() -> None:
    assert card().keys() == ("compressive_modulus", "handling_time")
    assert list(card()) == ["compressive_modulus", "handling_time"]
    assert "handling_time" in card()
    assert "viscosity" not in card()


def test_a_card_keeps_to_one_material() -> None:
    with pytest.raises(CardError, match="a compressive_modulus of gel-b cannot stand on the card"):
        card(records=(modulus(material="gel-b"),)).canonical()


def test_two_records_that_nothing_tells_apart_are_an_error() -> None:
    with pytest.raises(
        CardError, match="two entries that cannot be distinguished: compressive_mod"
    ):
        card(records=(modulus(), modulus(n=3))).canonical()


def test_a_wrong_unit_is_an_error() -> None:
    with pytest.raises(CardError, match="compressive_modulus of gel-a is in 'kPa', the property t"):
        card(records=(modulus(quantity=Quantity(158.8, "kPa")),)).canonical()
    with pytest.raises(CardError, match=r"viscosity of gel-a is in 'mPa\.s', the property table"):
        card(laws=(viscosity_law(unit="mPa.s"),)).canonical()


def test_a_condition_outside_the_closed_list_is_an_error() -> None:
    with pytest.raises(CardError, match="unknown condition weather; the closed list is age, cure"):
        card(records=(modulus(conditions={"weather": "fair"}),)).to_document()


def test_an_interval_that_is_none_is_an_error() -> None:
    with pytest.raises(CardError, match=r"\(2\.0, 1\.0\) is no interval"):
        card(records=(modulus(ci95=(2.0, 1.0)),)).to_document()
    with pytest.raises(CardError, match="is no interval"):
        card(records=(modulus(ci95=(1.0, float("nan"))),)).to_document()
    for limits in ((math.inf, math.inf), (-math.inf, -math.inf)):
        with pytest.raises(CardError, match="is no interval"):
            card(records=(modulus(ci95=limits),)).to_document()
    card(records=(modulus(ci95=(-math.inf, math.inf)),)).to_document()


def test_a_card_cannot_hide_a_synthetic_campaign() -> None:
    with pytest.raises(CardError, match="gel-a has a synthetic campaign, its card must say so"):
        card(campaigns=(samples.TWIN,)).to_document()


def test_the_order_of_the_inputs_plays_no_part() -> None:
    one = card(records=(replace(modulus(), flags=(Flag("b", "2"), Flag("a", "1"))), aged()))
    first = one.records[0]
    turned = replace(
        first,
        origins=first.origins[::-1],
        flags=first.flags[::-1],
        budget=first.budget[::-1],
        conditions=dict(reversed(list(first.conditions.items()))),
        diagnostics=dict(reversed(list(first.diagnostics.items()))),
    )
    other = replace(one, records=(aged(), turned), refusals=one.refusals[::-1])
    assert other.to_json() == one.to_json()


def test_lines_of_one_file_that_the_register_names_together_stand_in_order() -> None:
    runs = [samples.origin("A1", 158212.5, 2, first_line=line) for line in (None, 12, 100)]
    found = card(records=(modulus(origins=(runs[2], runs[0], runs[1])),)).canonical()
    assert [origin.first_line for origin in found.records[0].origins] == [None, 12, 100]


def test_a_card_is_read_as_it_is_written() -> None:
    assert "Gel µ 10:1".encode() in replace(card(), name="Gel µ 10:1").to_json()


def test_the_release_speaks_of_the_content_alone() -> None:
    assert card().release == card().release
    changed = modulus(quantity=Quantity(158812.50000000003, "Pa", 600.0, 800.0))
    assert card(records=(changed,)).release != card(records=(modulus(),)).release


@given(samples.cards)
def test_a_card_comes_back_exactly(any_card: MaterialCard) -> None:
    document = json.loads(any_card.to_json())
    back = MaterialCard.from_document(document)
    assert back == any_card.canonical()
    assert back.to_json() == any_card.to_json()


def test_a_card_file_is_all_a_designer_needs(tmp_path: Path) -> None:
    path = tmp_path / "gel-a.json"
    path.write_bytes(card().to_json())
    found = read_card(path)
    assert found == card().canonical()
    assert found.law("viscosity")(7200.0).value == pytest.approx(1.64 + 7.4e-5 * 7200)


def test_diagnostics_that_are_not_finite_come_back() -> None:
    odd = card(records=(modulus(diagnostics={"a": float("inf"), "b": float("nan"), "c": "nil"}),))
    document = json.loads(odd.to_json())
    assert document["properties"][0]["diagnostics"] == {"a": "inf", "b": "nan", "c": "nil"}
    back = MaterialCard.from_document(document).records[0].diagnostics
    assert back["a"] == float("inf")
    assert back["b"] != back["b"]
    assert back["c"] == "nil"


def test_an_edited_card_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "gel-a.json"
    path.write_bytes(card().to_json().replace(b"158812.5", b"168812.5"))
    with pytest.raises(
        CardError, match=rf"gel-a\.json: its content is that of release .* not of {card().release}"
    ):
        read_card(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (b'{"schema": "urn:deamat:card:2"}', "not a card of schema urn:deamat:card:1"),
        (b'{"schema": "urn:deamat:card:1"}', "a card: lacks campaigns, laws, material"),
        (b"[]", "not a card: a card is one JSON object"),
        (b"{", "not JSON: Expecting property name"),
        (b"\xff", "not JSON: 'utf-8' codec can't decode"),
    ],
)
def test_what_is_not_a_card_is_refused(text: bytes, message: str, tmp_path: Path) -> None:
    path = tmp_path / "x.json"
    path.write_bytes(text)
    with pytest.raises(CardError, match=message) as caught:
        read_card(path)
    assert str(caught.value).startswith(str(path))


def test_a_card_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(CardError, match=r"none\.json: No such file"):
        read_card(tmp_path / "none.json")


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("colour", "red", r"properties\[0\]: a property: lacks nothing, has unknown colour"),
        ("value", "high", r"properties\[0\]: must be real number"),
        ("flags", ["toe"], r"properties\[0\]: "),
        ("ci95", [1.0], r"properties\[0\]: not enough values"),
        ("u_shared", -1.0, r"properties\[0\]: u_shared must be finite and not negative"),
    ],
)
def test_an_entry_that_does_not_fit_is_named_by_its_place(
    field: str, value: object, message: str
) -> None:
    document = json.loads(card().to_json())
    document["properties"][0][field] = value
    with pytest.raises(CardError) as caught:
        MaterialCard.from_document(document)
    document["release"] = str(caught.value).split()[6].rstrip(",")  # as a forger would
    with pytest.raises(CardError, match=message):
        MaterialCard.from_document(document)


def test_a_lower_bound_is_never_given_as_a_bare_number() -> None:
    known = samples.modulus(
        key="handling_time", quantity=Quantity(43200.0, "s"), ci95=(43200.0, math.inf),
        bound="lower",
    )  # fmt: skip
    card = MaterialCard(known.material, "Gel", False, records=(known,))
    with pytest.raises(MissingProperty, match=r"handling_time of .* is only known to be >= 12 h"):
        card["handling_time"]
    assert card.record("handling_time").quantity.value == 43200.0
