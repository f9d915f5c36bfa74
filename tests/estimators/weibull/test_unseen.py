"""What n specimens could not have seen: checked by making it, and by looking."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.estimators.weibull.fit import fit, quantile
from deamat.estimators.weibull.goodness import curved, goodness_of_fit
from deamat.estimators.weibull.unseen import _departure, _fitted, unseen
from tests.estimators.weibull.samples import CABLE_I, simulated


@pytest.mark.parametrize("sign", [-1, 1])
def test_the_tests_find_the_stated_departure_with_the_stated_power(sign: int) -> None:
    c, power = _departure((0,) * 30, sign, 0.8, 0.05, 0.005)
    assert power == 0.8
    hazard = np.random.default_rng(71).standard_exponential((600, 30))
    x = 70.0 * np.exp((hazard**c - 1.0) / c / 9.0)
    seen = [goodness_of_fit(v).p_value < 0.05 or curved(v).p_value < 0.005 for v in x]
    assert np.mean(seen) == pytest.approx(0.8, abs=0.06)


def test_the_curvature_alone_has_the_stated_power() -> None:
    c, power = _departure((0,) * 30, -1, 0.8, 1e-6, 0.2)
    assert power == 0.8
    hazard = np.random.default_rng(75).standard_exponential((400, 30))
    x = 70.0 * np.exp((hazard**c - 1.0) / c / 9.0)
    assert np.mean([curved(v).p_value < 0.2 for v in x]) == pytest.approx(0.8, abs=0.05)


def test_no_sample_of_the_most_curved_form_underflows() -> None:
    hazard, scale, shape = _fitted((0,) * 5, -0.7)
    assert (hazard.shape, scale.shape, shape.shape) == ((400, 5), (400,), (400,))


def test_the_stated_departure_is_how_far_the_quantile_of_the_fit_is_off() -> None:
    c, _ = _departure((0,) * 30, -1, 0.8, 0.05, 0.005)
    hazard = np.random.default_rng(72).standard_exponential((2000, 30))
    x = np.exp((hazard**c - 1.0) / c / 9.0)
    fits = [fit(v) for v in x]
    true = ((-np.log1p(-0.01)) ** c - 1.0) / c / 9.0
    off = np.mean([np.log(quantile(f.scale, f.shape, 0.01)) - true for f in fits])
    straight = simulated(30, 2000, seed=73, shape=9.0)[0] / 97.0
    bias = np.mean([np.log(quantile(f.scale, f.shape, 0.01)) for f in map(fit, straight)])
    bias -= np.log(quantile(1.0, 9.0, 0.01))
    shape = float(np.mean([f.shape for f in fits]))
    told = -np.log1p(-unseen(straight[0], None, 0.01).lower) * fit(straight[0]).shape
    assert told == pytest.approx((off - bias) * shape, rel=0.15)


def test_more_specimens_see_more() -> None:
    found = [unseen(simulated(n, 1, seed=74)[0][0], None, 0.01) for n in (10, 50, 500)]
    assert found[0].power_lower < 0.8
    assert found[1].lower > found[2].lower > 0.0
    assert found[1].higher > found[2].higher > 0.0
    assert 0.1 < found[0].power_higher < found[0].power_lower < 0.8
    assert found[1].power_lower == found[1].power_higher == 0.8
    assert [round(f.weak_fraction, 4) for f in found] == [0.2589, 0.0582, 0.0060]


@pytest.mark.parametrize("power", [0.8, 1.0])  # reached, not reached
def test_what_is_seen_of_many_specimens_is_less_by_the_root_of_their_number(power: float) -> None:
    some, many = (_departure((0,) * n, 1, power, 0.05, 0.005) for n in (400, 1600))
    assert many[0] == pytest.approx(0.5 * some[0], rel=0.05)
    assert some[1] == many[1]
    assert (some[1] == power) == (power < 1.0)


def test_neither_unit_nor_order_matters() -> None:
    assert unseen(1e6 * CABLE_I[::-1], None, 0.1).lower == pytest.approx(
        unseen(CABLE_I, None, 0.1).lower, rel=1e-9
    )
