"""What a published law says of how it was chosen: the quartic where the noise allows, less else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from pipeline.techniques import viscosity
from pipeline.techniques.viscosity.config import ViscosityConfig
from tests.techniques.runs import CONTEXT, HOUR, newtonian, reduce

TIMES = np.arange(0.25, 13.01, 0.25) * HOUR
# Sylgard 184 (10:1), Sikulskyi et al. 2022, Table 2.
QUARTIC = np.asarray(
    np.polynomial.polynomial.polyval(TIMES / HOUR, [2.5, 0.493, 0.207, -0.0674, 0.00743]),
    np.float64,
)


@pytest.mark.parametrize(("noise", "degrees"), [(0.0, {4}), (0.1, {2, 3})])
def test_a_law_says_which_order_was_taken_and_what_the_others_scored(
    noise: float, degrees: set[int]
) -> None:
    config = ViscosityConfig(torque_window=(0.0, 1.0), laws=("polynomial",))
    context = replace(CONTEXT, config=config)
    rng = np.random.default_rng(5)
    scattered = QUARTIC * np.exp(noise * rng.normal(size=len(TIMES)))
    measured = reduce(newtonian(scattered, TIMES, speed_rpm=1.5), context)
    law = viscosity.summarise([measured], context).laws[0]
    degree = len(law.coefficients) - 1
    assert degree in degrees
    choice = str(law.diagnostics["choice"])
    assert choice.startswith(f"polynomial of degree {degree}: AICc ")
    assert choice in law.method
    assert {f"aicc polynomial of degree {d}" for d in range(5)} <= set(law.diagnostics)
