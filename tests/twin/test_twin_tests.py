"""A simulated test looks like its machine's, and its truth can be found again in it."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable

import numpy as np
import pytest

from deamat.core.errors import ConfigError, MissingProperty
from deamat.core.instruments import Gauge, Machine
from deamat.twin import compression
from deamat.twin.compression import simulate_compression
from deamat.twin.draws import CALIPER, MACHINE, cell_noise, stream
from deamat.twin.part import SimulatedTest
from deamat.twin.tension import simulate_tension
from deamat.twin.truth import AGED, materials, true_value


def _slope(test: SimulatedTest, length: str, area_m2: float, window: float) -> float:
    strain = test.displacement_m / test.numbers[length].value
    inside = strain <= window
    return float(np.polyfit(strain[inside], test.force_N[inside] / area_m2, 1)[0])


def _compressive(test: SimulatedTest) -> float:
    area_m2 = math.pi / 4 * test.numbers["diameter_m"].value ** 2
    return _slope(test, "height_m", area_m2, 0.05)


def _section(test: SimulatedTest) -> float:
    return test.numbers["width_m"].value * test.numbers["thickness_m"].value


def _tensile(test: SimulatedTest) -> float:
    return _slope(test, "gauge_length_m", _section(test), 0.01)


def _assert_mean_is_one(ratios: Iterable[float], sd: float) -> None:
    """Mean within 4 standard errors of 1, and a scatter that the declared errors explain."""
    values = list(ratios)
    assert abs(statistics.fmean(values) - 1) < 4 * sd / math.sqrt(len(values)) + 1e-3
    assert 0.8 * sd < statistics.stdev(values) < 1.25 * sd


def test_the_declared_errors_are_those_of_the_core() -> None:
    assert MACHINE.u_force_calibration == Machine().u_force_calibration
    assert MACHINE.u_displacement_calibration == Machine().u_displacement_calibration
    assert Gauge() == CALIPER


@pytest.mark.parametrize("material", ["sylgard-182-10to1", "sylgard-182-40to1"])
def test_compression_gives_the_modulus_back(material: str) -> None:
    truth = true_value("compressive_modulus", material, AGED).value
    ratios = [_compressive(simulate_compression(s, material, AGED, 1)) / truth for s in range(200)]
    # scatter 3 %, cell 0.5 %, crosshead 0.2 %, diameter and height 0.14 %
    _assert_mean_is_one(ratios, math.hypot(0.03, 0.005, 0.002, 0.0014))


@pytest.mark.parametrize(
    ("material", "fit"), [("sylgard-184-10to1", 0.003), ("sylgard-182-40to1", 0.14)]
)
def test_tension_gives_the_modulus_back(material: str, fit: float) -> None:
    truth = true_value("tensile_modulus", material).value
    ratios = [_tensile(simulate_tension(s, material, 2)) / truth for s in range(200)]
    assert min(ratios) > 0
    # scatter 4 %, cell 0.5 %, width and thickness 0.7 %, the fit over 0-1 %
    _assert_mean_is_one(ratios, math.hypot(0.04, 0.005, 0.007, fit))


def test_tension_gives_the_break_point_back() -> None:
    material = "sylgard-182-30to1"
    strength = true_value("tensile_strength", material).value
    elongation = true_value("elongation_at_break", material).value
    tests = [simulate_tension(seed, material, 1) for seed in range(200)]
    _assert_mean_is_one(
        (t.force_N.max() / _section(t) / strength for t in tests), math.hypot(0.08, 0.005, 0.007)
    )
    ends = [t.displacement_m[t.force_N.argmax()] / t.numbers["gauge_length_m"].value for t in tests]
    _assert_mean_is_one((end / elongation for end in ends), math.hypot(0.06, 0.002))


def test_the_force_error_is_one_for_all_specimens_of_a_campaign() -> None:
    """Within a campaign, strength over true strength varies far less than between campaigns."""
    material = "sylgard-182-10to1"

    def error(seed: int, number: int) -> float:
        test = simulate_tension(seed, material, number)
        true_area_m2 = test.truth["width_m"] * test.truth["thickness_m"]
        force_N = test.force_N.max() - test.truth["tare_N"]
        return float(force_N / true_area_m2 / test.truth["tensile_strength"] - 1)

    errors = np.array([[error(seed, number) for number in range(1, 4)] for seed in range(30)])
    assert errors.std(axis=1).max() < 5e-4
    assert 0.003 < errors.mean(axis=1).std() < 0.007


@pytest.mark.parametrize("material", materials())
def test_a_tension_file_holds_enough_of_the_first_percent(material: str) -> None:
    for seed in range(5):
        test = simulate_tension(seed, material, 1)
        strain = test.displacement_m / test.numbers["gauge_length_m"].value
        assert np.count_nonzero(strain <= 0.01) >= 40
        steps = np.unique(np.round(np.diff(test.time_s), 6))
        assert steps[0] == 0.01
        assert steps[-1] == 0.5
        assert np.all(np.diff(test.displacement_m) > 0)
        assert test.force_N.max() < 9.80665
        assert np.all(np.abs(test.force_N[-5:]) < 1e-3)
        assert test.force_N[-6] > 0.98 * test.force_N.max()


@pytest.mark.parametrize("material", materials())
@pytest.mark.parametrize("age", compression.AGES)
def test_a_compression_file_ends_at_the_cell_or_at_30_percent(material: str, age: str) -> None:
    for seed in range(5):
        test = simulate_compression(seed, material, age, 1)
        strain = test.displacement_m / test.numbers["height_m"].value
        assert np.count_nonzero(strain <= 0.05) >= 90
        assert test.force_N.max() <= 49.0
        assert strain[-1] == pytest.approx(0.30, abs=0.005) or test.force_N[-1] > 48.0
        assert strain[-1] > 0.055
        assert test.displacement_m[0] == 0.0
        assert -0.02 < test.force_N[0] < 0.10
        assert np.all(np.diff(test.displacement_m) > 0)


def test_specimens_differ_and_have_their_own_streams() -> None:
    material = materials()[0]
    tests = [simulate_compression(1, material, age, n) for age in compression.AGES for n in (1, 2)]
    assert len({t.truth["height_m"] for t in tests}) == 4
    assert len({t.specimen for t in tests}) == 4
    assert simulate_compression(2, material, AGED, 1).truth != tests[2].truth
    again = simulate_compression(1, material, AGED, 1)
    assert np.array_equal(again.force_N, tests[2].force_N)


def test_noise_keeps_its_spread_when_the_sampling_interval_changes() -> None:
    time_s = np.concatenate([np.arange(20_000) * 0.01, 200.0 + np.arange(20_000) * 0.5])
    noise = cell_noise(stream(3, "noise"), time_s, 2.0, 0.01)
    for part, lag_1 in ((noise[:20_000], math.exp(-1)), (noise[20_000:], 0.0)):
        assert part.std() == pytest.approx(2.0, rel=0.04)
        assert np.corrcoef(part[1:], part[:-1])[0, 1] == pytest.approx(lag_1, abs=0.03)


def test_the_numbers_carry_both_kinds_of_uncertainty() -> None:
    thickness = simulate_tension(0, materials()[0], 1).numbers["thickness_m"]
    assert (thickness.unit, thickness.u_independent, thickness.u_shared) == ("m", 1e-6, 1e-6)
    assert thickness.value * 1e6 == pytest.approx(round(thickness.value * 1e6), abs=1e-9)


def test_what_cannot_be_simulated_is_refused() -> None:
    with pytest.raises(MissingProperty, match=r"^the twin knows no tensile_modulus of ecoflex"):
        simulate_tension(0, "ecoflex", 1)
    with pytest.raises(MissingProperty, match=r"sylgard-184-10to1 \(3 years\); it knows"):
        simulate_compression(0, "sylgard-184-10to1", "3 years", 1)
    with pytest.raises(ConfigError, match=r"^the seed must be 0 or more, not -1$"):
        simulate_tension(-1, "sylgard-184-10to1", 1)
