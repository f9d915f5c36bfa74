"""The trace of one number: from the card back to the raw bytes, the method and the code."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from deamat.core.card_lists import CalibrationRecord, Excluded
from deamat.core.ledger import Provenance
from deamat.core.present import (
    Scale,
    aligned,
    readable,
    readable_conditions,
    readable_interval,
    readable_record,
    readable_uncertainty,
    scale_of,
    si_text,
)
from deamat.core.properties import property_key
from deamat.core.quantity import Contribution, Quantity
from deamat.core.records import Condition, Detail, Law, Origin, PropertyRecord, Refusal
from deamat.core.schema import document_of, fields_of
from deamat.materials.card import MaterialCard
from deamat.materials.correlation import partners
from deamat.materials.database import Database
from deamat.materials.document import Document
from deamat.materials.present import credit_text, law_text, synthetic_lines, title

Entry = PropertyRecord | Law


@dataclass(frozen=True, slots=True)
class Trace:
    """The chain behind one number; `text` gives it for people, `to_document` for programs.

    Parameters
    ----------
    card : the card that the number stands on
    key : property key
    entry : the record, or the law where there is no record; None if the key was only refused
    refusals : of this key
    provenance : what made the release
    excluded : specimens that were left out of it
    """

    card: MaterialCard
    key: str
    entry: Entry | None
    refusals: tuple[Refusal, ...]
    provenance: Provenance
    excluded: tuple[Excluded, ...] = ()

    def text(self) -> str:
        """Write the trace for people: readable units, the SI value beside."""
        return "\n".join(_lines(self))

    def to_document(self) -> Document:
        """Return the trace as a JSON object, SI units."""
        return _document(self)


def trace(db: Database, material: str, key: str, **conditions: Condition | None) -> Trace:
    """Follow one number of a card back to where it comes from.

    Parameters
    ----------
    db : an open database
    material, key : which number
    conditions : as for `MaterialCard.record`

    Raises
    ------
    MissingMaterial : no such material
    MissingProperty : neither a value nor a law nor a refusal of this key, or several answers
    """
    card = db[material]
    refusals = tuple(r for r in card.refusals if r.key == key)
    entry: Entry | None = None
    if key in card:
        entry = card.record(key, **conditions)
    elif any(law.key == key for law in card.laws):
        entry = card.law(key, **conditions)
    elif not refusals:
        card.record(key)  # raises, and says what there is
    return Trace(card, key, entry, refusals, db.provenance(), _excluded(card, key, entry))


# --- what the text and the JSON form both need


def percent_of_variance(budget: Sequence[Contribution]) -> list[float]:
    """Return each contribution's part of the combined variance in percent."""
    total = math.fsum(c.u**2 for c in budget)
    return [100.0 * c.u**2 / total if total else 0.0 for c in budget]


def _excluded(card: MaterialCard, key: str, entry: Entry | None) -> tuple[Excluded, ...]:
    """Find the specimens of the tests of a key that were left out, those of its campaign alone."""
    if not card.excluded:
        return ()
    tests = _tests_of(key)
    return tuple(
        left_out
        for left_out in card.excluded
        if left_out.technique in tests and (entry is None or entry.campaign == left_out.campaign)
    )


def _tests_of(key: str) -> set[str]:
    from deamat.techniques import TECHNIQUES  # imports every room: only few traces need them

    return {t.key for t in TECHNIQUES.values() if key in t.yields}


def _refusal_places(refusal: Refusal, card: MaterialCard) -> list[str]:
    """Say where the refused specimen's data stand, as far as another value of its test tells."""
    tests = _tests_of(refusal.key)
    entries: list[Entry] = [*card.records, *card.laws]
    places = {
        _place(origin)
        for entry in entries
        for origin in entry.origins
        if entry.campaign == refusal.campaign
        and origin.specimen == refusal.specimen
        and origin.technique in tests
    }
    return sorted(places)


def _place(origin: Origin) -> str:
    file = "" if origin.path is None else f"{origin.path}; "
    return f"{file}{origin.register}, line {origin.register_line}"


# --- for programs


