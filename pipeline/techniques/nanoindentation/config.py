"""What a laboratory may decide about its indentations: `[nanoindentation]`."""

from __future__ import annotations

from pydantic import Field

from deamat.core.declared import Declared

MODULUS = "indentation_modulus"
YIELDS = (MODULUS,)
IDEAL_BERKOVICH = (24.5,)  # 3 sqrt(3) tan^2(65.27 degrees)


class NanoindentationConfig(Declared):
    """`[nanoindentation]` in `config/methods.toml`."""

    poisson_ratio: float = Field(
        default=0.49, ge=0.0, le=0.5, description="of the specimen, to come from E* to E"
    )
    u_poisson_ratio: float = Field(
        default=0.005, ge=0.0, description="standard uncertainty, shared by all specimens"
    )
    loading_end: float = Field(
        default=0.95, gt=0.0, le=1.0, description="part of the peak load where the loading ends"
    )
    min_air_samples: int = Field(
        default=10, ge=3, description="fewest samples before the contact point"
    )
    min_contact_samples: int = Field(
        default=20, ge=5, description="fewest samples of the loading, and of the unloading"
    )
    min_signal_to_noise: float = Field(
        default=20.0, gt=0.0, description="least rise of the load over its noise"
    )
    max_relative_uncertainty: float = Field(
        default=0.1, gt=0.0, description="of the fitted stiffness; beyond it there is no value"
    )
    max_part_of_height: float = Field(
        default=0.1, gt=0.0, description="depth or contact radius over height that is flagged"
    )
    max_part_of_radius: float = Field(
        default=0.1, gt=0.0, description="depth over radius of a sphere that is flagged"
    )
    u_tilt_N_per_m: float = Field(
        default=0.3,
        ge=0.0,
        description="standard uncertainty of the load's tilt where no air shows it: what springs "
        "of a transducer leave uncompensated; declared, not measured",
    )
    least_pull: float = Field(
        default=0.01, gt=0.0, description="pull-off over peak load that is corrected for"
    )
    reach_of_adhesion_m: float = Field(
        default=3e-10, gt=0.0, description="z_0 of Tabor's parameter: the distance of atoms"
    )
    max_disagreement: float = Field(
        default=0.05,
        gt=0.0,
        description="between moduli of loading and unloading, beyond what adhesion explains",
    )
    tip_modulus_Pa: float = Field(
        default=1.141e12, gt=0.0, description="of diamond; only to say when a tip is not rigid"
    )
    tip_poisson_ratio: float = Field(default=0.07, ge=0.0, le=0.5, description="of diamond")
    max_tip_compliance: float = Field(
        default=0.01, gt=0.0, description="part of the modulus due to the tip that is flagged"
    )
    unloading: tuple[float, float] = Field(
        default=(0.4, 0.95), description="parts of the peak load between which it is fitted"
    )
    first_loading: float = Field(
        default=0.2, gt=0.0, le=1.0, description="part of a pyramid's load that finds its contact"
    )
    area_function: tuple[float, ...] = Field(
        default=IDEAL_BERKOVICH,
        min_length=1,
        description="coefficients of h_c^2, h_c, h_c^(1/2), h_c^(1/4)... of a Berkovich tip, in m",
    )
    u_area: float = Field(
        default=0.02, ge=0.0, description="of the area function, relative, shared"
    )
    beta: float = Field(default=1.034, gt=0.0, description="pyramid against cone")
    u_beta: float = Field(default=0.015, ge=0.0, description="of beta, relative, shared")
    epsilon: float = Field(default=0.75, gt=0.0, le=1.0, description="of the depth of contact")
