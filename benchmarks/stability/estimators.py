"""The one list of estimators under test, the slowest first."""

from __future__ import annotations

from benchmarks.stability import mean, polynomial, regression, slope, weibull

ESTIMATORS = (
    weibull.ESTIMATOR,
    polynomial.CHOSEN,
    regression.NONLINEAR,
    polynomial.RISING,
    regression.POWER_LAW,
    polynomial.GIVEN,
    slope.ESTIMATOR,
    regression.LINEAR,
    mean.ESTIMATOR,
)
