"""The modulus of a strip that hangs loose: the room of tension, with its refusals and flags."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmarks.stability.cells import Draw, Estimator, Failure, Told
from deamat.core.arrays import FloatArray
from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.recording import Recording, Source, Specimen
from deamat.core.technique import Context
from deamat.estimators.mean import coverage_factor
from deamat.techniques.tension import TECHNIQUE
from deamat.techniques.tension.config import MODULI

Curve = tuple[FloatArray, FloatArray]
_E = 1e6  # Pa
_WINDOW = 0.01
_END = 0.12  # strain to which the strip is pulled
_STRESS = _WINDOW * _E


def _drawn(
    *,
    slack: float = 0.003,
    loose: float = 0.0,
    noise: float = 0.005,
    round_over: float = 0.0,
    untared: float = 0.0,
) -> Draw:
    """Draw pulls of n readings in the window of 0-1 % strain.

    Parameters
    ----------
    slack : strain until the strip is taut
    loose : slope until there over that of the strip
    noise, untared : of the load and at its start, over the stress at 1 % strain
    round_over : strain over which the hinge is rounded
    """

    def draw(rng: np.random.Generator, n: int) -> tuple[Curve, FloatArray]:
        x = np.linspace(0.0, _END, round(n * _END / _WINDOW))
        taut = x - slack
        if round_over:
            taut = 0.5 * (taut + np.sqrt(taut**2 + round_over**2))
        y = _E * (loose * np.minimum(x, slack) + np.maximum(taut, 0.0)) + untared * _STRESS
        y = y + noise * _STRESS * rng.standard_normal(x.size)
        return (x, y), np.array([_E if slack == 0.0 else np.nan, np.nan if slack == 0.0 else _E])

    return draw


def _settings(name: str, values: Sequence[float]) -> tuple[tuple[str, Draw], ...]:
    return tuple((f"{100 * v:g} %", _drawn(**{name: v})) for v in values)


_FAILURES = (
    Failure("slack, strain", _settings("slack", (0.0, 0.0007, 0.002, 0.005, 0.02))),
    Failure("slope of the slack", _settings("loose", (0.0, 0.2, 0.5, 0.7, 0.9))),
    Failure("noise", _settings("noise", (0.001, 0.01, 0.03, 0.1, 0.5))),
    Failure("hinge rounded over", _settings("round_over", (0.0002, 0.001, 0.003, 0.01, 0.03))),
    Failure("load before the pull", _settings("untared", (0.02, 0.1, 0.3, 1.0, 3.0))),
)
_MACHINE = Machine(u_force_calibration=0.0, u_displacement_calibration=0.0)
_CONTEXT = Context(TECHNIQUE.config(), _MACHINE, {})
_WIDTH_m, _THICKNESS_m, _GAUGE_m = 6e-3, 2e-3, 40e-3
_NUMBERS = {
    "width_m": Quantity(_WIDTH_m, "m"),
    "thickness_m": Quantity(_THICKNESS_m, "m"),
    "gauge_length_m": Quantity(_GAUGE_m, "m"),
}
_SPECIMEN = Specimen(
    "a", "simulated", "simulated", "tension", "a.csv", None, _NUMBERS, {}, {}, "s.csv", 2
)


def _ask(curves: Sequence[Curve]) -> list[Told]:
    return [_ask_one(curve) for curve in curves]


def _ask_one(curve: Curve) -> Told:
    x, y = curve
    columns = {"displacement_m": x * _GAUGE_m, "force_N": y * _WIDTH_m * _THICKNESS_m}
    source = Source("a.csv", "0" * 64, 1, len(x), "utf-8", "simulated")
    measured = TECHNIQUE.reduce(_SPECIMEN, Recording(columns, {}, {}, source), _CONTEXT)
    low, high = np.full(2, np.nan), np.full(2, np.nan)
    flags = [frozenset[str](), frozenset[str]()]
    for value in measured.values:
        if value.key not in MODULI:
            continue
        k = MODULI.index(value.key)
        q = value.quantity
        half = coverage_factor(value.degrees_of_freedom) * q.standard_uncertainty
        low[k], high[k] = q.value - half, q.value + half
        flags[k] = frozenset(flag.name for flag in value.flags)
    return Told(low, high, tuple(flags))


ESTIMATOR = Estimator(
    "tension",
    ("modulus without slack", "toe-compensated modulus"),
    (10, 40, 160),
    _FAILURES,
    _ask,
    "tension",
)
