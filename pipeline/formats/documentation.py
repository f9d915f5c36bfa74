"""What a campaign's README says about units, held against what stands over the columns."""

from __future__ import annotations

import re
from collections.abc import Mapping

from deamat.core.records import Flag
from deamat.core.units import UnknownUnit, known, si_factor

_STATEMENT = re.compile(
    r"\s*(?:[-*+•]\s+)?"  # a bullet
    r"(?P<label>[^\W\d_][\w \-/]*?)\s*"
    r"[(\[](?P<unit>[^()\[\]]+)[)\]]"
    r"\s*(?:[:;,.=–—-].*)?"  # and a remark
)


def stated_units(text: str) -> dict[str, str]:
    """Read lines such as `- Engineering stress (N/mm^2)` or `Load [N]: compressive force`.

    Parameters
    ----------
    text : a README, or the header of a file

    Returns
    -------
    label to unit, both as written; a bracket that holds no known unit is no statement, and of two
    statements on one label the first counts
    """
    stated: dict[str, str] = {}
    for line in text.splitlines():
        found = _STATEMENT.fullmatch(line.replace("**", "").replace("`", ""))
        if found and known(found["unit"]):
            stated.setdefault(found["label"], found["unit"].strip())
    return stated


def contradictions(
    stated: Mapping[str, str], column_units: Mapping[str, str], where: str = "README"
) -> tuple[Flag, ...]:
    """Flag every column whose unit is not the one stated for its label.

    Parameters
    ----------
    stated : label to unit, from `stated_units`
    column_units : label to unit as written (`Recording.column_units`), empty where none is
    where : who made the statements

    Returns
    -------
    a flag `unit-contradiction` per column; two spellings of one unit are no contradiction, and
    labels are compared without regard to case
    """
    by_label = {label.casefold(): unit for label, unit in stated.items()}
    return tuple(
        Flag(
            "unit-contradiction",
            f"{label}: the {where} says {by_label[label.casefold()]}, the column says {unit}; "
            "the column was used",
        )
        for label, unit in column_units.items()
        if unit and label.casefold() in by_label and _differ(unit, by_label[label.casefold()])
    )


def _differ(written: str, stated: str) -> bool:
    try:
        return si_factor(written) != si_factor(stated)
    except UnknownUnit:
        return written.strip() != stated.strip()
