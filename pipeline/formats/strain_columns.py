"""Columns of strain whose label nobody knows: an extensometer's would be the better strain."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from deamat.core.records import Flag
from deamat.formats.vocabulary import vocabulary

_STRAIN = (
    "strain", "dehnung", "déformation", "deformación", "deformazione", "odkształcenie", "extenso",
    "extensó", "estensi", "应变", "ひずみ",
)  # fmt: skip
_OTHER = ("rate", "true", "wahre", "vraie", "geschwindigkeit", "vitesse", "energy")


def unknown_strain(names: Collection[str], labels: Iterable[str]) -> tuple[Flag, ...]:
    """Flag columns that look like strain beside displacement, and are not used.

    Parameters
    ----------
    names : of the columns that are known
    labels : of the others; names among them are passed over
    """
    if "displacement_m" not in names or "extensometer_strain" in names:
        return ()
    known = vocabulary()
    strains = sorted(label for label in labels if label not in known and _is_strain(label))
    if not strains:
        return ()
    said = ", ".join(map(repr, strains))
    return (
        Flag(
            "columns-not-used",
            f"strain column {said} has an unknown label: strain is the crosshead's; if that column "
            "is an extensometer's, call it `Extensometer strain`",
        ),
    )


def _is_strain(label: str) -> bool:
    text = label.casefold()
    return any(word in text for word in _STRAIN) and not any(word in text for word in _OTHER)
