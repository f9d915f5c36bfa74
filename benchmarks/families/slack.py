"""Moduli of strips that hang loose at first: where the strip is taut is found, or assumed."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from benchmarks.families.family import Family, default_of, named, number
from benchmarks.measure import Answer, Contender, measured_rows
from benchmarks.rivals import slack as rivals
from benchmarks.rivals.slope import Slope
from benchmarks.timing import Row
from deamat.core.arrays import FloatArray
from deamat.estimators.curves.slack import find_slack
from deamat.estimators.curves.slope import curvature, fit_line
from deamat.estimators.mean import coverage_factor

Curve = tuple[FloatArray, FloatArray]
MODULUS_Pa = 1e6
WINDOW = 0.01
_NOISE_Pa = 30.0  # 0.3 % of the stress at the end of the window
_MOST_SLACK = 0.005
_UNTARED_Pa = 4000.0  # greatest load before the pull, of either sign: 4 % of the greatest load
_STRAIN = np.linspace(0.0, 0.1, 201)
_SOFTENING = 0.12


def _stress(strain: FloatArray) -> FloatArray:
    return MODULUS_Pa * (strain - _SOFTENING * strain**2)


TRUTH_Pa = float(np.polyfit(_STRAIN[:21], _stress(_STRAIN[:21]), 1)[0])


def curves(m: int, seed: int = 6) -> list[Curve]:
    """Simulate m pulls with slack of up to half a window and a load cell that is off its zero."""
    rng = np.random.default_rng(seed)
    found = []
    for slack in rng.uniform(0.0, _MOST_SLACK, m):
        stress = _stress(np.maximum(_STRAIN - slack, 0.0))
        stress = stress + rng.uniform(-_UNTARED_Pa, _UNTARED_Pa)
        found.append((_STRAIN, stress + rng.normal(0.0, _NOISE_Pa, _STRAIN.size)))
    return found


def rows(scale: float) -> list[Row]:
    """Measure all contenders on the same curves."""
    samples = curves(max(int(1500 * scale), 80))
    contenders = [
        Contender("hinge, then slope", _default, default=True),
        Contender("plain window", _rival(rivals.plain)),
        Contender("from a preload of 2 %", _rival(rivals.from_preload)),
        Contender("from the steepest tangent (ASTM D638)", _rival(rivals.from_tangent)),
    ]
    return measured_rows(contenders, samples, np.full((len(samples), 1), TRUTH_Pa))


def _default(curve: Curve) -> Answer:
    """The slope over the window from where the strip is taut, as the room of tension takes it."""
    strain, stress = curve
    slack = find_slack(strain, stress, WINDOW)
    zero, u_zero = (0.0, 0.0) if slack is None else (slack.strain, slack.u_strain)
    inside = (strain >= zero) & (strain <= zero + WINDOW)
    line = fit_line(strain[inside], stress[inside])
    bend = abs(curvature(strain[inside], stress[inside]))
    error = np.hypot(line.standard_error, bend * u_zero)
    half = coverage_factor(line.degrees_of_freedom) * error
    return Answer(*(np.array([line.slope + part]) for part in (0.0, -half, half)))


def _rival(
    method: Callable[[FloatArray, FloatArray, float], Slope],
) -> Callable[[Curve], Answer]:
    def fit(curve: Curve) -> Answer:
        found = method(*curve, WINDOW)
        return Answer(np.array([found.value]), np.array([found.low]), np.array([found.high]))

    return fit


def _why(found: Sequence[Row]) -> str:
    ours, plain = default_of(found), named(found, "plain window")
    return (
        "A hinge in the curve shows where the strip is taut, whatever the zero of the load: RMSE "
        f"{number(ours, 'rmse %'):.1f} % instead of {number(plain, 'rmse %'):.0f} % of the window "
        f"as recorded, for {number(ours, 'us per fit'):.0f} us instead of "
        f"{number(plain, 'us per fit'):.0f}. A preload or a tangent needs that zero."
    )


FAMILY = Family(
    "slack",
    "Modulus of a strip with slack of up to half its window, on a load cell off its zero",
    "interval error %",
    "interval error: width and misses [%]",
    rows,
    _why,
)
