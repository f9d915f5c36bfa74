"""What testing machines call the quantities that techniques need, and the names they get here.

A closed table: a column whose label is not listed keeps its own name, so that nothing is taken
for a force because it looks like one.
"""

from __future__ import annotations

import re
from functools import lru_cache

# name in SI -> (SI unit, labels in order of preference); of two columns in one file that mean the
# same quantity the one listed first gets the name, the other keeps its own
STANDARD: dict[str, tuple[str, tuple[str, ...]]] = {
    "time_s": (
        "s",
        ("time", "test time", "running time", "elapsed time", "zeit", "prüfzeit"),
    ),
    "displacement_m": (
        "m",
        (
            "displacement",
            "extension",
            "compression",
            "compressive extension",
            "compressive displacement",
            "tensile extension",
            "tensile displacement",
            "machine extension",
            "crosshead",
            "crosshead displacement",
            "axial displacement",
            "travel",
            "standard travel",
            "standardweg",
            "stroke",
            "position",
            "standard extensometer",
        ),
    ),
    "force_N": (
        "N",
        (
            "force",
            "load",
            "compressive load",
            "tensile load",
            "axial force",
            "standard force",
            "standard load cell",
            "standardkraft",
            "kraft",
        ),
    ),
    "nominal_strain": (
        "1",
        (
            "engineering strain",
            "nominal strain",
            "compressive strain",
            "tensile strain",
            "strain",
            "dehnung",
        ),
    ),
    "extensometer_strain": (
        "1",
        (
            "extensometer strain",
            "strain 1",
            "strain 2",
            "video strain",
            "extensometer",
            "tensile strain (strain 1)",
            "tensile strain (strain 2)",
            "compressive strain (strain 1)",
            "strain (extensometer)",
            "tensile strain (extensometer)",
        ),
    ),
    "nominal_stress_Pa": (
        "Pa",
        (
            "engineering stress",
            "nominal stress",
            "compressive stress",
            "tensile stress",
            "stress",
            "spannung",
        ),
    ),
    "shear_rate_per_s": ("1/s", ("shear rate", "scherrate")),
    "shear_stress_Pa": ("Pa", ("shear stress", "schubspannung")),
    "viscosity_Pas": ("Pa.s", ("viscosity", "viskosit\u00e4t")),
    "speed_rpm": ("rpm", ("drehzahl",)),
    "true_strain": ("1", ("true strain",)),
    "true_stress_Pa": ("Pa", ("true stress",)),
}

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
