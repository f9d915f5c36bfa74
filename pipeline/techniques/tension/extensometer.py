"""The strain of an extensometer, which takes the place of the crosshead's where there is one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.instruments import Machine
from deamat.core.quantity import Contribution
from deamat.core.records import Flag
from deamat.techniques.shared.stress_strain import StressStrain
from deamat.techniques.tension.config import TensionConfig

_STILL = 0.3  # of the usual ratio to the crosshead: an extensometer that follows less was taken off
_CALIBRATION = Machine().u_displacement_calibration


def by_extensometer(curve: StressStrain, config: TensionConfig) -> StressStrain:
    """Take strain from the extensometer, and say what the crosshead would have said.

    Grips and shoulders give way: the crosshead over the gauge length says more strain than the
    strip has.

    Raises
    ------
    FitRefused : the extensometer stops following before the strip ends
    """
    if curve.extensometer is None:
        return curve
    strain = curve.extensometer - curve.extensometer[curve.first]
    crosshead = curve.nominal_strain
    loaded = slice(curve.first, int(curve.nominal_stress_Pa.argmax()) + 1)
    ratio = _ratio(strain[loaded], crosshead[loaded])
    if ratio < 0.0:
        strain, ratio = -strain, -ratio
    tail = max((loaded.stop - loaded.start) // 20, 3)
    late = slice(max(loaded.stop - tail, loaded.start), loaded.stop)
    if _ratio(strain[late], crosshead[late]) < _STILL * ratio:
        raise FitRefused(
            "the extensometer stops following the crosshead before the greatest load: it ran out "
            "of travel, was taken off or slipped; export it up to there, or without it"
        )
    flags = curve.flags
    if abs(ratio - 1.0) > config.own_columns_tolerance:
        flags += (
            Flag(
                "extensometer",
                f"strain is the extensometer's; the crosshead over the gauge length says "
                f"{1.0 / ratio:.4g} times as much, with which the modulus would be "
                f"{100.0 * ratio:.4g} % of this one",
            ),
        )
    return replace(
        curve,
        nominal_strain=strain,
        strain_budget=(Contribution("extensometer calibration", _CALIBRATION, shared=True),),
        basis="force over the register's cross-section, strain of the extensometer",
        own=None if curve.own is None else (None, curve.own[1]),
        flags=flags,
    )


def _ratio(strain: FloatArray, crosshead: FloatArray) -> float:
    """Least-squares slope of the extensometer's strain against the crosshead's."""
    x = crosshead - crosshead.mean()
    spread = float(x @ x)
    return float(x @ (strain - np.mean(strain))) / spread if spread > 0.0 else 0.0
