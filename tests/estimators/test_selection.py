from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from deamat.core.errors import FitRefused
from deamat.estimators.least_squares.checks import ErrorScale
from deamat.estimators.least_squares.linear import LinearFit, fit_linear
from deamat.estimators.least_squares.polynomial import PolynomialFit, fit_polynomial
from deamat.estimators.selection import (
    DECISIVE,
    Enough,
    aicc,
    akaike_weights,
    averaged,
    choose,
    choose_for,
    leave_one_out_sd,
)

HOURS = np.linspace(1, 12, 23)
# Sylgard 184 (10:1) and 182 (10:1), Sikulskyi et al. 2022, Table 2.
QUARTIC = np.polynomial.polynomial.polyval(HOURS, [2.5, 0.493, 0.207, -0.0674, 0.00743])
LINE = 1.64 + 0.267 * HOURS


def orders(
    y: np.ndarray,
    most: int,
    sigma: np.ndarray | None = None,
    error_scale: ErrorScale = "estimated",
    x: np.ndarray = HOURS,
) -> list[tuple[str, Callable[[], PolynomialFit]]]:
    def candidate(degree: int) -> tuple[str, Callable[[], PolynomialFit]]:
        return f"order {degree}", lambda: fit_polynomial(x, y, degree, sigma, error_scale)

    return [candidate(degree) for degree in range(most + 1)]


@pytest.mark.parametrize(("error_scale", "cases"), [("estimated", 1000), ("known", 150)])
def test_of_a_thousand_straight_lines_hardly_any_is_called_a_curve(
    error_scale: ErrorScale, cases: int
) -> None:
    rng = np.random.default_rng(21)
    x, line = HOURS[::2], LINE[::2]  # every hour
    sigma = np.full(len(x), 0.05)
    higher = 0
    for _ in range(cases):
        y = line + sigma * rng.normal(size=len(x))
        higher += choose(orders(y, 4, sigma, error_scale, x)[1:]).fit.degree > 1
    assert higher < 0.03 * cases  # promised are 5 %


@pytest.mark.parametrize(("noise", "least", "most"), [(0.005, 39, 40), (0.3, 0, 10)])
def test_the_quartic_is_found_when_the_noise_allows_and_only_then(
    noise: float, least: int, most: int
) -> None:
    rng = np.random.default_rng(22)
    found = []
    for _ in range(40):
        y = QUARTIC * (1 + noise * rng.normal(size=len(HOURS)))
        found.append(choose(orders(y, 6, QUARTIC)).fit.degree)
    assert least <= found.count(4) <= most
    assert max(found) <= 5
    if noise > 0.1:
        assert np.median(found) < 4


def test_the_answer_records_what_was_tried_and_why() -> None:
    rng = np.random.default_rng(23)
    choice = choose(orders(LINE + 0.05 * rng.normal(size=len(HOURS)), 3))
    assert choice.name == "order 1"
    assert [t.name for t in choice.tried] == ["order 0", "order 1", "order 2", "order 3"]
    assert [t.parameter_count for t in choice.tried] == [1, 2, 3, 4]
    assert all(t.leave_one_out_sd is not None and t.refusal == "" for t in choice.tried)
    scores = [t.aicc for t in choice.tried]
    assert scores[1] == aicc(choice.fit)
    assert choice.reason == (
        f"order 1: AICc {scores[1]:.1f} is the lowest; the best cheaper law, order 0, has "
        f"{scores[0]:.1f}"
    )


def test_a_cheaper_law_wins_unless_it_is_clearly_worse() -> None:
    x = np.arange(20.0)
    # Residuals made so that the parabola is better, but not by enough.
    ripple = np.where(np.arange(20) % 2 == 0, 1.0, -1.0)
    bow = (x - 9.5) ** 2 - np.mean((x - 9.5) ** 2)
    weak, strong = 0.02 * bow, 0.05 * bow
    for extra, name in ((weak, "order 1"), (strong, "order 2")):
        choice = choose(orders(x + ripple + extra, 2, x=x))
        assert choice.name == name
        line, parabola = choice.tried[1].aicc, choice.tried[2].aicc
        assert line is not None
        assert parabola is not None
        assert parabola < line
        assert (line - parabola <= DECISIVE) == (name == "order 1")
    assert "order 1: AICc " in choose(orders(x + ripple + weak, 2, x=x)).reason
    assert f"is within {DECISIVE:g} of the lowest, 10.5 of order 2; " in (
        choose(orders(x + ripple + weak, 2, x=x)).reason
    )


def test_refused_candidates_are_recorded_and_passed_over() -> None:
    x = np.array([1.0, 2, 3, 4, 5, 6])
    choice = choose(orders(x + np.array([0.1, -0.1, 0.1, 0, -0.1, 0.1]), 6, x=x))
    told = {t.name: t.refusal for t in choice.tried}
    assert choice.name == "order 1"
    assert told["order 4"] == (
        "AICc of 5 parameters and an error scale needs at least 8 points, not 6"
    )
    assert told["order 6"].startswith("7 parameters need at least 8 points, not 6")


