"""What a laboratory may decide about its moduli in compression: `[compression]`."""

from __future__ import annotations

from pydantic import Field

from deamat.techniques.shared.curve_config import CurveConfig, StrainWindow

MODULUS = "compressive_modulus"
COMPENSATED = "compressive_modulus_toe_compensated"
YIELDS = (MODULUS, COMPENSATED)


class CompressionConfig(CurveConfig):
    """`[compression]` in `config/methods.toml`."""

    window: StrainWindow = Field(
        default=(0.0, 0.05), description="nominal strain over which the slope is taken"
    )
    toe_bin: float = Field(
        default=0.01, ge=1e-4, description="width in strain of the bins that show a toe"
    )
    toe_flag_ratio: float = Field(
        default=0.8,
        gt=0,
        le=1,
        description="a first bin less steep than this fraction of the steepest is a toe",
    )
    contact_flag_ratio: float = Field(
        default=0.1,
        ge=0,
        le=1,
        description="a first bin less steep than this fraction of the steepest has no full contact",
    )
    preload_flag_ratio: float = Field(
        default=0.1,
        gt=0,
        description="stress of the line at zero strain, as a fraction of its rise, that is flagged",
    )
    correct_bonded_plates: bool = Field(
        default=False,
        description="divide moduli of cylinders whose plates are declared bonded by 1 + 2 S^2",
    )
