from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from deamat.actuator.ladder import (
    NEGLECTS,
    Actuator,
    Aim,
    Answer,
    Rung,
    choose,
    errors,
    evaluate,
)
from deamat.actuator.stack import FIRST_LAYER_DOWN, ON_EDGE, STANDING, Orientation, Stack
from deamat.actuator.strain import pull_in_voltage
from deamat.core.errors import FitRefused, OutOfRange

from .stacks import layer, strip

RUNGS: tuple[Rung, ...] = tuple(NEGLECTS)


def measured(length_m: float, voltage_V: float = 9800.0) -> Actuator:
    """Design 1 of Sikulskyi et al. 2022, horizontal."""
    return Actuator(strip(), length_m, voltage_V, "poisson", FIRST_LAYER_DOWN)


def random_actuator(rng: np.random.Generator) -> Actuator:
    """One to four films, 3 to 50 mm long, in any orientation, below nine tenths of pull-in."""

    def decades(low: float, high: float) -> float:
        return float(10.0 ** rng.uniform(low, high))

    n = int(rng.integers(1, 5))
    ta, ya = decades(-4.5, -3.2), decades(5, 6.5)
    electrode = layer("electrode", ta * decades(-2.5, -0.5), ya * decades(-1, 1))
    passive = layer("passive", n * ta * decades(-1, 0.5), ya * decades(-1, 2))
    stack = Stack((passive, electrode, *(layer("de", ta, ya), electrode) * n))
    volts = float(rng.uniform(0, 0.9)) * float(pull_in_voltage(ta, ya, 2.58))
    tilt = Orientation(float(rng.uniform(-2.5, 2.5)))
    return Actuator(stack, decades(-2.5, -1.3), volts, "poisson", tilt)


def _off(actuator: Actuator, rung: Rung, top: Answer) -> float:
    one = evaluate(actuator, rung)
    return math.hypot(one.tip_x_m - top.tip_x_m, one.tip_y_m - top.tip_y_m) / actuator.length_m


def test_the_estimated_error_bounds_the_true_one_on_every_rung() -> None:
    rng = np.random.default_rng(20)
    bounded = 0
    for _ in range(80):
        actuator = random_actuator(rng)
        if math.isinf(errors(actuator, "tip")["weight"]):
            continue
        top = evaluate(actuator, "elastica")
        for rung, error in errors(actuator, "tip").items():
            assert _off(actuator, rung, top) <= error, rung
            bounded += 1
    assert bounded > 200


def test_what_is_chosen_keeps_the_tolerance() -> None:
    rng = np.random.default_rng(21)
    chosen = set()
    for _ in range(60):
        actuator = random_actuator(rng)
        try:
            top = evaluate(actuator, "elastica")
        except (FitRefused, OutOfRange):  # snaps, or coils through itself
            continue
        for tolerance in (0.1, 1e-2, 1e-3, 1e-5):
            choice = choose(actuator, tolerance)
            assert _off(actuator, choice.rung, top) <= tolerance
            assert choice.error <= tolerance
            cheaper = [e for r, e in choice.errors if RUNGS.index(r) < RUNGS.index(choice.rung)]
            assert all(e > tolerance for e in cheaper)
            chosen.add(choice.rung)
    assert len(chosen) >= 5


@pytest.mark.parametrize(
    ("length_m", "tolerance", "rung"),
    [
        (1e-3, 1e-2, "planar"),
        (3e-3, 1e-3, "thinning"),
        (5e-3, 1e-3, "weight"),
        (1e-2, 1e-3, "elastica"),
    ],
)
def test_short_strips_ask_for_less(length_m: float, tolerance: float, rung: Rung) -> None:
    assert choose(measured(length_m), tolerance).rung == rung


def test_the_curvature_asks_for_no_more_than_thinning() -> None:
    ladder = errors(measured(0.05), "curvature")
    assert ladder["thinning"] == ladder["weight"] == ladder["elastica"] == 0.0
    assert ladder["multilayer"] == pytest.approx(ladder["single layer"], rel=1e-9)
    assert ladder["planar"] > ladder["no electrodes"] > ladder["single layer"] > 0.0
    assert choose(measured(0.05), 1e-3, "curvature").rung == "thinning"
    assert choose(measured(0.05), 0.05, "curvature").rung == "single layer"


def test_it_says_why() -> None:
    choice = choose(measured(5e-3), 1e-3)
    below = dict(choice.errors)["thinning"]
    assert choice.why == (
        f"'weight' is off by about {choice.error:.2g} of the length, within 0.001; 'thinning' is "
        f"off by {below:.2g}: it leaves out the weight"
    )
    assert choose(measured(0.05), 1e-2).why == (
        "'elastica' is off by about 1e-09 of the length, within 0.01; 'weight' leaves out large "
        "rotations, too large to bound"
    )
    assert choose(measured(1e-3, 0.0), 0.5).why.endswith("; there is no cheaper rung")


def test_a_stack_that_the_closed_forms_do_not_describe() -> None:
    sealed = Stack((*strip().layers, layer("insulation", 20e-6, 1e6)))
    actuator = replace(measured(2e-3), stack=sealed)
    ladder = errors(actuator, "tip")
    assert [r for r in RUNGS if math.isinf(ladder[r])] == list(RUNGS[:3])
    choice = choose(actuator, 1.0)
    assert choice.rung == "multilayer"
    assert choice.why.endswith("; 'single layer' does not describe this stack")
    with pytest.raises(OutOfRange) as raised:
        evaluate(actuator, "single layer")
    assert str(raised.value) == (
        "'single layer' describes one passive layer below electrodes and films; the stack is "
        "passive, electrode, de, electrode, insulation"
    )


def test_no_voltage_and_no_weight_is_a_straight_strip_on_every_rung() -> None:
    still = replace(measured(0.02, 0.0), orientation=ON_EDGE)
    for rung in RUNGS:
        answer = evaluate(still, rung)
        assert (answer.curvature_per_m, answer.tip_x_m, answer.tip_y_m) == (0.0, 0.02, 0.0)
    for aim in ("tip", "curvature"):
        goal: Aim = "tip" if aim == "tip" else "curvature"
        assert choose(still, 1e-6, goal).rung == "planar"


def test_bad_input_is_refused() -> None:
    with pytest.raises(
        OutOfRange, match=r"^tolerance is 1e-12; allowed is 1e-09 to 1; it is a frac"
    ):
        choose(measured(0.02), 1e-12)
    with pytest.raises(
        OutOfRange, match=r"^voltage_V of layer 3 \(de\) is 40000 V; allowed is 0 to 3"
    ):
        choose(measured(0.02, 4e4), 1e-3)
    with pytest.raises(
        OutOfRange, match=r"^length_m is 20 m; allowed is 1e-06 to 10 m; lengths are"
    ):
        measured(20.0)
    no_rung: Any = "best"
    no_aim: Any = "force"
    with pytest.raises(
        OutOfRange, match=r"^rung is 'best'; allowed are planar, no electrodes, single"
    ):
        evaluate(measured(0.02), no_rung)
    with pytest.raises(OutOfRange, match=r"^aim is 'force'; allowed are 'tip' and 'curvature'$"):
        errors(measured(0.02), no_aim)
    with pytest.raises(FitRefused, match=r"buckles, snaps or is not resolved"):
        choose(replace(measured(0.05), orientation=STANDING), 1e-3)
