"""Breakdown: high-voltage ramps, or registers of voltages or fields, to a Weibull fit."""

from __future__ import annotations

from deamat.core.channels import CHANNEL_COLUMNS
from deamat.core.register import RegisterForm
from deamat.core.technique import Technique
from deamat.techniques.breakdown.config import YIELDS, BreakdownConfig
from deamat.techniques.breakdown.figure import figure
from deamat.techniques.breakdown.reduce import reduce
from deamat.techniques.breakdown.summarise import summarise

TECHNIQUE = Technique(
    key="breakdown",
    yields=YIELDS,
    needs=(),
    config=BreakdownConfig,
    required=(),  # published registers hold the field alone; `reduce` says what a row lacks
    optional=(
        "thickness_m",
        "electrode_area_m2",
        "rate_V_per_s",
        "breakdown_voltage_V",
        "breakdown_field_V_per_m",
        "micrometer_force_N",
    ),
    reduce=reduce,
    summarise=summarise,
    figure=figure,
    register=RegisterForm(notes=("censored", *CHANNEL_COLUMNS), asked=("thickness_m",)),
    measures=("voltage",),
)

__all__ = ["TECHNIQUE", "BreakdownConfig"]
