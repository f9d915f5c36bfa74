r"""What a change of rotor or speed tells of the calibration error.

An error d of the torque's zero, in its standard uncertainties, adds $d\,c_i$ to every reading, with
$c_i$ proportional to full scale: at a change of setting it makes a step that the liquid does not
make. A law that ignored it would grow terms to follow the step.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from deamat.core.records import Flag
from deamat.estimators.least_squares.linear import fit_linear
from deamat.techniques.viscosity.readings import Readings

# A step of more than so many standard uncertainties is not the calibration's.
_BELIEVABLE = 3.0


@dataclass(frozen=True, slots=True)
class Settled:
    """Readings less the error that their steps show, and with what is left of its uncertainty.

    Parameters
    ----------
    shift : d, in standard uncertainties of the calibration; 0 where nothing was seen
    left : standard uncertainty of d, 1 where nothing was seen
    """

    readings: Readings
    shift: float
    left: float
    flags: tuple[Flag, ...] = ()


def settled(readings: Readings, degree: int) -> Settled:
    r"""Estimate d beside a polynomial, with $d \sim N(0, 1)$ as one more observation.

    Parameters
    ----------
    degree : of a polynomial that is surely flexible enough for the liquid

    Source: JCGM 101:2008, 6.4 (prior knowledge as an observation).
    """
    one_setting = np.all(readings.rotor == readings.rotor[0]) and np.all(
        readings.speed_rpm == readings.speed_rpm[0]
    )
    if one_setting or not readings.of_full_scale or len(readings) < degree + 4:
        return Settled(readings, 0.0, 1.0)
    t = readings.time_s
    x = 2.0 * (t - t.min()) / (t.max() - t.min()) - 1.0
    terms = np.polynomial.chebyshev.chebvander(x, degree)
    design = np.zeros((len(t) + 1, degree + 2))
    design[:-1, :-1] = terms
    design[:-1, -1] = readings.calibration_Pas
    design[-1, -1] = 1.0
    fit = fit_linear(
        design, np.append(readings.viscosity_Pas, 0.0), np.append(readings.noise_Pas, 1.0), "known"
    )
    shift, left = float(fit.parameters[-1]), float(fit.standard_errors[-1])
    if abs(shift) > _BELIEVABLE:
        flag = Flag(
            "settings-disagree",
            f"readings before and after a change of rotor or speed disagree by {abs(shift):.1f} "
            "standard uncertainties of the calibration; nothing was corrected",
        )
        return Settled(readings, 0.0, 1.0, (flag,))
    better = replace(
        readings,
        viscosity_Pas=readings.viscosity_Pas - shift * readings.calibration_Pas,
        calibration_Pas=left * readings.calibration_Pas,
    )
    return Settled(better, shift, left)
