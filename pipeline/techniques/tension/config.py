"""What a laboratory may decide about its tensile tests: `[tension]`."""

from __future__ import annotations

from pydantic import Field

from deamat.techniques.shared.curve_config import CurveConfig, StrainWindow

MODULI = ("tensile_modulus", "tensile_modulus_toe_compensated")
STRENGTH = "tensile_strength"
ELONGATION = "elongation_at_break"
YIELDS = (*MODULI, STRENGTH, ELONGATION)


class TensionConfig(CurveConfig):
    """`[tension]` in `config/methods.toml`."""

    window: StrainWindow = Field(
        default=(0.0, 0.01), description="nominal strain over which the slope is taken"
    )
    min_samples: int = Field(
        default=5, ge=5, description="fewest samples in the window that carry a slope"
    )
    break_drop: float = Field(
        default=0.5, gt=0, lt=1, description="fraction of the greatest load whose loss is a break"
    )
