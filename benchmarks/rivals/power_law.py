"""Other ways to a power law in a rate, for charts of what they lose and for comparison only.

No card is made from these. Each takes t, q and y, shape (n,), the degrees of K and m in t, and the
places (t0, q0) that are asked about, shape (k, 2); it gives y there with the ends of a nominal 95 %
interval, shape (3, k). The law is y = K(t) q^m(t).
"""

from __future__ import annotations

import warnings

import numpy as np

from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.mean import coverage_factor

Degrees = tuple[int, int]


def surface(
    t: FloatArray, q: FloatArray, y: FloatArray, degrees: Degrees, at: FloatArray
) -> FloatArray:
    """Fit ln y by a surface linear in its coefficients: ln K and m polynomials in t.

    It is another law than one whose K is a polynomial, unless K is constant.
    """
    design, rows = _surface_columns(t, q, degrees), _surface_columns(at[:, 0], at[:, 1], degrees)
    value, variance = _linear(design, np.log(y), rows)
    return _from_logarithms(value, variance, len(y) - design.shape[1])


def log_log(
    t: FloatArray, q: FloatArray, y: FloatArray, degrees: Degrees, at: FloatArray
) -> FloatArray:
    """Draw a line of ln y over ln q at each time, then polynomials through the ln K and m found."""
    times, where = np.unique(t, return_inverse=True)
    logs, factors, exponents = np.log(q), np.empty(times.size), np.empty(times.size)
    for i in range(times.size):
        exponents[i], factors[i] = np.polyfit(logs[where == i], np.log(y[where == i]), 1)
    value, variance = np.zeros(len(at)), np.zeros(len(at))
    gains = (np.ones(len(at)), np.log(at[:, 1]))
    for points, degree, gain in zip((factors, exponents), degrees, gains, strict=True):
        found, spread = _linear(
            np.vander(times, degree + 1), points, np.vander(at[:, 0], degree + 1)
        )
        value += gain * found
        variance += gain**2 * spread
    return _from_logarithms(value, variance, times.size - max(degrees) - 1)


def weighted_values(
    t: FloatArray, q: FloatArray, y: FloatArray, degrees: Degrees, at: FloatArray
) -> FloatArray:
    """Fit the values with weights 1 / y^2 by `scipy.optimize.curve_fit` from a constant."""
    return _curve_fit(t, q, y, degrees, at, sigma=y)


def plain_values(
    t: FloatArray, q: FloatArray, y: FloatArray, degrees: Degrees, at: FloatArray
) -> FloatArray:
    """Fit the values with equal weights by `scipy.optimize.curve_fit` from a constant."""
    return _curve_fit(t, q, y, degrees, at, sigma=None)


def law(t: FloatArray, q: FloatArray, b: FloatArray, degrees: Degrees) -> FloatArray:
    """Return K(t) q^m(t) for raw coefficients b of K, then of m, lowest order first."""
    split = degrees[0] + 1
    with np.errstate(all="ignore"):
        factor = np.polynomial.polynomial.polyval(t, b[:split])
        exponent = np.polynomial.polynomial.polyval(t, b[split:])
        return np.asarray(factor * q**exponent)


def constant_start(y: FloatArray, degrees: Degrees) -> FloatArray:
    """Return the coefficients of a law that is the mean of y everywhere."""
    b = np.zeros(sum(degrees) + 2)
    b[0] = y.mean()
    return b


def _surface_columns(t: FloatArray, q: FloatArray, degrees: Degrees) -> FloatArray:
    factor, exponent = (np.vander(t, degree + 1, increasing=True) for degree in degrees)
    return np.concatenate([factor, exponent * np.log(q)[:, None]], axis=1)


def _linear(design: FloatArray, y: FloatArray, rows: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Predict at other rows of the design, with variances, shape (k,) each."""
    n, p = design.shape
    if n <= p:
        raise FitRefused(f"{p} parameters need more than {n} points")
    lengths = np.sqrt(np.square(design).sum(axis=0))
    q, r = np.linalg.qr(design / lengths)
    residual = y - q @ (q.T @ y)
    half = np.linalg.solve(r.T, (rows / lengths).T)
    return half.T @ (q.T @ y), float(residual @ residual) / (n - p) * np.square(half).sum(axis=0)


def _from_logarithms(value: FloatArray, variance: FloatArray, dof: int) -> FloatArray:
    half = coverage_factor(dof) * np.sqrt(variance)
    return np.asarray(np.exp([value, value - half, value + half]))


def _curve_fit(
    t: FloatArray,
    q: FloatArray,
    y: FloatArray,
    degrees: Degrees,
    at: FloatArray,
    sigma: FloatArray | None,
) -> FloatArray:
    from scipy.optimize import OptimizeWarning, curve_fit  # heavy, and only rivals need it

    start = constant_start(y, degrees)

    def values(_: FloatArray, *b: float) -> FloatArray:
        return law(t, q, np.array(b), degrees)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OptimizeWarning)
        try:
            b, covariance = curve_fit(values, t, y, p0=start, sigma=sigma, maxfev=5000)
        except (RuntimeError, ValueError) as error:
            raise FitRefused(f"the search did not end: {error}") from error

    def predicted(parameters: FloatArray) -> FloatArray:
        return law(at[:, 0], at[:, 1], parameters, degrees)

    value = predicted(b)
    step = np.diag(1e-6 * np.maximum(np.abs(b), 1e-12))
    slopes = np.array([(predicted(b + d) - predicted(b - d)) / (2.0 * d.sum()) for d in step])
    with np.errstate(all="ignore"):
        variance = np.einsum("ik,ij,jk->k", slopes, covariance, slopes)
    half = coverage_factor(len(y) - len(b)) * np.sqrt(np.maximum(variance, 0.0))
    return np.array([value, value - half, value + half])
