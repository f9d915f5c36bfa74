"""Uncertainty of a design: first order against Monte Carlo, tornado, next best test."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise

import numpy as np
import pytest
from scipy.special import ndtr

from deamat.actuator.inputs import Input
from deamat.actuator.limits import Allowed
from deamat.actuator.model import respond
from deamat.actuator.next_test import next_tests, plan
from deamat.actuator.ranges import Reals
from deamat.actuator.strain import pull_in_voltage
from deamat.actuator.uncertainty import first_order, monte_carlo, tornado
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.core.quantity import Contribution

from .test_strip import STRIP

PULL_IN_V = float(np.asarray(pull_in_voltage(500e-6, 1e5, 2.6)))


def inputs(relative: float, shared: float = 0.0) -> tuple[Input, ...]:
    """Inputs of STRIP with one relative uncertainty; moduli share a calibration."""
    listed = []
    for name, field, value, test in (
        ("film modulus", "film_modulus_Pa", 1e5, "compression of soft"),
        ("passive modulus", "passive_modulus_Pa", 1e6, "compression of stiff"),
        ("permittivity", "relative_permittivity", 2.6, "permittivity of soft"),
        ("film thickness", "film_thickness_m", 500e-6, None),
        ("electrode thickness", "electrode_thickness_m", 10e-6, None),
    ):
        own = Contribution(f"scatter of {name}", relative * value, test is None)
        cell = Contribution("load cell", shared * value, True)
        budget = (own, cell) if shared and "modulus" in name else (own,)
        listed.append(Input(name, (field,), value, "", budget, test, 4 if test else 0))
    return tuple(listed)


def linear(values: Mapping[str, FloatArray]) -> Reals:
    return 2.0 * values["film_modulus_Pa"] - 0.1 * values["passive_modulus_Pa"]


def test_a_shared_error_adds_up_before_it_is_squared() -> None:
    two = inputs(0.01, shared=0.02)[:2]
    # 2 x 1e5 against 0.1 x 1e6: the shared parts 4000 and -2000 partly cancel
    expected = math.sqrt(2000.0**2 + 1000.0**2 + (4000.0 - 2000.0) ** 2)
    found = first_order(two, linear)
    assert found.u == pytest.approx(expected, rel=1e-6)
    assert found.asymmetry < 1e-6
    assert monte_carlo(two, linear).sd == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("shared", [0.0, 0.03])
@pytest.mark.parametrize("relative", [0.005, 0.02, 0.05, 0.1])
@pytest.mark.parametrize("part", [0.1, 0.5, 0.8, 0.9, 0.97, 0.99])
def test_both_ways_agree_within_5_percent_where_first_order_holds(
    part: float, relative: float, shared: float
) -> None:
    uncertain = inputs(relative, shared)
    response = respond(STRIP, part * PULL_IN_V)
    found = first_order(uncertain, response)
    if found.holds:
        drawn = monte_carlo(uncertain, response)
        assert drawn.sd == pytest.approx(found.u, rel=0.05)
    # far from pull-in and with the uncertainties of good cards it must hold
    assert found.holds or relative > 0.02 or shared > 0.0 or part > 0.8


def test_at_the_breakdown_limit_the_strength_counts_twice() -> None:
    """The film is driven to a field, and the strain goes with its square: u doubles."""
    allowed = Allowed(0.01, 1.0)
    strength = Input(
        "strength", ("breakdown_strength_V_m",), 20e6, "V/m", (Contribution("fit", 2e5, False),)
    )
    response = respond(STRIP, allowed)
    bar = tornado([strength], first_order([strength], response), response)[0]
    assert bar.elasticity == pytest.approx(2.0, abs=0.2)  # and a little for the thinner film


def test_draws_that_pull_in_are_counted() -> None:
    """V_pi goes with sqrt(Y): with ln(Y) normal, the lost part is a normal probability."""
    modulus = Input("Y", ("film_modulus_Pa",), 1e5, "Pa", (Contribution("s", 5e3, False),))
    found = monte_carlo([modulus], respond(STRIP, 0.97 * PULL_IN_V), draws=50_000)
    sigma = math.sqrt(math.log1p(0.05**2))
    expected = float(ndtr((2 * math.log(0.97) + 0.5 * sigma**2) / sigma))
    assert found.pull_in_probability == pytest.approx(expected, rel=0.04)
    assert not first_order([modulus], respond(STRIP, 0.97 * PULL_IN_V)).holds


def test_a_film_at_pull_in_is_refused() -> None:
    with pytest.raises(FitRefused, match="the film is at pull-in: lower the voltage"):
        first_order(inputs(0.01), respond(STRIP, PULL_IN_V * (1 - 1e-9)))
    with pytest.raises(FitRefused, match=r"\d\d % of 20000 draws pull in: lower the voltage"):
        monte_carlo(inputs(0.02), respond(STRIP, 1.02 * PULL_IN_V))


def test_the_tornado_has_the_widest_bar_on_top_and_the_unknown_ones_below() -> None:
    unknown = Input("Poisson's ratio", ("poisson_ratio",), 0.49, "1", ())
    response, listed = respond(STRIP, 0.5 * PULL_IN_V), [unknown, *inputs(0.02)]
    bars = tornado(listed, first_order(listed, response), response)
    assert bars[0].name == "film thickness"
    assert [b.u for b in bars] == sorted((b.u for b in bars), reverse=True)
    assert bars[-1].name == "Poisson's ratio"
    assert bars[-1].elasticity == pytest.approx(1.0, rel=1e-6)
    assert (bars[-1].low, bars[-1].declared) == (bars[-1].high, False)
    total = math.sqrt(sum(b.u**2 for b in bars))
    uncertain = first_order(inputs(0.02), respond(STRIP, 0.5 * PULL_IN_V))
    assert uncertain.u == pytest.approx(total, rel=1e-6)  # nothing shared here


def test_the_next_specimen_narrows_only_what_is_independent() -> None:
    uncertain = inputs(0.02, shared=0.03)
    now = first_order(uncertain, respond(STRIP, 0.5 * PULL_IN_V))
    ranked = next_tests(uncertain, now, further=12)
    assert ranked[0].test == "permittivity of soft"
    assert [t.u_then for t in ranked] == sorted(t.u_then for t in ranked)
    slope = dict(zip([x.name for x in uncertain], now.gradient, strict=True))
    film = next(t for t in ranked if t.test == "compression of soft")
    # 4 specimens become 16: half of the scatter goes, the load cell and all else stay
    gone = (slope["film modulus"] * 0.02 * 1e5) ** 2
    assert film.u_then**2 == pytest.approx(now.u**2 - 0.75 * gone, rel=1e-9)
    assert film.u_best**2 == pytest.approx(now.u**2 - gone, rel=1e-9)


def test_the_plan_takes_one_specimen_at_a_time_where_it_is_worth_most() -> None:
    uncertain = inputs(0.02)
    now = first_order(uncertain, respond(STRIP, 0.5 * PULL_IN_V))
    steps = plan(uncertain, now, 12)
    assert steps[0] == next_tests(uncertain, now)[0]
    assert all(a.u_then == b.u_now for a, b in pairwise(steps))
    assert {s.test for s in steps} > {"permittivity of soft"}  # its value falls as its n grows
    counts = [s.n for s in steps if s.test == "permittivity of soft"]
    assert counts == list(range(4, 4 + len(counts)))
