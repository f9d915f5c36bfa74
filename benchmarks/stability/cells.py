"""Cells of a stability map: one way to fail, how far, on how many values; and how they are judged.

Every cell is simulated some hundreds of times with a known truth. A 95 % interval may miss it in
5 % of samples. A sample is silently wrong when its interval misses the truth without any flag.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from deamat.core.arrays import FloatArray

Verdict = Literal["within", "flagged", "refused", "SILENTLY WRONG"]

SILENT_LIMIT = 0.10  # twice what a 95 % interval may miss
MOSTLY = 0.5  # of the samples
_CLEARLY = 0.2  # silently wrong beyond any doubt

Draw = Callable[[np.random.Generator, int], tuple[Any, FloatArray]]


@dataclass(frozen=True, slots=True)
class Told:
    """What an estimator says to k questions about one sample.

    Parameters
    ----------
    low, high : ends of the 95 % intervals, shape (k,); NaN where the answer is refused
    flags : for each question, what the answer is flagged with
    """

    low: FloatArray
    high: FloatArray
    flags: tuple[frozenset[str], ...]


@dataclass(frozen=True, slots=True)
class Failure:
    """One way to fail, from harmless to absurd.

    Parameters
    ----------
    name : as maps print it
    settings : label, and a function that draws a sample of n values with its truths, shape (k,)
    sizes : numbers of values; those of the estimator if empty
    """

    name: str
    settings: tuple[tuple[str, Draw], ...]
    sizes: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class Estimator:
    """An estimator under test.

    Parameters
    ----------
    key, questions : names; each question gets a map
    sizes : numbers of values in a sample
    failures : ways to fail
    ask : m samples to their answers
    page : page of docs/methods that shows its maps
    samples : for each cell; fewer where a fit is slow
    """

    key: str
    questions: tuple[str, ...]
    sizes: tuple[int, ...]
    failures: tuple[Failure, ...]
    ask: Callable[[Sequence[Any]], Sequence[Told]]
    page: str
    samples: int = 200


@dataclass(frozen=True, slots=True)
class Cell:
    """What became of the samples of one cell, each as a fraction of all of them `[1]`."""

    estimator: str
    question: str
    failure: str
    n: int
    setting: str
    samples: int
    refused: float
    flagged: float
    missed: float
    silent: float

    @property
    def verdict(self) -> Verdict:
        """Silently wrong above `limit` of samples; else what happens to most; else within."""
        if self.silent > self.limit:
            return "SILENTLY WRONG"
        if self.refused > MOSTLY:
            return "refused"
        if self.flagged + self.refused > MOSTLY or self.missed > self.limit:
            return "flagged"
        return "within"

    @property
    def limit(self) -> float:
        """Ten percent, or what chance gives a sound interval in one of a thousand such cells."""
        return max(SILENT_LIMIT, 0.05 + 3.1 * math.sqrt(0.05 * 0.95 / self.samples))

    def row(self) -> Mapping[str, str | float | int]:
        """Return the cell as a row of a table, fractions in percent."""
        return {
            "estimator": self.estimator,
            "question": self.question,
            "failure": self.failure,
            "n": self.n,
            "setting": self.setting,
            "samples": self.samples,
            "refused %": 100.0 * self.refused,
            "flagged %": 100.0 * self.flagged,
            "missed %": 100.0 * self.missed,
            "silently missed %": 100.0 * self.silent,
            "verdict": self.verdict,
        }


def cells_of(
    estimator: Estimator,
    samples: int = 0,
    reduced: bool = False,
    failures: Sequence[Failure] | None = None,
) -> list[Cell]:
    """Simulate an estimator's whole grid.

    Parameters
    ----------
    failures : these only; all of the estimator's if not given
    samples : for each cell; those of the estimator if 0
    reduced : only the middle size and the first, middle and last setting of each failure
    """
    made: list[Cell] = []
    for failure in estimator.failures if failures is None else failures:
        sizes = failure.sizes or estimator.sizes
        settings = failure.settings
        if reduced:
            sizes = sizes[len(sizes) // 2 :][:1]
            settings = tuple(
                settings[i] for i in sorted({0, len(settings) // 2, len(settings) - 1})
            )
        for n in sizes:
            for setting, draw in settings:
                made += _confirmed(
                    estimator, failure.name, n, setting, draw, samples or estimator.samples
                )
    return made


def _confirmed(
    estimator: Estimator, failure: str, n: int, setting: str, draw: Draw, samples: int
) -> list[Cell]:
    """Simulate a cell; if it is narrowly silently wrong, judge it by fresh numbers, more of them.

    Of a thousand sound cells a few are beyond any limit by chance.
    """
    first = _simulate(estimator, failure, n, setting, draw, samples, "")
    if any(c.verdict == "SILENTLY WRONG" and c.silent < _CLEARLY for c in first):
        return _simulate(estimator, failure, n, setting, draw, 2 * samples, " again")
    return first


def _simulate(
    estimator: Estimator, failure: str, n: int, setting: str, draw: Draw, samples: int, seed: str
) -> list[Cell]:
    """Simulate one cell for all questions, all settings of a failure from the same numbers."""
    name = f"{estimator.key}/{failure}/{n}{seed}"
    rng = np.random.default_rng(zlib.crc32(name.encode()))
    drawn = [draw(rng, n) for _ in range(samples)]
    told = estimator.ask([sample for sample, _ in drawn])
    truth = np.array([t for _, t in drawn])
    low, high = np.array([t.low for t in told]), np.array([t.high for t in told])
    flagged = np.array([[bool(f) for f in t.flags] for t in told])
    answered = np.isfinite(low) & np.isfinite(high)
    missed = answered & ~((low <= truth) & (truth <= high))
    return [
        Cell(
            estimator.key,
            question,
            failure,
            n,
            setting,
            samples,
            float(np.mean(~answered[:, k])),
            float(np.mean(flagged[:, k] & answered[:, k])),
            float(np.mean(missed[:, k])),
            float(np.mean(missed[:, k] & ~flagged[:, k])),
        )
        for k, question in enumerate(estimator.questions)
        if np.isfinite(truth[:, k]).all()
    ]


def refused(questions: int) -> Told:
    """Return the answer of an estimator that declines all questions."""
    nothing = np.full(questions, np.nan)
    return Told(nothing, nothing, (frozenset(),) * questions)
