"""What the rooms of stress-strain curves let a laboratory decide alike."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Field

from deamat.core.declared import Declared


def _rising(window: tuple[float, float]) -> tuple[float, float]:
    low, high = window
    if not 0.0 <= low < high:
        raise ValueError(f"a window must be 0 <= low < high, not [{low:g}, {high:g}]")
    return window


StrainWindow = Annotated[tuple[float, float], AfterValidator(_rising)]


class CurveConfig(Declared):
    """What compression and tension decide alike."""

    min_samples: int = Field(
        default=10, ge=3, description="fewest samples in the window that carry a slope"
    )
    unloading_tolerance: float = Field(
        default=1e-4,
        ge=0,
        description="strain may go back by this much inside the window; more, and more than six "
        "times the displacement noise, is unloading",
    )
    own_columns_tolerance: float = Field(
        default=0.01,
        gt=0,
        description="relative difference at which the file's own stress and strain are flagged",
    )
    own_stress_refused: float = Field(
        default=0.2,
        gt=0,
        description="relative difference between the file's own stress and force over the "
        "register's cross-section from which nothing of the file is taken",
    )
