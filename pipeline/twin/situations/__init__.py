"""Situations that laboratories have: the one list, by name. One module per technique."""

from __future__ import annotations

from deamat.twin.situations import (
    breakdown,
    compression,
    conditions,
    nanoindentation,
    permittivity,
    registers,
    tension,
    viscosity,
    viscosity_units,
)
from deamat.twin.situations.situation import Situation

SITUATIONS: dict[str, Situation] = {
    s.name: s
    for s in (
        *tension.SITUATIONS,
        *permittivity.SITUATIONS,
        *breakdown.SITUATIONS,
        *nanoindentation.SITUATIONS,
        *viscosity.SITUATIONS,
        *viscosity_units.SITUATIONS,
        *compression.SITUATIONS,
        *conditions.SITUATIONS,
        *registers.SITUATIONS,
    )
}
