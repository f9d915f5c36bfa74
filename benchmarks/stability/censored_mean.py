"""Means of strips of which some did not break."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmarks.stability.cells import Draw, Estimator, Failure, Told, refused
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.censored_mean import BoolArray, mean_with_limits

Strips = tuple[FloatArray, BoolArray]
_SCATTER = 0.1


def _drawn(
    *, end: float = 1.05, scatter: float = _SCATTER, skew: float = 0.0, unit: float = 1.0
) -> Draw:
    """Draw n strips around 1, on a machine that ends at `end`.

    Parameters
    ----------
    skew : standard deviation of ln x of a lognormal scatter, instead of a normal one
    """

    def draw(rng: np.random.Generator, n: int) -> tuple[Strips, FloatArray]:
        normal = rng.standard_normal(n)
        x = np.exp(skew * normal - 0.5 * skew**2) if skew else 1.0 + scatter * normal
        limit = x > end
        return (unit * np.minimum(x, end), limit), np.array([unit])

    return draw


def _ask(samples: Sequence[Strips]) -> list[Told]:
    told = []
    for values, limit in samples:
        try:
            mean = mean_with_limits(values.tolist(), limit.tolist(), 0.0)
        except FitRefused:
            told.append(refused(1))
            continue
        flags = frozenset({"no-break"} if limit.any() else set[str]())
        low, high = mean.ci95
        told.append(Told(np.array([low]), np.array([high]), (flags,)))
    return told


def _settings(name: str, values: Sequence[float]) -> tuple[tuple[str, Draw], ...]:
    return tuple((f"{v:g}", _drawn(**{name: v})) for v in values)


_FAILURES = (
    Failure("machine ends at, means", _settings("end", (1.3, 1.1, 1.0, 0.95, 0.85))),
    Failure("scatter", _settings("scatter", (0.01, 0.05, 0.1, 0.2, 0.4))),
    Failure("lognormal, sd ln", _settings("skew", (0.05, 0.1, 0.2, 0.4, 0.8))),
    Failure("unit", _settings("unit", (1e-6, 1e-3, 1.0, 1e3, 1e6))),
)
ESTIMATOR = Estimator("mean with limits", ("mean",), (5, 8, 20), _FAILURES, _ask, "mean")
