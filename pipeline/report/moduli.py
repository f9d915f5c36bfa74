"""The moduli of a campaign: which bars its figure has, picked out of records and refusals."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from deamat.core.properties import PROPERTIES, REFERENCE_AGE
from deamat.core.records import Condition, PropertyRecord, Refusal

_MODULI = tuple(p.key for p in PROPERTIES.values() if p.is_modulus)


@dataclass(frozen=True, slots=True)
class ModulusBar:
    """One modulus of one material, or the slot of a refused one.

    Parameters
    ----------
    series : property and condition in words: what one colour stands for
    n : number of specimens; 0 for a refused value
    value_Pa : None if the value was refused
    ci95_Pa : 95 % confidence interval, None where none is known
    """

    material: str
    series: str
    n: int
    value_Pa: float | None
    ci95_Pa: tuple[float, float] | None


def modulus_bars(
    records: Iterable[PropertyRecord], refusals: Iterable[Refusal] = ()
) -> tuple[ModulusBar, ...]:
    """Pick the moduli of one campaign out of its records, and what was refused of them.

    A refusal shows only where its material has no such modulus at that age: single specimens are
    refused without the material losing its value. Conditions are named where they tell two values
    of one material apart.

    Raises
    ------
    ValueError : the records come from several campaigns, or two of them are the same modulus of one
        material under the same conditions
    """
    records = [r for r in records if r.key in _MODULI]
    refusals = [r for r in refusals if r.key in _MODULI]
    campaigns = sorted({r.campaign for r in records} | {r.campaign for r in refusals})
    if len(campaigns) > 1:
        raise ValueError(f"one figure shows one campaign, not {', '.join(campaigns)}")
    telling = _telling_conditions(records)
    bars = {}
    for record in records:
        series = _series(record.key, record.conditions, telling)
        if (record.material, series) in bars:
            raise ValueError(f"{record.material} has two records of its {series}")
        bar = ModulusBar(record.material, series, record.n, record.quantity.value, record.ci95)
        bars[record.material, series] = _order(record), bar
    known = {_identity(record) for record in records}
    for refusal in refusals:
        if _identity(refusal) not in known:
            series = _series(refusal.key, refusal.conditions, set())
            empty = ModulusBar(refusal.material, series, 0, None, None)
            bars[refusal.material, series] = _order(refusal), empty
    return tuple(bar for _, bar in sorted(bars.values(), key=lambda pair: pair[0]))


def is_modulus(key: str) -> bool:
    """Say whether the values of a property have bars in the figure."""
    return key in _MODULI


def _identity(item: PropertyRecord | Refusal) -> tuple[str, str, Condition | None]:
    return item.material, item.key, item.conditions.get("age")


def _order(item: PropertyRecord | Refusal) -> tuple[int, int, str]:
    age = item.conditions.get("age")
    first = (REFERENCE_AGE, None)
    return _MODULI.index(item.key), first.index(age) if age in first else len(first), str(age)


def _telling_conditions(records: Iterable[PropertyRecord]) -> set[str]:
    alike: dict[tuple[str, str, Condition | None], list[PropertyRecord]] = defaultdict(list)
    for record in records:
        alike[_identity(record)].append(record)
    return {
        name
        for group in alike.values()
        for name in {name for record in group for name in record.conditions}
        if len({record.conditions.get(name) for record in group}) > 1
    }


def _series(key: str, conditions: Mapping[str, Condition], telling: set[str]) -> str:
    words = [key.replace("_", " ")]
    if "age" in conditions:
        words.append(str(conditions["age"]))
    words += [f"{name} {conditions[name]}" for name in sorted(telling & set(conditions))]
    return ", ".join(words)
