"""Breakdown fields: points and intervals of the Weibull scale, shape and quantiles."""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from benchmarks.families.family import Family, default_of, named, number
from benchmarks.measure import Answer, Contender, is_there, measured_rows, statistics
from benchmarks.rivals.weibull import (
    RivalIntervals,
    bootstrap_intervals,
    likelihood_ratio_intervals,
    wald_intervals,
)
from benchmarks.rivals.weibull_lines import iec_62539, rank_regression
from benchmarks.timing import Row
from benchmarks.weibull import conditional_bounds
from benchmarks.weibull import samples as draw
from deamat.core.arrays import FloatArray
from deamat.estimators.weibull.fit import fit, fit_batch, solve_shape
from deamat.estimators.weibull.intervals import infer
from deamat.estimators.weibull.sample import check_sample, log_samples, sample_warnings
from deamat.estimators.weibull.shape import modified_ratio, unbiased_shape

SCALE, SHAPE = 97.0, 8.0
N_POINT, N_INTERVAL = 20, 5
B10 = SCALE * (-np.log(0.9)) ** (1.0 / SHAPE)
B1 = SCALE * (-np.log(0.99)) ** (1.0 / SHAPE)
_POINT_TRUTH = np.array([SCALE, B10])
_INTERVAL_TRUTH = np.array([SHAPE, SCALE, B1])
_LOG_HAZARD_B10 = float(np.log(-np.log(0.9)))

_RATIO = modified_ratio(np.array([float(N_POINT)]))
_INTERVAL_COLUMNS = ("coverage %", "interval error %")


def point_rows(scale: float) -> list[Row]:
    """Measure point estimates of the scale and B10 on the same samples."""
    x = draw(N_POINT, max(int(4000 * scale), 200))
    truth = np.tile(_POINT_TRUTH, (len(x), 1))
    made = measured_rows(_points(), list(x), truth)
    batched, seconds = _timed(lambda: _batched_points(x), len(x))
    made.insert(
        1, _batch_row("maximum likelihood, batched", seconds, len(x)) | statistics(batched, truth)
    )
    return [{k: v for k, v in row.items() if k not in _INTERVAL_COLUMNS} for row in made]


def interval_rows(scale: float) -> list[Row]:
    """Measure 95 % intervals of shape, scale and B1 on the same samples."""
    x = draw(N_INTERVAL, max(int(1200 * scale), 80))
    truth = np.tile(_INTERVAL_TRUTH, (len(x), 1))
    made = measured_rows(_intervals(), list(x), truth)
    bounds, seconds = _timed(lambda: conditional_bounds(x), len(x))
    answers = np.stack([truth, *bounds.transpose(1, 2, 0)], axis=1)
    row = _batch_row("exact conditional, batched", seconds, len(x)) | statistics(answers, truth)
    made.insert(1, row)
    points = ("bias %", "rmse %")
    return [{k: v for k, v in row.items() if k not in points} for row in made]


def _batch_row(name: str, seconds: float, fits: int) -> dict[str, str | float | int]:
    return {
        "contender": name,
        "kind": "batch",
        "us per fit": 1e6 * seconds,
        "fits": fits,
        "failed %": 0.0,
    }


def _timed(batch: Callable[[], FloatArray], count: int) -> tuple[FloatArray, float]:
    """Run a batch five times: its result, and the least processor time for each sample `[s]`."""
    seconds = []
    for _ in range(5):
        start = time.process_time()
        result = batch()
        seconds.append((time.process_time() - start) / count)
    return result, min(seconds)


def _batched_points(x: FloatArray) -> FloatArray:
    fits = fit_batch(x)
    value = np.stack([fits.scale, fits.scale * np.exp(_LOG_HAZARD_B10 / fits.shape)], axis=1)
    return np.stack([value, value, value], axis=1)


def _points() -> list[Contender[FloatArray]]:
    found = [
        Contender("maximum likelihood", _point(lambda x: _pair(fit(x))), default=True),
        Contender("shape freed of bias (Ross)", _point(_ross)),
        Contender("modified profile likelihood", _point(_modified_profile)),
        Contender("rank regression, x on y", _point(lambda x: _pair(rank_regression(x)))),
        Contender(
            "rank regression, y on x",
            _point(lambda x: _pair(rank_regression(x, direction="y on x"))),
        ),
        Contender("IEC 62539 (White)", _point(lambda x: _pair(iec_62539(x)))),
        Contender("moments of ln x", _point(_moments)),
        Contender("scipy weibull_min.fit", _point(_scipy), outside=True),
    ]
    if is_there("lmfit"):
        lmfit = Contender("lmfit, distribution to ranks", _point(_lmfit), outside=True)
        found.append(lmfit)
    peers = {"reliability": _reliability, "surpyval": _surpyval, "lifelines": _lifelines}
    found += [
        Contender(name, _point(peer), outside=True, every=100)
        for name, peer in peers.items()
        if is_there(name)
    ]
    return found


class _Fitted(Protocol):
    @property
    def scale(self) -> float: ...
    @property
    def shape(self) -> float: ...


def _pair(fitted: _Fitted) -> tuple[float, float]:
    return fitted.scale, fitted.shape


def _point(method: Callable[[FloatArray], tuple[float, float]]) -> Callable[[FloatArray], Answer]:
    """Turn scale and shape into the scale and B10, without intervals."""

    def ask(x: FloatArray) -> Answer:
        scale, shape = method(x)
        value = np.array([scale, scale * np.exp(_LOG_HAZARD_B10 / shape)])
        return Answer(value, value, value)

    return ask


