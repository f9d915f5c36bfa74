"""Breakdown: high-voltage ramps, or registers of voltages or fields, to a Weibull fit."""

from __future__ import annotations

from pipeline.core.technique import Technique
from pipeline.techniques.breakdown.config import VERSION, YIELDS, BreakdownConfig
from pipeline.techniques.breakdown.figure import draw
from pipeline.techniques.breakdown.specimen import reduce
from pipeline.techniques.breakdown.summary import summarise

TECHNIQUE = Technique(
    key="breakdown",
    version=VERSION,
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
    figure=draw,
)

__all__ = ["TECHNIQUE", "BreakdownConfig"]
