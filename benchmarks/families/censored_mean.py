"""Mean elongation of strips of which some did not break before the machine's end."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from benchmarks.families.family import Family, default_of, named, number
from benchmarks.measure import Answer, Contender, measured_rows
from benchmarks.rivals import censored_mean as rivals
from benchmarks.rivals.slope import Slope
from benchmarks.timing import Row
from deamat.core.arrays import FloatArray
from deamat.estimators.censored_mean import FEWEST_EXACT, BoolArray, mean_with_limits

Strips = tuple[FloatArray, BoolArray]
SPECIMENS = 8
_SCATTER, _END = 0.15, 1.0  # of the mean: scatter, and where the machine ends


def strips(m: int, seed: int = 7) -> list[Strips]:
    """Simulate m materials of eight strips, three of which broke at least."""
    rng = np.random.default_rng(seed)
    found: list[Strips] = []
    while len(found) < m:
        x = 1.0 + _SCATTER * rng.standard_normal(SPECIMENS)
        limit = x > _END
        if (~limit).sum() >= FEWEST_EXACT:
            found.append((np.minimum(x, _END), limit))
    return found


def rows(scale: float) -> list[Row]:
    """Measure all contenders on the same strips."""
    samples = strips(max(int(2000 * scale), 80))
    contenders = [
        Contender("maximum likelihood with limits", _default, default=True),
        Contender("limits taken for values", _rival(rivals.as_values)),
        Contender("limits left out", _rival(rivals.without_limits)),
        Contender("scipy Nelder-Mead, normal limits", _rival(rivals.nelder_mead), outside=True),
    ]
    return measured_rows(contenders, samples, np.ones((len(samples), 1)))


def _default(sample: Strips) -> Answer:
    x, limit = sample
    found = mean_with_limits(x.tolist(), limit.tolist(), 0.0)
    return Answer(*(np.array([end]) for end in (found.value, *found.ci95)))


def _rival(method: Callable[[FloatArray, BoolArray], Slope]) -> Callable[[Strips], Answer]:
    def fit(sample: Strips) -> Answer:
        found = method(*sample)
        return Answer(np.array([found.value]), np.array([found.low]), np.array([found.high]))

    return fit


def _why(found: Sequence[Row]) -> str:
    ours, values = default_of(found), named(found, "limits taken for values")
    simplex = named(found, "scipy Nelder-Mead, normal limits")
    return (
        "About half of the strips reach the end of the machine unbroken. Their limits belong into "
        f"the likelihood: RMSE {number(ours, 'rmse %'):.1f} %, bias {number(ours, 'bias %'):.1f} % "
        f"and intervals that hold in {number(ours, 'coverage %'):.0f} %; limits taken for values "
        f"have a bias of {number(values, 'bias %'):.1f} % and intervals that hold in "
        f"{number(values, 'coverage %'):.0f} %, normal limits at the same maximum hold in "
        f"{number(simplex, 'coverage %'):.0f} %."
    )


FAMILY = Family(
    "censored_mean",
    f"Mean of {SPECIMENS} strips, of which half did not break",
    "rmse %",
    "RMSE of the mean [%]",
    rows,
    _why,
)
