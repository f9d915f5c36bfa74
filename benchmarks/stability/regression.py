"""Linear models, a nonlinear one (a decay to a constant), and power laws in a rate."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmarks.families.power_law import DEGREES, LAW
from benchmarks.rivals.power_law import law
from benchmarks.stability.cells import Draw, Estimator, Failure, Told, refused
from benchmarks.stability.polynomial import fit_flags
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.least_squares.fit import Fit
from deamat.estimators.least_squares.lack_of_fit import outlying_points
from deamat.estimators.least_squares.linear import fit_linear
from deamat.estimators.least_squares.nonlinear import fit_nonlinear
from deamat.estimators.least_squares.power_law import fit_power_law
from deamat.estimators.mean import coverage_factor

_SCALES = (1e-6, 1e-3, 1.0, 1e3, 1e6)


def _linear(
    *,
    closeness: float = 1.0,
    noise: float = 0.01,
    unit: float = 1.0,
    bad: float = 0.0,
    tail: float = 0.0,
) -> Draw:
    """Draw y = 1 + 2 a + 3 b with columns a and b that differ by `closeness`.

    Parameters
    ----------
    tail : degrees of freedom of Student's t noise; 0 for a normal one
    bad : part of the values at half their size
    unit : of the second column
    """

    def draw(rng: np.random.Generator, n: int) -> tuple[tuple[FloatArray, FloatArray], FloatArray]:
        a = rng.uniform(0.0, 1.0, n)
        b = a + closeness * rng.uniform(-1.0, 1.0, n)
        design = np.column_stack((np.ones(n), a, unit * b))
        e = rng.standard_t(tail, n) if tail else rng.standard_normal(n)
        y = 1.0 + 2.0 * a + 3.0 * b + noise * e
        return (design, np.where(rng.random(n) < bad, 0.5 * y, y)), np.array([2.0])

    return draw


def _ask_linear(samples: Sequence[tuple[FloatArray, FloatArray]]) -> list[Told]:
    told = []
    for design, y in samples:
        try:
            fit = fit_linear(design, y)
        except FitRefused:
            told.append(refused(1))
            continue
        half = coverage_factor(fit.dof) * fit.standard_errors[1]
        value = fit.parameters[1]
        told.append(Told(np.array([value - half]), np.array([value + half]), (_outliers(fit),)))
    return told


def _outliers(fit: Fit) -> frozenset[str]:
    return frozenset({"outlying points"} if outlying_points(fit).size else set())


LINEAR = Estimator(
    "linear model",
    ("coefficient",),
    (6, 20, 100),
    (
        Failure("points", (("sound", _linear()),), sizes=(3, 4, 6, 20, 100)),
        Failure(
            "columns differ by",
            tuple((f"{v:g}", _linear(closeness=v)) for v in (1e-2, 1e-4, 1e-8, 1e-11, 1e-14)),
        ),
        Failure("noise", tuple((f"{v:g}", _linear(noise=v)) for v in (1e-9, 1e-3, 0.1, 1, 100))),
        Failure("unit of a column", tuple((f"{v:g}", _linear(unit=v)) for v in _SCALES)),
        Failure(
            "values at half",
            tuple((f"{100 * v:g} %", _linear(bad=v)) for v in (0.02, 0.05, 0.1, 0.3)),
        ),
        Failure(
            "long-tailed noise", tuple((f"t({v:g})", _linear(tail=v)) for v in (10, 5, 3, 2, 1))
        ),
    ),
    _ask_linear,
    "linear",
)

Decay = tuple[FloatArray, FloatArray, FloatArray]  # t, y, start
_DECAY = np.array([5.0, 0.7, 2.0])  # amplitude, rate, constant


def _decay(
    *,
    noise: float = 0.05,
    start: float = 1.5,
    time: float = 1.0,
    unit: float = 1.0,
    seen: float = 10.0,
    second: float = 0.0,
    bad: float = 0.0,
) -> Draw:
    """Draw y = 5 exp(-0.7 t) + 2.

    Parameters
    ----------
    start : factor by which the starting values are off
    time, unit : factors on t and y
    seen : end of t
    second : amplitude of a second decay at a tenth of the rate, which the model has not
    """

    def draw(rng: np.random.Generator, n: int) -> tuple[Decay, FloatArray]:
        t = np.linspace(0.0, seen, n)
        y = _DECAY[0] * np.exp(-_DECAY[1] * t) + _DECAY[2] + second * np.exp(-0.07 * t)
        y = y + noise * rng.standard_normal(n)
        y = np.where(rng.random(n) < bad, 0.5 * y, y)
        units = np.array([unit, 1.0 / time, unit])
        truth = _DECAY * units
        return (time * t, unit * y, truth * np.array([start, 1.0 / start, 1.0])), truth[1:2]

    return draw


def _ask_decay(samples: Sequence[Decay]) -> list[Told]:
    return [_ask_one_decay(*sample) for sample in samples]


def _ask_one_decay(t: FloatArray, y: FloatArray, start: FloatArray) -> Told:
    def model(b: FloatArray) -> FloatArray:
        return np.asarray(b[0] * np.exp(-b[1] * t) + b[2])

    def jacobian(b: FloatArray) -> FloatArray:
        e = np.exp(-b[1] * t)
        return np.stack([e, -b[0] * t * e, np.ones(len(t))], axis=1)

    try:
        fit = fit_nonlinear(model, jacobian, start, y)
    except FitRefused:
        return refused(1)
    half = coverage_factor(fit.dof) * fit.standard_errors[1]
    value = fit.parameters[1]
    return Told(np.array([value - half]), np.array([value + half]), (fit_flags(t, fit),))


NONLINEAR = Estimator(
    "nonlinear model",
    ("rate of a decay",),
    (20,),
    (
        Failure("points", (("sound", _decay()),), sizes=(3, 4, 6, 20, 100)),
        Failure("noise", tuple((f"{v:g}", _decay(noise=v)) for v in (1e-6, 0.01, 0.2, 1, 5))),
        Failure("start off by", tuple((f"{v:g}", _decay(start=v)) for v in (1, 3, 10, 100, 1000))),
        Failure("unit of time", tuple((f"{v:g}", _decay(time=v)) for v in _SCALES)),
        Failure("unit of y", tuple((f"{v:g}", _decay(unit=v)) for v in _SCALES)),
        Failure(
            "decay seen up to",
            tuple((f"{0.7 * v:.2g} τ", _decay(seen=v)) for v in (10, 3, 1, 0.3, 0.1)),
        ),
        Failure("second decay", tuple((f"{v:g}", _decay(second=v)) for v in (0.01, 0.1, 0.3, 1))),
        Failure(
            "values at half", tuple((f"{100 * v:g} %", _decay(bad=v)) for v in (0.02, 0.1, 0.3))
        ),
    ),
    _ask_decay,
    "nonlinear",
    60,
)

Readings = tuple[FloatArray, FloatArray, FloatArray, float]  # t, q, y, time asked about
_RATES = np.array([0.05, 0.1, 0.27, 0.6])


def _readings(
    *,
    noise: float = 0.03,
    scale: float = 0.0,
    time: float = 1.0,
    unit: float = 1.0,
    spread: float = 1.0,
    bad: float = 0.0,
    step: float = 0.0,
) -> Draw:
    """Draw viscosities at n times and four rates.

    Parameters
    ----------
    noise : part of the reading
    scale : part of the greatest reading, a noise that is not of the reading
    time, unit : factors on t and y
    spread : power that narrows the range of rates
    bad : part of the readings at half value
    step : rounding `[Pa s]`
    """

    def draw(rng: np.random.Generator, n: int) -> tuple[Readings, FloatArray]:
        t = np.repeat(np.linspace(1.0, 12.0, n), 4)
        q = np.tile(0.2 * (_RATES / 0.2) ** spread, n)
        clean = law(t, q, LAW, DEGREES)
        y = clean * np.exp(noise * rng.standard_normal(t.size))
        y = np.abs(y + scale * clean.max() * rng.standard_normal(t.size))
        y = np.where(rng.random(t.size) < bad, 0.5 * y, y)
        if step:
            y = np.maximum(np.round(y / step), 0.0) * step
        truth = law(np.array([6.0]), np.array([0.2]), LAW, DEGREES)
        return (time * t, q, unit * y, 6.0 * time), unit * truth

    return draw


def _ask_power_law(samples: Sequence[Readings]) -> list[Told]:
    told = []
    for t, q, y, asked in samples:
        try:
            fit = fit_power_law(t, q, y, *DEGREES, "of reading")
            value, u = fit(asked, 0.2)
        except FitRefused:
            told.append(refused(1))
            continue
        half = coverage_factor(fit.fit.dof) * u
        ends = np.array([value - half]), np.array([value + half])
        told.append(Told(*ends, (_outliers(fit.fit),)))
    return told


POWER_LAW = Estimator(
    "power law",
    ("viscosity",),
    (12,),
    (
        Failure("times", (("sound", _readings()),), sizes=(2, 4, 6, 12, 40)),
        Failure(
            "noise of reading",
            tuple((f"{v:g}", _readings(noise=v)) for v in (1e-6, 0.01, 0.1, 0.3, 1)),
        ),
        Failure(
            "noise of full scale",
            tuple((f"{v:g}", _readings(scale=v)) for v in (1e-3, 0.01, 0.03, 0.1)),
        ),
        Failure("unit of time", tuple((f"{v:g}", _readings(time=v)) for v in _SCALES)),
        Failure("unit of viscosity", tuple((f"{v:g}", _readings(unit=v)) for v in _SCALES)),
        Failure(
            "power on rate range",
            tuple((f"{v:g}", _readings(spread=v)) for v in (0.5, 0.1, 1e-2, 1e-4, 0)),
        ),
        Failure(
            "readings at half",
            tuple((f"{100 * v:g} %", _readings(bad=v)) for v in (0.02, 0.05, 0.1, 0.3)),
        ),
        Failure("rounding [Pa s]", tuple((f"{v:g}", _readings(step=v)) for v in (1, 10, 50, 200))),
    ),
    _ask_power_law,
    "power_law",
    60,
)
