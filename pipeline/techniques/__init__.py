"""The rooms: one module per technique, and the one list of them."""

from pipeline.core.technique import Technique
from pipeline.techniques import compression, tension

TECHNIQUES: dict[str, Technique] = {
    "compression": compression.TECHNIQUE,
    "tension": tension.TECHNIQUE,
}
