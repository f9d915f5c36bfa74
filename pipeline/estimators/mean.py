"""Mean over specimens with an error that they share kept apart."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

import numpy as np
from scipy.special import stdtrit

from deamat.core.errors import FitRefused

_NOT_TOLD_FROM_ZERO = 3.0  # half widths of an interval over its value


@dataclass(frozen=True, slots=True)
class Mean:
    """A mean with its two kinds of uncertainty.

    Parameters
    ----------
    value, n : the mean and how many values it is of
    sd : standard deviation of the values; None for one value
    u_independent : `sd / sqrt(n)`; for one value its own
    u_shared : as given, not divided by anything
    degrees_of_freedom : of the combined uncertainty
    ci95 : 95 % confidence interval
    """

    value: float
    n: int
    sd: float | None
    u_independent: float
    u_shared: float
    degrees_of_freedom: float
    ci95: tuple[float, float]


def coverage_factor(degrees_of_freedom: float) -> float:
    """Return the half width of a 95 % interval in standard uncertainties: Student's t quantile.

    Parameters
    ----------
    degrees_of_freedom : at least 1; may be fractional or infinite
    """
    # beyond 1e6 the quantile is the normal one to 6 digits
    return float(stdtrit(min(degrees_of_freedom, 1e6), 0.975))


def mean_with_shared(
    values: Sequence[float], u_own: float, u_shared: float, dof_own: float = math.inf
) -> Mean:
    r"""Average values that scatter independently and share one further error.

    $$ u_c^2 = \frac{s^2}{n} + u_\mathrm{shared}^2, \qquad
    \nu = (n-1) \, u_c^4 \Big/ \Big(\frac{s^2}{n}\Big)^2 $$

    and the interval is the mean $\pm t_{0.975}(\nu) u_c$ (Welch-Satterthwaite; the shared part
    counts as known), but never narrower than Student's $\pm t_{0.975}(n-1) s/\sqrt{n}$ without the
    shared part: a further error cannot make a mean better known. That bound matters for few
    values that happen to lie close together; without it the coverage falls to 92 % at n = 3.

    Parameters
    ----------
    values : one per specimen, shape (n,)
    u_own : independent standard uncertainty of a single value; used only when n = 1, where the
        scatter between specimens cannot be seen
    u_shared : standard uncertainty of the error common to all values
    dof_own : degrees of freedom of `u_own`

    Raises
    ------
    FitRefused : no values

    Source: JCGM 100:2008 (GUM), 4.2, 5.2 and G.4.
    """
    n = len(values)
    if n == 0:
        raise FitRefused("a mean needs at least one value")
    # exact sums: the order of the specimens must not show in the last digit
    mean = math.fsum(values) / n
    if n == 1:
        sd, independent = None, u_own
        dof = dof_own * (1.0 + (u_shared / u_own) ** 2) ** 2 if u_own > 0.0 else math.inf
    else:
        sd = math.sqrt(math.fsum((v - mean) ** 2 for v in values) / (n - 1))
        independent = sd / math.sqrt(n)
        ratio = u_shared / independent if independent > 0.0 else math.inf
        dof = (n - 1) * (1.0 + ratio * ratio) ** 2 if math.isfinite(ratio) else math.inf
    half = coverage_factor(dof) * math.hypot(independent, u_shared)
    half = max(half, coverage_factor(n - 1 if n > 1 else dof_own) * independent)
    return Mean(mean, n, sd, independent, u_shared, dof, (mean - half, mean + half))


def positive_interval(mean: Mean) -> tuple[float, float]:
    r"""Return the 95 % interval of a positive quantity: on a log scale where zero is near.

    $m \, e^{\pm h/m}$ with the half width h where $m - h \le 0$, else the symmetric interval: an
    interval that includes zero says nothing of a modulus, a strength or a permittivity. Beyond
    $h = 3 m$ the value is not told from zero, and the symmetric interval is cut off there.

    Parameters
    ----------
    mean : of positive values
    """
    low, high = mean.ci95
    if low > 0.0 or mean.value <= 0.0:
        return low, high
    relative = (high - mean.value) / mean.value
    if relative > _NOT_TOLD_FROM_ZERO:
        return 0.0, high
    return mean.value * math.exp(-relative), mean.value * math.exp(relative)


def outliers(values: Sequence[float], significance: float = 0.01) -> tuple[int, ...]:
    r"""Name the value that stands apart, if one does: Grubbs' two-sided test.

    $G = \max|x - \bar x| / s > \frac{n-1}{\sqrt n} \sqrt{t^2 / (n - 2 + t^2)}$ with $t$ the
    quantile of Student's distribution at significance / 2n and n - 2 degrees of freedom.

    Parameters
    ----------
    values : shape (n,), of one normal sample; below five values nothing is called an outlier
    significance : how often a clean sample is accused

    Returns
    -------
    position of the outlier in `values`, or nothing

    Source: F. E. Grubbs, Ann. Math. Stat. 21 (1950) 27; ASTM E178. A modified z-score beyond 3.5
    accuses one clean sample of five in five.
    """
    n = len(values)
    if n < 5:
        return ()
    x = np.asarray(values)
    sd = float(x.std(ddof=1))
    distance = np.abs(x - x.mean())
    t = float(stdtrit(n - 2, 1.0 - significance / (2 * n)))
    limit = (n - 1) / math.sqrt(n) * math.sqrt(t * t / (n - 2 + t * t))
    worst = int(distance.argmax())
    return (worst,) if distance[worst] > limit * sd else ()


_FAR, _FAR_SDS = 1.75, 10.0
_LEAST_SD = 0.05  # of the median: two values may lie close together by chance


def apart_of_few(values: Sequence[float]) -> tuple[int, ...]:
    """Name a value that stands apart from the two or three others, where Grubbs' test sees nothing.

    It is at least 1.75 times their median, or that many times smaller, and ten of their robust
    standard deviations away, which count as no less than 5 % of the median.

    Parameters
    ----------
    values : shape (n,), of a positive quantity; nothing is named of other counts than 3 and 4

    Returns
    -------
    position in `values`, or nothing
    """
    if len(values) not in (3, 4) or min(values) <= 0.0:
        return ()
    for i, value in enumerate(values):
        others = [*values[:i], *values[i + 1 :]]
        middle = median(others)
        sd = max(1.4826 * median(abs(v - middle) for v in others), _LEAST_SD * middle)
        if abs(value - middle) > _FAR_SDS * sd and not 1.0 / _FAR < value / middle < _FAR:
            return (i,)
    return ()
