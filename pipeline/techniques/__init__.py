"""The rooms: one module per technique, and the one list of them."""

from deamat.core.technique import AnyTechnique
from deamat.techniques import (
    breakdown,
    compression,
    handling,
    nanoindentation,
    permittivity,
    tension,
    viscosity,
)

TECHNIQUES: dict[str, AnyTechnique] = {
    "breakdown": breakdown.TECHNIQUE,
    "compression": compression.TECHNIQUE,
    "handling": handling.TECHNIQUE,
    "nanoindentation": nanoindentation.TECHNIQUE,
    "permittivity": permittivity.TECHNIQUE,
    "tension": tension.TECHNIQUE,
    "viscosity": viscosity.TECHNIQUE,
}
