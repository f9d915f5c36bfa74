"""The conditional distributions of Weibull parameters, for many samples at once.

Given how the values of a sample lie relative to each other, shape and scale have exactly known
distributions. With z = ln(x / max x), r failures, S0(k) = sum over all of exp(k z),

    p(k)           ~ k^(r-2) exp(k sum_failed z) / S0(k)^r                                  (1)
    P(ln x_p <= t) = integral p(k) Q(r, S0(k) exp(A - k t)) dk,   A = ln(-ln(1 - p))        (2)

with t relative to ln max x and Q the regularised upper incomplete gamma function. A film of another
area only shifts A by -ln(area ratio). Integrals run over w = ln k by the trapezoidal rule, which
converges exponentially for such functions.

Source: Lawless, Technometrics 20 (1978) 355-364, and Statistical Models and Methods for Lifetime
Data, chapter 5; Trefethen and Weideman, SIAM Review 56 (2014) 385-458 on the rule.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.typing import ArrayLike
from scipy.special import digamma, gammaincc, gammaln, ndtri, polygamma, sici

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange
from deamat.estimators.weibull.fit import solve_shape
from deamat.estimators.weibull.sample import LogSamples, accepted, as_arrays, log_samples

Bounds = tuple[FloatArray, FloatArray]
Distribution = Callable[[FloatArray], tuple[FloatArray, FloatArray]]

_DROP = 30.0  # nodes reach to where p(w) has fallen by exp(-30) = 1e-13
_STEP = 0.4  # between nodes, of the narrowest feature: errors below 1e-9 with 3 failures
_ROWS = 64  # samples at once
_AT_ONCE = 32  # values summed at once: a block stays in the cache
_SERIES_LIMIT = 64  # failures up to which the finite series is faster than the library
_LARGEST_SERIES = 700.0  # exp(-700) is the least that a double holds with all digits
_MANY = 256  # values from which ln S0 is interpolated: summing them again for every question costs
_DEGREE = 40  # of the interpolation; its last coefficients say whether that was enough
_RESOLVED = 1e-13  # of ln S0, absolute; r times that is the error of ln p(w)
_MOST_NODES = 200_000  # 0.1 s for one sample of 20
_NEWTON_STEPS = 60
_CONVERGED = 1e-6  # Newton squares it in the last step


@dataclass(frozen=True, slots=True)
class Conditional:
    """What m samples say of shape, quantiles and failure probabilities.

    Parameters
    ----------
    samples : the m samples
    mode : most probable w = ln k, shape (m,)
    width : standard deviation of w, by the curvature there, shape (m,)
    low, high : range of w outside which p(w) is below 1e-13 of its peak, shape (m,)
    log_sum, mean : ln S0 and S1/S0 at the mode, shape (m,)
    log_sums : Chebyshev coefficients of ln S0 over `low` to `high`, shape (degree + 1, m); None
        where summing is cheap or the degree does not resolve it
    """

    samples: LogSamples
    mode: FloatArray
    width: FloatArray
    low: FloatArray
    high: FloatArray
    log_sum: FloatArray
    mean: FloatArray
    log_sums: FloatArray | None

    def shape(self, level: float) -> Bounds:
        """Bounds on the shape that leave (1 - level)/2 on either side, shape (m,) each."""
        nodes = _nodes(self, self.width)
        lower, upper = _central(_shape_distribution(nodes), self.mode, self.width, level)
        return np.exp(lower), np.exp(upper)

    def quantile(self, log_hazard: ArrayLike, level: float) -> Bounds:
        """Bounds on the value with hazard exp(A), equation (2).

        Parameters
        ----------
        log_hazard : A = ln(-ln(1 - p)) - ln(area ratio); 0 asks for the scale; scalar or (m,)
        level : of the interval, 0 to 1
        """
        a = np.broadcast_to(np.asarray(log_hazard, dtype=float), self.mode.shape)
        r, k = self.samples.failures, np.exp(self.mode)
        centre = (self.log_sum + a - digamma(r)) / k
        spread = np.hypot((self.mean - centre) * self.width, np.sqrt(polygamma(1, r)) / k)
        nodes = _nodes(self, self._feature(centre))

        def distribution(t: FloatArray) -> tuple[FloatArray, FloatArray]:
            below, density = _gamma_terms(nodes, r, a[:, None] - nodes.shape * t[:, None])
            return nodes.mean(below), nodes.mean(nodes.shape * density)

        lower, upper = _central(distribution, centre, spread, level)
        return self.samples.largest * np.exp(lower), self.samples.largest * np.exp(upper)

    def shape_below(self, shape: float) -> FloatArray:
        """Probability that the shape is at most this, shape (m,)."""
        at = np.full_like(self.mode, np.log(shape))
        return _shape_distribution(_nodes(self, self.width))(at)[0]

    def quantile_below(self, log_hazard: float, value: float) -> FloatArray:
        """Probability that the value with hazard exp(A) is at most `value`, equation (2), (m,)."""
        t = np.log(value / self.samples.largest)
        nodes = _nodes(self, self._feature(t))
        shift = log_hazard - nodes.shape * t[:, None]
        below, _ = _gamma_terms(nodes, self.samples.failures, shift)
        return nodes.mean(below)

    def log_hazard(self, field: ArrayLike, level: float) -> Bounds:
        """Bounds on ln(-ln(1 - F)), with F the fraction that does not survive `field`.

        Parameters
        ----------
        field : value asked about, scalar or (m,) `[unit of x]`
        level : of the interval, 0 to 1
        """
        t = np.log(np.asarray(field, dtype=float) / self.samples.largest)
        r, k = self.samples.failures, np.exp(self.mode)
        centre = digamma(r) - self.log_sum + k * t
        spread = np.hypot(k * (t - self.mean) * self.width, np.sqrt(polygamma(1, r)))
        nodes = _nodes(self, self._feature(t))

        def distribution(a: FloatArray) -> tuple[FloatArray, FloatArray]:
            above, density = _gamma_terms(nodes, r, a[:, None] - nodes.shape * t[:, None])
            return nodes.mean(1.0 - above), nodes.mean(density)

        return _central(distribution, centre, spread, level)

    def predictive(self, field: ArrayLike, area_ratio: float = 1.0) -> FloatArray:
        """Probability that the next specimen does not survive `field`, shape (m,).

        It is 1 - integral p(k) (1 + area_ratio exp(k t) / S0)^(-r) dk, good to 1e-12 absolute.
        """
        t = np.log(np.asarray(field, dtype=float) / self.samples.largest)
        r = self.samples.failures[:, None]
        nodes = _nodes(self, self._feature(t))
        log_odds = nodes.shape * t[:, None] + np.log(area_ratio) - nodes.log_sum
        probability: FloatArray = -np.expm1(-r * np.logaddexp(0.0, log_odds))
        return nodes.mean(probability)

    def _feature(self, t: FloatArray) -> FloatArray:
        """Width in w of what is integrated: of p(w), or of the step in Q, if that is steeper."""
        steep = np.exp(self.mode + self.width)  # steps sharpen towards large k
        slope = steep * np.abs(self.mean - t) * np.sqrt(self.samples.failures)
        return np.asarray(np.minimum(self.width, 1.0 / np.maximum(slope, 1e-300)))


def condition(x: ArrayLike, censored: ArrayLike | None = None) -> list[Conditional]:
    """Prepare m samples, in blocks that fit the cache.

    Parameters
    ----------
    x : values, shape (m, n)
    censored : true where a specimen left the test unbroken, shape (m, n)

    Raises
    ------
    FitRefused : any sample that `weibull.fit` refuses
    """
    values, failed = as_arrays(x, censored, ndim=2)
    mask = None if censored is None else failed
    good = accepted(values, mask)
    if not good.all():
        raise FitRefused(
            f"{int((~good).sum())} of {good.size} samples cannot be fitted (the first is sample "
            f"{int(np.argmin(good)) + 1}); weibull.fit says why"
        )
    return [
        _locate(log_samples(values[i : i + _ROWS], None if mask is None else mask[i : i + _ROWS]))
        for i in range(0, len(values), _ROWS)
    ]


@dataclass(frozen=True, slots=True)
class _Nodes:
    """Nodes of the trapezoidal rule, shape (m, N) each: w, k, ln S0(k) and p(w) dw."""

    w: FloatArray
    shape: FloatArray
    log_sum: FloatArray
    weight: FloatArray

    def mean(self, values: FloatArray) -> FloatArray:
        """Average over p(w), shape (m,)."""
        return np.asarray(np.einsum("ij,ij->i", self.weight, values))


def _locate(samples: LogSamples) -> Conditional:
    r = samples.failures
    k, log_sum = solve_shape(samples, (r - 1.0) / r)
    _, mean, variance = samples.power_sums(k)
    width = 1.0 / np.sqrt(r - 1.0 + r * k * k * variance)
    mode = np.log(k)
    low, high = (_edge(samples, mode, log_sum, sign * width) for sign in (-1.0, 1.0))
    series = _log_sum_series(samples, low, high)
    return Conditional(samples, mode, width, low, high, log_sum, mean, series)


def _log_sum_series(samples: LogSamples, low: FloatArray, high: FloatArray) -> FloatArray | None:
    """Interpolate ln S0 over w in Chebyshev points of the first kind."""
    if samples.log_ratio.shape[0] < _MANY:
        return None
    count = _DEGREE + 1
    x = np.cos(np.pi * (np.arange(count) + 0.5) / count)
    w = low[:, None] + (high - low)[:, None] * 0.5 * (1.0 + x)
    coefficients = 2.0 / count * chebvander(x, _DEGREE).T @ _log_sums(samples, np.exp(w)).T
    coefficients[0] /= 2.0
    return coefficients if np.abs(coefficients[-3:]).max() < _RESOLVED else None


def _log_sums(samples: LogSamples, shape: FloatArray) -> FloatArray:
    """Return ln S0 at the shapes of each sample, shape (m, N)."""
    total = np.zeros_like(shape)
    for start in range(0, samples.log_ratio.shape[0], _AT_ONCE):
        z = samples.log_ratio[start : start + _AT_ONCE]
        total += np.exp(shape[:, None, :] * z.T[:, :, None]).sum(axis=1)
    return np.log(total)


def _edge(
    samples: LogSamples, mode: FloatArray, log_sum: FloatArray, step: FloatArray
) -> FloatArray:
    """Walk from the mode until ln p(w) has dropped by 30 in every sample."""
    peak = _log_density(samples, mode, log_sum)
    reach = 5.0 * step
    for _ in range(100):
        w = mode + reach
        s0, _, _ = samples.power_sums(np.exp(w))
        short = peak - _log_density(samples, w, np.log(s0)) < _DROP
        if not short.any():
            break
        reach = np.where(short, 1.2 * reach, reach)
    return mode + reach


def _log_density(samples: LogSamples, w: FloatArray, log_sum: FloatArray) -> FloatArray:
    """Return ln p(w) up to a constant: equation (1) times dk/dw = k."""
    r = samples.failures
    return (r - 1.0) * w + r * (np.exp(w) * samples.mean_failed - log_sum)


def _nodes(given: Conditional, feature: FloatArray) -> _Nodes:
    samples = given.samples
    count = int(np.ceil(np.max((given.high - given.low) / (_STEP * feature))))
    if count > _MOST_NODES:
        raise OutOfRange(
            f"the question lies too far from the sample: it takes {count} nodes, and the limit is "
            f"{_MOST_NODES}; ask nearer to the measured values"
        )
    place = (np.arange(count) + 0.5) / count
    w = given.low[:, None] + (given.high - given.low)[:, None] * place
    shape = np.exp(w)
    if given.log_sums is None:
        log_sum = _log_sums(samples, shape)
    else:
        log_sum = (chebvander(2.0 * place - 1.0, _DEGREE) @ given.log_sums).T
    r = samples.failures[:, None]
    log_density = (r - 1.0) * w + r * (shape * samples.mean_failed[:, None] - log_sum)
    weight = np.exp(log_density - log_density.max(axis=1, keepdims=True))
    weight /= weight.sum(axis=1, keepdims=True)
    return _Nodes(w, shape, log_sum, weight)


def _shape_distribution(nodes: _Nodes) -> Distribution:
    """P(ln k <= w) from values at equal steps h, by the sinc formula for indefinite integrals.

    F(w) = sum of weight_j (1/2 + Si(pi (w - w_j)/h)/pi) is as exact as the trapezoidal rule.
    Source: Stenger, Numerical Methods Based on Sinc and Analytic Functions (1993), section 4.5.
    """
    h = nodes.w[:, 1:2] - nodes.w[:, 0:1]

    def distribution(w: FloatArray) -> tuple[FloatArray, FloatArray]:
        distance = (w[:, None] - nodes.w) / h
        return (
            nodes.mean(0.5 + sici(np.pi * distance)[0] / np.pi),
            nodes.mean(np.sinc(distance)) / h[:, 0],
        )

    return distribution


def _gamma_terms(nodes: _Nodes, r: FloatArray, shift: FloatArray) -> Bounds:
    """Q(r, u) and the density u^r exp(-u) / Gamma(r) of ln u, for ln u = ln S0 + shift."""
    # far beyond r nothing is left of Q, and exp must not overflow
    log_u = np.minimum(nodes.log_sum + shift, np.log(_LARGEST_SERIES + 10.0 * r)[:, None])
    u = np.exp(log_u)
    density = np.exp(r[:, None] * log_u - u - gammaln(r)[:, None])
    if r[0] > _SERIES_LIMIT or (r != r[0]).any():
        return gammaincc(r[:, None], u), density
    u = np.minimum(u, _LARGEST_SERIES)
    series = np.ones_like(u)  # Q(r, u) = exp(-u) sum of u^j / j! over j < r, by Horner
    for j in range(int(r[0]) - 1, 0, -1):
        series *= u
        series *= 1.0 / j
        series += 1.0
    series *= np.exp(-u)
    return series, density


def _central(
    distribution: Distribution, centre: FloatArray, spread: FloatArray, level: float
) -> Bounds:
    tail = ndtri(0.5 * (1.0 + level))
    return (
        _invert(distribution, centre, spread, -tail),
        _invert(distribution, centre, spread, tail),
    )


def _invert(
    distribution: Distribution, centre: FloatArray, spread: FloatArray, goal: float
) -> FloatArray:
    """Solve Phi^-1(F(x)) = goal by Newton within a bracket: the left side is nearly straight."""
    x = centre + goal * spread
    low, high = np.full_like(x, -np.inf), np.full_like(x, np.inf)
    for _ in range(_NEWTON_STEPS):
        probability, density = distribution(x)
        score = ndtri(np.clip(probability, 1e-300, 1.0 - 1e-16))
        np.copyto(low, x, where=score < goal)
        np.copyto(high, x, where=score >= goal)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            change = (goal - score) * np.exp(-0.5 * score * score) / (np.sqrt(2 * np.pi) * density)
            done = np.abs(change) <= _CONVERGED * spread
            proposed = x + np.clip(change, -3.0 * spread, 3.0 * spread)
            stray = ~(done | ((proposed > low) & (proposed < high)))
            if stray.any():
                outward = x + np.where(score < goal, 3.0, -3.0) * spread
                middle = 0.5 * (low + high)
                proposed = np.where(stray, np.where(np.isfinite(middle), middle, outward), proposed)
        x = proposed
        if done.all():
            return np.asarray(x)
    raise FitRefused("a conditional distribution could not be inverted")
