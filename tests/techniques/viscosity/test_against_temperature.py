"""A liquid at several temperatures: its Arrhenius law, and when there is none."""

from __future__ import annotations

import math

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.records import Measurement, Summary
from deamat.materials.present import law_text
from deamat.techniques import viscosity
from deamat.techniques.viscosity.result import Run
from tests.techniques.viscosity.runs import CONTEXT, HOUR, newtonian, reduce

RATES = np.geomspace(0.1, 100.0, 13)
KELVIN = (283.15, 293.15, 303.15, 313.15, 323.15)
ENERGY = 2.6e4
TIMES = np.arange(0.25, 12.51, 0.25) * HOUR


def thermal(kelvin: float) -> float:
    return math.exp(ENERGY / 8.314462618 * (1.0 / kelvin - 1.0 / 293.15))


def curves(kelvin: tuple[float, ...], index: float = 1.0) -> dict[str, FloatArray]:
    """Sweeps at several temperatures below each other, with 0.5 % noise."""
    rng = np.random.default_rng(3)
    level = [3.5 * thermal(k) * RATES ** (index - 1.0) for k in kelvin]
    return {
        "shear_rate_per_s": np.tile(RATES, len(kelvin)),
        "viscosity_Pas": np.concatenate(level) * np.exp(0.005 * rng.normal(size=13 * len(kelvin))),
        "temperature_K": np.repeat(kelvin, 13),
    }


def summary(*measured: Measurement[Run]) -> Summary:
    return viscosity.TECHNIQUE.summarise(list(measured), CONTEXT)


@pytest.mark.parametrize("index", [1.0, 0.6])
def test_flow_curves_at_five_temperatures_make_a_law(index: float) -> None:
    (law,) = summary(reduce(curves(KELVIN, index))).laws
    assert (law.key, law.kind, law.argument_unit) == (
        "viscosity_against_temperature", "arrhenius", "K",
    )  # fmt: skip
    assert law.valid == (283.15, 323.15)
    assert law.coefficients[1] == pytest.approx(ENERGY, rel=0.01)
    u = math.sqrt(law.covariance[1][1])
    assert abs(law.coefficients[1] - ENERGY) < 4.0 * u < 0.05 * ENERGY
    rate = law.conditions["rate_per_s"]
    assert rate == pytest.approx(math.sqrt(0.1 * 100.0))
    true = 3.5 * thermal(308.0) * float(str(rate)) ** (index - 1.0)
    low, high = law.ci95(308.0)
    assert low <= true <= high
    assert high - low == pytest.approx(4 * 0.03 * true, rel=0.2)  # the rheometer's calibration
    assert law_text(law).startswith("arrhenius, ")
    assert "exp(E / (R x)), E = 2.6" in law_text(law)
    assert {o.specimen for o in law.origins} == {"v-1"}


def test_the_law_is_a_model_of_lmfit_whose_energy_is_bounded() -> None:
    (law,) = summary(reduce(curves(KELVIN))).laws
    model, parameters = law.model()
    assert (parameters["E"].min, parameters["a"].min) == (0.0, 0.0)
    assert parameters["E"].stderr == pytest.approx(math.sqrt(law.covariance[1][1]))
    readings = [3.5 * thermal(k) for k in KELVIN]
    fitted = model.fit(readings, parameters, x=np.array(KELVIN))
    assert fitted.params["E"].value == pytest.approx(ENERGY, rel=1e-4)


def test_two_temperatures_make_none_and_a_rise_is_refused() -> None:
    two = summary(reduce(curves(KELVIN[:2])))
    assert (two.laws, two.refusals) == ((), ())
    warm = curves(KELVIN)
    warm["viscosity_Pas"] = warm["viscosity_Pas"][::-1].copy()
    found = summary(reduce(warm))
    assert found.laws == ()
    (refused,) = (r for r in found.refusals if r.key == "viscosity_against_temperature")
    assert "cannot be told from zero" in refused.reason


def run(kelvin: float, number: int, growth: float) -> Measurement[Run]:
    level = 2.0 * thermal(kelvin) * (1.0 + growth * TIMES / TIMES[-1])
    columns = newtonian(level, TIMES, speed_rpm=30.0, seed=number)
    return reduce({**columns, "temperature_K": np.full(len(TIMES), kelvin)}, number=number)


def test_runs_of_a_liquid_that_does_not_cure_tell_it_and_those_of_one_that_does_do_not() -> None:
    kelvin = (289.15, 295.15, 301.15)
    found = summary(*(run(k, i, 0.02) for i, k in enumerate(kelvin, start=1)))
    (law,) = found.laws
    assert law.conditions["time_s"] == HOUR
    low, high = (law.coefficients[1] + s * 12.7 * law.covariance[1][1] ** 0.5 for s in (-1, 1))
    assert low <= ENERGY <= high
    found = summary(*(run(k, i, 0.9) for i, k in enumerate(kelvin, start=1)))
    assert found.laws == ()
    refused = {r.key: r.reason for r in found.refusals}
    assert refused["viscosity_against_temperature"].startswith("the liquid cures: at 289.1 K its ")
