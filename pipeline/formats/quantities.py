"""What testing machines call the quantities that techniques need, and the names they get here.

A closed table (`vocabulary.toml`): a column whose label is not listed keeps its own name, so that
nothing is taken for a force because it looks like one.
"""

from __future__ import annotations

import re
from functools import lru_cache

from deamat.formats.vocabulary import vocabulary


def _standard() -> dict[str, tuple[str, tuple[str, ...]]]:
    seen: set[str] = set()
    found = {}
    for name, words in vocabulary().items():
        if words.general:
            labels = tuple(label for label in words.labels if label not in seen)
            seen.update(labels)  # a label of two quantities means the one listed first
            found[name] = (words.unit, labels)
    return found


# name in SI -> (SI unit, labels in order of preference); of two columns in one file that mean the
# same quantity the one listed first gets the name, the other keeps its own
STANDARD = _standard()

_MEANING = {
    label: (rank, name)
    for name, (_, labels) in STANDARD.items()
    for rank, label in enumerate(labels)
}
# Bluehill: `Tensile strain (Extension)` is the crosshead's, `Tensile strain (Strain 1)` is not
_REMARK = re.compile(r"\s*\([^()]*\)$")


@lru_cache(maxsize=256)  # the files of a campaign have the same labels
def meaning(label: str) -> tuple[int, str] | None:
    """Return rank and standard name of a label, or None for a label outside the table."""
    plain = label.casefold()
    return _MEANING.get(plain) or _MEANING.get(_REMARK.sub("", plain))


def own_name(label: str, si_unit: str) -> str:
    """Make a column name from label and SI unit: `Speed`, `m/s` to `speed_m_per_s`."""
    plain = re.sub(r"\W+", "_", label.casefold()).strip("_")
    if si_unit == "1":
        return plain
    return f"{plain}_{si_unit.removeprefix('1').replace('.', '').replace('/', '_per_')}".replace(
        "__", "_"
    )


@lru_cache(maxsize=64)
def assign(labels: tuple[str, ...], si_units: tuple[str, ...]) -> tuple[str, ...]:
    """Name the columns of a table.

    Parameters
    ----------
    labels, si_units : per column, in order; no label twice

    Returns
    -------
    the names, in order: a standard name where label and unit agree on it, else the column's own
    """
    best: dict[str, tuple[int, int]] = {}
    for column, (label, si_unit) in enumerate(zip(labels, si_units, strict=True)):
        found = meaning(label)
        if found is None or STANDARD[found[1]][0] != si_unit:
            continue
        rank, name = found
        best[name] = min(best.get(name, (rank, column)), (rank, column))
    standard = {column: name for name, (_, column) in best.items()}
    return tuple(
        standard[column] if column in standard else own_name(label, si_unit)
        for column, (label, si_unit) in enumerate(zip(labels, si_units, strict=True))
    )
