"""Handling time: how long after mixing a silicone still prints clean lines.

Lines are printed one after another, and each is looked at. The truth lies between the last clean
line and the first defective one, or beyond the last line where the test or the equipment ended
first: the value is the time of the last clean line, which an operator can rely on, and its record
says whether it is the lower end of an interval or only a lower bound.

Which viscosity the silicone has then stands beside it, with what it does not mean: see
`viscosity_then`.
"""

from __future__ import annotations

from deamat.core.register import RegisterForm
from deamat.core.technique import Technique
from deamat.techniques.handling.config import VISCOSITY, YIELDS, HandlingConfig
from deamat.techniques.handling.figure import figure
from deamat.techniques.handling.reduce import reduce
from deamat.techniques.handling.runs import RUN_COLUMNS
from deamat.techniques.handling.summarise import summarise

TECHNIQUE = Technique(
    key="handling",
    yields=YIELDS,
    needs=(VISCOSITY,),
    config=HandlingConfig,
    required=("time_s",),
    optional=("bed_temperature_K",),
    reduce=reduce,
    summarise=summarise,
    figure=figure,
    register=RegisterForm(
        file="observations.csv",
        text=("material", "defect"),
        identity=("material", *RUN_COLUMNS, "bed_temperature_K", "time_s", "line"),
        conditions={"bed_temperature_K": "temperature_K"},
        whole=True,
        notes=(*RUN_COLUMNS, "line", "limit"),
    ),
)
