"""The lowest point of a function on an interval."""

from __future__ import annotations

import math

import numpy as np
import pytest

from deamat.estimators.curves.search import lowest

GRID = np.linspace(-1.0, 1.0, 21)


@pytest.mark.parametrize("place", [-0.9, -0.123456789, 0.0, 0.5, 0.87])
def test_the_minimum_is_found_between_grid_points(place: float) -> None:
    found, at = lowest(lambda x: math.cosh(x - place), GRID)
    assert found == pytest.approx(place, abs=1e-7)  # the function is flat to rounding within 1e-8
    assert abs(GRID[at] - place) < 0.1


def test_a_kink_is_found_to_the_last_digits() -> None:
    assert lowest(lambda x: abs(x - 0.3141), GRID)[0] == pytest.approx(0.3141, abs=1e-9)


def test_a_minimum_at_an_end_is_that_grid_point() -> None:
    assert lowest(lambda x: x, GRID) == (-1.0, 0)
    assert lowest(lambda x: -x, GRID) == (1.0, 20)
    assert lowest(lambda x: math.inf if x < 0.5 else -x, GRID) == (1.0, 20)
