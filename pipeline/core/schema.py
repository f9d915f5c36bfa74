"""The one list of the fields of a card: read from the dataclasses that hold them.

A field is declared once, as `name: Annotated[type, ...]` in its class, with a description, a `Kind`
where the type alone does not tell it, and marks. Card JSON, `docs/card.schema.json`, the tables of
`materials.sqlite` and the labels of `curves.h5` all come from here.
"""

from __future__ import annotations

import types
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import MISSING, dataclass, fields, is_dataclass, replace
from enum import Enum
from functools import cache
from operator import attrgetter
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin
from typing import get_type_hints as hints_of

from deamat.core.errors import CardError
from deamat.core.kinds import (
    BOOLEAN,
    CONDITIONS_KIND,
    DETAILS_KIND,
    INTEGER,
    NUMBER,
    RANGE,
    TEXT,
    Condition,
    Detail,
    Kind,
    array,
    choice,
    nullable,
)

T = TypeVar("T")


class Mark(Enum):
    """What is special about a field."""

    OF_THE_CARD = "stands once on the card, not in each of its entries"
    IN_FRONT = "its column stands before those of the others"
    ALWAYS = "written also where it has its default, where other such fields are left out"
    IF_ANY = "a list that is left out where it is empty"
    NO_COLUMN = "follows from another column"
    NOT_WRITTEN = "stands elsewhere on the card"


@dataclass(frozen=True, slots=True)
class After:
    """Marks a property that is written too, behind a field, and never read back."""

    field: str


@dataclass(frozen=True, slots=True)
class Called:
    """Gives a field another name in JSON."""

    name: str


@dataclass(frozen=True, slots=True)
class Label:
    """Marks a field of a specimen that labels its curve in `curves.h5`, under this name."""

    name: str


@dataclass(frozen=True, slots=True)
class Entry:
    """What an object of a card is called: a class holds one as `ENTRY`.

    Parameters
    ----------
    name : of its definition in the schema
    table : of the database, which holds its rows
    text : what it is, for the schema
    identity : columns that no two rows share; without them each row has a number
    as_text : a text in JSON: what `str` gives and the class's `from_text` reads
    """

    name: str
    table: str
    text: str = ""
    identity: tuple[str, ...] = ()
    as_text: Kind | None = None