def _document(trace: Trace) -> Document:
    card, provenance, entry = trace.card, trace.provenance, trace.entry
    return {
        "material": card.material,
        "name": card.name,
        "synthetic": bool(synthetic_lines(card, entry.campaign if entry else None)),
        "release": card.release,
        "key": trace.key,
        "property": _record_document(entry) if isinstance(entry, PropertyRecord) else None,
        "law": document_of(entry) if isinstance(entry, Law) else None,
        "refused": [{**document_of(r), "places": _refusal_places(r, card)} for r in trace.refusals],
        "correlations": [document_of(pair) for _, _, pair in partners(card.correlations, entry)]
        if isinstance(entry, PropertyRecord)
        else [],
        "calibrations": [document_of(c) for c in _calibrations(entry, card)] if entry else [],
        "excluded": [document_of(left_out) for left_out in trace.excluded],
        "code": {"version": provenance.version, "digest": provenance.code},
        "stages": dict(provenance.stages),
        "environment": dict(provenance.environment),
        "config": dict(provenance.config),
    }


def _record_document(record: PropertyRecord) -> Document:
    document = document_of(record)
    shares = percent_of_variance(record.budget)
    for line, share in zip(document["budget"], shares, strict=True):
        line["percent_of_variance"] = share
    return document


# --- for people


def _lines(trace: Trace) -> Iterator[str]:
    card, entry = trace.card, trace.entry
    yield f"{trace.key} ({property_key(trace.key).symbol}) of {title(card)}"
    yield from synthetic_lines(card, entry.campaign if entry else None)
    yield ""
    if entry is None:
        yield "No value: it was refused."
    else:
        yield from aligned(list(_facts(entry, card)), "  ")
    if isinstance(entry, PropertyRecord):
        yield from _budget_lines(entry)
    if entry is not None:
        yield from _calibration_lines(entry, card)
    if isinstance(entry, PropertyRecord):
        yield from _correlation_lines(entry, card)
    if trace.refusals:
        yield from ("", "Refused")
        for refusal in trace.refusals:
            yield from _refusal_lines(refusal, card)
    if trace.excluded:
        yield from ("", "Excluded")
        for left_out in trace.excluded:
            yield f"  {left_out.campaign}, {left_out.specimen}: {left_out.reason}"
            file = "" if left_out.path is None else f"{left_out.path}; "
            place = f"{file}{left_out.register}, line {left_out.register_line}"
            yield from aligned([("place", place)], "    ")
    if entry is not None:
        yield from ("", "Specimens")
        for origin in entry.origins:
            yield from _origin_lines(origin, entry)
    yield from ("", "Made by")
    yield from aligned(list(_code_facts(trace)), "  ")


def _facts(entry: Entry, card: MaterialCard) -> Iterator[tuple[str, str]]:
    if isinstance(entry, Law):
        yield "law", law_text(entry)
        for power, (c, row) in enumerate(zip(entry.coefficients, entry.covariance, strict=True)):
            yield f"c{power}", f"{c!r}, u = {math.sqrt(row[power]):.3g}"
    else:
        yield from _value_facts(entry)
    yield "conditions", readable_conditions(entry.conditions)
    for field in fields_of(type(entry)):
        value = field.get(entry)
        if field.optional and value != field.default:
            yield field.name, _number_or_words(value)
    credits_ = [credit_text(c) for c in card.campaigns if c.campaign == entry.campaign]
    yield "campaign", next(iter(credits_), entry.campaign)
    yield "method", entry.method
    yield "standard", property_key(entry.key).standard
    if entry.diagnostics:
        yield "diagnostics", _details(entry.diagnostics)
    for flag in entry.flags:
        yield "flag", str(flag)
    yield "card", f"release {card.release}"


def _value_facts(record: PropertyRecord) -> Iterator[tuple[str, str]]:
    quantity, scale = record.quantity, scale_of(record.quantity, record.key)
    si = si_text(quantity.value, quantity.unit)
    u = Scale(quantity.unit, None).with_number(quantity.standard_uncertainty)
    yield "value", f"{readable_record(record)}  ({si}, u = {u})"
    low, high = (si_text(bound, quantity.unit) for bound in record.ci95)
    yield "95 %", f"{readable_interval(record.ci95, scale)}  ({low} to {high})"
    sd = "" if record.sd is None else f", sd {readable_uncertainty(record.sd, scale.unit)}"
    yield "n", f"{record.n}{sd}"


