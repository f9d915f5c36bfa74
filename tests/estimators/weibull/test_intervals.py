from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from mpmath import mp, mpf, quad
from scipy.special import gammaincc

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange
from deamat.estimators.weibull.conditional import Conditional, condition
from deamat.estimators.weibull.intervals import P_SCALE, Inference, Interval, infer
from deamat.estimators.weibull.sample import BoolArray
from tests.estimators.weibull.samples import CABLE_I, simulated

A1, A10 = np.log(-np.log1p(-0.01)), np.log(-np.log1p(-0.1))


def on_a_fine_grid(x: FloatArray, failed: BoolArray, a: float, t: float) -> tuple[float, float]:
    """P(ln x_p <= t) and, for a shape of exp(a), P(shape <= exp(a)), with 50001 nodes."""
    z = np.log(x / x.max())
    r = int(failed.sum())
    w = np.linspace(-14.0, 8.0, 50_001)
    k = np.exp(w)
    log_sum = np.log(sum(np.exp(k * value) for value in z))
    log_density = (r - 1) * w + k * z[failed].sum() - r * log_sum
    weight = np.exp(log_density - log_density.max())
    weight /= weight.sum()
    above = gammaincc(r, np.exp(np.minimum(log_sum + a - k * t, 6.5)))
    cumulative = np.cumsum(weight) - 0.5 * weight
    return float(weight @ above), float(np.interp(a, w, cumulative))


def one(x: FloatArray, failed: BoolArray) -> Conditional:
    (given,) = condition(x[None, :], ~failed[None, :])
    return given


SAMPLES = {
    "3 complete": simulated(3, 1, seed=11, shape=3.0),
    "5 complete": simulated(5, 1, seed=12),
    "8 stopped at 6": simulated(8, 1, seed=13, stop_at=6),
    "20 complete": simulated(20, 1, seed=14),
    "20 of shape 0.5": simulated(20, 1, seed=15, shape=0.5),
    "70 of 100": simulated(100, 1, seed=16, stop_at=70),
}


@pytest.mark.parametrize(("x", "censored"), SAMPLES.values(), ids=SAMPLES)
def test_bounds_have_the_tail_probabilities_of_a_fine_grid(
    x: FloatArray, censored: BoolArray
) -> None:
    values, failed = x[0], ~censored[0]
    given = one(values, failed)
    for bound, tail in zip(given.shape(0.95), (0.025, 0.975), strict=True):
        assert on_a_fine_grid(values, failed, np.log(bound).item(), 0.0)[1] == pytest.approx(
            tail, abs=5e-7
        )
    for a in (0.0, A10, A1, np.log(1e-6)):
        bounds = given.quantile(a, 0.95)
        for bound, tail in zip(bounds, (0.025, 0.975), strict=True):
            t = np.log(bound / values.max()).item()
            assert on_a_fine_grid(values, failed, a, t)[0] == pytest.approx(tail, abs=2e-8)
        field = 0.8 * bounds[0].item()
        t = np.log(field / values.max())
        for bound, tail in zip(given.log_hazard(field, 0.95), (0.975, 0.025), strict=True):
            assert on_a_fine_grid(values, failed, bound.item(), t)[0] == pytest.approx(
                tail, abs=2e-8
            )


def test_both_equations_by_adaptive_quadrature_at_twenty_digits() -> None:
    cable = one(CABLE_I, np.ones(20, dtype=np.bool_))
    low, high = cable.quantile(A1, 0.95)
    with mp.workdps(20):
        z = [mp.log(mpf(float(v)) / mpf("56.3")) for v in CABLE_I]
        total = sum(z)

        def power_sum(k: mpf) -> mpf:
            return sum(mp.exp(k * value) for value in z)

        def density(k: mpf) -> mpf:
            return k**18 * mp.exp(k * total) / power_sum(k) ** 20

        def below(t: float) -> mpf:
            def integrand(k: mpf) -> mpf:
                u = power_sum(k) * mp.exp(mpf(A1) - k * mpf(t))
                series = sum(u**j / mp.factorial(j) for j in range(20))
                return density(k) * series * mp.exp(-u)

            return quad(integrand, pieces) / quad(density, pieces)

        pieces = [0, 4, 7, 9, 12, 16, 40]
        assert float(below(np.log(low.item() / 56.3))) == pytest.approx(0.025, abs=1e-10)
        assert float(below(np.log(high.item() / 56.3))) == pytest.approx(0.975, abs=1e-10)
        for bound, tail in zip(cable.shape(0.95), (0.025, 0.975), strict=True):
            inner = [*(k for k in pieces if k < bound.item()), mpf(bound.item())]
            share = quad(density, inner) / quad(density, pieces)
            assert float(share) == pytest.approx(tail, abs=1e-10)


