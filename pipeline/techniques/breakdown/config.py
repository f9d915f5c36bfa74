"""What the breakdown room decides, and how it is called."""

from __future__ import annotations

from pydantic import Field

from deamat.core.instruments import Declared
from deamat.techniques.breakdown.ramp import Criteria

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
        default=0.1, gt=0, lt=1, description="part of the voltage whose loss is looked into"
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
        description="a start above this part of the voltage reached is flagged; a slow rise "
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
    area_ratio_limit: float = Field(
        default=10.0,
        ge=1,
        description="largest ratio of areas over which the strength may be scaled: flaws of one "
        "kind are assumed, and a wider step was not tested",
    )

    def criteria(self) -> Criteria:
        """Give what the search for the breakdown goes by."""
        return Criteria(
            self.amplifier_limit_V,
            self.limit_tolerance,
            self.dip,
            self.collapse,
            self.collapse_steps,
            self.spike_A,
            self.spike_noise,
        )
