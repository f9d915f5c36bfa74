"""The rooms: one folder per technique, and the one list of them."""

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
    technique.key: technique
    for technique in (
        breakdown.TECHNIQUE,
        compression.TECHNIQUE,
        handling.TECHNIQUE,
        nanoindentation.TECHNIQUE,
        permittivity.TECHNIQUE,
        tension.TECHNIQUE,
        viscosity.TECHNIQUE,
    )
}
