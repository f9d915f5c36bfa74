"""Compression of cylinders between plates: modulus as the slope over the first strain."""

from __future__ import annotations

from deamat.core.register import RegisterForm
from deamat.core.technique import Technique
from deamat.techniques.compression.config import YIELDS, CompressionConfig
from deamat.techniques.compression.figure import figure
from deamat.techniques.compression.reduce import reduce
from deamat.techniques.compression.summarise import summarise

TECHNIQUE = Technique(
    key="compression",
    yields=YIELDS,
    needs=(),
    config=CompressionConfig,
    required=("diameter_m", "height_m"),
    optional=("speed_m_per_s",),
    reduce=reduce,
    summarise=summarise,
    figure=figure,
    register=RegisterForm(notes=("plates",)),
    measures=("force", "displacement"),
)
