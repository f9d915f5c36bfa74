"""The one list of estimators under test, the slowest first."""

from __future__ import annotations

from benchmarks.stability import (
    censored_mean,
    mean,
    polynomial,
    regression,
    slack,
    slope,
    weibull,
)

ESTIMATORS = (
    weibull.ESTIMATOR,
    polynomial.CHOSEN,
    regression.NONLINEAR,
    polynomial.RISING,
    regression.POWER_LAW,
    polynomial.GIVEN,
    slope.ESTIMATOR,
    slack.ESTIMATOR,
    regression.LINEAR,
    mean.ESTIMATOR,
    censored_mean.ESTIMATOR,
)
