"""A design from means of few specimens: its interval holds the truth as often as it says."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from deamat.actuator.card_values import gather
from deamat.actuator.inputs import Input, inputs_of
from deamat.actuator.model import respond
from deamat.actuator.strain import pull_in_voltage
from deamat.actuator.uncertainty import combined, monte_carlo
from deamat.core.card_lists import JointFit
from deamat.core.quantity import Contribution
from deamat.materials.correlation import correlations_of

from .cards import CAMPAIGN, cards, declared
from .test_strip import STRIP

TRUTH = {"film_modulus_Pa": 1e5, "passive_modulus_Pa": 1e6, "relative_permittivity": 2.6}
SCATTER = 0.06  # relative, between specimens
VOLTAGE_V = 0.5 * float(np.asarray(pull_in_voltage(500e-6, 1e5, 2.6)))
RUNS = 1500


def coverage(fields: tuple[str, ...], n: int, *, as_known: bool = False) -> float:
    """Return how often the interval of the curvature holds that of the truth.

    Parameters
    ----------
    fields : known from means of n specimens; the others exactly
    as_known : take the scatter for known, as a normal distribution does
    """
    rng = np.random.default_rng(20261128)
    response = respond(STRIP, VOLTAGE_V)
    truth = float(np.asarray(response({f: np.array([v]) for f, v in TRUTH.items()}))[0])
    held = 0
    for campaign in range(RUNS):
        inputs = []
        for field, value in TRUTH.items():
            budget: tuple[Contribution, ...] = ()
            if field in fields:
                specimens = value * (1.0 + SCATTER * rng.standard_normal(n))
                value = float(specimens.mean())
                u = float(specimens.std(ddof=1)) / math.sqrt(n)
                dof = None if as_known else n - 1.0
                budget = (Contribution(f"scatter of {field}", u, False, degrees_of_freedom=dof),)
            inputs.append(Input(field, (field,), value, "", budget))
        low, high = monte_carlo(inputs, response, 1000, seed=campaign).interval95
        held += low <= truth <= high
    return held / RUNS


def test_three_specimens_give_an_interval_of_95_percent() -> None:
    assert coverage(("film_modulus_Pa",), 3) == pytest.approx(0.95, abs=0.015)


def test_a_normal_distribution_would_not() -> None:
    assert coverage(("film_modulus_Pa",), 3, as_known=True) < 0.88


def test_several_means_of_three_hold_at_least_as_often() -> None:
    assert 0.945 < coverage(tuple(TRUTH), 3) < 0.99


def test_two_specimens_leave_all_but_nothing_known() -> None:
    scatter = Contribution("scatter", 5e3, False, degrees_of_freedom=1.0)
    response = respond(STRIP, VOLTAGE_V)
    modulus = Input("Y", ("film_modulus_Pa",), 1e5, "Pa", (scatter,))
    known = Input("Y", ("film_modulus_Pa",), 1e5, "Pa", (Contribution("scatter", 5e3, False),))
    two, many = (monte_carlo([x], response) for x in (modulus, known))
    assert math.isnan(two.sd)
    assert two.median == pytest.approx(many.median, rel=0.01)
    assert two.interval95[1] - two.interval95[0] > 3.0 * (many.interval95[1] - many.interval95[0])


@pytest.mark.parametrize("together", [0.6, -0.4, 0.0])
def test_scale_and_shape_err_together_as_the_card_says(together: float) -> None:
    soft = cards()["soft"]
    strength, shape = (soft.record(key) for key in ("breakdown_strength", "weibull_shape"))
    u = strength.quantity.u_independent / strength.quantity.standard_uncertainty
    fit = JointFit(
        ("breakdown_strength", "weibull_shape"), CAMPAIGN, strength.conditions,
        ((1.0, together), (together, 1.0)), "one fit",
    )  # fmt: skip
    known = replace(soft, correlations=correlations_of(soft.records, [fit]))
    assert sum(pair.coefficient for pair in known.correlations) == pytest.approx(
        u * together, rel=1e-3
    )
    electrode = declared().electrode("pedot-triton")
    values = gather(known, cards()["stiff"], declared(), {})
    assert any("drawn independently" in note for note in values.notes) == (together == 0.0)
    listed = inputs_of(values, declared(), electrode, STRIP)
    chosen = [x for x in listed if x.concerns_breakdown]
    assert [x.u for x in chosen] == pytest.approx(
        [r.quantity.standard_uncertainty for r in (strength, shape)]
    )
    own = [strength.quantity.u_independent, shape.quantity.u_independent]
    both = combined(chosen, [1.0 / own[0], 1.0 / own[1]]) ** 2
    shared = (strength.quantity.u_shared / own[0]) ** 2
    assert both == pytest.approx(2.0 + shared + 2.0 * together, rel=1e-3)


def test_a_permittivity_is_never_drawn_below_that_of_vacuum() -> None:
    scatter = Contribution("scatter", 0.3, False, degrees_of_freedom=1.0)
    thin = Input("eps_r", ("relative_permittivity",), 1.5, "1", (scatter,))
    assert monte_carlo([thin], respond(STRIP, VOLTAGE_V)).interval95[0] > 0.0