def _budget_lines(record: PropertyRecord) -> Iterator[str]:
    if not record.budget:
        return
    unit = scale_of(record.quantity, record.key).unit
    yield from ("", "Uncertainty budget")
    yield from aligned(
        [
            (
                _source_of(line),
                "shared" if line.shared else "independent",
                readable_uncertainty(line.u, unit),
                f"{share:.1f} % of the variance",
            )
            for line, share in zip(record.budget, percent_of_variance(record.budget), strict=True)
        ],
        "  ",
    )


def _source_of(line: Contribution) -> str:
    return line.source if line.calibration is None else f"{line.source} ({line.calibration})"


def _calibrations(entry: Entry, card: MaterialCard) -> tuple[CalibrationRecord, ...]:
    """Find what is known of the calibrations that a value rests on."""
    named = {name for origin in entry.origins for name in origin.calibrations}
    return tuple(c for c in card.calibrations if c.calibration in named)


def _calibration_lines(entry: Entry, card: MaterialCard) -> Iterator[str]:
    found = _calibrations(entry, card)
    if not found:
        return
    yield from ("", "Calibrations")
    yield from aligned(
        [
            (
                one.calibration,
                ", ".join(one.covers),
                "" if one.u_relative is None else f"u = {100.0 * one.u_relative:.3g} %",
                f"valid {one.date} to {one.valid_until}",
                one.certificate,
            )
            for one in found
        ],
        "  ",
    )


def _correlation_lines(record: PropertyRecord, card: MaterialCard) -> Iterator[str]:
    rows = [
        (
            key,
            readable_conditions(conditions) if conditions else "",
            f"{pair.coefficient:+.2f}",
            pair.why,
        )
        for key, conditions, pair in partners(card.correlations, record)
    ]
    if rows:
        yield from ("", "Errs together with", *aligned(rows, "  "))


def _origin_lines(origin: Origin, entry: Entry) -> Iterator[str]:
    unit = entry.unit if isinstance(entry, Law) else entry.quantity.unit
    quantity = Quantity(origin.value, unit, origin.u_independent, origin.u_shared)
    yield f"  {origin.specimen}  {readable(quantity, entry.key)}  ({si_text(origin.value, unit)})"
    yield from aligned(list(_origin_facts(origin)), "    ")


def _origin_facts(origin: Origin) -> Iterator[tuple[str, str]]:
    if origin.path is None:
        yield "file", "none: the register holds the value"
    else:
        yield "file", origin.path
        yield "sha256", origin.sha256 or "not recorded"
        yield "lines", f"{origin.first_line} to {origin.last_line}, read by {origin.reader}"
    yield "register", f"{origin.register}, line {origin.register_line}"
    yield "technique", origin.technique
    if origin.tested_on is not None:
        yield "tested on", origin.tested_on
    if origin.calibrations:
        yield "calibrations", ", ".join(origin.calibrations)
    if origin.diagnostics:
        yield "diagnostics", _details(origin.diagnostics)


def _refusal_lines(refusal: Refusal, card: MaterialCard) -> Iterator[str]:
    who = (
        refusal.campaign if refusal.specimen is None else f"{refusal.campaign}, {refusal.specimen}"
    )
    yield f"  {who}: {refusal.reason}"
    facts = [("conditions", readable_conditions(refusal.conditions))] if refusal.conditions else []
    facts += [("place", place) for place in _refusal_places(refusal, card)]
    if refusal.diagnostics:
        facts.append(("diagnostics", _details(refusal.diagnostics)))
    if facts:
        yield from aligned(facts, "    ")


def _code_facts(trace: Trace) -> Iterator[tuple[str, str]]:
    provenance = trace.provenance
    yield "code", f"deamat {provenance.version}, digest {provenance.code}"
    origins = trace.entry.origins if trace.entry else ()
    techniques = sorted({o.technique for o in origins})
    made = [f"{stage} {t}" for t in techniques for stage in ("measurement", "summary")]
    fingerprints = dict(provenance.stages)
    for stage in (*made, "card"):
        if stage in fingerprints:
            yield stage, f"fingerprint {fingerprints[stage]}"
    yield "with", ", ".join(f"{name} {version}" for name, version in provenance.environment)
    for file, sha256 in provenance.config:
        yield "config", f"{file}, sha256 {sha256}"


def _details(details: Mapping[str, Detail]) -> str:
    return ", ".join(f"{name} {_number_or_words(v)}" for name, v in sorted(details.items()))


def _number_or_words(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
