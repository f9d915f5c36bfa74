"""Which record of a card answers a question; a question that several answer is refused."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeVar

from deamat.core.errors import MissingProperty
from deamat.core.properties import CONDITIONS, REFERENCE_AGE
from deamat.core.records import Condition, Law, PropertyRecord, Refusal

E = TypeVar("E", PropertyRecord, Law)
Asked = Mapping[str, Condition | None]


def choose(entries: Sequence[E], what: str, asked: Asked) -> E:
    """Return the one entry that a question means.

    Parameters
    ----------
    entries : all records, or all laws, of one key; at least one
    what : words for messages, `compressive_modulus of ef50-0t`
    asked : condition key, or `campaign`, to the value wanted, a number also as its text
        (`0.005`, `0,0.05`); None wants it not stated

    The one entry that meets the conditions; if several do and the question says nothing of the
    age, the one at the reference age (`core.properties.REFERENCE_AGE`).

    Raises
    ------
    MissingProperty : no entry meets the conditions, or several do; the message lists the choices
    """
    unknown = sorted(set(asked) - {*CONDITIONS, "campaign"})
    if unknown:
        raise MissingProperty(
            f"no condition is called {', '.join(unknown)}; known: campaign, {', '.join(CONDITIONS)}"
        )
    left = [e for e in entries if all(_meets(e, name, asked[name]) for name in asked)]
    if not left:
        raise MissingProperty(f"no {what} with {_said(asked)}", f"there is {_choices(entries)}")
    left = [e for e in left if _stated(e, "age") == REFERENCE_AGE] or left
    if len(left) > 1:
        raise MissingProperty(f"{len(left)} records of {what}; choose {_choices(left, brief=True)}")
    return left[0]


def _stated(entry: PropertyRecord | Law, name: str) -> Condition | None:
    if name == "campaign":
        return entry.campaign
    return entry.conditions.get(name)


def _meets(entry: PropertyRecord | Law, name: str, wanted: Condition | None) -> bool:
    return _same(_stated(entry, name), wanted)


def _same(found: Condition | None, wanted: Condition | None) -> bool:
    if isinstance(found, tuple):
        parts = wanted.split(",") if isinstance(wanted, str) else wanted
        return (
            isinstance(parts, tuple | list)
            and len(parts) == len(found)
            and all(map(_same, found, parts))
        )
    if isinstance(found, float | int) and wanted is not None:
        return _near(found, wanted)
    return found == wanted


def _near(found: float, wanted: Condition) -> bool:
    """Compare numbers as people copy them: six digits, perhaps as text of a command line."""
    try:
        return isinstance(wanted, str | float | int) and math.isclose(
            found, float(wanted), rel_tol=1e-5
        )
    except ValueError:
        return False


def _said(conditions: Asked) -> str:
    return ", ".join(f"{name}={value!r}" for name, value in conditions.items())


def _choices(entries: Sequence[PropertyRecord | Law], *, brief: bool = False) -> str:
    """List entries in the words with which they can be asked for; brief is what parts them."""
    told: list[dict[str, Condition | None]] = [
        {"campaign": e.campaign, **e.conditions} for e in entries
    ]
    if brief:
        names = dict.fromkeys(name for one in told for name in one)
        told = [{name: one.get(name) for name in names} for one in told]
        same = {name for name in names if all(one[name] == told[0][name] for one in told)}
        told = [{name: one[name] for name in names if name not in same} for one in told]
    return " or ".join(f"({_said(one)})" for one in told)


def refusal_reasons(refusals: Iterable[Refusal], key: str) -> list[str]:
    """Say each reason for which a key was refused once, with the specimens that it holds for."""
    specimens: dict[str, list[str]] = {}
    for refusal in refusals:
        if refusal.key == key:
            named = specimens.setdefault(refusal.reason, [])
            if refusal.specimen is not None:
                named.append(refusal.specimen)
    return [f"{r} ({', '.join(names)})" if names else r for r, names in specimens.items()]
