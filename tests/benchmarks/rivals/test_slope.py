"""The rival slopes are what their names say; how good they are is for the charts."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from benchmarks.rivals.slope import (
    Slope,
    bin_wise,
    generalised,
    huber,
    naive,
    theil_sen,
    toe_compensated,
)
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.curves.slope import fit_line

Rival = Callable[[FloatArray, FloatArray], Slope]
RIVALS: tuple[Rival, ...] = (naive, generalised, theil_sen, huber, bin_wise, toe_compensated)


def curve(seed: int = 1, n: int = 40) -> tuple[FloatArray, FloatArray]:
    rng = np.random.default_rng(seed)
    x = np.linspace(0.0, 0.05, n)
    return x, 3e5 * x + 100.0 * rng.standard_normal(n)


@pytest.mark.parametrize("rival", RIVALS)
def test_an_exact_line_is_recovered(rival: Rival) -> None:
    x = np.linspace(0.0, 0.05, 40)
    found = rival(x, 3e5 * x)
    assert (found.value, found.low, found.high) == pytest.approx((3e5, 3e5, 3e5), rel=1e-9)


@pytest.mark.parametrize("rival", RIVALS)
@settings(deadline=None, derandomize=True, max_examples=15)
@given(factor=st.floats(1e-6, 1e6), unit=st.floats(1e-3, 1e3))
def test_units_only_scale(rival: Rival, factor: float, unit: float) -> None:
    x, y = curve()
    plain, scaled = rival(x, y), rival(unit * x, factor * y)
    for a, b in ((plain.value, scaled.value), (plain.low, scaled.low), (plain.high, scaled.high)):
        assert b * unit / factor == pytest.approx(a, rel=1e-6)


def test_naive_is_what_scipy_says() -> None:
    x, y = curve()
    peer = stats.linregress(x, y)
    half = stats.t.ppf(0.975, 38) * peer.stderr
    assert naive(x, y).value == pytest.approx(peer.slope, rel=1e-12)
    assert naive(x, y).high == pytest.approx(peer.slope + half, rel=1e-10)


def test_theil_sen_is_what_scipy_says() -> None:
    x, y = curve()
    peer = stats.theilslopes(y, x)
    found = theil_sen(x, y)
    assert (found.value, found.low, found.high) == pytest.approx(
        (peer.slope, peer.low_slope, peer.high_slope), rel=1e-12
    )


def test_generalised_is_least_squares_with_the_full_covariance() -> None:
    x, y = curve(3)
    rho = fit_line(x, y).autocorrelation
    weight = np.linalg.inv(rho ** np.abs(np.subtract.outer(np.arange(40), np.arange(40))))
    design = np.column_stack((np.ones(40), x))
    exact = np.linalg.solve(design.T @ weight @ design, design.T @ weight @ y)
    assert generalised(x, y).value == pytest.approx(exact[1], rel=1e-9)


def test_one_wrong_reading_moves_the_robust_ones_little() -> None:
    x, y = curve()
    y[35] = 0.0
    assert abs(naive(x, y).value / 3e5 - 1.0) > 0.04
    for rival in (theil_sen, huber):
        assert abs(rival(x, y).value / 3e5 - 1.0) < 0.025


def test_what_they_refuse() -> None:
    with pytest.raises(FitRefused, match=r"^all 5 samples lie at one x: a line needs a range$"):
        theil_sen(np.ones(5), np.arange(5.0))
    with pytest.raises(FitRefused, match=r"^0 of 5 bins have 3 samples; an average needs 2 slopes"):
        bin_wise(np.linspace(0.0, 1.0, 5), np.arange(5.0))
