"""Forms of laws: their derivatives, their uncertainty, and what they refuse."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.errors import OutOfRange
from deamat.core.laws import FORMS, evaluate
from deamat.core.records import Law
from deamat.core.viscometer import SPEEDS_RPM, full_scale_Pas

POINTS = {
    "polynomial": ((2.0, -0.5, 0.3), (), None),
    "exponential": ((2.0, 0.2), (), None),
    "power-law-to-gel": ((2.0, 7.0, 1.3), (), None),
    "arrhenius": ((2.0, 9.0), (), None),
    "power-law-fluid": ((5.0, 1.5, 0.4, -0.01), (2, 2), 0.27),
}


def law(kind: str, dof: float | None = None, covariance_of: float = 0.01) -> Law:
    coefficients, parts, rate = POINTS[kind]
    p = len(coefficients)
    covariance = covariance_of * (np.eye(p) + 0.2)
    return Law(
        key="viscosity", material="m", campaign="c", kind=kind, unit="Pa.s",
        argument="time since mixing", argument_unit="s", coefficients=coefficients,
        covariance=tuple(tuple(row) for row in covariance.tolist()), valid=(1.0, 5.0),
        conditions={}, method="test", parts=parts,
        rates=None if rate is None else (0.1, 1.0), degrees_of_freedom=dof,
    )  # fmt: skip


@pytest.mark.parametrize("kind", sorted(FORMS))
def test_derivatives_are_those_of_the_value(kind: str) -> None:
    coefficients, parts, rate = POINTS[kind]
    c = np.array(coefficients)
    for x in (1.0, 3.3, 5.0):
        slopes = evaluate(kind, c, parts, x, rate)[1]
        for i, slope in enumerate(slopes):
            step = np.zeros(len(c))
            step[i] = 1e-6
            up, down = (evaluate(kind, c + s, parts, x, rate)[0] for s in (step, -step))
            assert slope == pytest.approx((up - down) / 2e-6, rel=1e-6)


@pytest.mark.parametrize("kind", sorted(FORMS))
def test_the_uncertainty_is_that_of_drawn_coefficients(kind: str) -> None:
    coefficients, parts, rate = POINTS[kind]
    asked = law(kind, covariance_of=1e-6)
    found = asked(3.0, rate)
    rng = np.random.default_rng(1)
    drawn = rng.multivariate_normal(coefficients, np.array(asked.covariance), 4000)
    values = [evaluate(kind, c, parts, 3.0, rate)[0] for c in drawn]
    assert found.standard_uncertainty == pytest.approx(np.std(values), rel=0.05)


def test_intervals_widen_with_few_degrees_of_freedom() -> None:
    known, few = law("polynomial").ci95(2.0), law("polynomial", dof=2.0).ci95(2.0)
    u = law("polynomial")(2.0).standard_uncertainty
    assert known[1] - known[0] == pytest.approx(2 * 1.95996 * u, rel=1e-5)
    assert few[1] - few[0] == pytest.approx(2 * 4.30265 * u, rel=1e-5)


def test_a_law_of_a_fluid_needs_a_rate_and_others_refuse_one() -> None:
    with pytest.raises(OutOfRange) as caught:
        law("power-law-fluid")(2.0, 2.0)
    assert str(caught.value) == (
        "viscosity of m is known for shear rates from 0.1 to 1 1/s, not at 2"
    )
    with pytest.raises(OutOfRange) as caught:
        law("exponential")(2.0, 0.5)
    assert str(caught.value) == "viscosity of m is a law without a shear rate"
    with pytest.raises(ValueError, match="a shear rate and two polynomials"):
        evaluate("power-law-fluid", np.ones(3), (1, 2), 1.0)


def test_full_scales_are_those_of_the_instrument() -> None:
    found = {rotor: [round(1e3 * full_scale_Pas(rotor, s)) for s in SPEEDS_RPM] for rotor in (1, 4)}
    assert found == {
        1: [20000, 10000, 4000, 2000, 1000, 500, 200, 100],
        4: [2000000, 1000000, 400000, 200000, 100000, 50000, 20000, 10000],
    }
    with pytest.raises(OutOfRange, match="an NDJ-8S has rotors 1 to 4, not 5"):
        full_scale_Pas(5, 3.0)
