"""Exact conditional intervals of one Weibull sample: shape, scale, quantiles, failure probability.

The formulas stand in `weibull_conditional`. An interval at 95 % covers the truth in 95 % of
samples, however small, when the sample is complete or all tests stopped at the last failure
(type II); with other censoring it is an approximation with unequal tails, and `weibull.coverage`
says how good a one for a given sample.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.errors import OutOfRange
from deamat.estimators.weibull.conditional import Conditional, condition
from deamat.estimators.weibull.fit import WeibullFit, fit, probability_of
from deamat.estimators.weibull.sample import Warnings

P_SCALE = 1.0 - np.exp(-1.0)  # the scale is the quantile of this probability


@dataclass(frozen=True, slots=True)
class Interval:
    """A confidence interval around a maximum-likelihood estimate.

    Parameters
    ----------
    estimate, low, high : `[unit of what is estimated]`
    level : probability that the interval covers the truth
    exact : False when the censoring makes it an approximation
    warnings : what weakens it, as (name, detail)
    """

    estimate: float
    low: float
    high: float
    level: float
    exact: bool
    warnings: Warnings

    @property
    def method(self) -> str:
        """Name of the method as a card prints it."""
        return "exact conditional" if self.exact else "conditional, approximate for this censoring"


@dataclass(frozen=True, slots=True)
class Inference:
    """What one sample says, ready for questions; made by `infer`.

    Parameters
    ----------
    fit : the maximum-likelihood fit
    given : the conditional distributions of this sample
    level : of every interval
    """

    fit: WeibullFit
    given: Conditional
    level: float

    def shape(self) -> Interval:
        """Interval of the shape `[1]`."""
        low, high = self.given.shape(self.level)
        return self._interval(self.fit.shape, low.item(), high.item())

    def scale(self, area_ratio: float = 1.0) -> Interval:
        """Interval of the scale on a film of another area, see `quantile`."""
        return self.quantile(P_SCALE, area_ratio)

    def quantile(self, p: float, area_ratio: float = 1.0) -> Interval:
        """Interval of the value that a fraction p does not survive (B1: p = 0.01).

        Parameters
        ----------
        p : between 0 and 1
        area_ratio : area asked about over area tested, from `weibull_area.area_ratio`

        Raises
        ------
        OutOfRange : p outside (0, 1), or an area ratio that is not positive
        """
        _between("a probability", p, 1.0)
        _between("an area ratio", area_ratio, np.inf)
        a = float(np.log(-np.log1p(-p) / area_ratio))
        low, high = self.given.quantile(a, self.level)
        estimate = self.fit.scale * np.exp(a / self.fit.shape)
        return self._interval(
            float(estimate), low.item(), high.item(), self._extrapolation(probability_of(a))
        )

    def failure_probability(self, field: float, area_ratio: float = 1.0) -> Interval:
        """Interval of the fraction of specimens that does not survive `field`.

        Parameters
        ----------
        field : `[unit of x]`, above 0
        area_ratio : area asked about over area tested, from `weibull_area.area_ratio`

        Raises
        ------
        OutOfRange : a field or area ratio that is not positive
        """
        _between("a field", field, np.inf)
        _between("an area ratio", area_ratio, np.inf)
        low, high = self.given.log_hazard(field, self.level)
        tested = float(self.fit.shape * np.log(field / self.fit.scale))
        scaling = float(np.log(area_ratio))
        return self._interval(
            probability_of(tested + scaling),
            probability_of(low.item() + scaling),
            probability_of(high.item() + scaling),
            self._extrapolation(probability_of(tested)),
        )

    def predictive(self, field: float, area_ratio: float = 1.0) -> float:
        """Probability that one more specimen fails at or below `field`, parameters averaged out.

        Over samples and the next specimen together it is right on average, which the estimate
        `failure_probability(field).estimate` is not: with few specimens that is too hopeful.

        Raises
        ------
        OutOfRange : a field or area ratio that is not positive
        """
        _between("a field", field, np.inf)
        _between("an area ratio", area_ratio, np.inf)
        return self.given.predictive(field, area_ratio).item()

    def _interval(self, estimate: float, low: float, high: float, more: Warnings = ()) -> Interval:
        exact = self.fit.censoring != "type I or random"
        return Interval(estimate, low, high, self.level, exact, self.fit.warnings + more)

    def _extrapolation(self, p: float) -> Warnings:
        if p * self.fit.n > 1.0 - 1e-9:
            return ()
        detail = f"p = {p:.2g} is below 1/n = {1 / self.fit.n:.2g}: it rests on the Weibull form"
        return (("extrapolated", detail),)


def infer(x: ArrayLike, censored: ArrayLike | None = None, level: float = 0.95) -> Inference:
    """Fit one sample and prepare its exact conditional intervals.

    Parameters
    ----------
    x : values, or the values at which a specimen left the test unbroken, shape (n,)
    censored : true where a specimen left the test unbroken, shape (n,)
    level : of the intervals, between 0 and 1

    Raises
    ------
    FitRefused : as `weibull.fit`
    OutOfRange : a level outside (0, 1)
    """
    _between("a level", level, 1.0)
    best = fit(x, censored)
    mask = None if censored is None else np.asarray(censored)[None, :]
    (given,) = condition(np.asarray(x, dtype=float)[None, :], mask)
    return Inference(best, given, level)


def _between(what: str, value: float, upper: float) -> None:
    if not 0.0 < value < upper:
        limits = "above 0 and finite" if np.isinf(upper) else f"between 0 and {upper:g}"
        raise OutOfRange(f"{what} must lie {limits}, not {value:g}")
