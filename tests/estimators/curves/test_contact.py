"""Promises of the joint fit of contact point and stiffness, on simulated (synthetic) loadings."""

from __future__ import annotations

import numpy as np
import pytest

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.curves.contact import (
    Contact,
    fit_contact,
    fit_in_contact,
    has_air,
    independent_samples,
    standard_errors,
)

DEPTH = np.linspace(-1.0, 4.0, 250)
K, H0, OFFSET, TILT = 7.0, 0.1234, -0.3, 0.4


def load(exponent: float, depth: FloatArray = DEPTH) -> FloatArray:
    rise: FloatArray = np.maximum(depth - H0, 0.0) ** exponent
    return OFFSET + TILT * depth + K * rise


def fit(exponent: float, force: FloatArray, depth: FloatArray = DEPTH) -> Contact:
    return fit_contact(depth, force, exponent, 10, 20)


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0])
def test_a_loading_without_noise_gives_everything_back(exponent: float) -> None:
    found = fit(exponent, load(exponent))
    assert found.stiffness == pytest.approx(K, rel=1e-6)
    assert found.depth0 == pytest.approx(H0, abs=1e-6)
    assert found.offset == pytest.approx(OFFSET, abs=1e-6)
    assert found.tilt == pytest.approx(TILT, abs=1e-5)
    assert (found.in_air, found.in_contact) == (56, 194)
    assert found.u_stiffness < 1e-5
    assert found.load(DEPTH) + found.air(DEPTH) == pytest.approx(load(exponent), abs=1e-5)


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0])
def test_units_scale_through(exponent: float) -> None:
    noise = np.random.default_rng(1).normal(0.0, 0.02, DEPTH.size)
    plain = fit(exponent, load(exponent) + noise)
    small = fit(exponent, 1e-6 * (load(exponent) + noise), 1e-9 * DEPTH)
    assert small.stiffness == pytest.approx(1e-6 * plain.stiffness * 1e9**exponent, rel=1e-6)
    assert small.u_stiffness == pytest.approx(1e-6 * plain.u_stiffness * 1e9**exponent, rel=1e-6)
    assert small.depth0 == pytest.approx(1e-9 * plain.depth0, abs=1e-15)
    assert small.u_depth0 == pytest.approx(1e-9 * plain.u_depth0, rel=1e-5)


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0])
def test_stated_errors_are_those_of_the_scatter(exponent: float) -> None:
    """Noise of the load everywhere, of the depth where it matters: in contact."""
    rng = np.random.default_rng(2)
    pulls, points = [], []
    for _ in range(300):
        depth = DEPTH + rng.normal(0.0, 0.003, DEPTH.size)
        found = fit(exponent, load(exponent) + rng.normal(0.0, 0.02, DEPTH.size), depth)
        pulls.append((found.stiffness - K) / found.u_stiffness)
        points.append((found.depth0 - H0) / found.u_depth0)
        assert found.u_stiffness_alone < found.u_stiffness
    for values in (pulls, points):
        assert abs(np.mean(values)) < 0.25
        assert 0.88 < np.std(values) < 1.12  # 3 standard errors of 300
        assert 0.92 < np.mean(np.abs(values) < 1.96) < 0.98


def test_correlated_noise_does_not_make_it_look_better_known() -> None:
    rng = np.random.default_rng(3)
    depth = np.linspace(-1.0, 4.0, 1000)
    pulls = []
    for _ in range(150):
        noise = rng.normal(0.0, 0.02, depth.size)
        for i in range(1, depth.size):
            noise[i] += 0.8 * noise[i - 1]
        found = fit(1.5, load(1.5, depth) + noise, depth)
        pulls.append((found.stiffness - K) / found.u_stiffness)
        assert 60 < found.independent_samples < 200
    assert 0.8 < np.std(pulls) < 1.2


def test_residuals_count_as_independent_samples_by_their_correlation() -> None:
    rng = np.random.default_rng(4)
    white = rng.normal(size=1000)
    assert independent_samples(white, 4, 1e3) == pytest.approx(1000, rel=0.2)
    drifting = np.repeat(rng.normal(size=100), 10)
    assert independent_samples(drifting, 4, 1e3) < 150
    assert independent_samples(np.zeros(10), 4, 0.0) == 10
    assert independent_samples(1e-9 * drifting, 4, 1e3) == 1000


