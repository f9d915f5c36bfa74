"""The material card: everything that is known of one material, and what was refused."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, replace
from functools import partial
from itertools import pairwise
from operator import itemgetter
from pathlib import Path
from typing import Annotated, Any, ClassVar, TypeVar

from deamat.core.card_lists import CalibrationRecord, Correlation, Excluded
from deamat.core.errors import CardError, MissingProperty
from deamat.core.json_text import indented
from deamat.core.kinds import CONDITIONS_KIND, ID, SAID, Kind
from deamat.core.present import readable_record
from deamat.core.quantity import Quantity
from deamat.core.records import Condition, Law, PropertyRecord, Refusal
from deamat.core.schema import (
    After,
    Called,
    Entry,
    Field,
    Mark,
    check_names,
    document_of,
    fields_of,
    maker,
    read,
)
from deamat.materials import document as doc
from deamat.materials.document import Document
from deamat.materials.select import choose, refusal_reasons

E = TypeVar("E", PropertyRecord, Law)


SCHEMA = "urn:deamat:card:1"


@dataclass(frozen=True, slots=True)
class Credit:
    """Where a campaign's data come from and on which terms they may be used."""

    ENTRY: ClassVar = Entry("campaign", "campaigns", identity=("material", "campaign"))

    campaign: Annotated[str, ID, "Its folder under raw/."]
    title: str
    laboratory: str
    licence: str
    source: Annotated[str, "Article or address, empty if there is none."]
    synthetic: Annotated[bool, "True if it is simulated."]


@dataclass(frozen=True, slots=True)
class MaterialCard:
    """Records, laws and refusals of one material; `card["compressive_modulus"]` is a `Quantity`."""

    ENTRY: ClassVar = Entry(
        "card",
        "materials",
        "Everything that is known of one soft dielectric elastomer, with uncertainty, conditions "
        "and origin of every value, and what was refused. All numbers are in SI units.",
        identity=("material",),
    )

    material: Annotated[str, ID, "Identifier of the material, as in the registers and file names."]
    name: Annotated[str, SAID, "Name that people read."]
    synthetic: Annotated[
        bool,
        "True if any of the campaigns is simulated: then the card holds no pure measurement.",
    ]
    _: KW_ONLY
    campaigns: Annotated[
        tuple[Credit, ...], "Where the data come from and on which terms they may be used."
    ] = ()
    records: Annotated[
        tuple[PropertyRecord, ...],
        Called("properties"),
        "One entry for each property key, set of conditions and campaign; they stand side by side "
        "and are never pooled silently.",
    ]
    laws: Annotated[tuple[Law, ...], "Fitted functions."] = ()
    refusals: Annotated[
        tuple[Refusal, ...],
        Called("refused"),
        "Values that were asked for and not given, and why.",
    ] = ()
    excluded: Annotated[
        tuple[Excluded, ...],
        Mark.IF_ANY,
        "Specimens that were left out on purpose, and why. Left out where there are none.",
    ] = ()
    calibrations: Annotated[
        tuple[CalibrationRecord, ...],
        Mark.IF_ANY,
        "Calibrations that the values rest on. Left out where none is declared.",
    ] = ()
    correlations: Annotated[
        tuple[Correlation, ...],
        Mark.IF_ANY,
        "Pairs of values that do not err independently; a pair that is not listed does, or is of "
        "one property under two conditions. Left out where there are none.",
    ] = ()

    def keys(self) -> tuple[str, ...]:
        """Property keys that have a value, sorted."""
        return tuple(sorted({r.key for r in self.records}))

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __contains__(self, key: object) -> bool:
        return any(r.key == key for r in self.records)

    def __getitem__(self, key: str) -> Quantity:
        """Return the quantity of a key, as `record` without conditions does.

        Raises
        ------
        MissingProperty : as `record` does, or all that is known is a lower bound: a bare number
            would pass for an estimate
        """
        record = self.record(key)
        if record.bound == "lower":
            raise MissingProperty(
                f"{key} of {self.material} is only known to be {readable_record(record)}; "
                f"card.record({key!r}) returns the bound"
            )
        return record.quantity

    def record(self, key: str, **conditions: Condition | None) -> PropertyRecord:
        """Return the one record of a key under these conditions.

        Parameters
        ----------
        key : property key
        conditions : of `core.properties.CONDITIONS`, and `campaign`; None wants it not stated.
            A question that leaves several records and says nothing of the age means the
            reference age.

        Raises
        ------
        MissingProperty : no such record, with the reasons if it was refused; or several
        """
        found = [r for r in self.records if r.key == key]
        if not found:
            law = any(entry.key == key for entry in self.laws)
            hint = f"it has a law, ask for card.law({key!r}); " if law else ""
            raise MissingProperty(self._lacks(key), hint + _there(self.records))
        return choose(found, f"{key} of {self.material}", conditions)

    def law(self, key: str, **conditions: Condition | None) -> Law:
        """Return the one law of a key under these conditions, chosen as `record` does.

        Raises
        ------
        MissingProperty : no such law, with the reasons if it was refused; or several
        """
        found = [law for law in self.laws if law.key == key]
        if not found:
            raise MissingProperty(self._lacks(f"law of {key}", key), _there(self.laws))
        return choose(found, f"law of {key} of {self.material}", conditions)

    def _lacks(self, what: str, key: str | None = None) -> str:
        reasons = "; ".join(refusal_reasons(self.refusals, key or what))
        return f"{self.material} has no {what}" + (
            f", it was refused: {reasons}" if reasons else ""
        )

    def canonical(self) -> MaterialCard:
        """Bring everything into its fixed order, so that equal content is equal.

        Raises
        ------
        CardError : a record of another material, two records under the same conditions, a wrong
            unit, a condition outside the closed list, a card that hides a synthetic campaign
        """
        entries: list[PropertyRecord | Law | Refusal] = [*self.records, *self.laws, *self.refusals]
        owners = [(entry.key, entry.material) for entry in entries]
        owners += [(f"exclusion of {entry.specimen}", entry.material) for entry in self.excluded]
        for what, material in owners:
            if material != self.material:
                raise CardError(
                    f"a {what} of {material} cannot stand on the card of {self.material}"
                )
        if any(c.synthetic for c in self.campaigns) and not self.synthetic:
            raise CardError(f"{self.material} has a synthetic campaign, its card must say so")
        return replace(
            self,
            records=_in_order(map(doc.canonical_record, self.records)),
            laws=_in_order(map(doc.canonical_law, self.laws)),
            refusals=tuple(sorted(self.refusals, key=_refusal_order)),
            excluded=tuple(sorted(self.excluded, key=_exclusion_order)),
            correlations=tuple(sorted(self.correlations, key=_correlation_order)),
            calibrations=tuple(sorted(self.calibrations, key=lambda c: c.calibration)),
            campaigns=tuple(sorted(self.campaigns, key=lambda c: c.campaign)),
        )

    def to_document(self) -> Document:
        """Write the card as the JSON object of `docs/card.schema.json`.

        `release` is the first 12 hex digits of the sha256 of everything else in it: two cards
        with the same release say the same thing.
        """
        content = {"schema": SCHEMA, **document_of(self.canonical(), release="")}
        content["release"] = _digest(content)
        return content

    @property
    def release(
        self,
    ) -> Annotated[
        str,
        Kind({"type": "string", "pattern": "^[0-9a-f]{12}$"}, "TEXT"),
        After("synthetic"),
        "First 12 hex digits of the sha256 of this object without this field, as JSON on one line "
        "with sorted keys, no blanks, UTF-8. Two cards with the same release say the same thing.",
    ]:
        """First 12 hex digits of the sha256 of the content: what the card's document says."""
        return str(self.to_document()["release"])

    def to_json(self) -> bytes:
        """Return the bytes of the card's file: the same for the same content."""
        return indented(self.to_document(), 2)

    @classmethod
    def from_document(cls, document: Mapping[str, Any]) -> MaterialCard:
        """Read a card back.

        Raises
        ------
        CardError : another schema, a missing or unknown field, or a content that is not the one
            its `release` was made of
        """
        content = dict(document)
        if content.pop("schema", None) != SCHEMA:
            raise CardError(f"not a card of schema {SCHEMA}, the only one this program reads")
        check_names(cls, content)
        if content["release"] != _digest(document):
            raise CardError(
                f"its content is that of release {_digest(document)}, not of {content['release']} "
                "as it says: it was changed after it was written; take the original card"
            )
        stored = [f for f in fields_of(cls) if not f.derived]
        return maker(cls, stored)([_value(field, content) for field in stored])


