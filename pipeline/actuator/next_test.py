"""Which test to do next: what a further specimen of each would take off the uncertainty."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from deamat.actuator.inputs import Input
from deamat.actuator.ranges import within
from deamat.actuator.uncertainty import FirstOrder, combined


@dataclass(frozen=True, slots=True)
class TestValue:
    """What further specimens of one test are worth to a prediction.

    Parameters
    ----------
    test : `compression of sylgard-182-30to1`
    n : specimens behind it now
    further : how many more
    u_now, u_then : standard uncertainty of the prediction before and after
    u_best : with endless specimens: what calibrations and other inputs leave
    """

    __test__ = False  # not a class of tests, whatever its name

    test: str
    n: int
    further: int
    u_now: float
    u_then: float
    u_best: float

    @property
    def gain(self) -> float:
        """How much narrower the prediction becomes, `1 - u_then / u_now` `[1]`."""
        return 1.0 - self.u_then / self.u_now if self.u_now else 0.0


_ENDLESS = 10**12


def next_tests(
    inputs: Sequence[Input], prediction: FirstOrder, further: int = 1
) -> tuple[TestValue, ...]:
    """Rank the tests by what `further` specimens of each alone would narrow, best first.

    The independent part of a mean shrinks as `sqrt(n / (n + further))`; shared parts (load cell,
    gauges) do not, nor does what a layer's thickness brings.

    Parameters
    ----------
    inputs, prediction : from `uncertainty.first_order` at these inputs
    further : specimens more, 1 to 10000

    Raises
    ------
    OutOfRange : another number of specimens
    """
    within("further specimens", further, 1, 10_000)
    values = [
        TestValue(
            test,
            next(x.n for x in inputs if x.test == test),
            further,
            prediction.u,
            _after(inputs, prediction, test, further),
            _after(inputs, prediction, test, _ENDLESS),
        )
        for test in dict.fromkeys(x.test for x in inputs if x.test is not None)
    ]
    return tuple(sorted(values, key=lambda v: v.u_then))


def plan(inputs: Sequence[Input], prediction: FirstOrder, specimens: int) -> tuple[TestValue, ...]:
    """Return the order in which so many specimens are best tested, one at a time, greedily."""
    within("specimens", specimens, 1, 1000)
    steps = []
    now, known = prediction, list(inputs)
    for _ in range(specimens):
        ranked = next_tests(known, now)
        if not ranked or ranked[0].u_then >= now.u:
            break
        best = ranked[0]
        steps.append(best)
        known = [_grown(x, 1) if x.test == best.test else x for x in known]
        now = FirstOrder(now.value, best.u_then, now.gradient, now.asymmetry, now.holds)
    return tuple(steps)


def _after(inputs: Sequence[Input], prediction: FirstOrder, test: str, further: int) -> float:
    grown = [_grown(x, further) if x.test == test else x for x in inputs]
    return combined(grown, prediction.gradient)


def _grown(x: Input, further: int) -> Input:
    """Return the input as `further` specimens would leave it: independent parts shrink."""
    factor = math.sqrt(x.n / (x.n + further)) if x.n else 1.0
    budget = (c if c.shared else replace(c, u=c.u * factor) for c in x.budget)
    return replace(x, budget=tuple(budget), n=x.n + further if x.n else 0)
