"""The reduced stability map: nothing is silently wrong but what is known to be, with its reason."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from benchmarks.stability.cells import Cell, Estimator, Failure, Told, cells_of, refused
from benchmarks.stability.estimators import ESTIMATORS
from benchmarks.stability.known import reason_for

_SAMPLES = {"nonlinear model": 8, "power law": 10, "polynomial of chosen order": 12, "Weibull": 25}


@pytest.mark.parametrize("estimator", ESTIMATORS, ids=lambda e: e.key)
def test_nothing_is_silently_wrong_without_a_known_reason(estimator: Estimator) -> None:
    cells = cells_of(estimator, _SAMPLES.get(estimator.key, 50), reduced=True)
    assert {c.question for c in cells} == set(estimator.questions)
    wrong = [c for c in cells if c.verdict == "SILENTLY WRONG" and reason_for(c) is None]
    assert [(c.question, c.failure, c.n, c.setting) for c in wrong] == []


def cell(**fractions: float) -> Cell:
    counts = {"refused": 0.0, "flagged": 0.0, "missed": 0.05, "silent": 0.05} | fractions
    return Cell("e", "q", "f", 5, "s", 1000, **counts)


@pytest.mark.parametrize(
    ("found", "verdict"),
    [
        (cell(), "within"),
        (cell(flagged=0.6), "flagged"),
        (cell(missed=0.4), "flagged"),
        (cell(refused=0.7), "refused"),
        (cell(refused=0.3, flagged=0.3), "flagged"),
        (cell(flagged=0.6, missed=0.5, silent=0.2), "SILENTLY WRONG"),
    ],
)
def test_cells_are_judged_by_what_happens_to_their_samples(found: Cell, verdict: str) -> None:
    assert found.verdict == verdict


def test_an_estimator_that_is_wrong_is_found_out_unless_it_says_so() -> None:
    def draw(rng: np.random.Generator, n: int) -> tuple[float, np.ndarray]:
        return float(rng.normal()), np.array([5.0, 5.0, 5.0, np.nan])

    def ask(samples: Sequence[float]) -> list[Told]:
        nothing, said = frozenset[str](), frozenset({"bad"})
        low = np.array([0.0, 0.0, np.nan, 0.0])
        return [Told(low, low + 1.0, (nothing, said, nothing, nothing)) for _ in samples]

    failures = (Failure("f", (("s", draw),)),)
    estimator = Estimator("e", ("a", "b", "c", "d"), (5,), failures, ask, "page", 50)
    assert [(c.question, c.verdict) for c in cells_of(estimator)] == [
        ("a", "SILENTLY WRONG"),
        ("b", "flagged"),
        ("c", "refused"),
    ]
    assert np.isnan(refused(2).low).all()