def test_exact_data_get_the_law_they_were_made_with() -> None:
    assert choose(orders(2 + 3 * HOURS, 6)).fit.degree == 1
    assert choose(orders(QUARTIC, 6)).fit.degree == 4
    assert choose(orders(np.round(4 * HOURS) ** 2, 6, x=np.round(4 * HOURS))).fit.degree == 2


def test_the_score_does_not_prefer_units() -> None:
    rng = np.random.default_rng(24)
    y = LINE + 0.05 * rng.normal(size=len(HOURS))
    small, large = orders(y, 3), orders(1e6 * y, 3)
    differences = [aicc(large[k][1]()) - aicc(small[k][1]()) for k in range(4)]
    np.testing.assert_allclose(differences, 2 * len(HOURS) * np.log(1e6), rtol=1e-12)


def test_leave_one_out_is_what_leaving_one_out_gives() -> None:
    rng = np.random.default_rng(25)
    sigma = 0.02 * QUARTIC
    y = QUARTIC + sigma * rng.normal(size=len(HOURS))
    errors = []
    for i in range(1, len(HOURS) - 1):  # a window without its end would have to extrapolate
        rest = np.arange(len(HOURS)) != i
        without = fit_polynomial(HOURS[rest], y[rest], 4, sigma[rest])
        errors.append((y[i] - float(without(HOURS[i])[0])) / sigma[i])
    fit = fit_polynomial(HOURS, y, 4, sigma)
    shortcut = fit.weighted_residuals / (1 - fit.leverages)
    np.testing.assert_allclose(shortcut[1:-1], errors, rtol=1e-9)
    assert leave_one_out_sd(fit) == pytest.approx(np.sqrt(np.mean(shortcut**2)), rel=1e-14)


def test_what_cannot_be_scored_is_refused() -> None:
    design = np.array([[1.0, 0], [1, 0], [1, 0], [1, 1]])
    alone = fit_linear(design, [1.0, 2, 4, 9])
    with pytest.raises(FitRefused) as refusal:
        leave_one_out_sd(alone)
    assert str(refusal.value) == (
        "point 3 alone determines a parameter: the others cannot predict it"
    )
    with pytest.raises(FitRefused) as refusal:
        choose([])
    assert str(refusal.value) == "no candidate law could be fitted: there are none"
    with pytest.raises(FitRefused) as refusal:
        choose([("flat", lambda: fit_linear(np.ones((5, 1)), np.zeros(5)))])
    assert str(refusal.value) == (
        "no candidate law could be fitted: flat: data that are all zero say nothing about a law"
    )


def test_scores_of_different_data_are_not_compared() -> None:
    def flat(n: int, error_scale: ErrorScale) -> Callable[[], LinearFit]:
        return lambda: fit_linear(np.ones((n, 1)), HOURS[:n], np.ones(n), error_scale)

    for other in (flat(8, "estimated"), flat(9, "known")):
        with pytest.raises(FitRefused) as refusal:
            choose([("a", flat(9, "estimated")), ("b", other)])
        assert str(refusal.value) == (
            "candidate laws must be fitted to the same data with the same errors"
        )


def asked(y: np.ndarray, at: float, tolerance: float) -> Enough[PolynomialFit]:
    def question(fit: PolynomialFit) -> tuple[float, float]:
        value, u = fit(at)
        return float(value), float(u)

    priced = [(name, float(k + 1), make) for k, (name, make) in enumerate(orders(y, 6))]
    return choose_for(priced, question, tolerance)


def test_the_cheapest_law_within_the_tolerance_answers() -> None:
    rng = np.random.default_rng(26)
    y = QUARTIC + 0.02 * rng.normal(size=len(HOURS))
    fine, coarse = asked(y, 6.5, 0.1), asked(y, 6.5, 8.0)
    assert fine.supported.name == coarse.supported.name == "order 4"
    assert fine.name == "order 4"
    assert int(coarse.name.removeprefix("order ")) < 3
    assert [t.cost for t in coarse.tried] == [1.0, 2, 3, 4, 5, 6, 7]
    assert coarse.error <= 8.0
    truth = float(np.polynomial.polynomial.polyval(6.5, [2.5, 0.493, 0.207, -0.0674, 0.00743]))
    assert abs(coarse.value - truth) < 2 * 8.0
    assert abs(fine.value - truth) < 4 * fine.error


def test_the_answer_says_what_a_finer_law_would_change() -> None:
    rng = np.random.default_rng(27)
    found = asked(QUARTIC + 0.02 * rng.normal(size=len(HOURS)), 6.5, 8.0)
    values = {t.name: t.value for t in found.tried}
    finer = values[found.finer]
    assert finer is not None
    assert found.finer == f"order {found.fit.degree + 1}"
    assert found.change == pytest.approx(finer - found.value)
    assert found.reason == (
        f"{found.name}: expected error {found.error:.3g}, within 8; "
        f"{found.finer} would change it by {found.change:.3g}"
    )


