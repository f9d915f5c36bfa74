"""Polynomials in time: digits that arithmetic keeps of coefficients and of their errors."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np

from benchmarks.families.family import Family, default_of, named, number
from benchmarks.measure import Answer, Contender, is_there, run, statistics
from benchmarks.rivals import polynomial as polynomial_rivals
from benchmarks.timing import Row
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.least_squares.polynomial import fit_polynomial
from deamat.estimators.mean import coverage_factor

Series = tuple[FloatArray, FloatArray, int]
Pair = tuple[FloatArray, FloatArray]  # raw coefficients and their standard errors
Method = Callable[[FloatArray, FloatArray, int], Pair]

# Sylgard 184 (10:1), Sikulskyi et al. 2022, Table 2: viscosity in Pa.s, time in hours.
QUARTIC = np.array([2.5, 0.493, 0.207, -0.0674, 0.00743])
POINTS = 45
NOISE = 0.02  # of the reading
_EXACT = "exact rationals"
_MOST_DIGITS = 16.0


def problems(m: int, seed: int = 7) -> list[Series]:
    """Simulate the quartic in four kinds of time: hours, seconds, hours of a clock, degree 8."""
    rng = np.random.default_rng(seed)
    hours = np.linspace(1.0, 12.0, POINTS)
    clean = np.polynomial.polynomial.polyval(hours, QUARTIC)
    found: list[Series] = []
    for i in range(m):
        y = clean * (1.0 + NOISE * rng.standard_normal(POINTS))
        kinds = ((hours, 4), (3600.0 * hours, 4), (hours + 100.0, 4), (hours, 8))
        x, degree = kinds[i % 4]
        found.append((x, y, degree))
    return found


def rows(scale: float) -> list[Row]:
    """Measure digits against exact rationals on all problems, and statistics on the first kind."""
    series = problems(max(4 * int(50 * scale), 16))
    everyone = contenders()
    most = 2 * 9  # coefficients and errors of degree 8
    found = run(everyone, series, most)
    exact = found[_EXACT][0]
    statistical = _statistics(everyone, max(int(400 * scale), 20))
    made: list[Row] = []
    for c in everyone:
        answers, seconds = found[c.name]
        parameters, errors = (_digits(answers, exact, part) for part in (0, 1))
        made.append(
            {
                "contender": c.name,
                "kind": "default" if c.default else "outside" if c.outside else "own rival",
                "us per fit": 1e6 * seconds,
                "fits": len(series),
                "digits of coefficients": parameters,
                "digits of errors": errors,
                "relative error": 10.0 ** -min(parameters, errors),
                **statistical[c.name],
            }
        )
    return made


def contenders() -> list[Contender[Series]]:
    """List the default, its rivals and the peers that are installed."""
    found = [
        Contender("Chebyshev, double-double QR", _answers(_default), default=True),
        Contender("Chebyshev, plain QR", _answers(_chebyshev)),
        Contender("raw Vandermonde, scaled QR", _answers(polynomial_rivals.scaled_qr)),
        Contender("raw Vandermonde, normal equations", _answers(_normal)),
        Contender(_EXACT, _answers(polynomial_rivals.exact_rationals)),
        Contender("numpy.polyfit", _answers(polynomial_rivals.numpy_polyfit), outside=True),
        Contender("scipy curve_fit", _answers(_curve_fit), outside=True),
    ]
    if is_there("lmfit"):
        found.append(Contender("lmfit minimize", _answers(_lmfit), outside=True))
    return found


def _answers(method: Method) -> Callable[[Series], Answer]:
    """Pack coefficients and errors into one row of 18 numbers, ones where there are none."""

    def fit(series: Series) -> Answer:
        packed = np.ones(18)
        coefficients, errors = method(*series)
        packed[: len(coefficients)] = coefficients
        packed[9 : 9 + len(errors)] = errors
        return Answer(packed, packed, packed)

    return fit


def _digits(answers: FloatArray, exact: FloatArray, part: int) -> float:
    """Digits kept in the worst coefficient (part 0) or error (part 1) of the worst problem."""
    asked = np.isfinite(exact[:, 0]).all(axis=1) & np.isfinite(answers[:, 1]).any(axis=1)
    block = slice(9 * part, 9 * part + 9)
    mine, right = answers[asked, 0, block], exact[asked, 0, block]
    with np.errstate(all="ignore"):
        worst = float(np.abs(mine / right - 1.0).max())
    if not np.isfinite(worst):
        return 0.0
    return float(np.clip(-np.log10(max(worst, 1e-16)), 0.0, _MOST_DIGITS))


def _statistics(everyone: Sequence[Contender[Series]], m: int) -> dict[str, dict[str, float]]:
    """Bias, RMSE and coverage of the coefficients in hours: the same for all exact solvers."""
    rng = np.random.default_rng(8)
    hours = np.linspace(1.0, 12.0, POINTS)
    clean = np.polynomial.polynomial.polyval(hours, QUARTIC)
    samples = [(hours, clean + 0.05 * rng.standard_normal(POINTS), 4) for _ in range(m)]
    factor = coverage_factor(POINTS - 5)
    told = {}
    for c in everyone:
        values = np.array([c.fit(s).value for s in samples])
        b, half = values[:, :5], factor * values[:, 9:14]
        answers = np.stack([b, b - half, b + half], axis=1)
        summary = statistics(answers, np.tile(QUARTIC, (m, 1)))
        told[c.name] = {k: summary[k] for k in ("bias %", "rmse %", "coverage %")}
    return told


def _default(x: FloatArray, y: FloatArray, degree: int) -> Pair:
    fit = fit_polynomial(x, y, degree)
    return fit.coefficients, fit.standard_errors


def _normal(x: FloatArray, y: FloatArray, degree: int) -> Pair:
    try:
        return polynomial_rivals.raw_normal_equations(x, y, degree)
    except np.linalg.LinAlgError as error:
        raise FitRefused(str(error)) from error


@lru_cache(maxsize=64)
def _powers(low: float, high: float, degree: int) -> FloatArray:
    """Matrix from Chebyshev coefficients of the window to raw ones, in plain doubles."""
    t = np.polynomial.Polynomial([-(high + low) / (high - low), 2.0 / (high - low)])
    columns = [
        np.polynomial.Chebyshev.basis(k).convert(kind=np.polynomial.Polynomial)(t).coef
        for k in range(degree + 1)
    ]
    return np.array([np.pad(c, (0, degree + 1 - len(c))) for c in columns]).T


def _chebyshev(x: FloatArray, y: FloatArray, degree: int) -> Pair:
    low, high = float(x.min()), float(x.max())
    design = np.polynomial.chebyshev.chebvander((2.0 * x - low - high) / (high - low), degree)
    q, r = np.linalg.qr(design)
    a = np.linalg.solve(r, q.T @ y)
    residual = y - design @ a
    to_raw = _powers(low, high, degree)
    half = to_raw @ np.linalg.inv(r)
    variance = float(residual @ residual) / (len(x) - degree - 1)
    return to_raw @ a, np.sqrt(variance * np.square(half).sum(axis=1))


def _curve_fit(x: FloatArray, y: FloatArray, degree: int) -> Pair:
    from scipy.optimize import OptimizeWarning, curve_fit

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OptimizeWarning)
        b, covariance = curve_fit(
            lambda v, *c: np.polynomial.polynomial.polyval(v, c), x, y, p0=np.ones(degree + 1)
        )
    return b, np.sqrt(np.diag(covariance))


def _lmfit(x: FloatArray, y: FloatArray, degree: int) -> Pair:
    from lmfit import Parameters, minimize

    names = [f"c{k}" for k in range(degree + 1)]
    start = Parameters()
    for name in names:
        start.add(name, value=1.0)
    found = minimize(
        lambda p: np.polynomial.polynomial.polyval(x, [p[name].value for name in names]) - y, start
    ).params
    errors = [found[name].stderr or np.nan for name in names]
    return np.array([found[name].value for name in names]), np.array(errors)


def _why(found: Sequence[Row]) -> str:
    ours, plain = default_of(found), named(found, "numpy.polyfit")
    return (
        f"The default keeps {number(ours, 'digits of coefficients'):.1f} digits of every "
        f"coefficient and {number(ours, 'digits of errors'):.1f} of every standard error, whatever "
        f"unit and origin time has; numpy.polyfit keeps "
        f"{number(plain, 'digits of coefficients'):.1f} and "
        f"{number(plain, 'digits of errors'):.1f}. A law is fitted once for a batch of "
        f"hours, so that {number(ours, 'us per fit') / 1e3:.1f} ms do not matter."
    )


FAMILY = Family(
    "polynomial",
    f"Polynomials of degree 4 and 8, {POINTS} points, several units and origins of time",
    "relative error",
    "worst relative rounding error",
    rows,
    _why,
)
