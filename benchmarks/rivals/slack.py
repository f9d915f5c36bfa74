"""Other ways to the modulus of a strip that hung loose, for charts of what they lose.

No card is made from these. Each takes strain and stress of one loading, shape (n,), and the width
of the window, and gives a slope behind the slack with a nominal 95 % interval.
"""

from __future__ import annotations

import numpy as np

from benchmarks.rivals.slope import Slope
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.curves.slope import fit_line
from deamat.estimators.curves.stress_strain import bin_slopes, zero_of_tangent
from deamat.estimators.mean import coverage_factor

_PRELOAD = 0.02  # of the greatest stress: the usual preload from which a machine counts strain
_BIN = 0.2  # of the window


def plain(strain: FloatArray, stress: FloatArray, window: float) -> Slope:
    """Take the window of strain as recorded."""
    return _line(strain, stress, 0.0, window)


def from_preload(strain: FloatArray, stress: FloatArray, window: float) -> Slope:
    """Count strain from where the stress first passes a preload, as machines are told to."""
    over = int(np.argmax(stress >= _PRELOAD * stress.max()))
    return _line(strain, stress, float(strain[over]), window)


def from_tangent(strain: FloatArray, stress: FloatArray, window: float) -> Slope:
    """Count strain from the zero of the tangent to the steepest bin (ASTM D638, annex A1)."""
    inside = strain <= 3.0 * window
    bins = bin_slopes(strain[inside], stress[inside], 0.0, 3.0 * window, _BIN * window)
    return _line(strain, stress, max(zero_of_tangent(bins), 0.0), window)


def _line(strain: FloatArray, stress: FloatArray, zero: float, window: float) -> Slope:
    inside = (strain >= zero) & (strain <= zero + window)
    if inside.sum() < 5:
        raise FitRefused("fewer than five samples in the window")
    line = fit_line(strain[inside], stress[inside])
    half = coverage_factor(line.degrees_of_freedom) * line.standard_error
    return Slope(line.slope, line.slope - half, line.slope + half)
