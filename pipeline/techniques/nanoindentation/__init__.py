"""Nanoindentation of soft specimens: modulus from the loading law of a declared tip."""

from __future__ import annotations

from deamat.core.register import RegisterForm
from deamat.core.technique import Technique
from deamat.techniques.nanoindentation.config import YIELDS, NanoindentationConfig
from deamat.techniques.nanoindentation.figure import figure
from deamat.techniques.nanoindentation.reduce import reduce
from deamat.techniques.nanoindentation.summarise import summarise

TECHNIQUE = Technique(
    key="nanoindentation",
    yields=YIELDS,
    needs=(),
    config=NanoindentationConfig,
    required=(),
    optional=("tip_radius_m", "height_m", "peak_load_N"),
    reduce=reduce,
    summarise=summarise,
    figure=figure,
    register=RegisterForm(notes=("tip",), asked=("tip", "tip_radius_m")),
    measures=("force", "displacement"),
)
