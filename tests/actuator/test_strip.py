"""The designer's strip: the general beam in closed form, and how far its voltage may go."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from deamat.actuator.beam import actuate as beam_under_voltage
from deamat.actuator.declared import Geometry
from deamat.actuator.limits import Allowed, breakdown_field, failure_probability, voltage_limits
from deamat.actuator.model import actuate, best_passive, blocked_force
from deamat.actuator.ranges import Reals
from deamat.actuator.stack import Layer, Role, Stack
from deamat.actuator.strain import pull_in_voltage
from deamat.actuator.strip import Strip
from deamat.core.errors import MissingProperty, OutOfRange

STRIP = Strip(
    film_modulus_Pa=1e5,
    relative_permittivity=2.6,
    poisson_ratio=0.49,
    film_thickness_m=500e-6,
    passive_modulus_Pa=1e6,
    passive_thickness_m=200e-6,
    electrode_modulus_Pa=3.5e6,
    electrode_thickness_m=10e-6,
    in_plane="poisson",
    breakdown_strength_V_m=20e6,
    weibull_shape=8.0,
)
ALLOWED = Allowed(0.01, 0.9)
SIZE = Geometry(length_mm=50.0, width_mm=10.0, source="made up")


def curvature(strip: Strip, voltage_V: Reals) -> Reals:
    return actuate(strip, voltage_V).curvature_per_m


def chance(strip: Strip, voltage_V: Reals) -> Reals:
    return actuate(strip, voltage_V).failure_probability()


def stack() -> Stack:
    def layer(role: Role, thickness_m: float, modulus_Pa: float) -> Layer:
        return Layer(role, thickness_m, modulus_Pa, 0.01, 1000.0, 2.6, 0.49)

    electrode = layer("electrode", 10e-6, 3.5e6)
    return Stack((layer("passive", 200e-6, 1e6), electrode, layer("de", 500e-6, 1e5), electrode))


@pytest.mark.parametrize("voltage_V", [100.0, 6400.0, 12_000.0])
def test_it_is_the_general_beam(voltage_V: float) -> None:
    beam = beam_under_voltage(stack(), voltage_V, "poisson")
    assert curvature(STRIP, voltage_V) == pytest.approx(beam.curvature_per_m, rel=1e-13)
    force = 1.5 * beam.bending_stiffness_N_m2 * beam.curvature_per_m / 0.05
    assert blocked_force(actuate(STRIP, voltage_V), SIZE) == pytest.approx(force, rel=1e-13)


def test_the_best_passive_layer_is_the_best_one_of_the_thinned_film() -> None:
    best = float(best_passive(STRIP, 12_000.0))
    around = replace(STRIP, passive_thickness_m=best * np.array([0.98, 1.0, 1.02]))
    bent = np.asarray(curvature(around, 12_000.0))
    assert bent.argmax() == 1
    made = float(best_passive(STRIP, 1.0))
    assert curvature(replace(STRIP, passive_thickness_m=made), 12_000.0) < bent[1]


def test_the_limit_is_the_allowed_fraction_of_the_films() -> None:
    limits = voltage_limits(STRIP, ALLOWED)
    voltage = float(limits.highest_V)
    assert limits.breakdown_V is not None
    assert voltage == limits.breakdown_V < limits.pull_in_V
    field = actuate(STRIP, voltage).true_field_V_m
    assert field == pytest.approx(breakdown_field(STRIP, ALLOWED), rel=1e-9)
    assert chance(STRIP, voltage) == pytest.approx(0.01, rel=1e-9)


def test_a_tough_film_pulls_in_first() -> None:
    tough = replace(STRIP, breakdown_strength_V_m=200e6)
    limits = voltage_limits(tough, ALLOWED)
    assert limits.breakdown_V == np.inf
    limit = 0.9 * pull_in_voltage(500e-6, 1e5, 2.6)
    assert limits.highest_V == pytest.approx(limit, rel=1e-15)
    assert chance(tough, limit / 0.9 * 1.001) == 1.0


def test_limits_of_many_strips_are_those_of_each() -> None:
    moduli = np.array([5e4, 1e5, 2e5])
    together = np.asarray(voltage_limits(replace(STRIP, film_modulus_Pa=moduli), ALLOWED).highest_V)
    for modulus, highest in zip(moduli.tolist(), together.tolist(), strict=True):
        alone = voltage_limits(replace(STRIP, film_modulus_Pa=modulus), ALLOWED).highest_V
        assert highest == pytest.approx(float(alone), rel=1e-14)


def test_a_larger_electrode_holds_a_weaker_spot() -> None:
    """A strip of nine tested areas fails as nine of them in a row."""
    one = chance(STRIP, 5000.0)
    large = replace(STRIP, area_ratio=9.0)
    assert chance(large, 5000.0) == pytest.approx(1 - (1 - one) ** 9, rel=1e-9)
    voltage = voltage_limits(large, ALLOWED).highest_V
    assert chance(large, voltage) == pytest.approx(0.01, rel=1e-9)


def test_beyond_pull_in_there_is_no_number() -> None:
    actuated = actuate(STRIP, np.array([1000.0, 20_000.0]))
    force = blocked_force(actuated, SIZE)
    for numbers in (actuated.curvature_per_m, actuated.true_field_V_m, force):
        assert np.isnan(numbers).tolist() == [False, True]


def test_an_unknown_breakdown_is_named() -> None:
    unknown = replace(STRIP, weibull_shape=None)
    limits = voltage_limits(unknown, ALLOWED)
    assert limits.breakdown_V is None
    assert limits.pull_in_V == voltage_limits(STRIP, ALLOWED).pull_in_V
    with pytest.raises(MissingProperty, match="the breakdown limit is unknown: the card of the de"):
        _ = limits.highest_V
    with pytest.raises(MissingProperty, match="the breakdown limit is unknown: the card of the de"):
        failure_probability(unknown, 1e6)


@pytest.mark.parametrize(("probability", "fraction"), [(1.0, 0.9), (0.01, 90.0), (0.0, 0.9)])
def test_percent_is_refused(probability: float, fraction: float) -> None:
    with pytest.raises(OutOfRange, match="it is a fraction: was it given in percent"):
        Allowed(probability, fraction)
