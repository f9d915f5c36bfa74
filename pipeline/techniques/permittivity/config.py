"""What a laboratory may decide about its permittivities: `[permittivity]` of `methods.toml`."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from deamat.core.declared import Declared

PERMITTIVITY = "relative_permittivity"
LOSS = "loss_tangent"
MODULUS = "compressive_modulus"
YIELDS = (PERMITTIVITY, LOSS)


class PermittivityConfig(Declared):
    """`[permittivity]` in `config/methods.toml`."""

    card_frequency_Hz: float = Field(
        default=10.0, gt=0, description="frequency of the value on the card"
    )
    frequency_tolerance: float = Field(
        default=0.01, gt=0, lt=0.5, description="a point this near (relative) is a measurement"
    )
    widest_gap_decades: float = Field(
        default=1.0, gt=0, description="widest gap between neighbours that is bridged in log f"
    )
    stated_frequencies_Hz: tuple[float, ...] = Field(
        default=(10.0, 100.0, 1e3, 1e4), description="where the dependence on f is stated"
    )
    repeat_tolerance: float = Field(
        default=0.002, gt=0, description="relative, within which repeated readings are the same"
    )
    max_drift: float = Field(
        default=0.05,
        gt=0,
        lt=1,
        description="relative, between sweeps or repeated readings, beyond which a film is refused",
    )
    max_step: float = Field(
        default=0.1, gt=0, lt=1, description="step of the capacitance beyond which it is refused"
    )
    widest_extrapolation_decades: float = Field(
        default=0.35, ge=0, description="how far neighbours stand in for an outlying end point"
    )
    polarisation_flag: float = Field(
        default=0.02,
        gt=0,
        description="rise by electrode polarisation, beyond the meter's limit, that is flagged",
    )
    max_polarisation: float = Field(
        default=0.05, gt=0, description="rise beyond which there is no value at that frequency"
    )
    polarisation_over: float = Field(
        default=0.01, gt=0, description="rise below which a higher frequency is sound"
    )
    min_points: int = Field(default=5, ge=4, description="fewest usable points of a sweep")
    level_V: float = Field(
        default=1.0, gt=0, description="test level where the file does not say it"
    )
    anvil_contact: Literal["slipping", "sticking"] = Field(
        default="slipping",
        description="how a film lies under the micrometer: slipping is the largest correction "
        "there can be, sticking nearly none",
    )
    u_micrometer_force: float = Field(
        default=0.05, ge=0, description="relative standard uncertainty of its force, shared; "
        "recalled (a ratchet repeats to some 10 %), not verified",
    )  # fmt: skip
    squeeze_flag: float = Field(
        default=0.05, gt=0, description="squeeze (strain) beyond which the modulus is extrapolated"
    )
    max_squeeze: float = Field(
        default=0.30, gt=0, lt=1, description="squeeze (strain) beyond which a film is refused"
    )
    min_aspect: float = Field(
        default=100.0, gt=0, description="sqrt(A)/d below which a film is flagged; Carpi 2015"
    )
    edge_field: Literal["none", "flush", "overhanging"] = Field(
        default="none",
        description="ASTM D150 correction for a film cut flush with the plates or larger than "
        "they are; none, as the register does not say which it is",
    )
    u_edge_field: float = Field(
        default=0.2, ge=0, description="relative standard uncertainty of that correction, shared"
    )
    u_stated_dimension: float = Field(
        default=0.02, ge=0, description="relative standard uncertainty of thickness and diameter "
        "where only a spectrometer's file states them, shared; a guess to be replaced",
    )  # fmt: skip
    edge_flag: float = Field(
        default=0.01, gt=0, description="uncorrected edge field that is flagged, relative"
    )
    series_loss_flag: float = Field(
        default=0.02, gt=0, description="loss at the top frequency by a resistance in series"
    )
    accuracy_flag: float = Field(
        default=0.05, gt=0, description="limit of error of the meter that is flagged, relative"
    )
