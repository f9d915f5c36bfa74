"""What one technique's file of the twin hands to the campaign."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from deamat.core.arrays import FloatArray
from deamat.core.quantity import Quantity
from deamat.twin.draws import Calibration
from deamat.twin.truth import TrueValue

# Said in every register row and every header that has room for it.
SYNTHETIC = "SYNTHETIC: simulated, not measured"


@dataclass(frozen=True, slots=True)
class SimulatedTest:
    """One simulated test on a machine, with the numbers that its file and its register row hold.

    Parameters
    ----------
    specimen, material, age : who was tested
    numbers : geometry as measured and settings, by SI name (`diameter_m`)
    time_s, displacement_m, force_N : as the machine recorded them, shape (n,) each
    truth : what this very specimen is, by property key, and what distorts its recording
    """

    specimen: str
    material: str
    age: str
    numbers: Mapping[str, Quantity]
    time_s: FloatArray
    displacement_m: FloatArray
    force_N: FloatArray
    truth: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Part:
    """One technique's share of a campaign.

    Parameters
    ----------
    technique : its folder in the campaign
    files : path relative to the campaign to content
    truth : the true values of its materials
    calibration : the errors that all its tests share
    specimens : specimen to its own truth
    """

    technique: str
    files: Mapping[str, bytes]
    truth: tuple[TrueValue, ...]
    calibration: Calibration
    specimens: Mapping[str, Mapping[str, float]]