@pytest.mark.parametrize(
    ("n", "stop_at"), [(5, None), (20, None), (8, 6)], ids=["5", "20", "8 stopped at 6"]
)
def test_intervals_cover_the_truth_as_often_as_they_say(n: int, stop_at: int | None) -> None:
    x, censored = simulated(n, 3000, seed=21, stop_at=stop_at)
    blocks = condition(x, None if stop_at is None else censored)
    hazard_at_60 = 8.0 * np.log(60.0 / 97.0)
    questions = {
        "shape": (8.0, [b.shape(0.95) for b in blocks]),
        "scale": (97.0, [b.quantile(0.0, 0.95) for b in blocks]),
        "B1": (97.0 * np.exp(A1 / 8.0), [b.quantile(A1, 0.95) for b in blocks]),
        "B10": (97.0 * np.exp(A10 / 8.0), [b.quantile(A10, 0.95) for b in blocks]),
        "at 60": (hazard_at_60, [b.log_hazard(60.0, 0.95) for b in blocks]),
    }
    for name, (truth, bounds) in questions.items():
        low, high = np.concatenate(bounds, axis=1)
        # one standard error of 3000 repetitions is 0.40 %
        assert 0.935 < np.mean((low <= truth) & (truth <= high)) < 0.965, name
        assert 0.015 < np.mean(truth < low) < 0.035, name


def test_the_predictive_probability_of_the_next_specimen_is_uniform() -> None:
    x, _ = simulated(6, 4000, seed=22)
    (following,) = x[:, 5:].T
    blocks = condition(x[:, :5])
    rank = np.concatenate(
        [b.predictive(following[64 * i : 64 * i + b.mode.size]) for i, b in enumerate(blocks)]
    )
    for p in (0.02, 0.1, 0.5, 0.9):
        assert np.mean(rank <= p) == pytest.approx(p, abs=4 * np.sqrt(p * (1 - p) / 4000))


def test_the_predictive_probability_is_the_mean_over_what_the_sample_says() -> None:
    asked = infer(CABLE_I)
    z = np.log(CABLE_I / 56.3)
    k = np.exp(np.linspace(-3.0, 4.0, 20_001))
    log_sum = np.log(np.exp(k[:, None] * z).sum(axis=1))
    weight = np.exp(19 * np.log(k) + k * z.sum() - 20 * log_sum + 80.0)
    survive = (1 + 3.0 * np.exp(k * np.log(30 / 56.3) - log_sum)) ** -20.0
    expected = 1 - (weight @ survive) / weight.sum()
    assert asked.predictive(30.0, area_ratio=3.0) == pytest.approx(expected, rel=1e-9)


Question = Callable[[Inference], Interval]


def interval(found: Interval) -> tuple[float, float, float]:
    return found.estimate, found.low, found.high


@pytest.mark.parametrize(("x", "censored"), SAMPLES.values(), ids=SAMPLES)
def test_units_and_powers_change_intervals_as_they_change_values(
    x: FloatArray, censored: BoolArray
) -> None:
    plain = infer(x[0], censored[0])
    scaled = infer(1e6 * x[0], censored[0])
    squared = infer(x[0] ** 2, censored[0])
    questions: tuple[Question, ...] = (lambda i: i.scale(), lambda i: i.quantile(0.01))
    for question in questions:
        values = np.array(interval(question(plain)))
        assert interval(question(scaled)) == pytest.approx(1e6 * values, rel=1e-9)
        assert interval(question(squared)) == pytest.approx(values**2, rel=1e-9)
    shape = np.array(interval(plain.shape()))
    assert interval(scaled.shape()) == pytest.approx(shape, rel=1e-9)
    assert interval(squared.shape()) == pytest.approx(shape / 2, rel=1e-9)
    probability = interval(plain.failure_probability(40.0))
    assert interval(scaled.failure_probability(40e6)) == pytest.approx(probability, rel=1e-8)


def test_probability_and_quantile_are_two_readings_of_one_bound() -> None:
    asked = infer(CABLE_I)
    b1 = asked.quantile(0.01)
    assert asked.failure_probability(b1.low).high == pytest.approx(0.01, rel=1e-7)
    assert asked.failure_probability(b1.estimate).estimate == pytest.approx(0.01, rel=1e-10)
    assert asked.failure_probability(b1.high).low == pytest.approx(0.01, rel=1e-7)
    larger = asked.quantile(0.01, area_ratio=30.0)
    assert asked.failure_probability(larger.low, 30.0).high == pytest.approx(0.01, rel=1e-7)
    assert asked.failure_probability(larger.estimate, 30.0).estimate == pytest.approx(0.01)


