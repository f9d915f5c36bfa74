"""Viscosity of a curing liquid: laws over time, power-law fluids, flow curves."""

from __future__ import annotations

from deamat.core.register import RegisterForm
from deamat.core.technique import Technique
from deamat.techniques.viscosity.config import YIELDS, ViscosityConfig
from deamat.techniques.viscosity.figure import figure
from deamat.techniques.viscosity.reduce import reduce
from deamat.techniques.viscosity.summarise import summarise

TECHNIQUE = Technique(
    key="viscosity",
    yields=YIELDS,
    needs=(),
    config=ViscosityConfig,
    required=(),
    optional=("mass_kg",),
    reduce=reduce,
    summarise=summarise,
    figure=figure,
    register=RegisterForm(notes=("mixed_at", "sample"), asked=("mixed_at",)),
    measures=("torque",),
)
