"""Promises about slack: found where a curve has a hinge, with an honest width, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.estimators.curves.slack import find_slack, steepest_behind

E = 100e3
STRAIN = np.linspace(0.0, 0.6, 601)
WINDOW = 0.1


def hinge(place: float, loose: float = 0.0, strain: FloatArray = STRAIN) -> FloatArray:
    """A curve whose start has a fraction of the slope behind the hinge."""
    return E * (loose * strain + (1.0 - loose) * np.maximum(strain - place, 0.0))


@pytest.mark.parametrize("place", [0.007, 0.03, 0.15, 0.25])
@pytest.mark.parametrize("strain", [STRAIN, np.linspace(0.0, 0.6, 241)])
def test_a_hinge_is_found_within_its_stated_width(place: float, strain: FloatArray) -> None:
    found = find_slack(strain, hinge(place, 0.1, strain), WINDOW)
    assert found is not None
    assert abs(found.strain - place) < 1.75 * found.u_strain < 0.1 * WINDOW
    assert found.slope_after_Pa == pytest.approx(E, rel=1e-2)
    assert found.slope_before_Pa == pytest.approx(0.1 * E, abs=0.2 * E)


def test_both_slopes_are_exact_where_the_hinge_lies_on_the_grid() -> None:
    found = find_slack(STRAIN, hinge(0.15, 0.3), WINDOW)
    assert found is not None
    assert found.strain == pytest.approx(0.15)
    assert (found.slope_before_Pa, found.slope_after_Pa) == pytest.approx((0.3 * E, E))


@pytest.mark.parametrize("place", [0.01822033898305085, 0.021525423728813563, 0.024830508474576275])
def test_a_hinge_without_any_scatter_is_found(place: float) -> None:
    found = find_slack(STRAIN, hinge(place), WINDOW)  # rounding leaves less than nothing of it
    assert found is not None
    assert found.strain == pytest.approx(place)


@pytest.mark.parametrize(("loose", "slack"), [(0.78, True), (0.85, False), (1.0, False)])
def test_a_start_less_steep_by_a_fifth_is_slack(loose: float, slack: bool) -> None:
    assert (find_slack(STRAIN, hinge(0.03, loose), WINDOW) is not None) == slack


def test_a_falling_or_softening_curve_has_no_slack() -> None:
    assert find_slack(STRAIN, -hinge(0.15), WINDOW) is None
    assert find_slack(STRAIN, hinge(0.15, 2.0), WINDOW) is None
    assert find_slack(STRAIN[:7], hinge(0.003)[:7], WINDOW) is None


@pytest.mark.parametrize(
    ("place", "loose", "noise"),
    [
        (0.03, 0.0, 200.0), (0.03, 0.0, 1e3), (0.08, 0.0, 1e3), (0.08, 0.0, 4e3), (0.08, 0.6, 1e3),
        (0.2, 0.0, 4e3), (0.2, 0.3, 4e3), (0.2, 0.0, 1e4),
    ],
)  # fmt: skip
def test_the_stated_width_is_that_of_the_scatter(place: float, loose: float, noise: float) -> None:
    rng = np.random.default_rng(9)
    curves = (hinge(place, loose) + rng.normal(0.0, noise, STRAIN.size) for _ in range(150))
    found = [one for curve in curves if (one := find_slack(STRAIN, curve, WINDOW)) is not None]
    assert len(found) > 80
    errors = np.array([one.strain - place for one in found])
    widths = np.array([one.u_strain for one in found])
    assert np.sqrt(np.mean(np.square(errors / widths))) < 1.35
    assert abs(errors.mean()) < 0.4 * widths.mean()
    step = 0.1 * WINDOW  # wider than the grid's only where noise makes it so
    assert widths.mean() < max(2.0 * float(errors.std()), step)


def test_noise_on_a_straight_line_is_no_slack() -> None:
    rng = np.random.default_rng(10)
    noisy = (E * STRAIN + rng.normal(0.0, 5e3, STRAIN.size) for _ in range(300))
    assert sum(find_slack(STRAIN, stress, WINDOW) is not None for stress in noisy) <= 1


def test_the_steepest_stretch_behind_a_strain_is_over_three_windows_of_it() -> None:
    strain = np.linspace(0.0, 1.0, 1001)
    stress = np.where(strain < 0.5, 2.0 * strain, 1.0 + 5.0 * (strain - 0.5))
    assert steepest_behind(strain, stress, 0.1, 0.05) == pytest.approx(5.0)
    assert steepest_behind(strain, stress, 0.6, 0.05) == pytest.approx(5.0)
    assert steepest_behind(strain[:400], stress[:400], 0.1, 0.05) == pytest.approx(2.0)
    assert steepest_behind(strain, stress, 0.95, 0.05) == 0.0
    assert steepest_behind(strain, -stress, 0.1, 0.05) == 0.0
