"""Slopes of stress over strain: a window of a compression test with the noise of a load cell."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from benchmarks.families.family import Family, default_of, named, number
from benchmarks.measure import Answer, Contender, is_there, measured_rows
from benchmarks.rivals import slope as slope_rivals
from benchmarks.timing import Row
from deamat.core.arrays import FloatArray
from deamat.estimators.curves.slope import fit_line
from deamat.estimators.mean import coverage_factor

Curve = tuple[FloatArray, FloatArray]
MODULUS_Pa = 0.3e6
WINDOW = 0.05
SAMPLES = 120  # 0-5 % strain at 2.5 %/s and 60 Hz
NOISE_Pa = 200.0  # 1.3 % of the stress at the end of the window
CORRELATION = 0.5


def correlated(rng: np.random.Generator, m: int, n: int, rho: float) -> FloatArray:
    """Draw m series of first-order autoregressive noise of unit variance, shape (m, n)."""
    noise = rng.standard_normal((m, n))
    for i in range(1, n):
        noise[:, i] = rho * noise[:, i - 1] + np.sqrt(1.0 - rho**2) * noise[:, i]
    return noise


def curves(m: int, seed: int = 5) -> list[Curve]:
    """Simulate m windows: a straight line and noise that remembers its last sample."""
    x = np.linspace(0.0, WINDOW, SAMPLES)
    noise = correlated(np.random.default_rng(seed), m, SAMPLES, CORRELATION)
    return [(x, MODULUS_Pa * x + NOISE_Pa * e) for e in noise]


def rows(scale: float) -> list[Row]:
    """Measure all contenders on the same curves."""
    samples = curves(max(int(2000 * scale), 80))
    return measured_rows(contenders(), samples, np.full((len(samples), 1), MODULUS_Pa))


def contenders() -> list[Contender[Curve]]:
    """List the default, its rivals and the peers that are installed."""
    found = [
        Contender("OLS, autocorrelation-aware error", _default, default=True),
        Contender("OLS, naive error", _rival(slope_rivals.naive)),
        Contender("GLS, autoregressive", _rival(slope_rivals.generalised)),
        Contender("Theil-Sen", _rival(slope_rivals.theil_sen)),
        Contender("Huber", _rival(slope_rivals.huber)),
        Contender("bin-wise average", _rival(slope_rivals.bin_wise)),
        Contender("toe-compensated", _rival(slope_rivals.toe_compensated)),
        Contender("numpy.polyfit", _polyfit, outside=True),
        Contender("scipy.stats.linregress", _linregress, outside=True),
    ]
    if is_there("lmfit"):
        found.append(Contender("lmfit LinearModel", _lmfit, outside=True))
    return found


def _interval(value: float, error: float, dof: float) -> Answer:
    half = coverage_factor(dof) * error
    return Answer(np.array([value]), np.array([value - half]), np.array([value + half]))


def _default(curve: Curve) -> Answer:
    line = fit_line(*curve)
    return _interval(line.slope, line.standard_error, line.degrees_of_freedom)


def _rival(
    method: Callable[[FloatArray, FloatArray], slope_rivals.Slope],
) -> Callable[[Curve], Answer]:
    def fit(curve: Curve) -> Answer:
        found = method(*curve)
        return Answer(np.array([found.value]), np.array([found.low]), np.array([found.high]))

    return fit


def _polyfit(curve: Curve) -> Answer:
    coefficients, covariance = np.polyfit(*curve, 1, cov=True)
    return _interval(coefficients[0], covariance[0, 0] ** 0.5, len(curve[0]) - 2)


def _linregress(curve: Curve) -> Answer:
    from scipy.stats import linregress

    found = linregress(*curve)
    return _interval(found.slope, found.stderr, len(curve[0]) - 2)


def _lmfit(curve: Curve) -> Answer:
    from lmfit.models import LinearModel

    x, y = curve
    model = LinearModel()
    found = model.fit(y, model.guess(y, x=x), x=x).params["slope"]
    return _interval(found.value, found.stderr, len(x) - 2)


def _why(found: Sequence[Row]) -> str:
    ours, naive = default_of(found), named(found, "OLS, naive error")
    return (
        f"The slope is that of least squares; what the default adds is an interval that holds when "
        f"readings follow each other closely: it covers the truth in "
        f"{number(ours, 'coverage %'):.1f} % of curves, the naive one in "
        f"{number(naive, 'coverage %'):.1f} %, for {number(ours, 'us per fit'):.0f} us instead of "
        f"{number(naive, 'us per fit'):.0f}."
    )


FAMILY = Family(
    "slope",
    f"Slope over 0-5 % strain, {SAMPLES} readings, noise correlated by {CORRELATION}",
    "interval error %",
    "interval error: width and misses [%]",
    rows,
    _why,
)
