"""What departures from the Weibull form a sample of this size could not have seen.

Two statements. Of a weaker population that is a fraction f of all, n specimens hold none with
probability (1 - f)^n: at 95 %, f = 1 - 0.05^(1/n) may be missing altogether, whatever its strength.
And of the curved forms ln x = a + b (H^c - 1)/c, H = -ln(1 - F), those of small |c| pass the tests:
c > 0 has a threshold, c < 0 a tail of weak specimens as competing modes have. The c that the tests
see with the wanted power is found by simulation, and with it how far a quantile of the fit is off.

In units of 1/shape neither depends on scale or shape. Of more than 100 failures the c is that of
100, times sqrt(100 / r).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.arrays import FloatArray
from deamat.estimators.weibull.fit import WeibullFit, fit, fit_batch
from deamat.estimators.weibull.reference import (
    anderson_darling,
    curvature,
    reference,
    thinned,
)
from deamat.estimators.weibull.sample import as_arrays
from deamat.estimators.weibull.simulate import Withdrawals, standard_samples, withdrawals

_DRAWS = 400  # a power of 0.8 is good to 0.02
_MOST_FAILURES = 100
_SEED = 62540
_GRID = (1.0, 2.0, 3.0, 4.5)  # of c, over sqrt(r)
_FARTHEST = 0.7  # |c|: B1 of a shape of 9 is then a tenth
_LEAST_LOG = -600.0  # of x, which must not underflow
_MISSING = 0.05


@dataclass(frozen=True, slots=True)
class Unseen:
    """How far off a quantile may be although the tests of the form let the sample pass.

    Parameters
    ----------
    lower, higher : fractions of the quantile by which it may be lower, and higher
    power_lower, power_higher : fraction of samples of those forms that the tests find; less than
        the power asked for where not even the most curved form reaches it
    weak_fraction : of a weaker population of which the sample may hold nothing (95 %)
    """

    lower: float
    higher: float
    power_lower: float
    power_higher: float
    weak_fraction: float


def unseen(
    x: ArrayLike,
    censored: ArrayLike | None,
    p: float,
    *,
    power: float = 0.8,
    form_level: float = 0.05,
    curvature_level: float = 0.005,
) -> Unseen:
    """Say how large a departure from the Weibull form this sample could not have seen.

    Parameters
    ----------
    x, censored : as for `weibull.fit`, shape (n,)
    p : of the quantile asked about
    power : fraction of samples in which a departure counts as seen
    form_level, curvature_level : p-values of Anderson-Darling and of the curvature below which the
        form counts as wrong

    Raises
    ------
    FitRefused : as `weibull.fit`
    """
    best: WeibullFit = fit(x, censored)
    values, failed = as_arrays(x, censored, ndim=1)
    removed = withdrawals(values, failed)
    low, high = (_departure(removed, sign, power, form_level, curvature_level) for sign in (-1, 1))
    shift_low, shift_high = (
        _shift(thinned(removed, _MOST_FAILURES), c, p) / best.shape for c, _ in (low, high)
    )
    return Unseen(
        -float(np.expm1(min(shift_low, 0.0))),
        float(np.expm1(max(shift_high, 0.0))),
        low[1],
        high[1],
        1.0 - _MISSING ** (1.0 / best.n),
    )


@lru_cache(maxsize=64)
def _departure(
    removed: Withdrawals, sign: int, power: float, form_level: float, curvature_level: float
) -> tuple[float, float]:
    """The c that the tests find with the power, and the power that they reach."""
    thin = thinned(removed, _MOST_FAILURES)
    null = reference(thin)
    critical = float(np.quantile(null.anderson_darling, 1.0 - form_level))
    tails = np.quantile(null.curvature, [curvature_level / 2.0, 1.0 - curvature_level / 2.0])
    before, reached = 0.0, form_level
    for step in _GRID:
        c = min(step / len(thin) ** 0.5, _FARTHEST)
        hazard, *_ = _fitted(thin, sign * c)
        score = curvature(hazard, thin)
        seen = (anderson_darling(hazard, thin) > critical) | (score < tails[0]) | (score > tails[1])
        found = float(np.mean(seen))
        if found >= power:
            c = before + (c - before) * (power - reached) / max(found - reached, 1e-9)
            return sign * c * min(1.0, len(thin) / len(removed)) ** 0.5, power
        before, reached = c, max(found, reached)
        if c == _FARTHEST:
            break
    return sign * before * min(1.0, len(thin) / len(removed)) ** 0.5, reached


@lru_cache(maxsize=256)
def _shift(removed: Withdrawals, c: float, p: float) -> float:
    """True less fitted ln quantile, in units of 1/shape, beyond that of the Weibull form."""
    log_hazard = float(np.log(-np.log1p(-p)))
    off = []
    for curved in (c, 0.0):
        _, scale, shape = _fitted(removed, curved)
        true = _form(np.array(np.exp(log_hazard)), curved)
        off.append(float(np.mean(shape * (true - np.log(scale)) - log_hazard)))
    return off[0] - off[1]


@lru_cache(maxsize=16)
def _fitted(removed: Withdrawals, c: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Hazards of the failures, scales and shapes of the fits to samples of a curved form."""
    failures, values, censored = standard_samples(removed, _DRAWS, _SEED)
    x, whole = (np.exp(np.maximum(_form(h, c), _LEAST_LOG)) for h in (failures, values))
    fits = fit_batch(whole, censored)
    kept = ~fits.refused
    scale, shape = fits.scale[kept], fits.shape[kept]
    return (x[kept] / scale[:, None]) ** shape[:, None], scale, shape


def _form(hazard: FloatArray, c: float) -> FloatArray:
    """Return (H^c - 1)/c, ln H where c is 0."""
    log_hazard = np.log(hazard)
    return log_hazard if c == 0.0 else np.expm1(c * log_hazard) / c
