from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Literal

import pytest

from deamat.core.errors import CardError
from deamat.core.kinds import UNCERTAINTY
from deamat.core.recording import Specimen
from deamat.core.records import Flag, Law, Origin, PropertyRecord
from deamat.core.schema import (
    After,
    Called,
    Entry,
    Mark,
    document_of,
    fields_of,
    kind_of,
    labels_of,
    read,
)


@dataclass(frozen=True, kw_only=True)
class Point:
    x: float
    y: Annotated[float, Mark.ALWAYS] = 0.0


@dataclass(frozen=True, kw_only=True)
class Thing:
    """One of every kind of field."""

    ENTRY: ClassVar = Entry("thing", "things")

    owner: Annotated[str, Mark.OF_THE_CARD]
    name: Annotated[str, Called("called"), "What it is called."]
    at: Point
    span: tuple[float, float] | None = None
    u: Annotated[float | None, UNCERTAINTY, Mark.ALWAYS] = None
    state: Annotated[Literal["on", "off"], Mark.ALWAYS] = "off"
    rare: bool = False
    path: tuple[str, ...] = ()
    flags: tuple[Flag, ...] = ()

    @property
    def loud(self) -> Annotated[str, After("name")]:
        return self.name.upper()

    @property
    def quiet(self) -> str:
        return self.name.lower()


def thing(**changes: Any) -> Thing:
    return Thing(**{"owner": "us", "name": "Box", "at": Point(x=1, y=-0.0), **changes})


def test_an_object_is_written_in_the_order_of_its_fields() -> None:
    plain = thing(path=("a", "b"), flags=(Flag("wet", "very: 2"),))
    assert document_of(plain) == {
        "called": "Box", "loud": "BOX", "x": 1.0, "y": 0.0, "u": None, "state": "off",
        "path": ["a", "b"], "flags": ["wet: very: 2"],
    }  # fmt: skip
    assert list(document_of(plain))[:3] == ["called", "loud", "x"]


@pytest.mark.parametrize(
    "one",
    [
        thing(),
        thing(rare=True),
        thing(span=(0.0, 2.5), u=0.5),
        thing(flags=(Flag("wet", "very: 2"),)),
    ],
)
def test_an_object_comes_back(one: Thing) -> None:
    assert read(Thing, document_of(one), owner="us", other="nobody asks for it") == one


def test_a_field_that_has_its_default_is_left_out_unless_it_is_always_told() -> None:
    assert "rare" not in document_of(thing())
    assert document_of(thing(rare=True))["rare"] is True
    assert "span" not in document_of(thing())
    assert document_of(thing(span=(0.0, 2.5)))["span"] == [0.0, 2.5]
    assert document_of(thing())["u"] is None


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.pop("u"), "a thing: lacks u, has unknown nothing"),
        (lambda d: d.update(colour="red"), "a thing: lacks nothing, has unknown colour"),
    ],
)
def test_nothing_may_lack_or_be_left_over(
    change: Callable[[dict[str, Any]], object], message: str
) -> None:
    document = document_of(thing())
    change(document)
    with pytest.raises(CardError, match=message):
        read(Thing, document, owner="us")


def test_the_schema_of_a_kind_says_what_it_allows() -> None:
    kinds = {field.name: field.kind for field in fields_of(Thing)}
    assert kinds["called"].schema == {"type": "string"}
    assert kinds["state"].schema == {"enum": ["on", "off"]}
    assert kinds["u"].schema == {"oneOf": [{"$ref": "#/$defs/uncertainty"}, {"type": "null"}]}
    assert kinds["u"].definitions == {"uncertainty": {"type": "number", "minimum": 0}}
    assert kinds["path"].schema == {"type": "array", "items": {"type": "string"}}
    assert kind_of(float | None).schema == {"type": ["number", "null"]}


def test_an_interval_has_two_columns_and_what_is_listed_has_rows() -> None:
    columns = {field.name: field.columns for field in fields_of(Thing)}
    assert columns["span"] == ("span_low", "span_high")
    assert columns["u"] == ("u",)
    assert columns["flags"] == ()


@pytest.mark.parametrize("hint", [bytes, dict[str, int], int | str, list[float]])
def test_a_type_without_a_kind_is_an_error(hint: object) -> None:
    with pytest.raises(TypeError, match=r"no kind of `core\.kinds` is known for"):
        kind_of(hint)


@pytest.mark.parametrize("cls", [PropertyRecord, Law, Origin])
def test_no_two_fields_have_one_name(cls: type) -> None:
    names = [field.name for field in fields_of(cls)]
    assert len(names) == len(set(names))


def test_the_labels_of_a_curve_are_fields_of_its_specimen() -> None:
    assert labels_of(Specimen) == {
        "specimen": "id", "material": "material", "campaign": "campaign", "technique": "technique",
    }  # fmt: skip
