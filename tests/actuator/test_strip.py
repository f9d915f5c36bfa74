"""The designer's strip: the general beam in closed form, and how far its voltage may go."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from deamat.actuator.beam import actuate
from deamat.actuator.stack import Layer, Role, Stack
from deamat.actuator.strain import pull_in_voltage
from deamat.actuator.strip import (
    Allowed,
    Strip,
    best_passive,
    blocked_force,
    breakdown_field,
    breakdown_voltage,
    curvature,
    curvature_or_nan,
    failure_probability,
    highest_voltage,
    pull_in_limit,
    true_field,
)
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


def stack() -> Stack:
    def layer(role: Role, thickness_m: float, modulus_Pa: float) -> Layer:
        return Layer(role, thickness_m, modulus_Pa, 0.01, 1000.0, 2.6, 0.49)

    electrode = layer("electrode", 10e-6, 3.5e6)
    return Stack((layer("passive", 200e-6, 1e6), electrode, layer("de", 500e-6, 1e5), electrode))


@pytest.mark.parametrize("voltage_V", [100.0, 6400.0, 12_000.0])
def test_it_is_the_general_beam(voltage_V: float) -> None:
    beam = actuate(stack(), voltage_V, "poisson")
    assert curvature(STRIP, voltage_V) == pytest.approx(beam.curvature_per_m, rel=1e-13)
    force = 1.5 * beam.bending_stiffness_N_m2 * beam.curvature_per_m / 0.05
    assert blocked_force(STRIP, voltage_V, 0.05, 0.01) == pytest.approx(force, rel=1e-13)


def test_the_best_passive_layer_is_the_best_one_of_the_thinned_film() -> None:
    best = float(best_passive(STRIP, 12_000.0))
    around = replace(STRIP, passive_thickness_m=best * np.array([0.98, 1.0, 1.02]))
    bent = np.asarray(curvature(around, 12_000.0))
    assert bent.argmax() == 1
    made = float(best_passive(STRIP, 1.0))
    assert curvature(replace(STRIP, passive_thickness_m=made), 12_000.0) < bent[1]


def test_the_limit_is_the_allowed_part_of_the_films() -> None:
    voltage = float(highest_voltage(STRIP, ALLOWED))
    assert voltage == breakdown_voltage(STRIP, ALLOWED) < pull_in_limit(STRIP, ALLOWED)
    assert true_field(STRIP, voltage) == pytest.approx(breakdown_field(STRIP, ALLOWED), rel=1e-9)
    assert failure_probability(STRIP, voltage) == pytest.approx(0.01, rel=1e-9)


def test_a_tough_film_pulls_in_first() -> None:
    tough = replace(STRIP, breakdown_strength_V_m=200e6)
    assert breakdown_voltage(tough, ALLOWED) == np.inf
    limit = 0.9 * pull_in_voltage(500e-6, 1e5, 2.6)
    assert highest_voltage(tough, ALLOWED) == pytest.approx(limit, rel=1e-15)
    assert failure_probability(tough, limit / 0.9 * 1.001) == 1.0


def test_a_larger_electrode_holds_a_weaker_spot() -> None:
    """A strip of nine tested areas fails as nine of them in a row."""
    one = failure_probability(STRIP, 5000.0)
    assert failure_probability(STRIP, 5000.0, 9.0) == pytest.approx(1 - (1 - one) ** 9, rel=1e-9)
    larger = Allowed(0.01, 0.9, 9.0)
    voltage = highest_voltage(STRIP, larger)
    assert failure_probability(STRIP, voltage, 9.0) == pytest.approx(0.01, rel=1e-9)


def test_beyond_pull_in_there_is_no_number() -> None:
    voltages = np.array([1000.0, 20_000.0])
    assert np.isnan(curvature_or_nan(STRIP, voltages)).tolist() == [False, True]
    with pytest.raises(
        OutOfRange, match="voltage_V of the de layer is 20000 V; allowed is 0 to 12684 V"
    ):
        curvature(STRIP, 20_000.0)


def test_an_unknown_breakdown_is_named() -> None:
    with pytest.raises(MissingProperty, match="the breakdown limit is unknown: the card of the de"):
        highest_voltage(replace(STRIP, weibull_shape=None), ALLOWED)


@pytest.mark.parametrize(("probability", "fraction"), [(1.0, 0.9), (0.01, 90.0), (0.0, 0.9)])
def test_percent_is_refused(probability: float, fraction: float) -> None:
    with pytest.raises(OutOfRange, match="it is a fraction: was it given in percent"):
        Allowed(probability, fraction)