def test_a_tolerance_never_buys_a_law_that_the_data_do_not_support() -> None:
    rng = np.random.default_rng(28)
    for _ in range(30):
        found = asked(LINE + 0.05 * rng.normal(size=len(HOURS)), 6.5, 0.05)
        assert found.fit.degree <= found.supported.fit.degree


def test_the_expected_error_is_the_error_to_be_expected() -> None:
    rng = np.random.default_rng(29)
    truth = float(np.polynomial.polynomial.polyval(10.0, [1.64, 0.267]))
    squares, expected = [], []
    for _ in range(150):
        found = asked(LINE + 0.2 * rng.normal(size=len(HOURS)), 10.0, 5.0)
        squares.append((found.value - truth) ** 2)
        expected.append(found.error**2)
    assert 0.6 < np.mean(expected) / np.mean(squares) < 1.7


def test_what_cannot_be_asked_is_refused() -> None:
    with pytest.raises(FitRefused) as refusal:
        asked(QUARTIC + np.where(np.arange(23) % 2 == 0, 1.0, -1.0), 6.5, 0.01)
    assert str(refusal.value).startswith(
        "no law that the data support answers within 0.01: the least expected error is "
    )
    with pytest.raises(FitRefused, match=r"^a tolerance must be positive, not 0$"):
        asked(QUARTIC, 6.5, 0.0)
    line = orders(LINE, 1)
    dearest_first = [
        (name, cost, make) for (name, make), cost in zip(line, (2.0, 1.0), strict=True)
    ]
    with pytest.raises(FitRefused) as refusal:
        choose_for(dearest_first, lambda _: (0.0, 0.0), 1.0)
    assert str(refusal.value) == (
        "candidate laws must come with the cheapest first, not at costs [2.0, 1.0]"
    )


def test_weights_follow_squares_and_counts_of_parameters() -> None:
    rng = np.random.default_rng(31)
    y = LINE + 0.05 * rng.normal(size=len(HOURS))
    fits = [make() for _, make in orders(y, 3)]
    weights = akaike_weights(fits, np.zeros(4))
    assert weights.sum() == pytest.approx(1.0)
    chi = [float(np.square(fit.residuals).sum()) for fit in fits]
    by_hand = (chi[2] / chi[1]) ** (len(y) / 2) * np.exp(3 - 2)
    assert weights[1] / weights[2] == pytest.approx(by_hand, rel=1e-9)
    handicapped = akaike_weights(fits, [0.0, 0.0, 3.0, 0.0])
    assert handicapped[1] / handicapped[2] == pytest.approx(by_hand * np.exp(1.5), rel=1e-9)
    with pytest.raises(FitRefused, match="there is no law to weigh"):
        akaike_weights([], [])


def test_an_average_holds_the_spread_of_its_laws_and_their_few_readings() -> None:
    value, u = averaged([1.0, 3.0], [0.0, 0.0], [1e9, 1e9], [3.0, 1.0])
    assert (value, u) == pytest.approx((1.5, np.sqrt(0.75 * 0.25 + 0.25 * 2.25)))
    value, u = averaged([2.0], [1.0], [7.0], [1.0])
    assert (value, u) == pytest.approx((2.0, 2.3646 / 1.95996), rel=1e-4)
    value, u = averaged([1.0, 3.0], [0.0, 0.0], [1e9, 1e9], [1.0, 1.0], about=1.0)
    assert (value, u) == pytest.approx((1.0, np.sqrt(2.0)))


def test_intervals_hold_after_the_choice_of_an_order() -> None:
    """Twelve hourly readings of a cubic with 3 % noise: the law chosen alone holds in 63-91 %."""
    rng = np.random.default_rng(32)
    hours, asked = np.arange(1.0, 13.0), np.array([1.0, 3.0, 6.0, 9.0, 12.0])
    cubic = np.polynomial.polynomial.Polynomial([4.36, 1.2, -0.13, 0.0146])
    hits = np.zeros(5)
    for _ in range(300):
        y = cubic(hours) * (1.0 + 0.03 * rng.normal(size=12))
        fits = [make() for _, make in orders(y, 5, 0.03 * y, x=hours)]
        weights = akaike_weights(fits, np.zeros(6))
        for i, hour in enumerate(asked):
            each = [fit(hour) for fit in fits]
            value, u = averaged(
                [float(v) for v, _ in each], [float(s) for _, s in each],
                [fit.dof for fit in fits], weights,
            )  # fmt: skip
            hits[i] += abs(value - cubic(hour)) <= 1.96 * u
    assert np.all(hits >= 0.91 * 300), hits  # 93 to 97 % within three standard errors
    assert np.all(hits <= 0.99 * 300), hits
