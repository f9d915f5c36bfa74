r"""How the estimates of one Weibull fit err together, complete or right-censored.

With $u = \ln \mathrm{scale}$, $b = 1/\mathrm{shape}$ and $z = (\ln x - u)/b$, the observed
information at the maximum of the likelihood is, in units of $1/b^2$,

$$ I = \begin{pmatrix} r & \sum z e^z \\ \sum z e^z & r + \sum z^2 e^z \end{pmatrix} $$

with r failures and sums over all specimens. For a large complete sample the correlation of scale
and shape is $0.4228/\sqrt{1.8237} = 0.313$; censoring changes it, even its sign.

Source: Lawless, Statistical Models and Methods for Lifetime Data, chapter 5.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.arrays import FloatArray
from deamat.estimators.weibull.fit import WeibullFit

SCALE = (1.0, 0.0)  # gradients of an estimate by ln scale and 1/shape, but for a factor above zero
SHAPE = (0.0, -1.0)


def of_quantile(p: float) -> tuple[float, float]:
    """Return the gradient of the logarithm of the value that a fraction p does not survive."""
    return 1.0, math.log(-math.log1p(-p))


def correlations(
    fit: WeibullFit, x: ArrayLike, gradients: Sequence[tuple[float, float]]
) -> FloatArray:
    """Return the correlation matrix of estimates of one fit, shape (k, k).

    Parameters
    ----------
    fit : by maximum likelihood
    x : the values that it is of, broken or not, shape (n,)
    gradients : of the k estimates, as `SCALE`, `SHAPE` and `of_quantile` give them
    """
    z = fit.shape * np.log(np.asarray(x, dtype=float) / fit.scale)
    weight = np.exp(z)
    cross = float(np.dot(z, weight))
    information = np.array([
        [fit.failures, cross],
        [cross, fit.failures + float(np.dot(z * z, weight))],
    ])  # fmt: skip
    slopes = np.array(gradients)
    covariance = slopes @ np.linalg.inv(information) @ slopes.T
    sd = np.sqrt(np.diagonal(covariance))
    found: FloatArray = covariance / np.outer(sd, sd)
    return found
