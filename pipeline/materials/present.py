"""A card as one screen of text."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence

from deamat.core.laws import ARRHENIUS, EXPONENTIAL, POWER_LAW_FLUID, POWER_LAW_TO_GEL
from deamat.core.present import (
    SYNTHETIC_BANNER,
    aligned,
    readable_conditions,
    readable_interval,
    readable_record,
    readable_unit,
    scale_of,
)
from deamat.core.properties import PROPERTIES, REFERENCE_AGE, property_key
from deamat.core.records import Condition, Law, PropertyRecord
from deamat.core.units import from_si
from deamat.materials.card import Credit, MaterialCard
from deamat.materials.select import refusal_reasons

_WIDTH = 110
_HEADINGS = ("property", "symbol", "value", "95 % interval", "n", "conditions", "flags")


def card_text(card: MaterialCard) -> str:
    """Write a card for people: what is known, under which conditions, and what was refused.

    What all values have in common is stated once; flags are numbered by name, each with its first
    detail (`trace` tells those of one value in full).
    """
    card = card.canonical()
    lines = [f"{title(card)}, card {card.release}"]
    lines += synthetic_lines(card)
    for credit in card.campaigns:
        lines += _wrapped(credit_text(credit), indent="")
    notes = _flag_details(card)
    if card.records:
        lines += ["", *_table(card, list(notes))]
    if card.laws:
        lines += ["", "Laws"]
        for law in card.laws:
            lines += _wrapped(_law_line(law, list(notes)))
    if notes:
        lines += ["", "Flags"]
        for number, (name, detail) in enumerate(notes.items(), 1):
            lines += _wrapped(f"[{number}] {name}: {detail}")
    refused = sorted({refusal.key for refusal in card.refusals})
    if refused:
        lines += ["", "Refused"]
        for key in refused:
            for reason in refusal_reasons(card.refusals, key):
                lines += _wrapped(f"{key}: {reason}")
    if card.excluded:
        lines += ["", "Excluded"]
        for left_out in card.excluded:
            lines += _wrapped(f"{left_out.place}: {left_out.reason}")
    return "\n".join(lines)


def title(card: MaterialCard) -> str:
    """Return the name that people read, and the id where it is another word."""
    return card.name if card.name == card.material else f"{card.name} ({card.material})"


def synthetic_lines(card: MaterialCard, campaign: str | None = None) -> list[str]:
    """Return the banner of a card, or of one campaign's values; no line if all was measured."""
    simulated = [credit.campaign for credit in card.campaigns if credit.synthetic]
    known = [credit.campaign for credit in card.campaigns]
    if campaign in known:
        return [SYNTHETIC_BANNER] if campaign in simulated else []
    if card.synthetic and 0 < len(simulated) < len(known):
        return [f"SYNTHETIC in part: {', '.join(simulated)} is simulated, not measured"]
    return [SYNTHETIC_BANNER] if card.synthetic else []


def credit_text(credit: Credit) -> str:
    """Name a campaign, its terms, and that it is simulated if it is."""
    parts = [credit.title, credit.laboratory, credit.licence]
    if credit.synthetic:
        parts.append("synthetic")
    return f"{credit.campaign}: {', '.join(part for part in parts if part)}"


def law_text(law: Law) -> str:
    """Write the form of a law and the range in which it holds."""
    unit = readable_unit(law.valid[1], law.argument_unit)
    low, high = (f"{from_si(x, unit):.4g}" for x in law.valid)
    rates = ""
    if law.rates is not None:
        slow, fast = law.rates
        rates = f", at nominal shear rates q from {slow:.4g} to {fast:.4g} 1/s"
    return (
        f"{law.kind}, {_form_text(law)} [{law.unit}] with x = {law.argument} "
        f"[{law.argument_unit}], from {low} to {high} {unit}{rates}"
    )


