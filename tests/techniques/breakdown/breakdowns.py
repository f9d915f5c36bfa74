"""Synthetic breakdown tests for the tests of their room: films, ramps and samples of fields."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from deamat.core.instruments import Machine
from deamat.core.quantity import Quantity
from deamat.core.recording import Recording, Specimen
from deamat.core.records import Measurement, PropertyRecord, Summary
from deamat.core.technique import Context
from deamat.techniques.breakdown import TECHNIQUE
from deamat.techniques.breakdown.config import BreakdownConfig
from deamat.techniques.breakdown.result import FilmTest
from tests.techniques.curves import recording

STRENGTH, SHAPE, UNBIASED, B10, B1 = TECHNIQUE.yields
MICROMETER = Quantity(100e-6, "m", 1e-6, 2e-6)
LAWLESS_I = (
    *(32, 35.4, 36.2, 39.8, 41.2, 43.3, 45.5, 46, 46.2, 46.4),
    *(46.5, 46.8, 47.3, 47.3, 47.6, 49.2, 50.4, 50.9, 52.4, 56.3),
)


def film(
    name: str = "a",
    line: int = 2,
    notes: Mapping[str, str] | None = None,
    **numbers: float | Quantity,
) -> Specimen:
    quantities = {
        k: v if isinstance(v, Quantity) else Quantity(v, k.rpartition("_")[2])
        for k, v in numbers.items()
    }
    return Specimen(
        name, "m", "c", "breakdown", None, None, quantities, {}, notes or {}, "c/b/s.csv", line
    )


def reduce(
    specimen: Specimen, file: Recording | None = None, **config: Any
) -> Measurement[FilmTest]:
    settings = Context(BreakdownConfig(**config), Machine(), {})
    return TECHNIQUE.reduce(specimen, file, settings)


def fields(
    values: Sequence[float], unbroken: Sequence[bool] | None = None, **numbers: float
) -> list[Measurement[FilmTest]]:
    """Register rows that hold fields `[V/um]`."""
    marks = unbroken or [False] * len(values)
    return [
        reduce(
            film(
                f"s{i}", i, {"censored": "yes" if c else "no"},
                breakdown_field_V_per_m=1e6 * x, **numbers,
            )
        )
        for i, (x, c) in enumerate(zip(values, marks, strict=True), start=2)
    ]  # fmt: skip


def summarise(measured: Sequence[Measurement[FilmTest]], **config: Any) -> Summary:
    return TECHNIQUE.summarise(measured, Context(BreakdownConfig(**config), Machine(), {}))


def records(measured: Sequence[Measurement[FilmTest]], **config: Any) -> dict[str, PropertyRecord]:
    return {r.key: r for r in summarise(measured, **config).records}


def ramp_file(top_V: float = 5950.0, *, spike: bool = True, dt: float = 2.0) -> Recording:
    volts = np.append(np.linspace(1000.0, top_V, 100), [30.0, 0.0, 0.0])
    amperes = np.zeros(volts.size)
    amperes[100] = 0.02 if spike else 0.0
    return recording(time_s=dt * np.arange(float(volts.size)), voltage_V=volts, current_A=amperes)


def steps_file(step_V: float = 500.0, hold_s: float = 20.0, noise_V: float = 0.0) -> Recording:
    """Held levels up to 6000 V, the last for half as long as the others, sampled at 2 s."""
    levels = np.arange(step_V, 6000.0 + 1.0, step_V)
    count = round(hold_s / 2.0)
    volts = np.append(np.repeat(levels, count)[: -(count // 2)], [0.0, 0.0, 0.0])
    volts = volts + noise_V * np.random.default_rng(4).standard_normal(volts.size)
    amperes = np.full(volts.size, 2e-6)
    amperes[-3] = 8e-3
    return recording(time_s=2.0 * np.arange(float(volts.size)), voltage_V=volts, current_A=amperes)
