"""Weibull shape, scale and quantiles with exact conditional intervals."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from benchmarks.stability.cells import Draw, Estimator, Failure, Told, refused
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.weibull.goodness import goodness_of_fit, low_outlier
from deamat.estimators.weibull.intervals import infer

Sample = tuple[FloatArray, NDArray[np.bool_] | None]
_SCALE, _SHAPE = 97.0, 8.0
_LEVEL = 0.05
_PROBABILITIES = (0.1, 0.01)

Strength = Callable[[np.random.Generator, int], FloatArray]


def weibull_quantile(p: float) -> float:
    """Quantile of the truth."""
    return float(_SCALE * (-np.log1p(-p)) ** (1.0 / _SHAPE))


_P_SCALE = 1.0 - np.exp(-1.0)
_TRUTH = np.array([_SHAPE, _SCALE, *(weibull_quantile(p) for p in _PROBABILITIES)])


def _weibull(rng: np.random.Generator, n: int) -> FloatArray:
    return _SCALE * rng.weibull(_SHAPE, n)


def _drawn(
    *,
    weak: int = 0,
    weakness: float = 0.5,
    stopped: float = 0.0,
    limit: float = 0.0,
    step: float = 0.0,
    unit: float = 1.0,
) -> Draw:
    """Draw n breakdown fields of a Weibull truth.

    Parameters
    ----------
    weak, weakness : specimens at this part of their strength
    stopped : part of the specimens left when the test is stopped at a failure (type II)
    limit : probability to survive the highest field that the source gives (type I)
    step : rounding
    """

    def draw(rng: np.random.Generator, n: int) -> tuple[Sample, FloatArray]:
        x = _weibull(rng, n)
        x[:weak] *= weakness
        if step:
            x = np.maximum(np.round(x / step), 1.0) * step
        end = np.inf
        if stopped:
            end = float(np.sort(x)[max(round(n * (1.0 - stopped)), 1) - 1])
        if limit:
            end = weibull_quantile(1.0 - limit)
        censored = x > end
        factors = np.array([1.0, unit, unit, unit])
        marks = censored if censored.any() else None
        return (unit * np.minimum(x, end), marks), _TRUTH * factors

    return draw


def _other(strength: Strength, quantile: Callable[[float], float]) -> Draw:
    """Draw from another distribution; its shape is no truth, so that question is not judged."""
    asked = [quantile(p) for p in (_P_SCALE, *_PROBABILITIES)]

    def draw(rng: np.random.Generator, n: int) -> tuple[Sample, FloatArray]:
        return (strength(rng, n), None), np.array([np.nan, *asked])

    return draw


def _lognormal(sigma: float) -> Draw:
    from scipy.special import ndtri

    return _other(
        lambda rng, n: _SCALE * np.exp(sigma * rng.standard_normal(n)),
        lambda p: _SCALE * float(np.exp(sigma * ndtri(p))),
    )


def _threshold(part: float) -> Draw:
    """Draw from a 3-parameter Weibull of shape 2 that starts at this part of its scale."""
    low, rest = part * _SCALE, (1.0 - part) * _SCALE
    return _other(
        lambda rng, n: low + rest * rng.weibull(2.0, n),
        lambda p: low + rest * float((-np.log1p(-p)) ** 0.5),
    )


def _ask(samples: Sequence[Sample]) -> list[Told]:
    return [_ask_one(*sample) for sample in samples]


def _ask_one(x: FloatArray, censored: NDArray[np.bool_] | None) -> Told:
    try:
        asked = infer(x, censored)
        fits = goodness_of_fit(x, censored).p_value >= _LEVEL
        lowest = low_outlier(x, censored)
    except FitRefused:
        return refused(4)
    found = [asked.shape(), asked.scale(), *(asked.quantile(p) for p in _PROBABILITIES)]
    # "extrapolated" stands on every B1 below 100 specimens: what is always there warns of nothing
    own = {name for name, _ in asked.fit.warnings}
    flags = frozenset(
        own | (set() if fits else {"misfit"}) | ({"low outlier"} if lowest.found else set())
    )
    low, high = np.array([(i.low, i.high) for i in found]).T
    return Told(low, high, (flags,) * 4)


_SCALES = (1e-6, 1e-3, 1.0, 1e3, 1e6)
_FAILURES = (
    Failure("specimens", (("sound", _drawn()),), sizes=(2, 3, 5, 20, 100)),
    Failure("at half strength", tuple((f"{k} of n", _drawn(weak=k)) for k in (1, 2, 3))),
    Failure(
        "one weak specimen",
        tuple((f"at {w:g}", _drawn(weak=1, weakness=w)) for w in (0.9, 0.8, 0.7, 0.6, 0.3)),
    ),
    Failure(
        "type II censoring",
        tuple((f"{100 * v:g} %", _drawn(stopped=v)) for v in (0.1, 0.25, 0.5, 0.75, 0.9)),
    ),
    Failure(
        "type I censoring",
        tuple((f"{100 * v:g} %", _drawn(limit=v)) for v in (0.1, 0.25, 0.5, 0.75, 0.9)),
    ),
    Failure("rounding to V/µm", tuple((f"{v:g}", _drawn(step=v)) for v in (1, 5, 10, 20, 40))),
    Failure("lognormal truth", tuple((f"sd ln {v:g}", _lognormal(v)) for v in (0.05, 0.15, 0.5))),
    Failure(
        "3-parameter truth",
        tuple((f"starts at {v:g}", _threshold(v)) for v in (0.1, 0.3, 0.5, 0.7, 0.9)),
    ),
    Failure("unit of field", tuple((f"{u:g}", _drawn(unit=u)) for u in _SCALES)),
)
ESTIMATOR = Estimator(
    "Weibull", ("shape", "scale", "B10", "B1"), (5, 20, 100), _FAILURES, _ask, "weibull", 100
)
