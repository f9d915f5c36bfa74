"""A dropped reading in a compression curve is said, not removed."""

from __future__ import annotations

import numpy as np

from deamat.techniques.compression import TECHNIQUE
from tests.techniques.curves import CYLINDER, reduce


def test_dropped_readings_are_flagged_on_the_modulus() -> None:
    strain = np.linspace(0.0, 0.06, 121)
    force = 1e6 * strain * np.pi * 0.025**2
    force *= 1.0 + 1e-3 * np.random.default_rng(4).standard_normal(121)
    sound = reduce(TECHNIQUE, CYLINDER, {"displacement_m": 0.03 * strain, "force_N": force})
    assert all(f.name != "outlying-readings" for v in sound.values for f in v.flags)
    dropped = force.copy()
    dropped[60:62] *= 0.5  # one alone is a wild reading
    said = reduce(TECHNIQUE, CYLINDER, {"displacement_m": 0.03 * strain, "force_N": dropped})
    (flag,) = (f for f in said.values[0].flags if f.name == "outlying-readings")
    assert flag.detail == (
        "2 of 101 readings lie more than 6 standard deviations of the majority off the line, the "
        "first at 3 % strain; they pull the slope"
    )
