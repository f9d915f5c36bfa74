"""`[viscosity]` in `config/methods.toml`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from pydantic import Field, model_validator

from deamat.core.declared import Declared

VISCOSITY = "viscosity"
AGAINST_TEMPERATURE = "viscosity_against_temperature"
AT_PRINTING_RATE = "viscosity_at_printing_rate"
DOUBLING = "viscosity_doubling_time"
LIMIT = "time_to_viscosity_limit"
CONSISTENCY = "flow_consistency"
CONSISTENCY_WIDE_CUP = "flow_consistency_wide_cup"
INDEX = "flow_index"
YIELDS = (
    VISCOSITY,
    AGAINST_TEMPERATURE,
    AT_PRINTING_RATE,
    DOUBLING,
    LIMIT,
    CONSISTENCY,
    INDEX,
    CONSISTENCY_WIDE_CUP,
)
# Refused by name where a run gives nothing; the others are only asked of some liquids.
ALWAYS = (VISCOSITY, DOUBLING)
ALWAYS_OF_FLOW_CURVES = (VISCOSITY, CONSISTENCY, INDEX)


class RateFactor(Declared):
    """Nominal shear rate per speed of one rotor, and where it is from."""

    per_s_per_rpm: float = Field(gt=0, description="nominal shear rate over speed")
    source: str = Field(min_length=3, description="who says so")


_PAPER = RateFactor(
    per_s_per_rpm=0.09,
    source="Sikulskyi et al. 2022: about 0.27 1/s at 3 rpm (rotor not said; the wall of a cylinder "
    "in a wide cup would give 0.63)",
)


class ActivationEnergy(Declared):
    """Activation energy of flow of the laboratory's liquids, and where it is from."""

    J_per_mol: float = Field(gt=0, description="E in exp(E / R T)")
    u_J_per_mol: float = Field(ge=0, description="its standard uncertainty")
    source: str = Field(min_length=3, description="who says so")


class ViscosityConfig(Declared):
    """What the room of viscosity asks of a run, and what it reports."""

    window_s: tuple[float, float] = Field(
        default=(3600.0, 43200.0), description="time since mixing over which a law is fitted"
    )
    torque_window: tuple[float, float] = Field(
        default=(0.10, 1.0), description="fraction of full torque within which a reading counts"
    )
    run_s: tuple[float, float] = Field(
        default=(60.0, 604800.0),
        description="how long after mixing a run may end; outside, its time is in another unit",
    )
    min_readings: int = Field(default=8, ge=4, description="fewest readings a law is fitted to")
    laws: tuple[Literal["polynomial", "exponential", "power-law-to-gel"], ...] = Field(
        default=("polynomial", "exponential", "power-law-to-gel"),
        min_length=1,
        description="laws of a Newtonian liquid on offer",
    )
    max_degree: int = Field(default=5, ge=1, le=7, description="highest polynomial on offer")
    max_relative_error: float = Field(
        default=0.15, gt=0, description="root mean square of residual over law, refused beyond"
    )
    answer_within: float | None = Field(
        default=None,
        gt=0,
        description="expected error of viscosity at stated times, as a fraction of the greatest "
        "reading, that will do: the cheapest law within it is taken; None takes the law that the "
        "data support",
    )
    reading_noise: float = Field(
        default=0.03, gt=0, description="fraction of the reading, where a file states no full scale"
    )
    reading_calibration: float = Field(
        default=0.03,
        ge=0,
        description="standard uncertainty of the instrument that all readings share, fraction of "
        "the reading, where a file states no full scale",
    )
    temperature_drift_K: float = Field(
        default=0.5, gt=0, description="change of temperature within a run that is let pass"
    )
    temperature_tolerance_K: float = Field(
        default=1.0, gt=0, description="difference between runs or sweeps at one temperature"
    )
    activation_energy: ActivationEnergy | None = Field(
        default=None, description="of flow; None fits it where the temperature moves to and fro"
    )
    printing_rate_per_s: float | None = Field(
        default=95.0, gt=0, description="shear rate at which liquids are printed; None asks nothing"
    )
    printing_rate_source: str = Field(
        default="Sikulskyi et al. 2022, section 3.2, estimated for Sylgard 182 while it is printed",
        min_length=3,
        description="who says so",
    )
    extrapolation_decades: float = Field(
        default=3.0,
        ge=0,
        description="how far beyond the measured shear rates a power law is trusted, flagged",
    )
    u_index_beyond: float = Field(
        default=0.05,
        ge=0,
        description="standard uncertainty of n beyond the measured shear rates, for a power law "
        "that bends there",
    )
    max_stress_contradiction: float = Field(
        default=0.05,
        gt=0,
        description="by how much stress over rate may differ from the viscosity of a flow curve",
    )
    max_sweep_drift: float = Field(
        default=0.1,
        gt=0,
        description="difference between flow curves in one file beyond which they are no repeats",
    )
    stated_times_s: tuple[float, ...] = Field(
        default=(3600.0, 21600.0, 43200.0), description="times since mixing that are recorded"
    )
    limit_viscosity_Pas: float | None = Field(
        default=None, gt=0, description="viscosity whose time is asked for; None asks for none"
    )
    sweep_gap_s: float = Field(
        default=300.0, gt=0, description="longest pause between the speeds of one sweep"
    )
    min_sweeps: int = Field(
        default=8, ge=5, description="fewest sweeps of two speeds for a power-law fluid"
    )
    max_contradicting: float = Field(
        default=0.2, ge=0, le=1, description="part of contradicting readings that voids a run"
    )
    rate_factors: Mapping[str, RateFactor] = Field(
        default={"3": _PAPER, "4": _PAPER}, description="nominal shear rates by rotor"
    )

    @model_validator(mode="after")
    def _ordered(self) -> ViscosityConfig:
        for name in ("window_s", "torque_window", "run_s"):
            low, high = getattr(self, name)
            if not 0 <= low < high:
                raise ValueError(f"{name} must rise from 0 or more, not {low:g} to {high:g}")
        return self
