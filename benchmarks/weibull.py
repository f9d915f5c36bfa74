"""How fast and how honest the Weibull estimators are: fits a second, and coverage beside rivals.

`python -m benchmarks.weibull` draws samples of scale 97 and shape 8 and prints the processor time
of fits and conditional intervals, alone and in batches, and how often nominal 95 % intervals of the
shape, the scale and B1 cover the truth. All of it is simulated; nothing of it is a measurement.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import numpy as np

from benchmarks.rivals.weibull import (
    RivalIntervals,
    bootstrap_intervals,
    likelihood_ratio_intervals,
    wald_intervals,
)
from benchmarks.timing import Row, stay_on_one_core, table, write_results
from deamat.core.arrays import FloatArray
from deamat.estimators.weibull.conditional import condition
from deamat.estimators.weibull.fit import fit, fit_batch
from deamat.estimators.weibull.intervals import Interval, infer

_SCALE, _SHAPE = 97.0, 8.0
_B1 = float(_SCALE * (-np.log(0.99)) ** (1 / _SHAPE))
_LOG_HAZARD_B1 = float(np.log(-np.log(0.99)))
_LEVEL = 0.95
_RIVALS: dict[str, Callable[[FloatArray], RivalIntervals]] = {
    "Wald, log": lambda x: wald_intervals(x, level=_LEVEL, probabilities=(0.01,)),
    "likelihood ratio": lambda x: likelihood_ratio_intervals(
        x, level=_LEVEL, probabilities=(0.01,)
    ),
    "bootstrap percentile": lambda x: bootstrap_intervals(
        x, level=_LEVEL, probabilities=(0.01,), draws=1000
    ),
}


def samples(n: int, m: int) -> FloatArray:
    """Draw m samples of n."""
    return _SCALE * np.random.default_rng([n, m]).weibull(_SHAPE, (m, n))


def conditional_bounds(x: FloatArray) -> FloatArray:
    """Conditional intervals of shape, scale and B1, shape (3, 2, m)."""
    blocks = [
        [b.shape(_LEVEL), b.quantile(0.0, _LEVEL), b.quantile(_LOG_HAZARD_B1, _LEVEL)]
        for b in condition(x)
    ]
    return np.concatenate(blocks, axis=2)


def card_intervals(x: FloatArray) -> list[Interval]:
    """Ask one sample for what a card prints."""
    asked = infer(x)
    return [asked.shape(), asked.scale(), asked.quantile(0.01), asked.quantile(0.1)]


def speed(n: int) -> list[Row]:
    """Time fits and intervals of samples of n, in processor time for each sample."""
    x = samples(n, 20_000)
    questions: dict[str, tuple[Callable[[], object], int]] = {
        "fit, batched": (lambda: fit_batch(x), len(x)),
        "fit, alone": (lambda: [fit(v) for v in x[:200]], 200),
        "3 conditional intervals, batched": (lambda: conditional_bounds(x[:1000]), 1000),
        "fit and 4 conditional intervals, alone": (
            lambda: [card_intervals(v) for v in x[:100]],
            100,
        ),
    }
    rows: list[Row] = []
    for name, (run, count) in questions.items():
        best = min(_seconds(run) for _ in range(5)) / count
        rows.append({"n": n, "what": name, "us a sample": 1e6 * best, "a second": 1.0 / best})
    return rows


def coverage(n: int, repetitions: int) -> list[Row]:
    """Count how often nominal 95 % intervals cover the truth `[%]`."""
    x = samples(n, repetitions)
    rows = [_coverage_row(n, "conditional", conditional_bounds(x))]
    for name, rival in _RIVALS.items():
        few = x[: repetitions // 10]
        bounds = np.array([[r.shape, r.scale, r.quantiles[0]] for r in map(rival, few)])
        rows.append(_coverage_row(n, name, bounds.transpose(1, 2, 0)))
    return rows


def _coverage_row(n: int, name: str, bounds: FloatArray) -> Row:
    truth = np.array([_SHAPE, _SCALE, _B1])[:, None]
    inside = 100.0 * np.mean((bounds[:, 0] <= truth) & (truth <= bounds[:, 1]), axis=1)
    shape, scale, b1 = (float(value) for value in inside)
    repetitions = bounds.shape[2]
    return {
        "n": n,
        "interval": name,
        "samples": repetitions,
        "shape": shape,
        "scale": scale,
        "B1": b1,
    }


def _seconds(run: Callable[[], object]) -> float:
    start = time.process_time()
    run()
    return time.process_time() - start


def main() -> None:
    """Print both tables and write them beside the other results."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repetitions", type=int, default=10_000)
    repetitions = parser.parse_args().repetitions
    stay_on_one_core()
    speeds = [row for n in (5, 20) for row in speed(n)]
    covered = [row for n in (5, 10, 20) for row in coverage(n, repetitions)]
    print(table(speeds), table(covered), sep="\n\n")
    write_results("weibull_speed", speeds, ["numpy", "scipy"])
    write_results("weibull_coverage", covered, ["numpy", "scipy"])


if __name__ == "__main__":
    main()
