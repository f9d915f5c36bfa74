"""What a laboratory may decide about its printed lines: `[handling]`."""

from __future__ import annotations

from pydantic import Field

from deamat.core.declared import Declared

KEY = "handling_time"
VISCOSITY_THEN = "viscosity_at_handling_time"
VISCOSITY = "viscosity"
YIELDS = (KEY, VISCOSITY_THEN)


class HandlingConfig(Declared):
    """`[handling]` in `config/methods.toml`."""

    clean: tuple[str, ...] = Field(
        default=("none",),
        description="words in the columns `defect` and `limit` that say that there was none",
    )
    defects: tuple[str, ...] = Field(
        default=("dripping", "gap", "under-extrusion", "over-extrusion", "bulging", "no flow"),
        description="words that call it defective; any other word is refused",
    )
    max_gap_s: float = Field(
        default=7200.0,
        gt=0.0,
        description="time between the last clean and the first defective line that is flagged",
    )
    max_temperature_difference_K: float = Field(
        default=3.0,
        gt=0.0,
        description="by which the bed may differ from the viscometer's cup for the viscosity at "
        "the handling time to be told",
    )
