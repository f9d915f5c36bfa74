"""What the breakdown room decides, and how it is called."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from deamat.core.declared import Declared
from deamat.techniques.breakdown.ramp import After, Criteria

FIELD = "breakdown_field"
STRENGTH, SHAPE, UNBIASED = "breakdown_strength", "weibull_shape", "weibull_shape_unbiased"
B10, B1 = "breakdown_B10", "breakdown_B1"
YIELDS = (STRENGTH, SHAPE, UNBIASED, B10, B1)


class BreakdownConfig(Declared):
    """`[breakdown]` in `config/methods.toml`."""

    amplifier_limit_V: float = Field(
        default=20e3,
        gt=0,
        description="voltage at which the amplifier ends; a specimen that bears it is "
        "right-censored (Trek 20/20C: the 20 kV of its name)",
    )
    limit_tolerance: float = Field(
        default=0.005, ge=0, lt=0.2, description="this near to the limit, it is reached"
    )
    least_voltage_V: float = Field(
        default=100.0,
        ge=0,
        description="a ramp that stays below is no breakdown test, or its unit is wrong",
    )
    dip: float = Field(
        default=0.03, gt=0, lt=1, description="part of the voltage whose loss is looked into"
    )
    collapse: float = Field(
        default=0.5, gt=0, lt=1, description="part of the voltage whose loss is a collapse"
    )
    collapse_steps: int = Field(
        default=3, ge=1, description="sampling steps within which a collapse happens"
    )
    spike_A: float = Field(default=5e-5, gt=0, description="least current of a spike")
    spike_noise: float = Field(
        default=10.0, gt=0, description="standard deviations by which a spike stands out"
    )
    event_A: float = Field(
        default=1e-3,
        gt=0,
        description="a jump of the current to this is a breakdown even where the voltage shows no "
        "dip; a smaller one without a dip is flagged alone",
    )
    arc_s: float = Field(
        default=0.02,
        ge=0,
        description="the current of a breakdown lasts at least this long: a log with longer steps "
        "may miss it, and a voltage that collapses without a current is then counted as broken "
        "and the interval widened to what it would be had it held",
    )
    after_clearing: After = Field(
        default="first breakdown",
        description="which voltage counts where a film clears itself and bears more again: that "
        "of the `first breakdown` or of the `final collapse`",
    )
    step_rule: Literal["ASTM D149", "IEC 60243-1"] = Field(
        default="ASTM D149",
        description="voltage that counts in a step-by-step test: of the step at which it broke "
        "(ASTM D149, method B) or of the last one held to its end (IEC 60243-1)",
    )
    least_hold_s: float = Field(
        default=5.0, gt=0, description="a voltage held this long between steps is step-by-step"
    )
    coarse_step: float = Field(
        default=0.02,
        gt=0,
        description="rise between two samples, relative to the voltage, that is flagged",
    )
    rate_tolerance: float = Field(
        default=0.2,
        gt=0,
        description="relative change of the rate of rise that is flagged (D149-style)",
    )
    least_time_s: float = Field(
        default=120.0,
        ge=0,
        description="a slow rise takes longer than this to break the specimen (ASTM D149, "
        "recalled, not verified); less is flagged",
    )
    start_flag_ratio: float = Field(
        default=0.7,
        gt=0,
        le=1,
        description="a start above this fraction of the voltage reached is flagged; a slow rise "
        "starts at about half of it",
    )
    register_tolerance: float = Field(
        default=0.02, gt=0, description="relative difference of register and ramp that is flagged"
    )
    goodness_level: float = Field(
        default=0.05, gt=0, lt=1, description="p-value below which a Weibull fit is called poor"
    )
    low_outlier_level: float = Field(
        default=0.05, gt=0, lt=1, description="p-value below which the weakest specimen is named"
    )
    curvature_level: float = Field(
        default=0.005,
        gt=0,
        lt=1,
        description="p-value below which the Weibull plot is called curved (two populations, "
        "competing modes, a threshold)",
    )
    thickness_level: float = Field(
        default=0.005,
        gt=0,
        lt=1,
        description="p-value below which the field at breakdown is said to follow the thickness",
    )
    form_power: float = Field(
        default=0.8,
        gt=0.1,
        lt=1,
        description="a departure from the Weibull form that the tests find in this fraction of "
        "samples counts as one that would have been seen",
    )
    form_tolerance: float = Field(
        default=0.1,
        gt=0,
        description="B1 and B10 are flagged where a departure that would not have been seen moves "
        "them by more than this fraction",
    )
    area_ratio_limit: float = Field(
        default=10.0,
        ge=1,
        description="largest ratio of areas over which the strength may be scaled: flaws of one "
        "kind are assumed, and a wider step was not tested",
    )

    def criteria(self) -> Criteria:
        """Return what the search for the breakdown goes by."""
        return Criteria(
            self.amplifier_limit_V,
            self.limit_tolerance,
            self.dip,
            self.collapse,
            self.collapse_steps,
            self.spike_A,
            self.spike_noise,
            self.event_A,
            self.arc_s,
            self.after_clearing,
        )