@dataclass(frozen=True, slots=True)
class Field:
    """One field as it is written.

    Parameters
    ----------
    name : in JSON, and of its column
    path : of attributes, from the object
    text : what it is
    marks : see `Mark`
    derived : computed from others, not read back
    optional : left out of JSON where it has its default
    default : that one; None without
    """

    name: str
    path: tuple[str, ...]
    kind: Kind
    get: Callable[[Any], Any]
    text: str = ""
    marks: frozenset[Mark] = frozenset()
    derived: bool = False
    optional: bool = False
    default: Any = None

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of its columns; none where it has rows in a table of its own."""
        if self.kind.rows_of is not None or Mark.NO_COLUMN in self.marks:
            return ()
        return tuple(self.name + ending for ending in self.kind.endings)


# --- the list


def entry_of(cls: Any) -> Entry:
    """Return what an object of a card is called."""
    found: Entry = cls.ENTRY
    return found


def fields_of(cls: Any) -> tuple[Field, ...]:
    """List the fields of a class in the order in which they are written.

    Raises
    ------
    TypeError : a field of a type that has no kind
    """
    return _listed(cls)


@cache
def _listed(cls: Any) -> tuple[Field, ...]:
    hints = hints_of(cls, include_extras=True)
    derived = list(_derived(cls))
    found: list[Field] = []
    for declared in fields(cls):
        hint = hints[declared.name]
        if is_dataclass(hint) and not hasattr(hint, "ENTRY"):  # its fields stand among ours
            found += [_below(declared.name, field) for field in fields_of(hint)]
        elif not {Mark.OF_THE_CARD, Mark.NOT_WRITTEN} & set(_marks(hint)):
            found.append(_field(declared.name, hint, declared.default))
        found += [field for after, field in derived if after == declared.name]
    return tuple(found)


def _derived(cls: Any) -> Iterator[tuple[str, Field]]:
    for name, member in vars(cls).items():
        if isinstance(member, property):
            hint = hints_of(member.fget, include_extras=True)["return"]
            for mark in _marks(hint):
                if isinstance(mark, After):
                    yield mark.field, replace(_field(name, hint, MISSING), derived=True)


def _marks(hint: Any) -> tuple[Any, ...]:
    return get_args(hint)[1:] if get_origin(hint) is Annotated else ()


def _field(name: str, hint: Any, default: Any) -> Field:
    told = _marks(hint)
    marks = frozenset(mark for mark in told if isinstance(mark, Mark))
    listed = isinstance(default, tuple) and Mark.IF_ANY not in marks  # an empty list says so
    return Field(
        next((mark.name for mark in told if isinstance(mark, Called)), name),
        (name,),
        kind_of(hint),
        attrgetter(name),
        " ".join(mark for mark in told if isinstance(mark, str)),
        marks,
        optional=default is not MISSING and not listed and Mark.ALWAYS not in marks,
        default=None if default is MISSING else default,
    )


def _below(name: str, field: Field) -> Field:
    path = (name, *field.path)
    return replace(field, path=path, get=attrgetter(".".join(path)))


_PLAIN: dict[Any, Kind] = {
    str: TEXT,
    float: NUMBER,
    int: INTEGER,
    bool: BOOLEAN,
    tuple[float, float]: RANGE,
    Mapping[str, Condition]: CONDITIONS_KIND,
    Mapping[str, Detail]: DETAILS_KIND,
}


def kind_of(declared: Any) -> Kind:
    """Tell from the type of a field how it is written.

    Raises
    ------
    TypeError : there is no kind for this type
    """
    if declared in _PLAIN:
        return _PLAIN[declared]
    origin, arguments = get_origin(declared), get_args(declared)
    if origin is Annotated:
        kinds = [mark for mark in arguments[1:] if isinstance(mark, Kind)]
        inner, empty = _without_none(arguments[0])
        kind = kinds[0] if kinds else kind_of(inner)
        return nullable(kind) if empty else kind
    if origin in (Union, types.UnionType):
        inner, empty = _without_none(declared)
        if empty:
            return nullable(kind_of(inner))
    if origin is Literal:
        return choice(*arguments)
    if origin is tuple and arguments[-1] is Ellipsis:
        inner = arguments[0]
        return _rows(inner) if hasattr(inner, "ENTRY") else array(kind_of(inner))
    raise TypeError(f"no kind of `core.kinds` is known for {declared}")


def _without_none(declared: Any) -> tuple[Any, bool]:
    left = [part for part in get_args(declared) if part is not types.NoneType]
    if get_origin(declared) in (Union, types.UnionType) and len(left) == 1:
        return left[0], True
    return declared, False


def _rows(cls: Any) -> Kind:
    entry = entry_of(cls)
    if entry.as_text is not None:
        one = replace(entry.as_text, write=str, read=cls.from_text)
    else:
        one = Kind(
            {"$ref": f"#/$defs/{entry.name}"},
            "",
            document_of,
            lambda document: read(cls, document),
        )
    return replace(array(one), rows_of=cls)


def labels_of(cls: Any) -> dict[str, str]:
    """Return the labels of a curve by name, each with the attribute that holds it."""
    hints = hints_of(cls, include_extras=True)
    return {
        mark.name: declared.name
        for declared in fields(cls)
        for mark in _marks(hints[declared.name])
        if isinstance(mark, Label)
    }


# --- JSON and back


def document_of(thing: Any, **told: Any) -> dict[str, Any]:
    """Write an object as JSON.

    Parameters
    ----------
    told : values to write in place of the object's own
    """
    document: dict[str, Any] = {}
    for field in fields_of(type(thing)):
        value = told[field.name] if field.name in told else field.get(thing)
        if not field.optional or value != field.default:
            document[field.name] = field.kind.write(value)
    return document


def check_names(cls: Any, document: Mapping[str, Any]) -> None:
    """Hold the names in a document against the list.

    Raises
    ------
    CardError : a field that is missing or unknown
    """
    listed = fields_of(cls)
    lacking = {f.name for f in listed if not f.optional} - document.keys()
    unknown = document.keys() - {f.name for f in listed}
    if lacking or unknown:
        lacks, more = (", ".join(sorted(names)) or "nothing" for names in (lacking, unknown))
        raise CardError(f"{_article(entry_of(cls).name)}: lacks {lacks}, has unknown {more}")


def read(cls: type[T], document: Mapping[str, Any], **of_card: Any) -> T:
    """Read an object back from JSON.

    Parameters
    ----------
    of_card : what the card holds once for all of its entries

    Raises
    ------
    CardError : a field that is missing or unknown
    """
    check_names(cls, document)
    stored = [f for f in fields_of(cls) if not f.derived and f.name in document]
    return maker(cls, stored, **of_card)([f.kind.read(document[f.name]) for f in stored])


def maker(cls: type[T], stored: Sequence[Field], **of_card: Any) -> Callable[[Iterable[Any]], T]:
    """Return the function that makes an object of the values of its stored fields."""
    made_of: Any = cls
    given = {name: value for name, value in of_card.items() if name in _of_card(made_of)}
    names = [field.path[-1] for field in stored]
    below: dict[str, list[str]] = {}
    for field in stored:
        if len(field.path) > 1:
            below.setdefault(field.path[0], []).append(field.path[1])
    inner = [(name, _type_of(made_of, name), parts) for name, parts in below.items()]

    def make(values: Iterable[Any]) -> T:
        told = dict(zip(names, values, strict=True))
        for name, kind, parts in inner:
            told[name] = kind(**{part: told.pop(part) for part in parts})
        return cls(**told, **given)

    return make


@cache
def _of_card(cls: Any) -> frozenset[str]:
    hints = hints_of(cls, include_extras=True)
    return frozenset(f.name for f in fields(cls) if Mark.OF_THE_CARD in _marks(hints[f.name]))


@cache
def _type_of(cls: Any, name: str) -> Any:
    return hints_of(cls)[name]


def _article(name: str) -> str:
    return f"{'an' if name[0] in 'aeiou' else 'a'} {name}"
