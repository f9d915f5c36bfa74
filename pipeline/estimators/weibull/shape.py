"""The Weibull shape freed of its small-sample bias.

The maximum-likelihood shape is too high by 45 % with 5 specimens and by 8 % with 20. Two remedies:
Ross' factor, made for complete samples, and the modified profile likelihood, which also holds for
censored ones. For complete samples Ross is the better (bias below 1 % at n = 5, against 5 %; and
the smaller spread), so that is used there. The other one takes over as soon as one specimen is
censored: bias below 3 % for type II; where limits were set beforehand and a quarter is censored it
overshoots, to -4 % with 20 specimens and -9 % with 10. Print the result beside the
maximum-likelihood shape, never instead of it: intervals, quantiles and area scaling belong to the
fit.

Source: Ross, IEEE Trans. Dielectr. Electr. Insul. 3 (1996) 28-42; Yang and Xie, Statistics and
Computing 13 (2003) 177-184 on the modified profile likelihood.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.arrays import FloatArray
from deamat.estimators.weibull.fit import solve_shape
from deamat.estimators.weibull.sample import check_sample, log_samples


@dataclass(frozen=True, slots=True)
class UnbiasedShape:
    """A corrected shape and how it was corrected.

    Parameters
    ----------
    value : shape `[1]`
    method : `Ross` for complete samples, `modified profile likelihood` for censored ones
    """

    value: float
    method: Literal["Ross", "modified profile likelihood"]


def unbiased_shape(x: ArrayLike, censored: ArrayLike | None = None) -> UnbiasedShape:
    """Estimate the shape nearly without bias.

    Parameters
    ----------
    x, censored : as for `weibull.fit`, shape (n,)

    Raises
    ------
    FitRefused : as `weibull.fit`
    """
    values, failed = check_sample(x, censored)
    samples = log_samples(values[None, :], failed[None, :])
    if failed.all():
        shape, _ = solve_shape(samples, np.ones(1))
        return UnbiasedShape(ross_factor(values.size) * shape.item(), "Ross")
    shape, _ = solve_shape(samples, modified_ratio(samples.failures))
    return UnbiasedShape(shape.item(), "modified profile likelihood")


def ross_factor(n: int) -> float:
    """Return (n - 2)/(n - 0.68), by which the shape of a complete sample of n is multiplied."""
    return (n - 2.0) / (n - 0.68)


def modified_ratio(failures: FloatArray) -> FloatArray:
    """Ratio (r - 2)/r, the right side of `weibull.solve_shape` for the modified profile likelihood.

    Its maximum over k of k^(r-2) exp(k sum_failed z) / S0(k)^r is the mode of the conditional p(k).
    """
    return (failures - 2.0) / failures
