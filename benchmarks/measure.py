"""Error and time of estimators on the same simulated data, and which of them are on the front."""

from __future__ import annotations

import gc
import importlib.util
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Generic, TypeVar

import numpy as np

from benchmarks.timing import Row
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused

Sample = TypeVar("Sample")

_PARTS = 16  # contenders take turns this often, so that a drift of the machine hits all alike
_ALPHA = 0.05
# Relative differences that can be told: the same estimator timed twice in one run differs by some
# 10 % (20 % on a busy machine); 1 % are two standard errors of the closest errors, for all
# contenders answer the same samples.
_CLOCK, _SIMULATION = 0.1, 0.01


@dataclass(frozen=True, slots=True)
class Answer:
    """Estimates and nominal 95 % intervals of k questions, shape (k,) each."""

    value: FloatArray
    low: FloatArray
    high: FloatArray


@dataclass(frozen=True, slots=True)
class Contender(Generic[Sample]):
    """One estimator.

    Parameters
    ----------
    name : as charts and tables print it
    fit : one sample to the answers
    default : what the pipeline uses
    outside : a peer from another package
    every : slow ones take only each so-manieth sample
    """

    name: str
    fit: Callable[[Sample], Answer]
    default: bool = False
    outside: bool = False
    every: int = 1


def is_there(package: str) -> bool:
    """Say whether an optional rival is installed; a missing one is skipped with a message."""
    if importlib.util.find_spec(package) is not None:
        return True
    print(f"{package} is not installed: skipped")
    return False


def run(
    contenders: Sequence[Contender[Sample]], samples: Sequence[Sample], questions: int
) -> dict[str, tuple[FloatArray, float]]:
    """Let all contenders answer, turn by turn, in another order each time.

    As in timeit, no garbage is collected within a part: it would be charged to whom it hits.

    Returns
    -------
    by name: answers, shape (samples, 3, questions), NaN where refused or not asked; and the least
    over the parts of the mean processor time of a fit `[s]`: other load only ever adds to it
    """
    answers = {c.name: np.full((len(samples), 3, questions), np.nan) for c in contenders}
    seconds: dict[str, list[float]] = {c.name: [] for c in contenders}
    for c in contenders:  # imports and caches are not what a fit costs
        _answer(c, samples[0])
    bounds = np.linspace(0, len(samples), _PARTS + 1).astype(int).tolist()
    rng = np.random.default_rng(1)
    for first, last in pairwise(bounds):
        for c in [contenders[k] for k in rng.permutation(len(contenders))]:
            chosen = [i for i in range(first, last) if i % c.every == 0]
            if not chosen:
                continue
            gc.collect()
            gc.disable()
            start = time.process_time()
            found = [_answer(c, samples[i]) for i in chosen]
            seconds[c.name].append((time.process_time() - start) / len(chosen))
            gc.enable()
            for i, answer in zip(chosen, found, strict=True):
                if answer is not None:
                    answers[c.name][i] = answer.value, answer.low, answer.high
    return {name: (answers[name], min(seconds[name])) for name in answers}


def _answer(contender: Contender[Sample], sample: Sample) -> Answer | None:
    try:
        return contender.fit(sample)
    except FitRefused:
        return None


def statistics(answers: FloatArray, truth: FloatArray) -> dict[str, float]:
    r"""Summarise answers, shape (m, 3, k), against truths, shape (m, k), relative to these.

    The interval error is the score $(u - l) + \tfrac{2}{\alpha} \cdot$ (distance by which the
    interval misses): it punishes an interval both for its width and for missing the truth, and on
    average is least for the interval that states what is known. Answers that are refused or not
    finite count as failed and enter nothing else.

    Source: T. Gneiting, A. E. Raftery, J. Am. Stat. Assoc. 102 (2007) 359, equation 43.
    """
    asked = answers / truth[:, None, :] - 1.0
    good = np.isfinite(asked[:, 0]).all(axis=1)
    if not good.any():
        return dict.fromkeys(("bias %", "rmse %", "coverage %", "interval error %"), math.nan)
    value, *ends = asked[good].transpose(1, 0, 2)
    low, high = np.minimum(*ends), np.maximum(*ends)  # a negative truth turns them about
    missed = np.maximum(low, 0.0) + np.maximum(-high, 0.0)
    score = (high - low) + 2.0 / _ALPHA * missed
    covered = (low <= 0.0) & (high >= 0.0)
    return {
        "bias %": 100.0 * float(np.abs(value.mean(axis=0)).max()),
        "rmse %": 100.0 * math.sqrt(float(np.mean(value**2))),
        "coverage %": 100.0 * float(covered.mean()) if np.isfinite(score).all() else math.nan,
        "interval error %": 100.0 * float(np.mean(score)),
    }


def measured_rows(
    contenders: Sequence[Contender[Sample]], samples: Sequence[Sample], truth: FloatArray
) -> list[Row]:
    """Return one row for each contender; `truth` is of shape (samples, questions)."""
    found = run(contenders, samples, truth.shape[1])
    rows: list[Row] = []
    for c in contenders:
        answers, seconds = found[c.name]
        asked = np.arange(len(samples)) % c.every == 0
        failed = ~np.isfinite(answers[asked, 0]).all(axis=1)
        rows.append(
            {
                "contender": c.name,
                "kind": "default" if c.default else "outside" if c.outside else "own rival",
                "us per fit": 1e6 * seconds,
                "fits": int(asked.sum()),
                "failed %": 100.0 * float(failed.mean()),
                **statistics(answers[asked], truth[asked]),
            }
        )
    return rows


def front(times: Sequence[float], errors: Sequence[float]) -> list[int]:
    """Find the Pareto front as far as clock and simulation can tell.

    One is beaten by another that is clearly faster (10 %) and as right, or clearly more right (1 %)
    and as fast. NaN is never on the front.

    Returns
    -------
    indices, the fastest first
    """
    real = [i for i, pair in enumerate(zip(times, errors, strict=True)) if np.isfinite(pair).all()]

    def beats(j: int, i: int) -> bool:
        quicker, better = times[j] / times[i], errors[j] / errors[i]
        return (quicker < 1.0 - _CLOCK and better < 1.0 + _SIMULATION) or (
            quicker < 1.0 + _CLOCK and better < 1.0 - _SIMULATION
        )

    return sorted((i for i in real if not any(beats(j, i) for j in real)), key=times.__getitem__)