def test_cable_intervals_hold_their_estimates_and_narrow_with_the_level() -> None:
    wide, narrow = infer(CABLE_I), infer(CABLE_I, level=0.5)
    for i in (wide, narrow):
        for found in (i.shape(), i.scale(), i.quantile(0.1), i.failure_probability(20.0)):
            assert found.low < found.estimate < found.high
            assert found.exact
            assert found.method == "exact conditional"
            assert found.level == i.level
    assert wide.shape().low < narrow.shape().low < narrow.shape().high < wide.shape().high
    assert wide.quantile(P_SCALE).estimate == pytest.approx(wide.fit.scale, rel=1e-14)


def test_the_label_says_whether_the_interval_is_exact() -> None:
    x, censored = simulated(20, 1, seed=31, stop_at=15)
    assert infer(x[0], censored[0]).scale().exact
    later = infer(np.where(censored[0], 150.0, x[0]), censored[0]).scale()
    assert not later.exact
    assert later.method == "conditional, approximate for this censoring"


def test_questions_beyond_the_sample_are_warned_of() -> None:
    asked = infer(CABLE_I)
    assert asked.quantile(0.05).warnings == ()
    assert asked.quantile(0.01).warnings == (
        ("extrapolated", "p = 0.01 is below 1/n = 0.05: it rests on the Weibull form"),
    )
    (asked_on_larger,) = asked.quantile(0.1, area_ratio=10.0).warnings
    assert asked_on_larger[0] == "extrapolated"
    (low_field,) = asked.failure_probability(20.0).warnings
    assert low_field[0] == "extrapolated"
    assert infer(CABLE_I[:4]).shape().warnings[0][0] == "few_failures"


def test_impossible_questions_are_out_of_range() -> None:
    asked = infer(CABLE_I)
    with pytest.raises(OutOfRange, match="a level must lie between 0 and 1, not 95"):
        infer(CABLE_I, level=95)
    with pytest.raises(OutOfRange, match="a probability must lie between 0 and 1, not 0"):
        asked.quantile(0.0)
    with pytest.raises(OutOfRange, match="a field must lie above 0 and finite, not -3"):
        asked.failure_probability(-3.0)
    with pytest.raises(OutOfRange, match="an area ratio must lie above 0 and finite, not nan"):
        asked.predictive(40.0, float("nan"))
    with pytest.raises(OutOfRange, match="an area ratio must lie above 0 and finite, not inf"):
        asked.failure_probability(40.0, float("inf"))
    with pytest.raises(OutOfRange, match="an area ratio must lie above 0 and finite, not 0"):
        asked.quantile(0.5, 0.0)
    with pytest.raises(OutOfRange, match="the question lies too far from the sample"):
        infer(97.0 * (CABLE_I / 97.0) ** 0.001).failure_probability(1e-9)


def test_far_fields_fail_surely_or_hardly_ever() -> None:
    asked = infer(CABLE_I)
    assert asked.failure_probability(1e6).low == 1.0
    assert 0 < asked.failure_probability(0.1).high < 1e-6


def test_a_batch_with_a_refused_sample_is_refused() -> None:
    x, _ = simulated(5, 10, seed=41)
    x[7] = 1.0
    with pytest.raises(FitRefused) as caught:
        condition(x)
    assert str(caught.value) == (
        "1 of 10 samples cannot be fitted (the first is sample 8); weibull.fit says why"
    )


@pytest.mark.parametrize("n", [300, 700, 10_000])
def test_many_failures_get_the_intervals_of_direct_summation(n: int) -> None:
    x, censored = simulated(n, 1, seed=51)
    values, failed = x[0], ~censored[0]
    given = one(values, failed)
    z = np.log(values / values.max())
    w = given.mode + given.width * np.linspace(-9.0, 9.0, 1201)
    k = np.exp(w)
    log_sum = np.log([np.exp(one_k * z).sum() for one_k in k])
    log_density = (n - 1) * w + n * (k * z.mean() - log_sum)
    weight = np.exp(log_density - log_density.max())
    weight /= weight.sum()
    for a in (0.0, A10, A1):
        for bound, tail in zip(given.quantile(a, 0.95), (0.025, 0.975), strict=True):
            t = np.log(bound / values.max())
            assert weight @ gammaincc(n, np.exp(log_sum + a - k * t)) == pytest.approx(
                tail, rel=1e-8
            )
    for bound, tail in zip(given.shape(0.95), (0.025, 0.975), strict=True):
        cumulative = np.cumsum(weight) - 0.5 * weight
        assert np.interp(np.log(bound), w, cumulative) == pytest.approx(tail, abs=1e-5)