def _value(field: Field, content: Mapping[str, Any]) -> Any:
    if field.name not in content:
        return field.default
    told, cls = content[field.name], field.kind.rows_of
    if cls is None:
        return field.kind.read(told)
    return doc.read_entries(told, partial(read, cls, material=content["material"]), field.name)


def _digest(document: Mapping[str, Any]) -> str:
    content = {key: value for key, value in document.items() if key != "release"}
    return hashlib.sha256(doc.canonical_json(content).encode()).hexdigest()[:12]


def _there(entries: Sequence[PropertyRecord | Law]) -> str:
    return f"there is {', '.join(sorted({e.key for e in entries})) or 'nothing'}"


def _identity(entry: PropertyRecord | Law) -> tuple[str, str, str]:
    """Return what tells an entry from the others of its card."""
    conditions = doc.canonical_json(CONDITIONS_KIND.write(entry.conditions))
    return entry.key, entry.campaign, conditions


def _in_order(entries: Iterable[E]) -> tuple[E, ...]:
    named = sorted(((_identity(entry), entry) for entry in entries), key=itemgetter(0))
    for (one, _), (other, _) in pairwise(named):
        if one == other:
            raise CardError(f"two entries that cannot be distinguished: {' '.join(one)}")
    return tuple(entry for _, entry in named)


def _refusal_order(refusal: Refusal) -> tuple[str, str, str, str]:
    rest = doc.canonical_json(document_of(refusal))
    return refusal.key, refusal.campaign, refusal.specimen or "", rest


def _correlation_order(pair: Correlation) -> tuple[str, ...]:
    told = (pair.conditions, pair.other_conditions)
    where = [doc.canonical_json(CONDITIONS_KIND.write(conditions)) for conditions in told]
    return pair.key, pair.campaign, where[0], pair.other_key, pair.other_campaign, where[1]


def _exclusion_order(excluded: Excluded) -> tuple[str, str, str]:
    return excluded.campaign, excluded.technique, excluded.specimen


def read_card(path: str | Path) -> MaterialCard:
    """Read a card's file.

    Raises
    ------
    CardError : not a file, not JSON, or not a whole and unchanged card; the message names it
    """
    try:
        if os.path.lexists(path) and not Path(path).is_file():  # a pipe would never end
            raise CardError("no regular file")
        document = json.loads(Path(path).read_bytes())
        if not isinstance(document, dict):
            raise CardError("not a card: a card is one JSON object")
        return MaterialCard.from_document(document)
    except OSError as error:
        raise CardError(f"{path}: {error.strerror}") from error
    except (ValueError, RecursionError) as error:  # no UTF-8, no JSON, or no end of brackets
        raise CardError(f"{path}: not JSON: {error}") from error
    except CardError as error:
        raise CardError(f"{path}: {error}") from error
