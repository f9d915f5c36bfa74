"""Power laws in a rate: viscosity of a pseudoplastic silicone while it cures."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from benchmarks.families.family import Family, default_of, named, number
from benchmarks.measure import Answer, Contender, is_there, measured_rows
from benchmarks.rivals import power_law as rivals
from benchmarks.timing import Row
from deamat.core.arrays import FloatArray
from deamat.core.errors import FitRefused
from deamat.estimators.least_squares.power_law import ErrorModel, fit_power_law
from deamat.estimators.mean import coverage_factor

Readings = tuple[FloatArray, FloatArray, FloatArray]
# Sylgard 186 (10:1), Sikulskyi et al. 2022, Table 2, the printed exponent read as n: n - 1 here.
LAW = np.array([34.95, 35.31, -15.99, 2.372, 0.3125 - 1.0, -0.01294, 0.002466])
DEGREES = (3, 2)
PLACES = ((2.0, 0.1), (6.5, 0.3), (11.0, 0.5))  # hours and 1/s
NOISE = 0.03  # of the reading
TIME_h = np.repeat(np.linspace(1.0, 12.0, 12), 4)
RATE_per_s = np.tile([0.05, 0.1, 0.27, 0.6], 12)


def readings(m: int, seed: int = 9) -> list[Readings]:
    """Simulate m batches of 12 times and 4 rates; half of them tell time in seconds."""
    rng = np.random.default_rng(seed)
    clean = rivals.law(TIME_h, RATE_per_s, LAW, DEGREES)
    made = []
    for i in range(m):
        y = clean * np.exp(NOISE * rng.standard_normal(clean.size))
        made.append(((3600.0 if i % 2 else 1.0) * TIME_h, RATE_per_s, y))
    return made


def truth() -> FloatArray:
    """Viscosity at the places asked about `[Pa s]`, shape (3,)."""
    t, q = np.array(PLACES).T
    return rivals.law(t, q, LAW, DEGREES)


def rows(scale: float) -> list[Row]:
    """Measure all contenders on the same batches."""
    samples = readings(max(int(400 * scale), 16))
    return measured_rows(contenders(), samples, np.tile(truth(), (len(samples), 1)))


def contenders() -> list[Contender[Readings]]:
    """List the default, its rivals and the peers that are installed."""
    found = [
        Contender("K(t), m(t), errors of reading", _ours("of reading"), default=True),
        Contender("K(t), m(t), errors of full scale", _ours("of full scale")),
        Contender("surface of ln viscosity", _rival(rivals.surface)),
        Contender("log-log, time by time", _rival(rivals.log_log)),
        Contender("scipy curve_fit, weighted", _rival(rivals.weighted_values), outside=True),
        Contender(
            "scipy curve_fit, weighted, time scaled by hand",
            _in_hours(_rival(rivals.weighted_values)),
            outside=True,
        ),
        Contender("scipy curve_fit, plain", _rival(rivals.plain_values), outside=True),
    ]
    if is_there("lmfit"):
        found += [
            Contender("lmfit Model, weighted", _lmfit, outside=True),
            Contender(
                "lmfit Model, weighted, time scaled by hand",
                _in_hours(_lmfit),
                outside=True,
            ),
        ]
    return found


def _ours(errors: ErrorModel) -> Callable[[Readings], Answer]:
    def fit(sample: Readings) -> Answer:
        law = fit_power_law(*sample, *DEGREES, errors)
        unit = sample[0][0] / TIME_h[0]
        value, u = np.array([law(unit * t, q) for t, q in PLACES]).T
        half = coverage_factor(law.fit.dof) * u
        return Answer(value, value - half, value + half)

    return fit


def _rival(method: Callable[..., FloatArray]) -> Callable[[Readings], Answer]:
    def fit(sample: Readings) -> Answer:
        unit = sample[0][0] / TIME_h[0]
        return Answer(*method(*sample, DEGREES, np.array(PLACES) * (unit, 1.0)))

    return fit


def _in_hours(fit: Callable[[Readings], Answer]) -> Callable[[Readings], Answer]:
    """Bring time to hours first, as somebody would who knows that the search needs it."""
    return lambda sample: fit((TIME_h, *sample[1:]))


def _lmfit(sample: Readings) -> Answer:
    from lmfit import Parameters, minimize

    t, q, y = sample
    unit = t[0] / TIME_h[0]
    start = Parameters()
    for k, value in enumerate(rivals.constant_start(y, DEGREES)):
        start.add(f"b{k}", value=float(value))

    def law(parameters: dict[str, float], times: FloatArray, rates: FloatArray) -> FloatArray:
        b = np.array([float(parameters[f"b{k}"]) for k in range(len(LAW))])
        return rivals.law(times, rates, b, DEGREES)

    try:
        found = minimize(lambda p: (law(p, t, q) - y) / y, start, max_nfev=5000)
    except ValueError as error:
        raise FitRefused(str(error)) from error
    hours, rates = np.array(PLACES).T
    value = law(found.params, unit * hours, rates)
    nothing = np.full(len(value), np.nan)
    return Answer(value, nothing, nothing)  # lmfit gives no interval of a prediction


def _why(found: Sequence[Row]) -> str:
    ours, fast = default_of(found), named(found, "log-log, time by time")
    peer = named(found, "scipy curve_fit, weighted")
    scaled = named(found, "scipy curve_fit, weighted, time scaled by hand")
    return (
        "The error of a viscometer is a part of its reading, and so the default fits logarithms: "
        f"RMSE {number(ours, 'rmse %'):.2f} %, coverage {number(ours, 'coverage %'):.1f} %. Lines "
        f"of logarithms are faster, but lose {number(fast, 'rmse %') / number(ours, 'rmse %'):.1f} "
        f"times as much. curve_fit with the same weights and a fair start is as right "
        f"({number(peer, 'rmse %'):.2f} %) in {number(peer, 'us per fit') / 1e3:.1f} ms, in "
        f"{number(scaled, 'us per fit') / 1e3:.1f} if somebody scales time for it; the default "
        f"needs neither start nor scale, {number(ours, 'us per fit') / 1e3:.1f} ms, and in these "
        f"it comes back to its minimum from a second start, or refuses."
    )


FAMILY = Family(
    "power_law",
    f"Viscosity K(t) rate^m(t), 48 readings with {100 * NOISE:.0f} % noise, hours and seconds",
    "rmse %",
    "RMSE of the viscosity [%]",
    rows,
    _why,
)
