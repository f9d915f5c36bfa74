"""What a published law says of how it was chosen: the quartic where the noise allows, less else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from deamat.core.records import Summary
from deamat.techniques import viscosity
from deamat.techniques.viscosity.config import ViscosityConfig
from tests.techniques.viscosity.runs import CONTEXT, HOUR, newtonian, reduce

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
    law = viscosity.TECHNIQUE.summarise([measured], context).laws[0]
    degree = len(law.coefficients) - 1
    assert degree in degrees
    choice = str(law.diagnostics["choice"])
    assert choice.startswith(f"polynomial of degree {degree}: AICc ")
    assert choice in law.method
    assert {f"aicc polynomial of degree {d}" for d in range(5)} <= set(law.diagnostics)


def quartic_within(answer_within: float | None) -> Summary:
    config = ViscosityConfig(
        torque_window=(0.0, 1.0), laws=("polynomial",), answer_within=answer_within
    )
    context = replace(CONTEXT, config=config)
    return viscosity.TECHNIQUE.summarise(
        [reduce(newtonian(QUARTIC, TIMES, speed_rpm=1.5), context)], context
    )


@pytest.mark.parametrize(("answer_within", "degree"), [(None, 4), (0.003, 4), (0.05, 3)])
def test_a_tolerance_takes_the_cheapest_law_within_it(
    answer_within: float | None, degree: int
) -> None:
    law = quartic_within(answer_within).laws[0]
    assert len(law.coefficients) - 1 == degree
    tolerance_Pas = (answer_within or 0.003) * QUARTIC[TIMES <= 12 * HOUR].max()
    for hours in (1.0, 6.0, 12.0):
        assert (
            abs(law(hours * HOUR).value - np.interp(hours * HOUR, TIMES, QUARTIC)) < tolerance_Pas
        )


def test_it_says_what_a_finer_law_would_change() -> None:
    law = quartic_within(0.05).laws[0]
    said = str(law.diagnostics["choice"])
    assert said.startswith("polynomial of degree 3: expected error 1.37, within 3.79; ")
    assert "polynomial of degree 4 would change it by 1.32; " in said
    assert said.endswith("the data support polynomial of degree 4")
    assert said in law.method


def test_a_tolerance_that_no_law_meets_is_refused() -> None:
    found = quartic_within(1e-6)
    assert not found.laws
    assert found.refusals[0].reason == (
        "no law that the data support answers within 7.57e-05: the least expected error is 0.149; "
        "measure more points, or ask for less"
    )
