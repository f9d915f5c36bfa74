"""Power laws in a rate whose factor and exponent change with time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused, OutOfRange
from deamat.estimators.least_squares.chebyshev_series import basis, lowest
from deamat.estimators.least_squares.checks import finite_array, same_length
from deamat.estimators.least_squares.nonlinear import NonlinearFit, fit_nonlinear
from deamat.estimators.least_squares.polynomial import half_width, middle, raw_from_chebyshev

# What the instrument's error is a constant part of: it decides between two estimators that do not
# agree, least squares on the logarithms and on the values.
ErrorModel = Literal["of reading", "of full scale"]

# Of 6000 simulated laws of degrees up to 4 and 2, noise up to 60 %, by either error model, further
# searches found a lower minimum than the first for none.
_CONFIRMATIONS = 1


@dataclass(frozen=True, slots=True)
class PowerLawFit:
    r"""A law $y(t, q) = K(t)\, q^{m(t)}$ with polynomials $K = \sum K_k t^k$, $m = \sum m_k t^k$.

    Parameters
    ----------
    factor_degree, exponent_degree : of K and m in t
    low, high : range of the fitted t
    lowest_rate, highest_rate : range of the fitted q
    errors : which error model was fitted
    fit : the fit behind it, of ln y or y, its parameters in the Chebyshev basis of the window
    """

    factor_degree: int
    exponent_degree: int
    low: float
    high: float
    lowest_rate: float
    highest_rate: float
    errors: ErrorModel
    fit: NonlinearFit

    @property
    def factor(self) -> FloatArray:
        """Coefficients of K, lowest order first, shape (a,)."""
        return (self._to_raw() @ self.fit.parameters)[: self.factor_degree + 1]

    @property
    def exponent(self) -> FloatArray:
        """Coefficients of m, lowest order first, shape (b,)."""
        return (self._to_raw() @ self.fit.parameters)[self.factor_degree + 1 :]

    @property
    def covariance(self) -> FloatArray:
        """Covariance of the coefficients of K and m together, shape (a + b, a + b)."""
        to_raw = self._to_raw()
        return np.asarray(to_raw @ self.fit.covariance @ to_raw.T)

    def _to_raw(self) -> FloatArray:
        """Matrix from the fitted parameters, in the Chebyshev basis, to raw coefficients."""
        split, p = self.factor_degree + 1, len(self.fit.parameters)
        matrix = np.zeros((p, p))
        matrix[:split, :split] = raw_from_chebyshev(self.low, self.high, self.factor_degree).high
        matrix[split:, split:] = raw_from_chebyshev(self.low, self.high, self.exponent_degree).high
        return matrix

    def __call__(self, time: float, rate: float) -> tuple[float, float]:
        """Return y and its standard uncertainty at one time and rate `[unit of y]`.

        Raises
        ------
        OutOfRange : a time or rate outside the fitted ones
        """
        if not (self.low <= time <= self.high and self.lowest_rate <= rate <= self.highest_rate):
            raise OutOfRange(
                f"the power law holds for times from {self.low:g} to {self.high:g} and rates from "
                f"{self.lowest_rate:g} to {self.highest_rate:g}, not at {time:g} and {rate:g}"
            )
        t = np.array([(time - middle(self.low, self.high)) / half_width(self.low, self.high)])
        bases = _bases(t, self.factor_degree, self.exponent_degree)
        y, slopes = _predict(self.fit.parameters, bases, np.log([rate]))
        variance = float(slopes[0] @ self.fit.covariance @ slopes[0])
        return float(y[0]), variance**0.5


def fit_power_law(
    time: ArrayLike,
    rate: ArrayLike,
    y: ArrayLike,
    factor_degree: int,
    exponent_degree: int,
    errors: ErrorModel,
    sigma: ArrayLike | None = None,
) -> PowerLawFit:
    r"""Fit K and m to y > 0, by the error model of the instrument.

    Errors that are a constant fraction of the reading: minimise
    $\sum_i (\ln y_i - \ln K(t_i) - m(t_i) \ln q_i)^2$. Errors that are a constant fraction of full
    scale: minimise $\sum_i (y_i - K(t_i) q_i^{m(t_i)})^2 / \sigma_i^2$. The error scale is
    estimated.

    Parameters
    ----------
    time : t, shape (n,)
    rate : q > 0, shape (n,), at least two different ones
    y : shape (n,)
    factor_degree, exponent_degree : of K and m in t, 0 or more
    errors : `"of reading"` or `"of full scale"`
    sigma : relative sizes of the errors of y where full scales differ, shape (n,); equal if None

    Raises
    ------
    FitRefused : values that are not positive or finite, too few of them, one rate only, a factor
        that is not positive in the whole window, and as in `fit_nonlinear`
    """
    times, rates, values = (
        finite_array(name, v) for name, v in (("time", time), ("rate", rate), ("y", y))
    )
    for name, v in (("rate", rates), ("y", values)):
        same_length(name, v, len(times))
        if not np.all(v > 0):
            raise FitRefused(f"a power law needs positive values, not {name} {v[~(v > 0)][0]:g}")
    if rates.min() == rates.max():
        raise FitRefused(
            f"a power law needs at least two rates, not {rates[0]:g} alone: the exponent is not "
            "determined"
        )
    low, high = float(times.min()), float(times.max())
    t = (times - middle(low, high)) / half_width(low, high)
    bases = _bases(t, factor_degree, exponent_degree)
    logs = np.log(rates)
    model, jacobian = _in_logarithms if errors == "of reading" else _in_values
    fit = fit_nonlinear(
        lambda b: model(b, bases, logs),
        lambda b: jacobian(b, bases, logs),
        _start(values, bases, logs),
        np.log(values) if errors == "of reading" else values,
        sigma,
        confirmations=_CONFIRMATIONS,
    )
    split = factor_degree + 1
    least = lowest(fit.parameters[:split])
    if least <= 0:
        raise FitRefused(
            f"the factor falls to {least:.3g} between the data; lower its degree",
            {"lowest_factor": least},
        )
    return PowerLawFit(
        factor_degree=factor_degree,
        exponent_degree=exponent_degree,
        low=low,
        high=high,
        lowest_rate=float(rates.min()),
        highest_rate=float(rates.max()),
        errors=errors,
        fit=fit,
    )


def _bases(t: FloatArray, factor_degree: int, exponent_degree: int) -> list[FloatArray]:
    """Chebyshev polynomials at t for K and for m, shapes (n, a) and (n, b)."""
    columns = basis(t, max(factor_degree, exponent_degree))
    return [columns[:, : factor_degree + 1], columns[:, : exponent_degree + 1]]


def _parts(b: FloatArray, bases: list[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """K and m at the data, shape (n,) each."""
    split = bases[0].shape[1]
    return bases[0] @ b[:split], bases[1] @ b[split:]


def _predict(
    b: FloatArray, bases: list[FloatArray], logs: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """y, shape (n,), and its derivatives by b, shape (n, p)."""
    factor, exponent = _parts(b, bases)
    power = np.exp(exponent * logs)
    columns = [bases[0] * power[:, None], bases[1] * (factor * power * logs)[:, None]]
    return factor * power, np.concatenate(columns, axis=1)


def _log_model(b: FloatArray, bases: list[FloatArray], logs: FloatArray) -> FloatArray:
    """Logarithm of the law; not finite where the factor is not positive: the search avoids it."""
    factor, exponent = _parts(b, bases)
    return np.asarray(np.log(factor) + exponent * logs)


def _log_jacobian(b: FloatArray, bases: list[FloatArray], logs: FloatArray) -> FloatArray:
    """Derivatives of the logarithm, shape (n, p)."""
    factor, _ = _parts(b, bases)
    return np.concatenate([bases[0] / factor[:, None], bases[1] * logs[:, None]], axis=1)


_Function = Callable[[FloatArray, list[FloatArray], FloatArray], FloatArray]
_in_logarithms: tuple[_Function, _Function] = (_log_model, _log_jacobian)
_in_values: tuple[_Function, _Function] = (
    lambda b, bases, logs: _predict(b, bases, logs)[0],
    lambda b, bases, logs: _predict(b, bases, logs)[1],
)


def _start(y: FloatArray, bases: list[FloatArray], logs: FloatArray) -> FloatArray:
    """Fit ln K and m linearly, then K to the exponential of ln K: near enough to start from."""
    split = bases[0].shape[1]
    design = np.concatenate([bases[0], bases[1] * logs[:, None]], axis=1)
    linear, _, rank, _ = np.linalg.lstsq(design, np.log(y))
    if rank < design.shape[1]:
        raise FitRefused(
            f"the readings do not determine a factor of degree {split - 1} and an exponent of "
            f"degree {bases[1].shape[1] - 1} in time: lower a degree, or measure several rates at "
            "more times",
            {"parameters": design.shape[1], "rank": int(rank)},
        )
    factors = np.exp(bases[0] @ linear[:split])
    start = np.linalg.lstsq(bases[0] / factors[:, None], np.ones(len(y)))[0]
    if np.any(bases[0] @ start <= 0):
        # A polynomial that dips below zero between the factors: a constant never does.
        start = np.zeros(split)
        start[0] = float(np.exp(np.log(factors).mean()))
    return np.concatenate([start, linear[split:]])
