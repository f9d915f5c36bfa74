"""Means over specimens with a shared error."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmarks.stability.cells import Draw, Estimator, Failure, Told
from deamat.core.arrays import FloatArray
from deamat.estimators.mean import mean_with_shared, outliers

Sample = tuple[FloatArray, float, float]  # values, own and shared uncertainty
_SCATTER = 0.05


def _drawn(
    *,
    shared: float = 0.01,
    weak: int = 0,
    step: float = 0.0,
    unit: float = 1.0,
    skew: float = 0.0,
    related: float = 0.0,
) -> Draw:
    """Draw n specimens around 1.

    Parameters
    ----------
    shared : standard error common to all, declared
    weak : specimens at half the value
    step : rounding
    skew : standard deviation of ln x of a lognormal scatter, instead of a normal one of 5 %
    related : part of the scatter that neighbours of one batch share, not declared
    """

    def draw(rng: np.random.Generator, n: int) -> tuple[Sample, FloatArray]:
        scatter = _SCATTER * rng.standard_normal(n)
        scatter = np.sqrt(1.0 - related) * scatter + np.sqrt(related) * _SCATTER * rng.normal()
        x = np.exp(skew * rng.standard_normal(n) - 0.5 * skew**2) if skew else 1.0 + scatter
        x = x + shared * rng.normal()
        x[:weak] *= 0.5
        if step:
            x = np.round(x / step) * step
        return (unit * x, unit * _SCATTER, unit * shared), np.array([unit])

    return draw


def _ask(samples: Sequence[Sample]) -> list[Told]:
    told = []
    for values, own, shared in samples:
        mean = mean_with_shared(values.tolist(), own, shared)
        flags = frozenset({"outlier"} if outliers(values.tolist()) else set()) | (
            frozenset({"single-specimen"}) if mean.n == 1 else frozenset()
        )
        told.append(Told(np.array([mean.ci95[0]]), np.array([mean.ci95[1]]), (flags,)))
    return told


_SCALES = (1e-6, 1e-3, 1.0, 1e3, 1e6)
_FAILURES = (
    Failure("specimens", (("sound", _drawn()),), sizes=(1, 2, 3, 5, 20)),
    Failure(
        "shared error",
        tuple((f"{100 * v:g} %", _drawn(shared=v)) for v in (0.0, 0.01, 0.05, 0.2, 1.0)),
    ),
    Failure("at half value", tuple((f"{k} of n", _drawn(weak=k)) for k in (1, 2))),
    Failure("rounding", tuple((f"{v:g}", _drawn(step=v)) for v in (0.01, 0.05, 0.1, 0.2, 0.5))),
    Failure(
        "lognormal", tuple((f"sd ln {v:g}", _drawn(skew=v)) for v in (0.1, 0.3, 0.5, 1.0, 2.0))
    ),
    Failure(
        "undeclared batch error",
        tuple((f"{100 * v:g} % of variance", _drawn(related=v)) for v in (0.05, 0.2, 0.5, 0.8)),
    ),
    Failure("unit", tuple((f"{u:g}", _drawn(unit=u)) for u in _SCALES)),
)
ESTIMATOR = Estimator("mean", ("mean",), (3, 5, 20), _FAILURES, _ask, "mean")