def test_standard_errors_are_those_of_a_mean() -> None:
    residual = np.array([1.0, -1.0, 2.0, -2.0])
    (error,) = standard_errors(np.ones((4, 1)), residual, 4.0)
    assert error == pytest.approx(np.std(residual, ddof=1) / 2.0, rel=1e-12)
    with pytest.raises(
        FitRefused, match=r"^the samples do not tell the parameters of the fit apart"
    ):
        standard_errors(np.ones((4, 2)), residual, 4.0)
    with pytest.raises(FitRefused, match=r"^the samples leave a parameter of the fit undetermined"):
        standard_errors(np.zeros((4, 1)), residual, 4.0)


NOISE = np.random.default_rng(5).normal(0.0, 0.01, DEPTH.size)


@pytest.mark.parametrize(
    ("depth", "force", "message"),
    [
        (
            DEPTH[:20],
            load(1.5)[:20],
            "20 samples of approach and loading; 10 in air and 20 in contact are needed: sample "
            "faster",
        ),
        (
            np.zeros(50),
            np.arange(50.0),
            "the depth does not change during approach and loading",
        ),
        (
            DEPTH[60:],
            load(1.5)[60:] + NOISE[60:],
            "the record starts in contact, the load rises from the first sample on: fewer than "
            "10 samples lie in air before the contact "
            "point, so neither it nor the zero of the load is known; start the approach farther "
            "above the surface",
        ),
        (
            DEPTH[:60],
            load(1.5)[:60] + 20.0 * np.maximum(DEPTH[:60] - DEPTH[55], 0.0),
            "the load does not rise before the last 20 samples: the tip hardly touched",
        ),
        (
            DEPTH,
            -load(2.0),
            "the load nowhere begins to rise: the tip never touched",
        ),
    ],
)
def test_what_has_no_contact_point_is_refused(
    depth: FloatArray, force: FloatArray, message: str
) -> None:
    with pytest.raises(FitRefused) as caught:
        fit(1.5, force, depth)
    assert caught.value.reason == message


INSIDE = np.linspace(0.0, 4.0, 200)  # a record that starts in contact, or hardly before


def inside(exponent: float, depth0: float) -> FloatArray:
    rise: FloatArray = np.maximum(INSIDE - depth0, 0.0) ** exponent
    return OFFSET + K * rise


@pytest.mark.parametrize("depth0", [-7.0, -0.4, 0.5 * (INSIDE[8] + INSIDE[9])])
@pytest.mark.parametrize("exponent", [1.5, 2.0])
def test_a_contact_point_before_the_record_or_up_to_its_tenth_sample_is_found(
    exponent: float, depth0: float
) -> None:
    found = fit_in_contact(INSIDE, inside(exponent, depth0), exponent, 10, 20)
    assert found.depth0 == pytest.approx(depth0, abs=1e-4)
    assert found.stiffness == pytest.approx(K, rel=1e-4)
    assert found.offset == pytest.approx(OFFSET, abs=1e-2)


def test_a_record_from_inside_contact_has_no_tilt_but_says_what_one_would_change() -> None:
    noise = np.random.default_rng(8).normal(0.0, 0.02, INSIDE.size)
    force = inside(1.5, -0.4) + noise
    found = fit_in_contact(INSIDE, force, 1.5, 10, 20)
    assert found.tilt == 0.0
    tilted = fit_in_contact(INSIDE, force + 1e-3 * INSIDE, 1.5, 10, 20)
    change = (tilted.stiffness - found.stiffness) / found.stiffness
    assert 1e-3 * found.per_tilt == pytest.approx(change, rel=0.01)


def test_the_noise_of_the_load_comes_out() -> None:
    noise = np.random.default_rng(9).normal(0.0, 0.02, DEPTH.size)
    assert fit(1.5, load(1.5) + noise).residual_sd == pytest.approx(0.02, rel=0.1)
    force = inside(1.5, -0.4) + noise[: INSIDE.size]
    found = fit_in_contact(INSIDE, force, 1.5, 10, 20)
    assert found.residual_sd == pytest.approx(0.02, rel=0.1)


@pytest.mark.parametrize("exponent", [1.5, 2.0])
def test_air_is_told_from_contact_only_where_there_is_some(exponent: float) -> None:
    noise = np.random.default_rng(10).normal(0.0, 0.02, DEPTH.size)
    force = load(exponent) + noise
    assert has_air(fit(exponent, force), fit_in_contact(DEPTH, force, exponent, 10, 20))
    force = inside(exponent, 0.1) + noise[: INSIDE.size]
    with_air = fit_contact(INSIDE, force, exponent, 3, 20)
    assert not has_air(with_air, fit_in_contact(INSIDE, force, exponent, 10, 20))
