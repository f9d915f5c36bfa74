"""Tension of strips to failure: modulus at small strain, strength, elongation at break."""

from __future__ import annotations

from deamat.core.technique import Technique
from deamat.techniques.tension.config import YIELDS, TensionConfig
from deamat.techniques.tension.figure import figure
from deamat.techniques.tension.reduce import reduce
from deamat.techniques.tension.summarise import summarise

TECHNIQUE = Technique(
    key="tension",
    yields=YIELDS,
    needs=(),
    config=TensionConfig,
    required=("width_m", "thickness_m", "gauge_length_m"),
    optional=("speed_m_per_s",),
    reduce=reduce,
    summarise=summarise,
    figure=figure,
    measures=("force", "displacement"),
)