def _form_text(law: Law) -> str:
    c = law.coefficients
    if law.kind == EXPONENTIAL:
        return f"{c[0]:.4g} exp({c[1]:.4g} x)"
    if law.kind == ARRHENIUS:
        return f"{c[0]:.4g} exp(E / (R x)), E = {c[1]:.4g} J/mol"
    if law.kind == POWER_LAW_TO_GEL:
        return f"{c[0]:.4g} (1 - x / {c[1]:.4g})^-{c[2]:.4g}"
    if law.kind == POWER_LAW_FLUID:
        split = law.parts[0]
        factor, index = (_polynomial_text(part) for part in (c[:split], c[split:]))
        return f"K q^(n - 1), K = {factor}, n = {index}"
    return _polynomial_text(c)


def _polynomial_text(coefficients: Sequence[float]) -> str:
    terms = [f"{c:.4g}" + ("", " x", f" x^{k}")[min(k, 2)] for k, c in enumerate(coefficients)]
    return " + ".join(terms).replace("+ -", "- ")


def _wrapped(line: str, indent: str = "  ") -> list[str]:
    return textwrap.wrap(
        line,
        _WIDTH,
        initial_indent=indent,
        subsequent_indent=f"{indent}    ",
        break_long_words=False,
        break_on_hyphens=False,
    )


def _flag_details(card: MaterialCard) -> dict[str, str]:
    """Return each flag's name with the detail of the first entry that has it."""
    entries: list[PropertyRecord | Law] = [*_in_table_order(card.records), *card.laws]
    details: dict[str, str] = {}
    for entry in entries:
        for flag in entry.flags:
            details.setdefault(flag.name, flag.detail)
    return details


def _in_table_order(records: Sequence[PropertyRecord]) -> list[PropertyRecord]:
    """Sort as the property table does, the reference age first, times and rates as they rise."""
    order = list(PROPERTIES)

    def place(record: PropertyRecord) -> tuple[int, bool, list[tuple[str, float]]]:
        conditions = record.conditions
        numbers = [(name, v) for name, v in sorted(conditions.items()) if isinstance(v, float)]
        return order.index(record.key), conditions.get("age") != REFERENCE_AGE, numbers

    return sorted(records, key=place)


def _table(card: MaterialCard, flags: Sequence[str]) -> list[str]:
    records = _in_table_order(card.records)
    common = _common_conditions(records)
    several = len({record.campaign for record in records}) > 1
    rows = [_row(record, common, flags, several) for record in records]
    lines = aligned([_HEADINGS, *rows])
    return [*lines, f"All values: {readable_conditions(common)}"] if common else lines


def _common_conditions(records: Sequence[PropertyRecord]) -> dict[str, Condition]:
    """Return the conditions that all of several records share."""
    if len(records) < 2:
        return {}
    return {
        name: value
        for name, value in records[0].conditions.items()
        if all(r.conditions.get(name) == value for r in records)
    }


def _row(
    record: PropertyRecord,
    common: Mapping[str, Condition],
    flags: Sequence[str],
    name_campaign: bool,
) -> tuple[str, ...]:
    own = {name: value for name, value in record.conditions.items() if name not in common}
    said = [readable_conditions(own)] if own or not common else []
    if name_campaign:
        said.append(record.campaign)
    return (
        record.key,
        property_key(record.key).symbol,
        readable_record(record),
        readable_interval(record.ci95, scale_of(record.quantity, record.key)),
        str(record.n),
        ", ".join(said),
        _marks(record, flags),
    )


def _law_line(law: Law, flags: Sequence[str]) -> str:
    head = f"{law.key} ({property_key(law.key).symbol}): {law_text(law)}"
    under = f"; {readable_conditions(law.conditions)}" if law.conditions else ""
    return f"{head}{under} {_marks(law, flags)}".rstrip()


def _marks(entry: PropertyRecord | Law, flags: Sequence[str]) -> str:
    names = dict.fromkeys(flag.name for flag in entry.flags)
    return " ".join(f"[{flags.index(name) + 1}]" for name in names)
