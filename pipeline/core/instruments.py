"""`config/instruments.toml`: what is declared of machines and gauges."""

from __future__ import annotations

import re
from collections.abc import Mapping

from pydantic import BaseModel, ConfigDict, Field


class Declared(BaseModel):
    """Base of every configuration section: unknown keys are errors, values never change."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Gauge(Declared):
    """Standard uncertainties of a length where its register has no `u_` column."""

    u_reading_m: float = Field(default=1e-5, ge=0, description="repeatability, one per specimen")
    u_calibration_m: float = Field(default=1e-5, ge=0, description="shared by all specimens")


class Machine(Declared):
    """What the numbers of a testing machine are good for (relative ones are 1 sigma)."""

    match: str = Field(default="", description="regular expression on the register's instrument")
    force_resolution_N: float = Field(default=0.0, ge=0)
    u_force_calibration: float = Field(default=0.005, ge=0, description="relative, shared")
    u_displacement_calibration: float = Field(default=0.002, ge=0, description="relative, shared")
    source: str = "defaults: an ISO 7500-1 class 1 machine"


class Instruments(Declared):
    """`config/instruments.toml`: machines by name, gauges by register column."""

    machines: Mapping[str, Machine] = Field(default_factory=dict)
    gauges: Mapping[str, Gauge] = Field(default_factory=dict)

    def machine(self, instrument: str) -> tuple[str, Machine]:
        """Find the machine that a register's `instrument` names; the class defaults otherwise."""
        for name, machine in self.machines.items():
            if machine.match and re.search(machine.match, instrument):
                return name, machine
        return "default", Machine()
