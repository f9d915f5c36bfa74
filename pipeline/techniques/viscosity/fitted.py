"""What was fitted to a run: the law to publish, the laws to answer with, and how it is answered."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange
from deamat.estimators.selection import averaged
from deamat.techniques.viscosity.direct import Direct
from deamat.techniques.viscosity.time_law import Estimate, TimeLaw

# An answer and its derivatives by the coefficients of a law.
OfLaw = Callable[[TimeLaw], tuple[float, FloatArray]]
OfReadings = Callable[[Direct], Estimate]

T = TypeVar("T")

_LEAST_WEIGHT = 1e-3
_ENOUGH_WEIGHT = 0.5


@dataclass(frozen=True, slots=True)
class Fitted:
    """Laws of one run, or of several runs together.

    Parameters
    ----------
    law : the one chosen, its covariance widened for the choice and for what it misses
    supported : weight and law of all that the data do not tell apart
    direct : the readings themselves, where the law misses them
    asked_for : the configuration asks for this law and no average
    """

    law: TimeLaw
    supported: tuple[tuple[float, TimeLaw], ...]
    direct: Direct | None = None
    asked_for: bool = False

    def answer(self, of_law: OfLaw, of_readings: OfReadings | None = None) -> Estimate:
        """Answer by all laws that the data support, or by the readings where these miss them.

        Raises
        ------
        FitRefused, OutOfRange : the law does not answer, or half of what the data support does not
        """
        if self.direct is not None and of_readings is not None:
            return of_readings(self.direct)
        chosen = self.law.estimate(*of_law(self.law))
        found: list[tuple[float, Estimate]] = []
        for weight, law in self.supported:
            try:
                found.append((weight, law.estimate(*of_law(law))))
            except (FitRefused, OutOfRange):
                continue
        total = math.fsum(weight for weight, _ in found)
        if total < _ENOUGH_WEIGHT:
            raise FitRefused(
                f"of the laws that the data do not tell apart, {total:.0%} by weight answer: the "
                "readings do not determine it; measure longer or more often"
            )
        weights = [weight / total for weight, _ in found]
        each = [estimate for _, estimate in found]
        value, u = averaged(
            [e.value for e in each],
            [e.scatter for e in each],
            [e.dof for e in each],
            weights,
            about=chosen.value if self.asked_for else None,
        )
        return Estimate(
            value,
            u,
            math.fsum(w * e.calibration for w, e in zip(weights, each, strict=True)),
            math.fsum(w * e.thermal for w, e in zip(weights, each, strict=True)),
            float("inf"),
        )


def supported_of(weights: FloatArray, candidates: Sequence[T]) -> tuple[tuple[float, T], ...]:
    """Pair candidates with their weights, less those that the data all but exclude."""
    pairs = zip(weights.tolist(), candidates, strict=True)
    return tuple((w, candidate) for w, candidate in pairs if w > _LEAST_WEIGHT)
