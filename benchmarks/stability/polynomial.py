"""Polynomials of a given degree, of a chosen one, and non-decreasing ones."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from benchmarks.families.polynomial import QUARTIC
from benchmarks.stability.cells import Draw, Estimator, Failure, Told, refused
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.least_squares.fit import Fit
from deamat.estimators.least_squares.lack_of_fit import outlying_points, residual_runs
from deamat.estimators.least_squares.monotone import fit_non_decreasing
from deamat.estimators.least_squares.polynomial import PolynomialFit, fit_polynomial
from deamat.estimators.mean import coverage_factor
from deamat.estimators.selection import choose

Sample = tuple[FloatArray, FloatArray, int, FloatArray]  # x, y, degree, places asked about
_ASKED_h = np.array([6.0, 11.9])
_MOST = 6  # degree on offer


def _drawn(
    *,
    noise: float = 0.05,
    degree: int = 4,
    unit: float = 1.0,
    time: float = 1.0,
    origin: float = 0.0,
    bad: float = 0.0,
    step: float = 0.0,
    rho: float = 0.0,
    clusters: float = 0.0,
    growing: float = 0.0,
    oscillation: float = 0.0,
) -> Draw:
    """Draw viscosities over 1 to 12 h: the quartic of Table 2 and noise.

    Parameters
    ----------
    noise : standard deviation `[Pa s]`
    degree : that is fitted where it is not chosen
    unit, time, origin : factor on y, factor on x and x at 0 h
    bad : part of the readings at half value
    step : rounding of y
    rho : correlation of neighbours
    clusters : half width of the three groups in which x lie, instead of evenly
    growing : noise at the end as a multiple of that at the start, less one
    oscillation : amplitude of a sine of three periods, which no polynomial on offer has
    """

    def draw(rng: np.random.Generator, n: int) -> tuple[Sample, FloatArray]:
        hours = np.linspace(1.0, 12.0, n)
        if clusters:
            hours = np.repeat([1.0, 6.0, 12.0], -(-n // 3))[:n]
            hours = np.clip(hours + clusters * rng.uniform(-1.0, 1.0, n), 1.0, 12.0)
            hours[0], hours[-1] = 1.0, 12.0
        e = rng.standard_normal(n)
        for i in range(1, n):
            e[i] = rho * e[i - 1] + np.sqrt(1.0 - rho**2) * e[i]

        def law(h: FloatArray) -> FloatArray:
            smooth = np.polynomial.polynomial.polyval(h, QUARTIC)
            return np.asarray(smooth + oscillation * np.sin(6.0 * np.pi * (h - 1.0) / 11.0))

        y = law(hours) + noise * (1.0 + growing * (hours - 1.0) / 11.0) * e
        y = np.where(rng.random(n) < bad, 0.5 * y, y)
        if step:
            y = np.round(y / step) * step
        asked = time * (origin + _ASKED_h)
        return (time * (origin + hours), unit * y, degree, asked), unit * law(_ASKED_h)

    return draw


def _given(x: FloatArray, y: FloatArray, degree: int) -> PolynomialFit:
    return fit_polynomial(x, y, degree)


def _chosen(x: FloatArray, y: FloatArray, _degree: int) -> PolynomialFit:
    def order(k: int) -> tuple[str, Callable[[], PolynomialFit]]:
        return f"order {k}", lambda: fit_polynomial(x, y, k)

    return choose([order(k) for k in range(_MOST + 1)]).fit


def _asking(
    method: Callable[[FloatArray, FloatArray, int], PolynomialFit],
) -> Callable[[Sequence[Sample]], list[Told]]:
    def ask(samples: Sequence[Sample]) -> list[Told]:
        return [one(*sample) for sample in samples]

    def one(x: FloatArray, y: FloatArray, degree: int, asked: FloatArray) -> Told:
        try:
            fit = method(x, y, degree)
        except FitRefused:
            return refused(2)
        return _told(fit, asked, fit_flags(x, fit))

    return ask


def fit_flags(x: FloatArray, fit: Fit) -> frozenset[str]:
    """Ask both tests for a lack of fit."""
    misfit = {"misfit"} if residual_runs(x, fit).found else set()
    far = {"outlying points"} if outlying_points(fit).size else set()
    return frozenset(misfit | far)


def _told(fit: PolynomialFit, asked: FloatArray, flags: frozenset[str]) -> Told:
    value, u = fit(asked)
    half = coverage_factor(fit.dof) * u
    return Told(value - half, value + half, (flags,) * len(asked))


def _rising(samples: Sequence[Sample]) -> list[Told]:
    told = []
    for x, y, degree, asked in samples:
        try:
            found = fit_non_decreasing(x, y, degree, 1e-6 * float(np.abs(y).max()))
        except FitRefused:
            told.append(refused(2))
            continue
        held = frozenset({"held to its shape"} if found.active else set())
        told.append(_told(found.fit, asked, held | fit_flags(x, found.fit)))
    return told


_SCALES = (1e-6, 1e-3, 1.0, 1e3, 1e6)
_ALIKE = (
    Failure("readings", (("sound", _drawn()),), sizes=(4, 6, 9, 24, 100)),
    Failure(
        "noise [Pa s]",
        tuple((f"{v:g}", _drawn(noise=v)) for v in (1e-6, 0.01, 0.1, 1.0, 10.0)),
    ),
    Failure("unit of time", tuple((f"{v:g}", _drawn(time=v)) for v in _SCALES)),
    Failure("unit of viscosity", tuple((f"{v:g}", _drawn(unit=v)) for v in _SCALES)),
    Failure(
        "clock starts at [h]",
        tuple((f"{v:g}", _drawn(origin=v)) for v in (1e2, 1e4, 1e6, 1e8, 1e10)),
    ),
    Failure(
        "clusters of width [h]",
        tuple((f"{v:g}", _drawn(clusters=v)) for v in (1.0, 1e-2, 1e-4, 1e-6, 1e-8)),
    ),
    Failure(
        "readings at half value",
        tuple((f"{100 * v:g} %", _drawn(bad=v)) for v in (0.02, 0.05, 0.1, 0.2)),
    ),
    Failure(
        "rounding [Pa s]",
        tuple((f"{v:g}", _drawn(step=v)) for v in (0.01, 0.1, 0.5, 2.0, 10.0)),
    ),
    Failure("correlation", tuple((f"{v:g}", _drawn(rho=v)) for v in (0.2, 0.4, 0.6, 0.8, 0.95))),
    Failure("noise grows by", tuple((f"{v:g}", _drawn(growing=v)) for v in (0.5, 1.0, 3.0, 9.0))),
    Failure(
        "oscillation [Pa s]",
        tuple((f"{v:g}", _drawn(oscillation=v)) for v in (0.01, 0.05, 0.2, 1.0)),
    ),
)
_DEGREES = Failure(
    "degree given (truth: 4)", tuple((f"{v}", _drawn(degree=v)) for v in (1, 3, 4, 6, 12))
)
_QUESTIONS = ("middle", "end")
_SIZES = (12, 24, 100)
GIVEN = Estimator(
    "polynomial of given degree",
    _QUESTIONS,
    _SIZES,
    (*_ALIKE, _DEGREES),
    _asking(_given),
    "polynomial",
    120,
)
CHOSEN = Estimator(
    "polynomial of chosen order", _QUESTIONS, (12, 48), _ALIKE, _asking(_chosen), "selection", 60
)
RISING = Estimator(
    "non-decreasing polynomial", _QUESTIONS, _SIZES, (*_ALIKE, _DEGREES), _rising, "polynomial", 80
)
