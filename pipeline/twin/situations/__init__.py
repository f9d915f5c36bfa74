"""Situations that laboratories have: the one list, by name. One module per technique."""

from __future__ import annotations

from deamat.twin.situations import breakdown, nanoindentation, permittivity, tension, viscosity
from deamat.twin.situations.situation import Situation

SITUATIONS: dict[str, Situation] = {
    s.name: s
    for s in (
        *tension.SITUATIONS,
        *permittivity.SITUATIONS,
        *breakdown.SITUATIONS,
        *nanoindentation.SITUATIONS,
        *viscosity.SITUATIONS,
    )
}