def _ross(x: FloatArray) -> tuple[float, float]:
    return fit(x).scale, unbiased_shape(x).value


def _modified_profile(x: FloatArray) -> tuple[float, float]:
    """Modified profile likelihood, with the checks and warnings that every fit of ours gives."""
    values, failed = check_sample(x, None)
    sample_warnings(values, failed)
    samples = log_samples(values[None, :], None)
    shape, log_sum = solve_shape(samples, _RATIO)
    scale = samples.largest * np.exp((log_sum - np.log(samples.failures)) / shape)
    return scale.item(), shape.item()


def _moments(x: FloatArray) -> tuple[float, float]:
    """Menon's estimates from mean and standard deviation of ln x."""
    logs = np.log(x)
    shape = np.pi / (np.sqrt(6.0) * float(logs.std(ddof=1)))
    return float(np.exp(logs.mean() + np.euler_gamma / shape)), float(shape)


def _scipy(x: FloatArray) -> tuple[float, float]:
    from scipy.stats import weibull_min

    shape, _, scale = weibull_min.fit(x, floc=0)
    return float(scale), float(shape)


def _lmfit(x: FloatArray) -> tuple[float, float]:
    """Least squares of the distribution function to median ranks, as users of lmfit do it."""
    from lmfit import Parameters, minimize

    strengths = np.sort(x)
    ranks = (np.arange(1, len(x) + 1) - 0.3) / (len(x) + 0.4)
    start = Parameters()
    start.add("scale", value=float(np.median(x)), min=0.0)
    start.add("shape", value=5.0, min=0.0)
    found = minimize(
        lambda p: -np.expm1(-((strengths / p["scale"].value) ** p["shape"].value)) - ranks, start
    )
    return float(found.params["scale"].value), float(found.params["shape"].value)


def _reliability(x: FloatArray) -> tuple[float, float]:
    fitters = importlib.import_module("reliability.Fitters")
    found = fitters.Fit_Weibull_2P(failures=x, show_probability_plot=False, print_results=False)
    return float(found.alpha), float(found.beta)


def _surpyval(x: FloatArray) -> tuple[float, float]:
    scale, shape = importlib.import_module("surpyval").Weibull.fit(x).params
    return float(scale), float(shape)


def _lifelines(x: FloatArray) -> tuple[float, float]:
    found = importlib.import_module("lifelines").WeibullFitter().fit(x)
    return float(found.lambda_), float(found.rho_)


def _intervals() -> list[Contender[FloatArray]]:
    return [
        Contender("exact conditional", _conditional, default=True),
        Contender("Wald, log (R, SAS)", _rival_intervals(wald_intervals)),
        Contender("likelihood ratio", _rival_intervals(likelihood_ratio_intervals)),
        Contender("bootstrap percentile", _rival_intervals(_bootstrap)),
    ]


def _conditional(x: FloatArray) -> Answer:
    asked = infer(x)
    found = (asked.shape(), asked.scale(), asked.quantile(0.01))
    value, low, high = np.array([(i.estimate, i.low, i.high) for i in found]).T
    return Answer(value, low, high)


def _bootstrap(x: FloatArray, *, probabilities: Sequence[float]) -> RivalIntervals:
    return bootstrap_intervals(x, probabilities=probabilities, draws=1000)


def _rival_intervals(method: Callable[..., RivalIntervals]) -> Callable[[FloatArray], Answer]:
    def ask(x: FloatArray) -> Answer:
        found = method(x, probabilities=(0.01,))
        low, high = np.array([found.shape, found.scale, found.quantiles[0]]).T
        return Answer(0.5 * (low + high), low, high)

    return ask


def _why_point(found: Sequence[Row]) -> str:
    ours, batched = default_of(found), named(found, "maximum likelihood, batched")
    return (
        f"No other way has less error of scale and B10 than maximum likelihood, "
        f"RMSE {number(ours, 'rmse %'):.2f} %, and its intervals are exact. "
        f"Alone it takes {number(ours, 'us per fit'):.0f} us, batched "
        f"{number(batched, 'us per fit'):.1f} us: {1e6 / number(batched, 'us per fit'):.2g} fits a "
        f"second on one core."
    )


def _why_interval(found: Sequence[Row]) -> str:
    ours, batched = default_of(found), named(found, "exact conditional, batched")
    wald = named(found, "Wald, log (R, SAS)")
    return (
        f"Five specimens are what a laboratory has. The exact intervals cover in "
        f"{number(ours, 'coverage %'):.1f} %, those of most packages (Wald) in "
        f"{number(wald, 'coverage %'):.1f} %; three of them take {number(ours, 'us per fit'):.0f} "
        f"us alone and {number(batched, 'us per fit'):.0f} us a sample in a batch."
    )


POINTS = Family(
    "weibull_point",
    f"Weibull scale and B10 of {N_POINT} specimens (shape {SHAPE:g}, scale {SCALE:g})",
    "rmse %",
    "RMSE of scale and B10 [%]",
    point_rows,
    _why_point,
)
INTERVALS = Family(
    "weibull_interval",
    f"95 % intervals of Weibull shape, scale and B1, {N_INTERVAL} specimens",
    "interval error %",
    "interval error: width and misses [%]",
    interval_rows,
    _why_interval,
)
