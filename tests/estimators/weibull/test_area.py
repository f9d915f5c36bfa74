from __future__ import annotations

import numpy as np
import pytest

from deamat.core.errors import OutOfRange
from deamat.estimators.weibull.area import area_ratio, scale_to_area
from deamat.estimators.weibull.conditional import condition
from deamat.estimators.weibull.intervals import infer
from tests.estimators.weibull.samples import CABLE_I, simulated


def test_the_weakest_of_many_films_has_the_scaled_strength() -> None:
    x, _ = simulated(10, 20_000, seed=81)
    weakest = np.sort(x.min(axis=1))
    scale = scale_to_area(97.0, 8.0, 1e-4, 1e-3, limit=10.0)
    assert scale == pytest.approx(97.0 * 0.1 ** (1 / 8), rel=1e-14)
    assert np.mean(weakest <= scale) == pytest.approx(1 - np.exp(-1), abs=0.015)


def test_scaling_there_and_back_changes_nothing() -> None:
    there = scale_to_area(97.0, 8.0, 1.0, 5.0, limit=10.0)
    assert there < 97.0
    assert scale_to_area(there, 8.0, 5.0, 1.0, limit=10.0) == pytest.approx(97.0, rel=1e-14)


def test_the_interval_on_another_area_covers_the_truth() -> None:
    x, _ = simulated(5, 4000, seed=82)
    a = -np.log(area_ratio(1.0, 30.0, limit=100.0))
    truth = scale_to_area(97.0, 8.0, 1.0, 30.0, limit=100.0)
    low, high = np.concatenate([b.quantile(a, 0.95) for b in condition(x)], axis=1)
    assert 0.935 < np.mean((low <= truth) & (truth <= high)) < 0.965


def test_the_interval_surrounds_the_scaled_fit_and_is_wider() -> None:
    asked = infer(CABLE_I)
    there = asked.scale(area_ratio(1.0, 10.0, limit=10.0))
    here = asked.scale()
    assert there.estimate == pytest.approx(
        scale_to_area(asked.fit.scale, asked.fit.shape, 1.0, 10.0, limit=10.0), rel=1e-13
    )
    assert there.high - there.low > 1.5 * (here.high - here.low)


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (
            (97.0, 8.0, 1.0, 200.0, 100.0),
            "areas 1 and 200 differ by a factor 200; the declared limit is 100: test specimens nearer in area",
        ),
        (
            (97.0, 8.0, 200.0, 1.0, 100.0),
            "areas 200 and 1 differ by a factor 200; the declared limit is 100: test specimens nearer in area",
        ),
        ((97.0, 8.0, 0.0, 1.0, 100.0), "area_from must be above 0 and finite, not 0"),
        ((97.0, 8.0, 1.0, np.inf, 100.0), "area_to must be above 0 and finite, not inf"),
        ((97.0, 8.0, 1.0, 1.0, 0.5), "the limit on the area ratio must be at least 1, not 0.5"),
        ((97.0, 0.0, 1.0, 1.0, 100.0), "shape must be above 0 and finite, not 0"),
    ],
)
def test_areas_beyond_the_limit_are_out_of_range(
    arguments: tuple[float, float, float, float, float], reason: str
) -> None:
    with pytest.raises(OutOfRange) as caught:
        scale_to_area(*arguments)
    assert str(caught.value) == reason
