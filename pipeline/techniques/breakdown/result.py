"""What is made of one film that was tested for breakdown."""

from __future__ import annotations

from dataclasses import dataclass

from deamat.core.arrays import FloatArray
from deamat.techniques.breakdown.ramp import End
from deamat.techniques.breakdown.rise import Steps


@dataclass(frozen=True, slots=True)
class Ramp:
    """The recorded ramp, its polarity made positive.

    Parameters
    ----------
    time_s, voltage_V, current_A : shape (n,) each; no current where it was not recorded
    end : what ended it
    duration_s, rate_V_per_s : from its start to the greatest voltage
    steps : of a step-by-step test, None for a ramp
    """

    time_s: FloatArray
    voltage_V: FloatArray
    current_A: FloatArray | None
    end: End
    duration_s: float
    rate_V_per_s: float
    steps: Steps | None = None


@dataclass(frozen=True, slots=True)
class FilmTest:
    """A film that broke, or bore its greatest field unbroken.

    Parameters
    ----------
    censored : it did not break
    sure : False where the log does not tell whether it broke
    thickness_m : None where the register gives the field itself
    ramp : None where the register gives voltage or field
    """

    censored: bool
    thickness_m: float | None
    ramp: Ramp | None
    sure: bool = True

    @property
    def columns(self) -> dict[str, FloatArray]:
        """The ramp, if there is one."""
        if self.ramp is None:
            return {}
        columns = {"time_s": self.ramp.time_s, "voltage_V": self.ramp.voltage_V}
        if self.ramp.current_A is not None:
            columns["current_A"] = self.ramp.current_A
        return columns
