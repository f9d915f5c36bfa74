"""Moduli from compression curves: the whole room, so that its refusals and flags count."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmarks.families.slope import correlated
from benchmarks.stability.cells import Draw, Estimator, Failure, Told
from deamat.core.arrays import FloatArray
from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.recording import Recording, Source, Specimen
from deamat.core.technique import Context
from deamat.estimators.mean import coverage_factor
from deamat.techniques.compression import TECHNIQUE
from deamat.techniques.compression.config import COMPENSATED, MODULUS

Curve = tuple[FloatArray, FloatArray]
_E = 1e6  # Pa
_END = 0.08  # strain to which a sound test goes
_NOISE = 0.005  # of the stress at 5 % strain
_STRESS = 0.05 * _E
_CORRELATION = 0.3


def _drawn(
    *,
    noise: float = _NOISE,
    rho: float = _CORRELATION,
    toe: float = 0.0,
    bad: float = 0.0,
    step: float = 0.0,
    end: float = _END,
    start: float = 0.0,
    bend: float = 0.0,
    unit: float = 1.0,
    drift: float = 0.0,
    preload: float = 0.0,
) -> Draw:
    """Draw curves of n readings in the window of 0-5 % strain, in multiples of its end stress.

    Parameters
    ----------
    noise, rho : of the force and between neighbours
    toe : strain over which contact forms; the force rises as its square there
    bad : part of readings at half force
    step : resolution of the force
    end, start : strains where the recording ends and starts
    bend : relative growth of the tangent over the window
    unit : factor on the stress
    drift : of the force's zero over the window
    preload : force at zero strain
    """

    def draw(rng: np.random.Generator, n: int) -> tuple[Curve, FloatArray]:
        size = max(round(n * (end - start) / 0.05), 2)
        x = np.linspace(start, end, size)
        y = np.where(x < toe, x**2 / (2.0 * toe) if toe else x, x - toe / 2.0) * _E
        y = y * (1.0 + 0.5 * bend * x / 0.05) + preload * _STRESS + drift * _STRESS * x / 0.05
        y = y + noise * _STRESS * correlated(rng, 1, size, rho)[0]
        if bad:
            y = np.where(rng.random(size) < bad, 0.5 * y, y)
        if step:
            y = np.round(y / (step * _STRESS)) * step * _STRESS
        return (x, unit * y), np.full(2, unit * _E)

    return draw


def _settings(
    name: str, labels: Sequence[str], values: Sequence[float]
) -> tuple[tuple[str, Draw], ...]:
    return tuple(
        (label, _drawn(**{name: value})) for label, value in zip(labels, values, strict=True)
    )


def _percent(values: Sequence[float], what: str = "") -> list[str]:
    return [f"{100 * v:g} %{what}" for v in values]


def _failure(title: str, name: str, values: Sequence[float]) -> Failure:
    return Failure(title, _settings(name, _percent(values), values))


_SCALES = (1e-6, 1e-3, 1.0, 1e3, 1e6)
_FAILURES = (
    Failure("readings in the window", (("sound", _drawn()),), sizes=(2, 5, 12, 50, 500)),
    _failure("noise", "noise", (1e-4, 0.01, 0.1, 0.5, 2.0)),
    Failure(
        "correlation",
        _settings("rho", ["0", "0.5", "0.9", "0.98", "0.999"], (0, 0.5, 0.9, 0.98, 0.999)),
    ),
    _failure("toe up to strain", "toe", (0.001, 0.005, 0.01, 0.02, 0.04)),
    _failure("readings at half force", "bad", (0.01, 0.02, 0.05, 0.1, 0.3)),
    _failure("rounding of the force", "step", (0.001, 0.01, 0.05, 0.2, 0.5)),
    _failure("curve ends at", "end", (0.05, 0.047, 0.04, 0.03, 0.01)),
    _failure("curve starts at", "start", (0.001, 0.004, 0.01, 0.02, 0.04)),
    _failure("preload", "preload", (0.01, 0.05, 0.1, 0.2, 0.5)),
    Failure("unit of stress", _settings("unit", [f"{u:g}" for u in _SCALES], _SCALES)),
)
_MACHINE = Machine(u_force_calibration=0.0, u_displacement_calibration=0.0)
_CONTEXT = Context(TECHNIQUE.config(), _MACHINE, {})
_AREA_m2, _HEIGHT_m = 1e-4, 0.01
_NUMBERS = {
    "diameter_m": Quantity((4.0 * _AREA_m2 / np.pi) ** 0.5, "m"),
    "height_m": Quantity(_HEIGHT_m, "m"),
}
_SPECIMEN = Specimen(
    "a", "simulated", "simulated", "compression", "a.csv", None, _NUMBERS, {}, {}, "s.csv", 2
)


def _ask(curves: Sequence[Curve]) -> list[Told]:
    return [_ask_one(curve) for curve in curves]


def _ask_one(curve: Curve) -> Told:
    x, y = curve
    columns = {"displacement_m": x * _HEIGHT_m, "force_N": y * _AREA_m2}
    source = Source("a.csv", "0" * 64, 1, len(x), "utf-8", "simulated")
    measured = TECHNIQUE.reduce(_SPECIMEN, Recording(columns, {}, {}, source), _CONTEXT)
    low, high = np.full(2, np.nan), np.full(2, np.nan)
    flags = [frozenset[str](), frozenset[str]()]
    for value in measured.values:
        k = (MODULUS, COMPENSATED).index(value.key)
        q = value.quantity
        half = coverage_factor(value.degrees_of_freedom) * q.standard_uncertainty
        low[k], high[k] = q.value - half, q.value + half
        flags[k] = frozenset(flag.name for flag in value.flags)
    return Told(low, high, tuple(flags))


ESTIMATOR = Estimator(
    "compression", ("modulus", "toe-compensated modulus"), (15, 60, 250), _FAILURES, _ask, "slope"
)
