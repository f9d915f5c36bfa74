"""What a number of a register may be: beyond it a row is wrong, or at least unusual."""

from __future__ import annotations

# By SI name: what is possible at all, and what laboratories of soft elastomers usually have.
_TABLE: dict[str, tuple[tuple[float, float], tuple[float, float]]] = {
    "diameter_m": ((1e-4, 1.0), (1e-3, 0.2)),
    "height_m": ((1e-8, 1.0), (1e-6, 0.2)),
    "width_m": ((1e-5, 1.0), (5e-4, 0.1)),
    "thickness_m": ((1e-8, 0.1), (1e-6, 0.02)),
    "gauge_length_m": ((1e-4, 2.0), (2e-3, 0.5)),
    "anvil_diameter_m": ((1e-4, 0.2), (1e-3, 0.1)),
    "plate_length_m": ((1e-4, 1.0), (2e-3, 0.3)),
    "plate_width_m": ((1e-4, 1.0), (2e-3, 0.3)),
    "electrode_area_m2": ((1e-10, 1.0), (1e-8, 0.1)),
    "tip_radius_m": ((1e-9, 0.05), (5e-9, 0.02)),
    "speed_m_per_s": ((1e-10, 20.0), (1e-7, 0.2)),
    "temperature_K": ((73.15, 673.15), (223.15, 423.15)),
    "bed_temperature_K": ((223.15, 673.15), (273.15, 473.15)),
    "humidity": ((0.0, 1.0), (0.01, 1.0)),
    "micrometer_force_N": ((0.0, 200.0), (0.0, 30.0)),
    "breakdown_voltage_V": ((1.0, 1e6), (10.0, 2e5)),
    "breakdown_field_V_per_m": ((1e4, 1e11), (1e6, 1e10)),
    "rate_V_per_s": ((1e-3, 1e7), (0.1, 1e5)),
    "mass_kg": ((1e-7, 1e3), (1e-5, 10.0)),
}


def possible(name: str) -> tuple[float, float] | None:
    """Give the range beyond which a number of this SI name is an error; None without one."""
    return _TABLE[name][0] if name in _TABLE else None


def usual(name: str) -> tuple[float, float] | None:
    """Give the range beyond which a number of this SI name is flagged; None without one."""
    return _TABLE[name][1] if name in _TABLE else None
